//! `cargo xtask knot identify`: the type of a curve in a file.

use crate::cli::IdentifyArgs;
use crate::error::XtaskError;
use std::fmt::Write as _;
use topo_knots::{KnotTable, identify, identify_open, read_components};

/// What is found, component by component.
pub(super) fn report(args: &IdentifyArgs, table: &KnotTable) -> Result<String, XtaskError> {
    let components = read_components(&args.file)?;
    if components.is_empty() {
        return Err(XtaskError::Input(format!(
            "{}: there is no vertex in it",
            args.file.display()
        )));
    }
    let mut text = String::new();
    let several = components.len() > 1;
    if several {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "a link of {} components; how they are linked is not told, each is named by itself",
            components.len()
        );
    }
    for (k, component) in components.iter().enumerate() {
        if several {
            let _ = write!(text, "component {}: ", k + 1);
        }
        let closed = args.closed || !args.open && component.closed.unwrap_or(true);
        if closed {
            let kind = identify(&component.vertices, table)?;
            let _ = writeln!(text, "{}", kind.describe());
            let sureness = if kind.is_certain() {
                "certain: every knot of so few crossings was compared".to_owned()
            } else if kind.types().len() == 1 {
                format!(
                    "consistent: nothing contradicts it, but the table is complete only to {} crossings",
                    table.complete_up_to()
                )
            } else {
                "not certain".to_owned()
            };
            let _ = writeln!(
                text,
                "  {} crossings in the simplest diagram found; {sureness}",
                kind.n_crossings
            );
            let jones = kind
                .jones
                .as_ref()
                .map_or_else(|| "not computed".to_owned(), |jones| jones.text());
            let _ = writeln!(
                text,
                "  Alexander polynomial {}, determinant {}, signature {}, Jones polynomial {jones}",
                kind.invariants.alexander_text(),
                kind.invariants.determinant,
                kind.invariants.signature
            );
        } else {
            let found = identify_open(&component.vertices, args.closures, 0, table)?;
            let _ = writeln!(
                text,
                "{} in {:.1} % of {} closures (open curve)",
                found.dominant(),
                100.0 * found.probability(found.dominant()),
                found.n_closures
            );
            for (label, share) in found.distribution.iter().skip(1) {
                let _ = writeln!(text, "  {label} in {:.1} %", 100.0 * share);
            }
        }
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_knots::{closed_braid, write_curve};

    #[test]
    fn files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("knot.vect");
        let table = KnotTable::builtin();
        write_curve(&path, &closed_braid(&[-1, -1, -1]).unwrap()).unwrap();
        let mut args = IdentifyArgs {
            file: path,
            open: false,
            closed: false,
            closures: 20,
        };
        let text = report(&args, &table).unwrap();
        assert!(text.starts_with("m3_1, the mirror image of 3_1\n") && text.contains("certain:"));
        args.open = true;
        assert!(report(&args, &table).unwrap().starts_with("m3_1 in "));
        args.file = folder.path().join("two.xyz");
        std::fs::write(&args.file, "0 0 0\n1 0 0\n0 1 0\n\n9 9 9\n9 8 9\n8 9 9\n").unwrap();
        args.open = false;
        let text = report(&args, &table).unwrap();
        assert!(text.contains("a link of 2 components") && text.contains("component 2: 0_1"));
        std::fs::write(&args.file, "0 0 0\n0 nan 0\n").unwrap();
        let error = report(&args, &table).unwrap_err();
        assert!(error.to_string().contains("vertex 1 is not finite"));
    }
}
