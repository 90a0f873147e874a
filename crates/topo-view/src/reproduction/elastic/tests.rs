//! Each claim on tables made by hand: one that bears it out, one that does in part, one that does not.
//!
//! Numbers are those of the claim as published or of its opposite; none is of a run.

mod charging;
mod discharge;
mod series;

use super::CLAIMS;
use crate::data::{Cut, KNOTS, Sweep};
use crate::reproduction::Finding;
use crate::reproduction::claim::Verdict::{Confirmed, NotConfirmed, NotJudged, Partly};
use crate::reproduction::claim::{ByCriterion, Side, Tables, Verdict};
use std::path::Path;

/// The seventeen published twists.
fn twists() -> Vec<f64> {
    (0..17).map(|k| -2.0 + 0.25 * f64::from(k)).collect()
}

/// Rows of all knots at `twists`, cut once, each changed by `change`.
fn rows(twists: &[f64], change: impl Fn(&mut Cut)) -> Vec<Cut> {
    let mut rows = Vec::new();
    for knot in KNOTS {
        for &twist in twists {
            let mut row = Cut {
                case: format!("{knot}_{twist}"),
                knot: knot.to_owned(),
                twist,
                energy: 1.0,
                total_twist: twist,
                link_drift: Some(1e-14),
                ..Cut::default()
            };
            change(&mut row);
            rows.push(row);
        }
    }
    rows
}

fn tables(rows: Vec<Cut>) -> Tables {
    Tables {
        results: Path::new("nowhere").to_owned(),
        elastic: Sweep::of_rows(rows),
        choices: Vec::new(),
        criteria: Vec::new(),
        last: None,
        nematic: None,
    }
}

/// The published sweep with changed rows.
fn published(change: impl Fn(&mut Cut)) -> Tables {
    tables(rows(&twists(), change))
}

fn side(name: &str, rows: Vec<Cut>) -> Side {
    Side {
        name: name.to_owned(),
        folder: Path::new("nowhere").to_owned(),
        sweep: Sweep::of_rows(rows).unwrap(),
    }
}

fn finding(claim: usize, tables: &Tables) -> Finding {
    let found = CLAIMS[claim - 1].finding(claim, tables);
    found.unwrap_or_else(|| panic!("nothing said to claim {claim}"))
}

fn verdict(claim: usize, tables: &Tables) -> Verdict {
    finding(claim, tables).verdict
}

/// The outcome under the other reading.
fn other(claim: usize, tables: &Tables) -> Verdict {
    finding(claim, tables).other_reading.unwrap().verdict
}

#[test]
fn flagged_runs_confirm_nothing() {
    let one = |r: &mut Cut| {
        if r.knot == "7_7" && r.twist == 2.0 {
            r.warnings = "discharge: strands overlap deeply".into();
        }
    };
    let energy = |r: &mut Cut| r.energy = 1.0 + 0.1 * f64::from(r.twist > 0.0);
    assert_eq!(verdict(2, &published(energy)), Confirmed);
    let flagged = published(|r| {
        energy(r);
        one(r);
    });
    let found = finding(2, &flagged);
    assert_eq!(found.verdict, Partly);
    assert_eq!(found.doubt.unwrap(), "1 of 238 runs carry warnings");
    // what is not borne out stays so
    assert_eq!(verdict(2, &published(one)), NotConfirmed);
}

#[test]
fn claims_say_nothing_without_what_they_need() {
    let untwisted = tables(rows(&[0.0], |_| {}));
    for claim in [2, 3, 4, 5, 6, 7, 8, 14] {
        let found = CLAIMS[claim - 1].finding(claim, &untwisted);
        assert!(found.is_none(), "{claim}: {found:?}");
    }
}
