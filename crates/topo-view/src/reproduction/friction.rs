//! The study of friction: what the times of untwisted knots owe to stiffness, range and ratio.

use super::claim::{Side, there};
use crate::data::Sweep;
use crate::error::ViewError;
use crate::plot::text;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;
use topo_analysis::median;
use topo_lab::{ElasticScene, Preset, Purpose, Variant};
use topo_rod::FrictionRange;

/// One choice of friction: times of the untwisted knots, one cut each at the largest energy density.
#[derive(Debug, Serialize)]
pub struct Row {
    /// Contact stiffness k_c.
    stiffness: f64,
    /// Friction range: 2h, or a multiple of the contact diameter d_c.
    range: String,
    /// η_f/η.
    ratio: f64,
    /// Knots with a time.
    n_knots: usize,
    /// Median of t99 over the knots, in T_0.
    median_t99: f64,
    /// Median over the knots of t99 over that of the default choice.
    median_t99_over_default: f64,
    /// t99 of 3_1 over the median of the knots.
    t99_of_3_1_over_median: Option<f64>,
    /// t99 of 7_4 over the median of the knots.
    t99_of_7_4_over_median: Option<f64>,
    /// Runs that carry warnings.
    n_flagged: usize,
    /// Folder of the runs.
    folder: String,
}

/// The rows of the study, the default first; empty where it was not run.
pub fn study(results: &Path) -> Result<Vec<Row>, ViewError> {
    let published = ElasticScene::published(Preset::Paper);
    let Some(default) = there(Sweep::read(results))? else {
        return Ok(Vec::new());
    };
    let mut rows: Vec<Row> = row(&published, &default, &default).into_iter().collect();
    let mut is_run = false;
    for variant in published.variants() {
        let same_reading = variant.scene.rod.reading == published.rod.reading;
        let is_of_friction = matches!(variant.purpose, Purpose::Choice | Purpose::Friction);
        if !is_of_friction || !same_reading {
            continue;
        }
        let Variant { scene, purpose, .. } = variant.clone();
        if let Some(side) = Side::read(results, variant)? {
            is_run |= purpose == Purpose::Friction;
            rows.extend(row(&scene, &side.sweep, &default));
        }
    }
    if !is_run {
        rows.clear();
    }
    Ok(rows)
}

/// t99 of the untwisted knots at the largest energy density.
fn times(s: &Sweep) -> Vec<(&str, f64)> {
    let each = |k| Some((k, s.at(k, 0.0)?.first().t99?));
    s.knots().into_iter().filter_map(each).collect()
}

fn row(scene: &ElasticScene, sweep: &Sweep, default: &Sweep) -> Option<Row> {
    let (own, usual) = (times(sweep), times(default));
    let of = |list: &[(&str, f64)], knot: &str| {
        let found = list.iter().find(|k| k.0 == knot);
        found.map(|k| k.1)
    };
    let middle = median(own.iter().map(|k| k.1))?;
    let over_default = own.iter().filter_map(|k| Some(k.1 / of(&usual, k.0)?));
    let (contact, friction) = (scene.rod.contact?, scene.rod.friction?);
    let first = |k| Some(sweep.at(k, 0.0)?.first());
    let untwisted = sweep.knots().into_iter().filter_map(first);
    Some(Row {
        stiffness: contact.stiffness,
        range: match friction.range {
            FrictionRange::Reading => "2h".to_owned(),
            FrictionRange::Contact => "d_c".to_owned(),
            FrictionRange::TimesContact(factor) => format!("{factor} d_c"),
        },
        ratio: friction.ratio,
        n_knots: own.len(),
        median_t99: middle,
        median_t99_over_default: median(over_default)?,
        t99_of_3_1_over_median: of(&own, "3_1").map(|t| t / middle),
        t99_of_7_4_over_median: of(&own, "7_4").map(|t| t / middle),
        n_flagged: untwisted.filter(|r| !r.warnings.is_empty()).count(),
        folder: scene.folder.clone(),
    })
}

/// The study as a table for `reproduction.md`; empty without rows.
pub fn markdown(rows: &[Row]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut table = "\nStudy of friction: untwisted knots, one cut each at the largest energy density; the first row is the default.\n\n\
         | k_c | range | η_f/η | knots | median t99, T₀ | t99 over default, median | 3₁ over median | 7₄ over median | runs with warnings |\n\
         |---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for r in rows {
        let cell = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| text::number(x, 2));
        // writing to a string cannot fail
        let _ = writeln!(
            table,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            r.stiffness,
            r.range,
            r.ratio,
            r.n_knots,
            text::number(r.median_t99, 2),
            text::number(r.median_t99_over_default, 3),
            cell(r.t99_of_3_1_over_median),
            cell(r.t99_of_7_4_over_median),
            r.n_flagged
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Cut;

    /// Writes 3_1, 7_4 and two others, untwisted, with the given t99 and a near tie that does not count.
    fn write(folder: &Path, t99: [f64; 4]) {
        let mut rows = Vec::new();
        for (knot, t99) in ["3_1", "5_1", "5_2", "7_4"].into_iter().zip(t99) {
            for (cut, t99) in [(0.1, t99), (0.6, 99.0)] {
                rows.push(Cut {
                    knot: knot.to_owned(),
                    cut,
                    t99: Some(t99),
                    ..Cut::default()
                });
            }
        }
        std::fs::create_dir_all(folder).unwrap();
        topo_analysis::write_table(&folder.join("sweep.csv"), &rows).unwrap();
    }

    #[test]
    fn the_study_compares_the_knots_one_by_one_with_the_default() {
        let dir = tempfile::tempdir().unwrap();
        assert!(study(dir.path()).unwrap().is_empty());
        write(&dir.path().join("elastic"), [20.0, 10.0, 10.0, 30.0]);
        write(
            &dir.path().join("elastic-contact-range"),
            [20.0, 10.0, 10.0, 30.0],
        );
        // other readings are no part of it, nor is one other choice a study
        write(&dir.path().join("elastic-tight"), [20.0, 10.0, 10.0, 30.0]);
        assert!(study(dir.path()).unwrap().is_empty());
        write(
            &dir.path().join("elastic-friction-range-1.2"),
            [10.0, 20.0, 20.0, 60.0],
        );
        let rows = study(dir.path()).unwrap();
        let ranges: Vec<&str> = rows.iter().map(|r| r.range.as_str()).collect();
        assert_eq!(ranges, ["2h", "d_c", "1.2 d_c"]);
        assert_eq!(
            (rows[0].median_t99, rows[0].median_t99_over_default),
            (15.0, 1.0)
        );
        let last = &rows[2];
        assert_eq!((last.median_t99, last.median_t99_over_default), (20.0, 2.0));
        assert_eq!(last.t99_of_3_1_over_median, Some(0.5));
        assert_eq!(last.t99_of_7_4_over_median, Some(3.0));
        let table = markdown(&rows);
        assert!(
            table.contains("| 20 | 1.2 d_c | 0.1 | 4 | 20 | 2 | 0.5 | 3 | 0 |"),
            "{table}"
        );
    }
}
