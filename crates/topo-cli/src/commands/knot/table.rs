//! The table that `cargo xtask knot tighten` leaves beside the curves.

use super::subject::{Facts, Subject};

const HEAD: &str = "| knot | L/r | published | excess (%) | writhe | struts | kinks | residual | CPU s |\n|---|---|---|---|---|---|---|---|---|\n";

/// A line of the table, and what its last line needs.
pub(super) struct Row {
    line: String,
    excess: Option<f64>,
    /// Said on the terminal.
    pub sentence: String,
}

impl Row {
    pub(super) fn new(subject: &Subject, tight: &Facts<'_>, sentence: String) -> Self {
        let length = tight.length_over_radius;
        let (published, _) = subject.published();
        let excess = excess(published, length);
        let missing = || "missing".to_owned();
        let mark = if tight.converged {
            ""
        } else {
            " (not converged)"
        };
        let line = format!(
            "| {} | {length:.4}{mark} | {} | {} | {:+.3} | {} | {} | {:.4} | {:.1} |\n",
            tight.name,
            published.map_or_else(missing, |l| format!("{l:.4}")),
            excess.map_or_else(missing, |e| format!("{e:+.3}")),
            tight.writhe,
            tight.n_struts,
            tight.n_kinks,
            tight.residual,
            tight.cpu_seconds
        );
        Self {
            line,
            excess,
            sentence,
        }
    }
}

/// Length over the published one, in percent above it.
pub(super) fn excess(published: Option<f64>, length: f64) -> Option<f64> {
    published.map(|l| 100.0 * (length / l - 1.0))
}

/// The table in Markdown, with the median and the largest excess below.
pub(super) fn markdown(rows: &[Row]) -> String {
    let mut text = HEAD.to_owned();
    rows.iter().for_each(|row| text += &row.line);
    let mut excesses: Vec<f64> = rows.iter().filter_map(|row| row.excess).collect();
    excesses.sort_by(f64::total_cmp);
    if let (Some(median), Some(largest)) = (excesses.get(excesses.len() / 2), excesses.last()) {
        text += &format!(
            "\nOf {} knots with a published length: median excess {median:+.3} %, largest {largest:+.3} %.\n",
            excesses.len()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::knot::subject::Tight;
    use topo_knots::{KnotTable, TightenSettings, tighten_entry};

    #[test]
    fn table_has_a_line_a_knot_and_says_what_is_missing() {
        let table = KnotTable::builtin();
        let settings = TightenSettings {
            per_unit: 2.0,
            search_vertices: 60,
            n_variants: 0,
            n_kicks: 0,
            n_kicks_a_start: 0,
            ..TightenSettings::draft()
        };
        let knot = &*table.get("3_1").unwrap();
        let tight = tighten_entry(knot, &settings).unwrap();
        let mut unpublished = knot.clone();
        unpublished.length_over_radius = None;
        let tight = Tight::Knot(Box::new(tight));
        let rows =
            [knot.clone(), unpublished].map(|k| Row::new(&k.into(), &tight.facts(), String::new()));
        let text = markdown(&rows);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[2].starts_with("| 3_1 | 3") && lines[2].contains("| 32.7436 | +"));
        assert!(lines[3].contains("| missing | missing |"));
        assert!(lines[5].starts_with("Of 1 knots"), "{text}");
    }
}
