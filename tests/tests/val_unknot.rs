//! The unknot as a battery: a circle that is charged, cut and discharged like any knot, against its exact discharge.

use std::f64::consts::PI;

use topo_analysis::DischargeTimes;
use topo_core::RunHooks;
use topo_knots::{KnotTable, TightenSettings, tighten_entry};
use topo_rod::{
    Accuracy, ChargeSettings, CutSite, Discharge, DischargeSettings, Guards, RodBattery,
    RodParameters, cut_circle_time,
};

const SHARES: [f64; 4] = [0.5, 0.9, 0.99, 0.999];
const ELASTIC: [&str; 3] = ["bend", "twist", "stretch"];

fn discharged(n_edges: usize) -> Discharge {
    let table = KnotTable::builtin();
    let knot = table.get("0_1").unwrap();
    let tight = tighten_entry(&knot, &TightenSettings::draft()).unwrap();
    let parameters = RodParameters {
        n_edges,
        ..Default::default()
    };
    let accuracy = Accuracy {
        tolerance: 1e-6,
        ..Default::default()
    };
    let centreline = tight.centreline().unwrap();
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &centreline).unwrap();
    assert!((battery.ropelength() / (2.0 * PI) - 1.0).abs() < 1e-4);
    let charged = battery
        .charge(&ChargeSettings::default(), &mut RunHooks::default())
        .unwrap();
    let stored = charged.record().samples.last().unwrap();
    // pi B/R for the circle of 50 h, and nothing else
    let energy = 0.125 * PI * (2.0 * PI / 50.0_f64).powi(2);
    let excess = stored.elastic() / energy - 1.0;
    assert!(
        excess.abs() < 7.0 / (n_edges * n_edges) as f64,
        "{excess:.1e}"
    );
    assert_eq!(stored.stored[3], 0.0);
    assert_eq!((stored.n_contacts, stored.min_distance), (0, None));
    let run = charged
        .cut(CutSite::MaximumEnergyDensity)
        .and_then(|cut| cut.discharge(&DischargeSettings::default(), &mut RunHooks::default()))
        .unwrap();
    assert!(run.is_finished(), "{}", run.record.report.stop);
    assert!((run.start / stored.elastic() - 1.0).abs() < 1e-12);
    // one vertex of N held 1/N of the energy
    let lost = 1.0 - run.after_cut / run.start;
    assert!((lost * n_edges as f64 - 1.0).abs() < 0.02, "{lost}");
    run
}

/// Relative errors of the four times, released shares counted from `of`.
fn errors(run: &Discharge, of: f64) -> [f64; 4] {
    let times = DischargeTimes::of(&run.record.curve, &ELASTIC, of, &SHARES);
    SHARES.map(|share| {
        let exact = cut_circle_time(share).unwrap() * 50.0 / (PI * PI);
        times.at(share).unwrap().value / exact - 1.0
    })
}

/// Its four times converge at second order when shares count from the energy before the cut. From just after it they would be of
/// first order: a vertex of N is lost.
#[test]
fn val_the_unknot_discharges_as_its_series() {
    let runs = [50, 100, 200].map(discharged);
    let found = runs.each_ref().map(|run| errors(run, run.start));
    let after = runs.each_ref().map(|run| errors(run, run.after_cut));
    for (n, (before, after)) in [50, 100, 200].iter().zip(found.iter().zip(&after)) {
        println!("N = {n}: {before:?} from before the cut, {after:?} from after it");
    }
    for (k, share) in SHARES.iter().enumerate() {
        let order = (found[0][k] / found[2][k]).abs().log2() / 2.0;
        println!("{share}: order {order:.2}");
        assert!(found[2][k].abs() < 3e-3, "{share}: {:.1e}", found[2][k]);
        assert!(order > 1.7, "{share}: order {order:.2}");
    }
    assert!(found[2][0].abs() < 5e-4);
    assert!(after[2][0] > 8e-3, "the countings do not differ");
}

/// A share that the cut itself releases is released at once.
#[test]
fn law_what_the_cut_takes_is_released_at_once() {
    let run = discharged(50);
    let share = 1.0 - run.after_cut / run.start;
    let times = |of: f64| {
        let shares = [0.5 * share, 2.0 * share];
        let found = DischargeTimes::of(&run.record.curve, &ELASTIC, of, &shares);
        shares.map(|share| found.at(share).unwrap().value)
    };
    let ([now, later], [early, _]) = (times(run.start), times(run.after_cut));
    assert!(
        now == 0.0 && later > 0.0 && early > 0.0,
        "{now} {later} {early}"
    );
}
