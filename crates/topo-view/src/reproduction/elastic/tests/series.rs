//! Claims 9 and 15, which read how energy and knot types change in time.

use super::super::phases::WITHOUT_INTERMEDIATE;
use super::*;
use std::fmt::Write as _;
use topo_knots::{KnotTable, closed_braid, identify};

fn write(folder: &Path, case: &str, moments: &[(f64, f64, f64, &str)]) {
    let mut text = "cut,time,energy,knot\n".to_owned();
    for (cut, time, energy, knot) in moments {
        writeln!(text, "{cut},{time},{energy},{knot}").unwrap();
    }
    let path = folder.join(case).join("series.csv");
    crate::data::write(&path, text.as_bytes()).unwrap();
}

/// Untwisted knots, of which those listed pass through 3_1; a second cut of all passes through nothing if `tie`.
fn passing(dir: &Path, through: &[&str], tie: bool) -> Tables {
    let mut all = rows(&[0.0], |_| {});
    for row in &all {
        let between = if through.contains(&row.knot.as_str()) {
            "3_1"
        } else {
            &row.knot
        };
        let kinds = [row.knot.as_str(), between, "", "0_1"];
        let mut moments: Vec<_> = (0..)
            .zip(kinds)
            .map(|(t, k)| (0.0, f64::from(t), 1.0, k))
            .collect();
        moments.push((0.5, 0.0, 1.0, &row.knot));
        moments.push((0.5, 1.0, 1.0, "0_1"));
        write(&dir.join("elastic"), &row.case, &moments);
    }
    if tie {
        let mut ties = all.clone();
        ties.iter_mut().for_each(|r| r.cut = 0.5);
        all.extend(ties);
    }
    let mut made = tables(all);
    made.results = dir.to_owned();
    made
}

#[test]
fn claim_9_counts_the_knots_that_have_a_simpler_one() {
    let dir = tempfile::tempdir().unwrap();
    let seven = ["5_1", "5_2", "6_1", "7_1", "7_2", "7_3", "7_4"];
    let found = finding(9, &passing(dir.path(), &seven, false));
    assert_eq!(found.verdict, Confirmed);
    assert!(
        found.found.contains("7₄ → 3₁ → 0₁; 7 of 12"),
        "{}",
        found.found
    );
    // half is not most
    assert_eq!(verdict(9, &passing(dir.path(), &seven[1..], false)), Partly);
    assert_eq!(verdict(9, &passing(dir.path(), &["7_4"], false)), Partly);
    // most others, not 7_4; 4_1 does not count
    let others = ["4_1", "5_1", "5_2", "6_1", "7_1", "7_2", "7_3"];
    let found = finding(9, &passing(dir.path(), &others, false));
    assert_eq!(found.verdict, NotConfirmed);
    assert!(found.found.contains("6 of 12"), "{}", found.found);
    assert_eq!(verdict(9, &passing(dir.path(), &[], false)), NotConfirmed);
    // at the other half of the cuts none passes through another
    let tied = passing(dir.path(), &seven, true);
    assert_eq!(
        (verdict(9, &tied), other(9, &tied)),
        (Confirmed, NotConfirmed)
    );
}

/// Crossing by crossing of the braid words of the table: twelve knots become a simpler one by one change, 3_1 and 4_1 the unknot.
#[test]
fn all_but_two_knots_are_one_crossing_change_from_a_simpler_one() {
    let table = KnotTable::builtin();
    for knot in KNOTS {
        let entry = table.get(knot).unwrap();
        let simpler = (0..entry.braid.len()).any(|k| {
            let mut word = entry.braid.clone();
            word[k] = -word[k];
            let kind = identify(closed_braid(&word).unwrap().vertices(), &table).unwrap();
            !kind.is_unknot()
                && kind.types().iter().all(|name| {
                    let found = table.get(&name.to_string());
                    found.is_ok_and(|other| other.crossing_number < entry.crossing_number)
                })
                && !kind.types().is_empty()
        });
        assert_eq!(simpler, !WITHOUT_INTERMEDIATE.contains(&knot), "{knot}");
    }
}

/// Twenty discharges, the first `n_slow` of which end at the rate of the slowest mode, the others twice as fast.
fn ending(dir: &Path, folder: &str, n_slow: usize) -> Vec<Cut> {
    let mut all = rows(&[-1.0, 1.0], |_| {});
    all.truncate(20);
    for (k, row) in all.iter().enumerate() {
        // T_b = 2 L² η/(π² h² E_b) is 5.066 T_0 at L = 50 h
        let rate = if k < n_slow { 1.0 } else { 2.0 } / 5.066;
        let moments: Vec<_> = (0..40)
            .map(|t| {
                let t = f64::from(t);
                // twist is gone at once
                (0.0, t, (-rate * t).exp() + 5.0 * (-70.0 * t).exp(), "")
            })
            .collect();
        write(&dir.join(folder), &row.case, &moments);
    }
    all
}

#[test]
fn claim_15_needs_discharges_that_end_at_the_rate_of_the_slowest_mode() {
    let dir = tempfile::tempdir().unwrap();
    for (n_slow, expected) in [
        (20, Confirmed),
        (18, Confirmed),
        (12, Partly),
        (9, NotConfirmed),
        (0, NotConfirmed),
    ] {
        let mut made = tables(ending(dir.path(), "elastic", 12));
        made.results = dir.path().to_owned();
        // the sweep alone
        let alone = finding(15, &made);
        assert_eq!(alone.verdict, Partly);
        assert!(alone.found.contains("99.9 % only") && alone.other_reading.is_none());
        let mut last = side("last", ending(dir.path(), "last", n_slow));
        last.folder = dir.path().join("last");
        made.last = Some(last);
        assert_eq!(verdict(15, &made), expected, "{n_slow}");
        assert_eq!(other(15, &made), Partly);
    }
}
