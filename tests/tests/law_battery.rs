//! Laws of a whole charge and discharge: link, energy books, mirror images, determinism, friction, what is absent.

use topo_core::{Polyline, Rejection, RunHooks, StopReason};
use topo_rod::{
    Accuracy, ChargeSettings, ChargedRod, ContactParameters, CutSite, Discharge, DischargeSettings,
    FrictionParameters, Guards, IntegratorKind, RodBattery, RodParameters,
};
use topo_tests::curves::{figure_eight, mirrored, trefoil};
use topo_tests::run::discharge;

fn battery(curve: &Polyline, parameters: RodParameters, tolerance: f64) -> RodBattery {
    let accuracy = Accuracy {
        tolerance,
        ..Default::default()
    };
    RodBattery::new(&parameters, &accuracy, Guards::default(), curve).unwrap()
}

fn twisted(n_edges: usize, twist: f64) -> RodParameters {
    RodParameters {
        n_edges,
        twist: Some(twist),
        ..Default::default()
    }
}

fn charged(battery: &RodBattery, duration: f64) -> ChargedRod {
    let settings = ChargeSettings {
        duration,
        ..Default::default()
    };
    battery.charge(&settings, &mut RunHooks::default()).unwrap()
}

fn start_trefoil() -> Polyline {
    trefoil(400, 2.0, 1.0)
}

/// Tw + Wr of a closed rod, whatever its shape and twist do.
#[test]
fn law_link_is_kept_through_a_charge() {
    for (curve, twist) in [
        (start_trefoil(), 2.0),
        (start_trefoil(), -2.0),
        (mirrored(&start_trefoil()), 1.0),
        (figure_eight(400), 1.25),
    ] {
        let run = charged(&battery(&curve, twisted(100, twist), 2e-3), 1.0);
        let samples = &run.record().samples;
        let (first, last) = (&samples[0], &samples[samples.len() - 1]);
        let drift = run.record().report.own.link_drift.unwrap();
        println!(
            "twist {twist}: Wr {:.3} -> {:.3}, Tw {:.3} -> {:.3}, drift {drift:.1e}",
            first.writhe, last.writhe, first.total_twist, last.total_twist
        );
        assert!(run.record().report.stop.is_success());
        assert!(
            (last.writhe - first.writhe).abs() > 1e-3,
            "nothing was exchanged"
        );
        assert!(drift < 1e-10, "link drifts by {drift:.1e}");
    }
}

/// dE + dissipation = work + removal: the residual of the books falls in proportion to the tolerance.
///
/// Residuals change their sign on the way and a discharge passes through many releases of contact, so that single ones
/// scatter: the order is that of a line through the logarithms of five, and each is held to a multiple of the tolerance.
#[test]
fn law_energy_books_balance_at_first_order() {
    let tolerances = [2e-3, 4e-4, 1e-4, 2e-5, 4e-6];
    let residuals = tolerances.map(|tolerance| {
        let battery = battery(&start_trefoil(), twisted(60, 1.0), tolerance);
        let found = [
            charged(&battery, 0.5).record().report.ledger_residual,
            discharge(&battery, 0.5, 1.0).record.report.ledger_residual,
        ];
        println!("tolerance {tolerance:.0e}: {found:?} charging and discharging");
        assert!(found.iter().all(|r| *r < 2.0 * tolerance));
        found
    });
    for (phase, least) in [("charging", 0.9), ("discharging", 0.75)] {
        let index = usize::from(phase == "discharging");
        let order = slope(&tolerances.map(f64::ln), &residuals.map(|r| r[index].ln()));
        println!("{phase}: order {order:.2}");
        assert!(order > least, "{phase}: order {order:.2}");
    }
}

/// Slope of the least-squares line.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mx, my) = (mean(x), mean(y));
    let of =
        |f: &dyn Fn(f64, f64) -> f64| x.iter().zip(y).map(|(a, b)| f(a - mx, b - my)).sum::<f64>();
    of(&|a, b| a * b) / of(&|a, _| a * a)
}

fn same_energies(a: &Discharge, b: &Discharge, tolerance: f64) {
    assert_eq!(a.record.curve.len(), b.record.curve.len());
    let mut worst = 0.0f64;
    for part in 0..4 {
        let (ours, theirs) = (
            &a.record.curve.stored()[part],
            &b.record.curve.stored()[part],
        );
        for (x, y) in ours.iter().zip(theirs.iter()) {
            worst = worst.max((x - y).abs() / a.start);
        }
    }
    println!(
        "energies differ by {worst:.1e} over {} steps",
        a.record.report.n_steps
    );
    assert!(worst <= tolerance, "energies differ by {worst:.1e}");
}

/// The mirror image with the opposite twist has the same energies at every step, cut and discharge included.
#[test]
fn law_mirror_image_with_opposite_twist_has_the_same_energy() {
    let curve = start_trefoil();
    let run = |curve: &Polyline, twist: f64| {
        discharge(&battery(curve, twisted(60, twist), 2e-3), 0.3, 0.5)
    };
    let (ours, theirs) = (run(&curve, 1.5), run(&mirrored(&curve), -1.5));
    same_energies(&ours, &theirs, 1e-9);
    let writhe = |d: &Discharge| d.record.samples.last().unwrap().writhe;
    assert!((writhe(&ours) + writhe(&theirs)).abs() < 1e-6);
    // and the other twist is another battery
    let other = run(&curve, -1.5);
    assert!(
        (other.after_cut / ours.after_cut - 1.0).abs() > 1e-3,
        "the trefoil does not see handedness"
    );
}

/// The same run twice gives the same bits.
#[test]
fn law_runs_are_deterministic() {
    let run = || {
        discharge(
            &battery(&start_trefoil(), twisted(60, -1.0), 2e-3),
            0.3,
            0.5,
        )
    };
    let (a, b) = (run(), run());
    assert_eq!(a.record.curve, b.record.curve);
    assert_eq!(a.record.report.own.work, b.record.report.own.work);
    let state = |d: &Discharge| d.record.samples.last().unwrap().state.clone();
    assert_eq!(state(&a).vertices(), state(&b).vertices());
    assert_eq!(state(&a).twists(), state(&b).twists());
}

/// Friction only ever takes energy, at every step, and strong friction slows the discharge.
#[test]
fn law_friction_never_adds_energy() {
    let run = |ratio: f64| {
        let parameters = RodParameters {
            friction: Some(FrictionParameters {
                ratio,
                ..Default::default()
            }),
            ..twisted(60, 0.0)
        };
        discharge(&battery(&start_trefoil(), parameters, 2e-3), 0.3, 1.0)
    };
    let (weak, strong) = (run(0.1), run(10.0));
    for d in [&weak, &strong] {
        let rubbed = &d.record.curve.dissipated()[2];
        assert!(
            *rubbed.last().unwrap() > 1e-6 * d.start,
            "no friction at work"
        );
        assert!(
            rubbed.windows(2).all(|w| w[1] >= w[0]),
            "friction gave energy back"
        );
        let parts = d.record.curve.stored();
        let total: Vec<f64> = (0..d.record.curve.len())
            .map(|k| (0..4).map(|p| parts[p][k]).sum())
            .collect();
        assert!(total.windows(2).all(|w| w[1] <= w[0] * (1.0 + 1e-4)));
    }
    let left = |d: &Discharge| d.record.samples.last().unwrap().elastic() / d.start;
    println!(
        "left after 1 T0: {:.3} and {:.3}",
        left(&weak),
        left(&strong)
    );
    assert!(left(&strong) > left(&weak));
}

/// Without contact nothing but the certificate keeps a tight trefoil from passing through itself: it refuses and says which edges.
#[test]
fn law_forced_crossing_is_caught_by_the_certificate() {
    let parameters = RodParameters {
        contact: None,
        twist: Some(2.0),
        friction: Some(FrictionParameters {
            ratio: 1e-6,
            ..Default::default()
        }),
        n_edges: 60,
        ..Default::default()
    };
    let accuracy = Accuracy {
        tolerance: 5e-2,
        max_steps: 20_000,
        ..Default::default()
    };
    let battery =
        RodBattery::new(&parameters, &accuracy, Guards::default(), &start_trefoil()).unwrap();
    let run = charged(&battery, 20.0);
    let report = &run.record().report;
    println!(
        "{} after {:.3} T0, refused {:?}",
        report.stop, report.time, report.rejections
    );
    assert!(report.rejections.count("crossing") > 0);
    let stuck = matches!(
        report.stop,
        StopReason::StepTooSmall {
            last: Rejection::Crossing { .. },
            ..
        } | StopReason::StepLimit { .. }
    );
    assert!(stuck, "{}", report.stop);
    assert!(
        report.own.link_drift.unwrap() < 1e-10,
        "a strand has passed"
    );
    // the same with contact goes through
    let parameters = RodParameters {
        contact: Some(ContactParameters::default()),
        ..parameters
    };
    let battery =
        RodBattery::new(&parameters, &accuracy, Guards::default(), &start_trefoil()).unwrap();
    let report = charged(&battery, 2.0).record().report.clone();
    assert!(report.stop.is_success(), "{}", report.stop);
}

/// A cut takes the bend and the twist of the vertex that it doubles, and nothing else.
#[test]
fn law_cut_removes_what_its_vertex_held() {
    let parameters = RodParameters {
        contact: None,
        friction: None,
        ..twisted(60, 1.0)
    };
    let charged = charged(&battery(&start_trefoil(), parameters, 2e-3), 0.05);
    let closed = charged.state();
    let (vertex, l0) = (17, closed.rest_length());
    let cut = charged.cut(CutSite::At(17.0 / 60.0)).unwrap();
    assert_eq!((cut.vertex, cut.state.n_vertices()), (vertex, 61));
    let (first, last) = (cut.state.vertices()[0], cut.state.vertices()[60]);
    assert_eq!(
        (first, last),
        (closed.vertices()[vertex], closed.vertices()[vertex])
    );
    let held = closed.twists()[vertex];
    let dropped = (closed.total_twist() - cut.state.total_twist()) * std::f64::consts::TAU;
    assert!((dropped / held - 1.0).abs() < 1e-10, "{dropped} of {held}");
    let cosine = closed.tangent(vertex - 1).dot(&closed.tangent(vertex));
    let bend = (1.0 - cosine) / (2.0 * l0 * (1.0 + cosine));
    let twist = held * held / (1.3 * 8.0 * l0);
    let settings = DischargeSettings {
        longest: 1e-3,
        ..Default::default()
    };
    let run = cut.discharge(&settings, &mut RunHooks::default()).unwrap();
    let removed = run.removed * closed.length() / std::f64::consts::PI;
    println!("removed {removed:.8}, held {:.8}", bend + twist);
    assert!((removed / (bend + twist) - 1.0).abs() < 1e-9);
}

/// What the scene leaves out is neither worked nor stored nor booked.
#[test]
fn law_absent_terms_cost_nothing() {
    let run = |parameters: RodParameters| {
        let curve = topo_tests::curves::closed(200, |u| {
            nalgebra::Vector3::new(u.cos(), 0.6 * u.sin(), 0.1 * (2.0 * u).sin())
        });
        charged(&battery(&curve, parameters, 2e-3), 0.2)
            .record()
            .report
            .clone()
    };
    let all = run(twisted(80, 0.3));
    assert!(all.own.work.n_twist_factorisations > 0 && all.own.work.n_list_rebuilds > 0);
    assert!(all.own.work.contact_bytes > 0 && all.own.work.n_mobility_factorisations > 1);
    let none = run(RodParameters {
        twist: None,
        contact: None,
        friction: None,
        ..twisted(80, 0.0)
    });
    assert_eq!(none.own.work.n_twist_factorisations, 0);
    assert_eq!(
        (none.own.work.n_list_rebuilds, none.own.work.contact_bytes),
        (0, 0)
    );
    // the resistance is constant without friction: factorised once
    assert_eq!(none.own.work.n_mobility_factorisations, 1);
    assert_eq!(none.ledger.stored_in("twist"), None);
    assert_eq!(none.ledger.stored_in("contact"), None);
    assert_eq!(none.ledger.dissipated_by("friction"), Some(0.0));
    assert_eq!(none.ledger.dissipated_by("twist_viscosity"), Some(0.0));
    assert_eq!(none.own.link_drift, None);
    let frictionless = run(RodParameters {
        friction: None,
        ..twisted(80, 0.3)
    });
    assert_eq!(frictionless.own.work.n_mobility_factorisations, 1);
    assert_eq!(frictionless.ledger.dissipated_by("friction"), Some(0.0));
    assert_eq!(all.ledger.work(), 0.0, "nobody works on a closed rod");
}

/// The integrators, which share only the model, follow the same discharge.
#[test]
fn law_integrators_agree() {
    let run = |integrator: IntegratorKind| {
        let accuracy = Accuracy {
            tolerance: 2e-4,
            integrator,
            ..Default::default()
        };
        let battery = RodBattery::new(
            &twisted(40, 1.0),
            &accuracy,
            Guards::default(),
            &start_trefoil(),
        );
        discharge(&battery.unwrap(), 0.2, 0.2)
    };
    let left = |d: &Discharge| d.record.samples.last().unwrap().elastic() / d.start;
    let explicit = left(&run(IntegratorKind::Rkc2));
    for kind in [IntegratorKind::Ros34pw2, IntegratorKind::Ros2w] {
        let implicit = left(&run(kind));
        println!("{kind:?}: left {implicit:.5}, explicit {explicit:.5}");
        assert!((implicit / explicit - 1.0).abs() < 5e-3);
    }
}
