//! Rows of a sweep say what the battery did: each column against the library, called by hand, and times and rates read off its curve
//! once more.

use std::path::Path;

use topo_analysis::NematicRow;
use topo_core::{DischargeCurve, Interrupt};
use topo_lab::{NematicScene, SweepSettings, run_nematic_sweep};
use topo_nematic::{DischargeSettings, NematicBattery, RunHooks};

const SCENE: &str = r#"
[nematic]
radius = 6
q = [2, 3]
[switch]
to = { free = "staircase" }
[flow]
q = 3
[accuracy]
tolerance = 1e-6
"#;

/// First time at which the energy is `goal`, falling exponentially between two steps.
fn crossing(curve: &DischargeCurve, goal: f64) -> f64 {
    if curve.stored_total(0) <= goal {
        return 0.0;
    }
    let after = (0..curve.len()).find(|i| curve.stored_total(*i) <= goal);
    let (i, j) = (after.unwrap() - 1, after.unwrap());
    let [from, to] = [i, j].map(|i| curve.stored_total(i).ln());
    let part = (goal.ln() - from) / (to - from);
    curve.time()[i] + part * (curve.time()[j] - curve.time()[i])
}

fn check(row: &NematicRow, scene: &NematicScene, case: usize) {
    let case = &scene.cases()[case];
    let battery = NematicBattery::new(&case.nematic, &scene.accuracy).unwrap();
    let hooks = &mut RunHooks::new(&Interrupt::new());
    let charged = battery.charge(&scene.charge, hooks).unwrap();
    let settings = DischargeSettings {
        flow: case.flow,
        ..scene.discharge.clone()
    };
    let switched = charged.switch(&scene.switch).unwrap();
    let run = switched.discharge(&settings, hooks).unwrap();
    let (report, curve) = (&run.record.report, &run.record.curve);
    assert_eq!((row.radius, row.spacing, row.q), (6.0, 1.5, case.q));
    assert_eq!(row.flow.is_on(), case.flow.is_some());
    assert_eq!(
        (row.boundary.as_str(), row.precision.as_str()),
        ("cut-link", "f64")
    );

    let whole = charged.energy().total();
    assert_eq!((row.f_charged, row.f_final), (whole, 0.0));
    assert_eq!(row.f_after_switch, curve.stored_total(0));
    assert!(
        row.f_after_switch < 0.9 * whole,
        "a staircase drops its links"
    );
    assert_eq!(row.order_parameter, charged.order().magnitude());
    let minimum = charged.report().minimum.unwrap();
    assert_eq!(row.lowest_eigenvalue, Some(minimum.lowest_eigenvalue));
    assert_eq!(row.state, Some(minimum.state));
    let ring = charged.ring(0.35).unwrap();
    assert_eq!(row.ring_radius, Some(ring.radius));
    let strongest = (1..=40).max_by(|a, b| ring.modes[a - 1].total_cmp(&ring.modes[b - 1]));
    assert_eq!(row.ring_mode.map(|m| m as usize), strongest);
    assert_eq!(row.ring_amplitude, strongest.map(|m| ring.modes[m - 1]));
    check_times(row, curve, whole);

    assert_eq!(row.steps, report.n_steps);
    let evaluations = charged.report().n_steps + report.counters.n_rate_evaluations;
    assert_eq!(row.evaluations, evaluations);
    let flow = report.own.flow.map(|f| f.counters).unwrap_or_default();
    let counts = (row.stokes_updates, row.stokes_iterations);
    assert_eq!(counts, (flow.n_updates, flow.n_boundary_solves));
    assert_eq!(flow.n_updates > 0, case.flow.is_some());
    assert!(row.warnings.is_empty(), "{}", row.warnings);
}

/// The times at which shares of the energy are released, `whole` being that before the switch, and the rate at the end.
fn check_times(row: &NematicRow, curve: &DischargeCurve, whole: f64) {
    let shares = [0.5, 0.1, 0.01, 0.001];
    let of = |start: f64| shares.map(|left| crossing(curve, left * start));
    let counted = [
        (
            of(row.f_after_switch),
            [row.t50, row.t90, row.t99, row.t999],
        ),
        (
            of(whole),
            [
                row.t50_charged,
                row.t90_charged,
                row.t99_charged,
                row.t999_charged,
            ],
        ),
    ];
    for (exact, found) in counted {
        for (exact, found) in exact.into_iter().zip(found) {
            let found = found.unwrap();
            assert!((found - exact).abs() <= 1e-9 * exact, "{found} {exact}");
        }
    }
    // At the end one mode is left: its rate is that between the last energy and twice the last.
    let last = curve.len() - 1;
    let end = curve.stored_total(last);
    let rate = 2.0_f64.ln() / (curve.time()[last] - crossing(curve, 2.0 * end));
    let found = row.late_rate.unwrap();
    assert!((found / rate - 1.0).abs() < 0.01, "{found} {rate}");
}

#[test]
fn law_rows_of_a_sweep_are_what_the_battery_did() {
    let scene = NematicScene::parse(SCENE, Path::new("scene.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let settings = SweepSettings::new(folder.path());
    let report = run_nematic_sweep(&scene, &settings, &|_| {}).unwrap();
    assert_eq!(report.rows.len(), 3);
    for (case, row) in report.rows.iter().enumerate() {
        check(row, &scene, case);
    }
}
