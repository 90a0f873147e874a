//! `topo knot list` and `show`: what the table knows.

use serde_json::{Value, json};
use std::fmt::Write as _;
use topo_knots::{Chirality, KnotEntry, KnotTable, LinkEntry, LinkTable};

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
            chirality(knot.chirality),
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
    let length = match (knot.length_over_radius, &knot.source) {
        (Some(length), Some(source)) => format!("{length:.4} ({source})"),
        _ => missing(),
    };
    let rows = [
        ("knot", names.join(", ")),
        ("crossing number", knot.crossing_number.to_string()),
        ("chirality", chirality(knot.chirality).to_owned()),
        ("braid", numbers(&knot.braid)),
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
        let _ = writeln!(text, "{:21} {}", "also started from", numbers(other));
    }
    text
}

/// All of one knot for programs.
pub(super) fn facts(knot: &KnotEntry) -> Value {
    json!({
        "name": knot.name, "aliases": knot.aliases, "crossing_number": knot.crossing_number, "chirality": chirality(knot.chirality),
        "braid": knot.braid, "other_braids": knot.other_braids, "alexander": knot.invariants.alexander_text(),
        "determinant": knot.invariants.determinant, "signature": knot.invariants.signature,
        "jones": knot.jones.as_ref().map(|jones| jones.text()), "length_over_radius": knot.length_over_radius,
        "source": knot.source,
    })
}

/// A line a link.
pub(super) fn list_of_links(table: &LinkTable) -> String {
    let mut text = format!(
        "\n{:10} {:>11} {:>10}  {:11} {:28} {}\n",
        "link", "components", "L/r", "chirality", "linking numbers", "also called"
    );
    for link in table.iter() {
        let length = link
            .length_over_radius
            .map_or_else(|| "missing".to_owned(), |l| format!("{l:.4}"));
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:10} {:>11} {length:>10}  {:11} {:28} {}",
            link.name,
            link.n_components(),
            chirality(link.chirality),
            numbers(&link.invariants.linking),
            link.aliases.join(", ")
        );
    }
    text
}

fn numbers(list: &[i32]) -> String {
    let list: Vec<String> = list.iter().map(i32::to_string).collect();
    list.join(" ")
}

/// All of one link.
pub(super) fn link(link: &LinkEntry) -> String {
    let missing = || "missing".to_owned();
    let mut names = vec![link.name.clone()];
    names.extend(link.aliases.iter().cloned());
    let length = match (link.length_over_radius, &link.source) {
        (Some(length), Some(source)) => format!("{length:.4} ({source})"),
        _ => missing(),
    };
    let jones = link.invariants.oriented_jones();
    let rows = [
        ("link", names.join(", ")),
        ("crossing number", link.crossing_number.to_string()),
        ("chirality", chirality(link.chirality).to_owned()),
        ("braid", numbers(&link.braid)),
        ("components", link.components.join(" ")),
        ("linking numbers", numbers(&link.invariants.linking)),
        (
            "Jones polynomial",
            jones.map_or_else(missing, |jones| jones.text()),
        ),
        ("published L/r", length),
    ];
    let mut text = String::new();
    for (what, value) in rows {
        let _ = writeln!(text, "{what:21} {value}");
    }
    for other in &link.other_braids {
        let _ = writeln!(text, "{:21} {}", "also started from", numbers(other));
    }
    text
}

/// All of one link for programs.
pub(super) fn link_facts(link: &LinkEntry) -> Value {
    json!({
        "name": link.name, "aliases": link.aliases, "crossing_number": link.crossing_number,
        "chirality": chirality(link.chirality), "braid": link.braid, "other_braids": link.other_braids,
        "components": link.components, "linking_numbers": link.invariants.linking,
        "jones": link.invariants.oriented_jones().map(|jones| jones.text()),
        "length_over_radius": link.length_over_radius, "source": link.source,
    })
}

fn chirality(chirality: Chirality) -> &'static str {
    match chirality {
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
        let links = LinkTable::builtin();
        let text = list_of_links(links);
        assert_eq!(text.lines().count(), links.len() + 2);
        let hopf = text.lines().find(|l| l.starts_with("L2a1")).unwrap();
        assert!(hopf.contains("25.1327") && hopf.contains("hopf"), "{hopf}");
        let shown = link(&links.get("solomon").unwrap());
        assert!(
            shown.contains("-t^(3/2) - t^(7/2) + t^(9/2) - t^(11/2)"),
            "{shown}"
        );
    }
}
