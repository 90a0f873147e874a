//! `topo knot list` and `show`: what the table knows.

use serde_json::{Value, json};
use std::fmt::Write as _;
use topo_knots::{Chirality, KnotEntry, KnotTable};

/// A line a knot.
pub(super) fn list(table: &KnotTable) -> String {
    let mut text = format!(
        "{:10} {:>11} {:>4} {:>10}  {:11} {}\n",
        "knot", "determinant", "sig", "L/r", "chirality", "Alexander polynomial"
    );
    for knot in table.iter() {
        let length = knot
            .length_over_radius
            .map_or_else(|| "missing".to_owned(), |l| format!("{l:.4}"));
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:10} {:>11} {:>4} {:>10}  {:11} {}",
            knot.name,
            knot.invariants.determinant,
            knot.invariants.signature,
            length,
            chirality(knot),
            knot.invariants.alexander_text()
        );
    }
    text
}

/// All of one knot.
pub(super) fn entry(knot: &KnotEntry) -> String {
    let missing = || "missing".to_owned();
    let mut names = vec![knot.name.clone()];
    names.extend(knot.aliases.iter().cloned());
    let word = |word: &[i32]| {
        let letters: Vec<String> = word.iter().map(i32::to_string).collect();
        letters.join(" ")
    };
    let length = match (knot.length_over_radius, &knot.source) {
        (Some(length), Some(source)) => format!("{length:.4} ({source})"),
        _ => missing(),
    };
    let rows = [
        ("knot", names.join(", ")),
        ("crossing number", knot.crossing_number.to_string()),
        ("chirality", chirality(knot).to_owned()),
        ("braid", word(&knot.braid)),
        ("Alexander polynomial", knot.invariants.alexander_text()),
        ("determinant", knot.invariants.determinant.to_string()),
        ("signature", knot.invariants.signature.to_string()),
        (
            "Jones polynomial",
            knot.jones
                .as_ref()
                .map_or_else(missing, |jones| jones.text()),
        ),
        ("published L/r", length),
    ];
    let mut text = String::new();
    for (what, value) in rows {
        let _ = writeln!(text, "{what:21} {value}");
    }
    for other in &knot.other_braids {
        let _ = writeln!(text, "{:21} {}", "also started from", word(other));
    }
    text
}

/// All of one knot for programs.
pub(super) fn facts(knot: &KnotEntry) -> Value {
    json!({
        "name": knot.name, "aliases": knot.aliases, "crossing_number": knot.crossing_number, "chirality": chirality(knot),
        "braid": knot.braid, "other_braids": knot.other_braids, "alexander": knot.invariants.alexander_text(),
        "determinant": knot.invariants.determinant, "signature": knot.invariants.signature,
        "jones": knot.jones.as_ref().map(|jones| jones.text()), "length_over_radius": knot.length_over_radius,
        "source": knot.source,
    })
}

fn chirality(knot: &KnotEntry) -> &'static str {
    match knot.chirality {
        Chirality::Chiral => "chiral",
        Chirality::Amphichiral => "amphichiral",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn list_and_show_mark_what_is_missing() {
        let table = KnotTable::builtin();
        let text = list(&table);
        assert_eq!(text.lines().count(), table.len() + 1);
        let granny = text.lines().find(|l| l.starts_with("3_1#3_1")).unwrap();
        assert!(granny.contains("missing"), "{granny}");
        let shown = entry(&table.get("T(3,4)").unwrap());
        assert!(shown.contains("60.9858 (ashton2011)") && shown.contains("t^3 + t^5 - t^8"));
    }
}
