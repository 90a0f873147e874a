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
    write_curves(path, std::slice::from_ref(curve))
}

/// Writes several curves, the components of a link, in the format of the extension of `path`.
///
/// # Errors
/// As [`write_curve`].
pub fn write_curves(path: &Path, curves: &[Polyline]) -> Result<(), KnotError> {
    let text = curves_text(curves, CurveFormat::of(path)?);
    Ok(write_atomic_bytes(path, text.as_bytes())?)
}

/// The text of a curve in a format; numbers read back to the bit.
///
/// # Validation
/// `curves_survive_every_format`, `curves_come_back_to_the_bit`.
pub fn curve_text(curve: &Polyline, format: CurveFormat) -> String {
    curves_text(std::slice::from_ref(curve), format)
}

/// The text of several curves, as [`curve_text`] of one: with a column `component` counted from 1, blank lines between components, or
/// as the components of a VECT file.
///
/// # Validation
/// `components_come_back_to_the_bit`
pub fn curves_text(curves: &[Polyline], format: CurveFormat) -> String {
    let several = curves.len() > 1;
    let (mut text, comma) = match format {
        CurveFormat::Csv if several => ("component,x,y,z\n".to_owned(), ','),
        CurveFormat::Csv => ("x,y,z\n".to_owned(), ','),
        CurveFormat::Xyz => (String::new(), ' '),
        CurveFormat::Vect => (vect_head(curves), ' '),
    };
    for (k, curve) in curves.iter().enumerate() {
        if k > 0 && format == CurveFormat::Xyz {
            text.push('\n');
        }
        let component = match several && format == CurveFormat::Csv {
            true => format!("{},", k + 1),
            false => String::new(),
        };
        for x in curve.vertices() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{component}{}{comma}{}{comma}{}", x.x, x.y, x.z);
        }
    }
    text
}

fn vect_head(curves: &[Polyline]) -> String {
    let n: usize = curves.iter().map(Polyline::n_vertices).sum();
    let size = |curve: &Polyline| {
        let sign = if curve.is_closed() { "-" } else { "" };
        format!("{sign}{}", curve.n_vertices())
    };
    let sizes: Vec<String> = curves.iter().map(size).collect();
    let colours = vec!["0"; curves.len()];
    format!(
        "VECT\n{} {n} 0\n{}\n{}\n",
        curves.len(),
        sizes.join(" "),
        colours.join(" ")
    )
}
