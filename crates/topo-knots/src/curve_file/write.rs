//! Curves to files.

use std::fmt::Write as _;
use std::path::Path;

use topo_core::{Polyline, write_atomic_bytes};

use super::CurveFormat;
use crate::KnotError;

/// Writes a curve in the format of the extension of `path`.
///
/// # Errors
/// [`KnotError::CurveFile`] for an unknown extension, [`KnotError::File`] if it cannot be written.
pub fn write_curve(path: &Path, curve: &Polyline) -> Result<(), KnotError> {
    let text = curve_text(curve, CurveFormat::of(path)?);
    Ok(write_atomic_bytes(path, text.as_bytes())?)
}

/// The text of a curve in a format; numbers read back to the bit.
///
/// # Validation
/// `curves_survive_every_format`, `curves_come_back_to_the_bit`.
pub fn curve_text(curve: &Polyline, format: CurveFormat) -> String {
    let n = curve.n_vertices();
    let (mut text, comma) = match format {
        CurveFormat::Csv => ("x,y,z\n".to_owned(), ','),
        CurveFormat::Xyz => (String::new(), ' '),
        CurveFormat::Vect => {
            let sign = if curve.is_closed() { "-" } else { "" };
            (format!("VECT\n1 {n} 0\n{sign}{n}\n0\n"), ' ')
        }
    };
    for x in curve.vertices() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}{comma}{}{comma}{}", x.x, x.y, x.z);
    }
    text
}
