//! Texts on the terminal.

use std::io::Write as _;

/// Writes to the terminal; a closed pipe (`| head`) is no fault.
pub fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
