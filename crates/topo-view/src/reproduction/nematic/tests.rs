//! Each verdict on tables made by hand, as claimed, in part, not, and with what the claim compares left out.

mod charging;
mod discharging;

use super::CLAIMS;
use crate::data::NematicSweep;
use crate::reproduction::claim::Verdict::{Confirmed, NotJudged};
use crate::reproduction::claim::{Tables, Verdict};
use std::f64::consts::PI;
use std::path::Path;
use topo_analysis::Flow;
use topo_analysis::NematicRow;

const RADIUS: f64 = 20.0;
/// First buckled charge.
const ONSET: u32 = 7;
/// Rate of the slowest mode between plates 87 apart, 2 π²/L_z².
const MODE: f64 = 2.0 * PI * PI / (87.0 * 87.0);

/// A state as the published work has it: flat below the buckling, tilted and undulating above, fastest just below.
fn row(q: u32) -> NematicRow {
    let x = f64::from(q);
    let above = f64::from(q.saturating_sub(ONSET));
    let buckled = q >= ONSET;
    let pick = |a: f64, b: f64| if buckled { b } else { a };
    NematicRow {
        case: format!("q{q:02}"),
        radius: RADIUS,
        spacing: 1.5,
        q,
        boundary: "cut-link".into(),
        precision: "f64".into(),
        flow: Flow::Off,
        f_charged: 500.0 + 80.0 * x,
        order_parameter: pick(1e-6, 0.05 + 0.01 * above),
        ring_mode: Some(q),
        ring_amplitude: Some(pick(1e-5, 4.0 + 0.5 * above)),
        t50: Some(10.0 / x),
        t99: Some(pick(150.0 / x, 30.0 + 25.0 * above)),
        t999: Some(pick(270.0 / x, 500.0 + 100.0 * above)),
        late_rate: Some(pick(0.1, 1.04 * MODE)),
        ..NematicRow::default()
    }
}

/// Tables of these runs, with files of the cases in a folder.
fn tables(folder: &Path, rows: Vec<NematicRow>, flowing: Vec<NematicRow>) -> Tables {
    Tables {
        results: folder.to_owned(),
        elastic: None,
        choices: Vec::new(),
        criteria: Vec::new(),
        last: None,
        nematic: Some(NematicSweep {
            folder: folder.to_owned(),
            rows,
            flowing,
        }),
    }
}

/// What claim `n` says to rows, with files of the cases in a folder.
fn said(n: usize, rows: &[NematicRow], folder: &Path) -> (String, Verdict) {
    let (flowing, still) = rows.iter().cloned().partition(|r| r.flow.is_on());
    (CLAIMS[n - 16].look)(&tables(folder, still, flowing)).unwrap()
}

/// The verdict on claim `n` of the states q = 1 to 10 after a change; no files.
fn verdict(n: usize, change: impl Fn(&mut Vec<NematicRow>)) -> Verdict {
    let mut rows: Vec<NematicRow> = (1..=10).map(row).collect();
    change(&mut rows);
    said(n, &rows, Path::new("no files")).1
}

fn as_it_is(_: &mut Vec<NematicRow>) {}

fn only_flat(rows: &mut Vec<NematicRow>) {
    rows.retain(|r| r.q < ONSET);
}

fn only_buckled(rows: &mut Vec<NematicRow>) {
    rows.retain(|r| r.q >= ONSET);
}

#[test]
fn runs_with_warnings_confirm_nothing() {
    let flag = |from: u32| {
        move |rows: &mut Vec<NematicRow>| {
            for r in rows.iter_mut().filter(|r| r.q >= from) {
                r.warnings.push(format!(
                    "charge {} is under-resolved: 6 nodes a wavelength",
                    r.q
                ));
            }
        }
    };
    for n in [16, 18, 19, 20, 21, 22, 25, 26, 27, 28] {
        let mut rows: Vec<NematicRow> = (1..=10).map(row).collect();
        flag(1)(&mut rows);
        let (found, verdict) = said(n, &rows, Path::new("no files"));
        assert_eq!(verdict, NotJudged, "claim {n}: {found}");
        // nothing resolved on the one side: only what is said of the other stands
        let mut rows: Vec<NematicRow> = (1..=10).map(row).collect();
        flag(ONSET)(&mut rows);
        let (found, verdict) = said(n, &rows, Path::new("no files"));
        let expected = if n == 25 { Confirmed } else { NotJudged };
        assert_eq!(verdict, expected, "claim {n}: {found}");
        assert!(
            found.contains("left out for their warnings: q = 7 to 10"),
            "{found}"
        );
    }
}
