//! Cells of warnings.

/// Adds a warning to a cell of warnings.
pub(crate) fn push_warning(warnings: &mut String, text: &str) {
    if !warnings.is_empty() {
        warnings.push(';');
    }
    // `;` separates warnings
    warnings.push_str(&text.replace(';', ","));
}
