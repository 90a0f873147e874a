//! The measures in closed form, the sites that they choose, and a ring that breaks as it swells.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use topo_core::{Polyline, StopReason};

use super::*;
use crate::contact::ContactPairs;
use crate::density::tests::{N, coil};
use crate::energy::terms_of;
use crate::{
    Accuracy, ChargeSettings, CutSite, DischargeSettings, Geometry, Guards, Protocol, RodBattery,
    RodState, RunHooks,
};

fn measure_of(criterion: Criterion, rod: &RodParameters, state: &RodState) -> Vec<f64> {
    let at = At {
        state,
        geometry: &Geometry::new(state),
        pairs: &ContactPairs::new(0.0, 0.1),
    };
    let terms = terms_of(rod, &rod.tube(50.0).unwrap(), state);
    criterion.measure(rod, &terms, at)
}

/// h κ, γ (|x'| − 1) + h κ and √(σ² + 3 (α h θ'/2)²) at every vertex of a ring and of a helix, strained by a quarter, compressed by a
/// fifth and as they are; a free end bears the strain alone.
#[test]
fn val_stresses_of_a_bent_twisted_stretched_coil() {
    let rod = RodParameters::default();
    let (alpha, gamma, twist) = (1.0 / 1.3, 5.0, 0.7);
    let is_near = |found: f64, exact: f64, what: &str| {
        let error = (found - exact).abs();
        assert!(error < 3e-4 * exact.max(1.0), "{what}: {found} for {exact}");
    };
    for pitch in [None, Some(2.0)] {
        let q: f64 = pitch.unwrap_or(0.0);
        for rest in [1.0, 0.8, 1.25] {
            let state = coil(rest, pitch, twist);
            let curvature = 3.0 / (9.0 + q * q) / rest;
            let axial = gamma * (1.0 / rest - 1.0);
            let tension = f64::max(axial + curvature, 0.0);
            let shear = 0.5 * alpha * twist;
            let mises = (tension * tension + 3.0 * shear * shear).sqrt();
            let of = |criterion| measure_of(criterion, &rod, &state);
            for (criterion, exact) in [
                (Criterion::Curvature, curvature),
                (Criterion::Tension, tension),
                (Criterion::VonMises, mises),
            ] {
                let found = of(criterion);
                for i in state.interior() {
                    is_near(found[i], exact, criterion.name());
                }
            }
            if pitch.is_some() {
                for end in [0, N] {
                    is_near(of(Criterion::Curvature)[end], 0.0, "bend of an end");
                    is_near(of(Criterion::Tension)[end], axial.max(0.0), "an end");
                    is_near(of(Criterion::VonMises)[end], axial.max(0.0), "an end");
                }
            }
            // without a twist to model, tension is all of it
            let untwisted = RodParameters {
                twist: None,
                ..Default::default()
            };
            let mises = measure_of(Criterion::VonMises, &untwisted, &state);
            is_near(mises[N / 2], tension, "an untwisted rod");
        }
    }
}

/// Stress counts from the natural curvature, which the curvature itself does not.
#[test]
fn val_a_natural_curve_bears_no_stress() {
    let rod = RodParameters::default();
    let natural = 2.0 / (TAU * 3.0 / N as f64) * (PI / N as f64).tan();
    let ring = coil(1.0, None, 0.0);
    let ring = ring.with_rest(|_, _| [natural, 0.0], |_, _| 0.0).unwrap();
    let largest = |criterion| {
        let measure = measure_of(criterion, &rod, &ring);
        measure.into_iter().fold(0.0, f64::max)
    };
    assert!(largest(Criterion::Tension) < 1e-3, "a ring at rest");
    assert!(largest(Criterion::VonMises) < 1e-3, "a ring at rest");
    assert!((largest(Criterion::Curvature) * 3.0 - 1.0).abs() < 1e-3);
}

/// A ring of natural length 50 h, made of edges that are shorter or longer by `strain`.
fn strained_ring(strain: f64, tolerance: f64) -> RodBattery {
    let n = 100;
    // vertices on a circle whose polygon is 50 h long
    let radius = 50.0 / (2.0 * n as f64 * (PI / n as f64).sin());
    let vertex = |k: usize| {
        let u = TAU * k as f64 / n as f64;
        Vector3::new(u.cos(), u.sin(), 0.0) * radius
    };
    let curve = Polyline::new((0..n).map(vertex).collect(), true).unwrap();
    let parameters = RodParameters {
        n_edges: n,
        twist: None,
        contact: None,
        friction: None,
        ..Default::default()
    };
    let accuracy = Accuracy {
        tolerance,
        ..Default::default()
    };
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve).unwrap();
    let strained = curve.scaled(1.0 + strain).unwrap();
    battery.starting_from(RodState::new(&strained, 50.0, 0.0).unwrap())
}

/// A ring compressed by a tenth swells: its strain decays as exp(−γ t), so that the tension at its surface rises as
/// σ = h κ − (γ/10) exp(−γ t), and passes a threshold at t = ln[(γ/10)/(h κ − σ)]/γ, in the middle of a step.
#[test]
fn val_a_swelling_ring_breaks_when_its_tension_passes_the_threshold() {
    let gamma = 5.0;
    let battery = strained_ring(-0.1, 1e-4);
    let curvature = 2.0 * (PI / 100.0).tan() / 0.5;
    let charge = |breaking: Option<Breaking>| {
        let settings = ChargeSettings {
            duration: 0.02,
            breaking,
            ..Default::default()
        };
        battery.charge(&settings, &mut RunHooks::default()).unwrap()
    };
    let tears = |threshold| {
        charge(Some(Breaking {
            criterion: Criterion::Tension,
            threshold,
        }))
    };
    let threshold = 0.4 * curvature;
    let torn = tears(threshold);
    let broken = torn.broken().unwrap();
    assert_eq!(
        torn.record().report.stop,
        StopReason::Condition("broken".to_owned())
    );
    let passed = (0.1 * gamma / (curvature - threshold)).ln() / gamma / 100.0;
    let steps = torn.record().curve.time();
    let [.., before, after] = steps else {
        panic!("no steps")
    };
    let rounding = 1e-3 * passed;
    assert_eq!((broken.time, torn.record().report.time), (*after, *after));
    assert!(
        *before < passed + rounding && *after > passed - rounding,
        "{before} {passed} {after}"
    );
    let exact = curvature - 0.1 * gamma * (-gamma * 100.0 * broken.time).exp();
    assert!((broken.site.density / exact - 1.0).abs() < 2e-3);
    // what is not exceeded changes no bit
    let (whole, plain) = (tears(1.01 * curvature), charge(None));
    assert!(whole.broken().is_none() && plain.broken().is_none());
    assert_eq!(whole.state().vertices(), plain.state().vertices());
    assert_eq!(whole.record().report.stop, StopReason::ReachedTime);
}

/// A stretched ring tears at once, and a protocol cuts it there and lets it go; one that holds is not cut.
#[test]
fn a_protocol_cuts_what_breaks_and_nothing_else() {
    let battery = strained_ring(0.1, 2e-3);
    let run = |threshold| {
        let protocol = Protocol {
            charge: ChargeSettings {
                duration: 0.01,
                breaking: Some(Breaking {
                    criterion: Criterion::VonMises,
                    threshold,
                }),
                ..Default::default()
            },
            cut: CutSite::At(0.37),
            discharge: DischargeSettings {
                until_released: 0.1,
                ..Default::default()
            },
        };
        battery.run(&protocol, &mut RunHooks::default()).unwrap()
    };
    let (torn, discharge) = run(0.5);
    let broken = torn.broken().unwrap();
    assert_eq!((broken.time, torn.record().report.n_steps), (0.0, 0));
    assert_eq!(discharge.unwrap().at, broken.site.at);
    let (whole, discharge) = run(0.7);
    assert!(whole.broken().is_none() && discharge.is_none());
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let breaking = Breaking {
            criterion: Criterion::Energy,
            threshold: bad,
        };
        let message = breaking.checked().unwrap_err().to_string();
        assert!(message.contains("charge.break.threshold"), "{message}");
    }
}

/// Each criterion cuts where its own measure is largest; that of the energy is the present one, to the bit.
#[test]
fn each_criterion_cuts_at_its_own_maximum() {
    let vertex = |k: usize| {
        let u = TAU * k as f64 / 120.0;
        Vector3::new(3.0 * u.cos(), 2.0 * u.sin(), 0.3 * (2.0 * u).sin())
    };
    let curve = Polyline::new((0..120).map(vertex).collect(), true).unwrap();
    let parameters = RodParameters {
        n_edges: 120,
        twist: Some(0.5),
        ..Default::default()
    };
    let accuracy = Accuracy::default();
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve).unwrap();
    let settings = ChargeSettings {
        duration: 1e-3,
        ..Default::default()
    };
    let rod = battery.charge(&settings, &mut RunHooks::default()).unwrap();
    assert_eq!(
        rod.cut_candidates_by(Criterion::Energy, 0.03),
        rod.cut_candidates(0.03)
    );
    assert_eq!(
        battery.measure(Criterion::Energy, rod.state()),
        rod.density()
    );
    for criterion in Criterion::ALL {
        let smoothed = rod
            .state()
            .smoothed(&battery.measure(criterion, rod.state()));
        let largest = smoothed.iter().copied().fold(0.0, f64::max);
        let cut = rod.cut(CutSite::Maximum(criterion)).unwrap();
        assert_eq!(smoothed[cut.vertex], largest, "{criterion}");
        let found = rod.cut_candidates_by(criterion, 0.03);
        assert!(found.iter().all(|c| c.density >= 0.97 * largest));
    }
}
