//! Extremes of the parameters: inside the stated range every run finishes, beyond it a run finishes or says why it stopped.

use std::cell::Cell;

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use topo_core::{RunHooks, StopReason};
use topo_rod::{
    Accuracy, ChargeSettings, ContactParameters, CutSite, Discharge, DischargeSettings,
    FrictionParameters, FrictionRange, Guards, Reading, RodBattery, RodParameters,
};
use topo_tests::curves::{closed, trefoil};

/// One corner of the space of parameters.
#[derive(Debug, Clone, Copy)]
struct Case {
    twist: f64,
    stretch_ratio: f64,
    n_edges: usize,
    friction: f64,
    contact: f64,
}

const MIDDLE: Case = Case {
    twist: 0.0,
    stretch_ratio: 5.0,
    n_edges: 100,
    friction: 0.1,
    contact: 20.0,
};

impl Case {
    fn is_inner(&self) -> bool {
        self.twist.abs() <= 2.0
            && (1.0..=100.0).contains(&self.stretch_ratio)
            && (100..=800).contains(&self.n_edges)
            && (5.0..=100.0).contains(&self.contact)
    }

    /// Charges for a while, cuts, discharges for a while; whether it came to the end of that while.
    fn run(&self, duration: f64, max_steps: u64) -> bool {
        self.run_for(Some(duration), max_steps)
    }

    /// As [`run`](Self::run), for the default durations without one.
    fn run_for(&self, duration: Option<f64>, max_steps: u64) -> bool {
        let parameters = RodParameters {
            n_edges: self.n_edges,
            stretch_ratio: self.stretch_ratio,
            twist: Some(self.twist),
            contact: Some(ContactParameters {
                stiffness: self.contact,
            }),
            friction: Some(FrictionParameters {
                ratio: self.friction,
                ..Default::default()
            }),
            ..Default::default()
        };
        let accuracy = Accuracy {
            max_steps,
            ..Default::default()
        };
        let curve = trefoil(400, 2.0, 1.0);
        let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve).unwrap();
        let mut charge = ChargeSettings::default();
        let mut settings = DischargeSettings::default();
        if let Some(duration) = duration {
            charge.duration = duration;
            settings.longest = duration;
        }
        let charged = battery.charge(&charge, &mut RunHooks::default()).unwrap();
        self.judge(&charged.record().report.stop, "charging");
        assert!(
            charged.record().report.own.link_drift.unwrap() < 1e-10,
            "{self:?}"
        );
        if !charged.record().report.stop.is_success() {
            return false;
        }
        let run = charged
            .cut(CutSite::MaximumEnergyDensity)
            .and_then(|cut| cut.discharge(&settings, &mut RunHooks::default()))
            .unwrap();
        self.judge(&run.record.report.stop, "discharging");
        assert_finite(&run);
        match duration {
            Some(_) => run.record.report.stop.is_success(),
            None => run.is_finished(),
        }
    }

    fn judge(&self, stop: &StopReason, phase: &str) {
        if !stop.is_success() {
            println!("{self:?} {phase}: {stop}");
            assert!(!self.is_inner(), "{self:?} {phase}: {stop}");
            assert!(
                matches!(
                    stop,
                    StopReason::StepTooSmall { .. }
                        | StopReason::StepLimit { .. }
                        | StopReason::Failed { .. }
                ),
                "{self:?} {phase}: {stop}"
            );
        }
    }
}

fn assert_finite(run: &Discharge) {
    let curve = &run.record.curve;
    let numbers = curve.stored().iter().chain(curve.dissipated()).flatten();
    assert!(numbers.chain(curve.time()).all(|x| x.is_finite()));
    let last = run.record.samples.last().unwrap();
    assert!(last.state.vertices().iter().all(|v| v.sum().is_finite()));
}

/// The middle of the range with one parameter at a time at its end, and the worst corners of the inner range.
#[test]
fn law_runs_at_the_extremes_finish_or_say_why() {
    let twisted = |twist| Case { twist, ..MIDDLE };
    let stretchable = |stretch_ratio| Case {
        stretch_ratio,
        ..MIDDLE
    };
    let rubbing = |friction| Case { friction, ..MIDDLE };
    let touching = |contact| Case { contact, ..MIDDLE };
    let cases = [
        MIDDLE,
        twisted(4.0),
        twisted(-4.0),
        stretchable(0.5),
        stretchable(1000.0),
        Case {
            n_edges: 50,
            ..MIDDLE
        },
        rubbing(0.0),
        rubbing(10.0),
        touching(5.0),
        touching(500.0),
        Case {
            twist: 2.0,
            stretch_ratio: 1.0,
            contact: 5.0,
            ..MIDDLE
        },
        Case {
            twist: -2.0,
            stretch_ratio: 100.0,
            contact: 100.0,
            friction: 10.0,
            ..MIDDLE
        },
    ];
    for case in cases {
        case.run(0.2, 20_000);
    }
    Case {
        n_edges: 400,
        twist: 2.0,
        ..MIDDLE
    }
    .run(0.05, 20_000);
    Case {
        n_edges: 1600,
        ..MIDDLE
    }
    .run(0.002, 2_000);
}

/// The grid of ends and middles at `n_edges`, charged and discharged for `duration`; returns how many of how many finished.
fn grid(n_edges: usize, duration: f64, twists: &[f64], frictions: &[f64]) -> (usize, usize) {
    let (mut finished, mut total) = (0, 0);
    for &twist in twists {
        for stretch_ratio in [0.5, 1.0, 5.0, 100.0, 1000.0] {
            for contact in [5.0, 20.0, 100.0, 500.0] {
                for &friction in frictions {
                    let case = Case {
                        twist,
                        stretch_ratio,
                        n_edges,
                        friction,
                        contact,
                    };
                    finished += usize::from(case.run(duration, 50_000));
                    total += 1;
                }
            }
        }
    }
    println!("{n_edges} edges: {finished} of {total} finished");
    (finished, total)
}

const TWISTS: [f64; 5] = [-4.0, -2.0, 0.0, 2.0, 4.0];
const FRICTIONS: [f64; 3] = [0.0, 0.1, 10.0];

#[test]
#[ignore = "long: 2 minutes"]
fn long_extremes_of_50_edges() {
    grid(50, 0.5, &TWISTS, &FRICTIONS);
}

#[test]
#[ignore = "long: 4 minutes"]
fn long_extremes_of_100_edges() {
    grid(100, 0.5, &TWISTS, &FRICTIONS);
}

#[test]
#[ignore = "long: 10 minutes"]
fn long_extremes_of_200_edges() {
    grid(200, 0.5, &TWISTS, &FRICTIONS);
}

#[test]
#[ignore = "long: 5 minutes"]
fn long_extremes_of_800_edges() {
    grid(800, 0.02, &[0.0, 2.0, 4.0], &[0.1]);
}

#[test]
#[ignore = "long: 5 minutes"]
fn long_extremes_of_1600_edges() {
    grid(1600, 0.005, &[0.0, 4.0], &[0.1]);
}

/// The corners of the inner range, charged in full and discharged until 0.1 % of the energy is left.
#[test]
#[ignore = "long: 10 minutes"]
fn long_inner_range_discharges_to_the_end() {
    for n_edges in [100, 800] {
        let frictions: &[f64] = if n_edges == 100 { &[0.0, 10.0] } else { &[0.1] };
        for twist in [-2.0, 0.0, 2.0] {
            for (stretch_ratio, contact) in [(1.0, 5.0), (1.0, 100.0), (100.0, 5.0), (100.0, 100.0)]
            {
                for &friction in frictions {
                    let case = Case {
                        twist,
                        stretch_ratio,
                        n_edges,
                        friction,
                        contact,
                    };
                    assert!(case.run_for(None, 200_000), "{case:?}");
                }
            }
        }
        println!("{n_edges} edges: all corners discharged");
    }
}

/// Charges and discharges an untwisted trefoil of 50 edges with stiff contact: sum of all rises of the energy over what the
/// discharge starts with, and its end.
fn bounced(contact: f64, guards: Guards, max_steps: u64) -> (f64, Discharge) {
    let parameters = RodParameters {
        n_edges: 50,
        contact: Some(ContactParameters { stiffness: contact }),
        ..Default::default()
    };
    let accuracy = Accuracy {
        max_steps,
        ..Default::default()
    };
    let curve = trefoil(400, 2.0, 1.2);
    let charge = ChargeSettings {
        duration: 0.2,
        ..Default::default()
    };
    let run = RodBattery::new(&parameters, &accuracy, guards, &curve)
        .and_then(|battery| battery.charge(&charge, &mut RunHooks::default()))
        .and_then(|charged| charged.cut(CutSite::MaximumEnergyDensity))
        .and_then(|cut| cut.discharge(&DischargeSettings::default(), &mut RunHooks::default()))
        .unwrap();
    let curve = &run.record.curve;
    let energies: Vec<f64> = (0..curve.len()).map(|i| curve.stored_total(i)).collect();
    let rises = energies.windows(2).map(|e| (e[1] - e[0]).max(0.0));
    (rises.sum::<f64>() / energies[0], run)
}

/// Strands far stiffer than the tolerance can tell bounce; what their steps gain stays below its limit all the same.
#[test]
fn law_rises_of_the_energy_stay_below_their_sum() {
    let guards = Guards::default();
    let (sum, _) = bounced(1e4, guards, 4_000);
    let single = Guards {
        energy_rise_in_all: f64::INFINITY,
        ..guards
    };
    let (without, _) = bounced(1e4, single, 4_000);
    println!("sum of rises {sum:.2e}, with the limit of single steps alone {without:.2e}");
    assert!(sum <= 1e-3, "{sum:.2e}");
    assert!(without > 1.5e-3, "nothing to be limited: {without:.2e}");
}

/// Strands as stiff as the inner range has them touch and stay in touch: the run finishes, in few steps.
#[test]
fn law_stiff_strands_do_not_bounce() {
    for contact in [20.0, 100.0, 500.0] {
        let (sum, run) = bounced(contact, Guards::default(), 20_000);
        let report = &run.record.report;
        println!(
            "k_c = {contact}: {}, {} trials, rises {sum:.1e}",
            report.stop, report.counters.n_trials
        );
        assert!(run.is_finished(), "k_c = {contact}: {}", report.stop);
        assert!(report.counters.n_trials < 10_000);
    }
}

/// A number that is mostly in a range, and else anything: negative, tiny, huge, zero, infinite or NaN.
fn number(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    prop_oneof![
        40 => range,
        1 => prop::num::f64::NORMAL,
        1 => prop::num::f64::ANY,
        1 => Just(0.0),
        1 => -5.0..100.0f64,
    ]
}

fn any_reading() -> impl Strategy<Value = Reading> {
    prop_oneof![
        Just(Reading::Shrunk),
        Just(Reading::Hard),
        Just(Reading::Tight),
        Just(Reading::OwnLength),
    ]
}

prop_compose! {
    fn any_parameters()(
        slenderness in number(5.0..100.0),
        twist_ratio in number(0.1..2.0),
        stretch_ratio in number(0.5..1000.0),
        stiffness in number(5.0..500.0),
        ratio in number(0.0..10.0),
        reading in any_reading(),
        n_edges in 4usize..80,
        twist in prop::option::of(number(-4.0..4.0)),
        has_contact in any::<bool>(),
        has_friction in any::<bool>(),
        range in prop_oneof![
            Just(FrictionRange::Reading),
            Just(FrictionRange::Contact),
            number(0.5..2.0).prop_map(FrictionRange::TimesContact),
        ],
    ) -> RodParameters {
        RodParameters {
            slenderness,
            reading,
            n_edges,
            twist_ratio,
            stretch_ratio,
            twist,
            contact: has_contact.then_some(ContactParameters { stiffness }),
            friction: has_friction.then_some(FrictionParameters { ratio, range }),
            ..RodParameters::default()
        }
    }
}

/// Builds a battery and, if it can be built, charges and discharges it for a few dozen steps; returns whether it ran.
fn survives(parameters: &RodParameters, accuracy: &Accuracy, knotted: bool) -> bool {
    let curve = if knotted {
        trefoil(60, 2.0, 1.0)
    } else {
        closed(40, |u| {
            nalgebra::Vector3::new(u.cos(), 0.5 * u.sin(), 0.2 * (2.0 * u).cos())
        })
    };
    let Ok(battery) = RodBattery::new(parameters, accuracy, Guards::default(), &curve) else {
        return false;
    };
    let settings = ChargeSettings {
        duration: 0.01,
        ..Default::default()
    };
    let Ok(charged) = battery.charge(&settings, &mut RunHooks::default()) else {
        return false;
    };
    let sample = charged.record().samples.last().unwrap();
    assert!(sample.state.vertices().iter().all(|v| v.sum().is_finite()));
    assert!(
        sample.stored.iter().all(|e| e.is_finite()),
        "{:?}",
        sample.stored
    );
    let settings = DischargeSettings {
        longest: 0.01,
        ..Default::default()
    };
    if let Ok(run) = charged
        .cut(CutSite::At(0.3))
        .and_then(|cut| cut.discharge(&settings, &mut RunHooks::default()))
    {
        assert_finite(&run);
    }
    true
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(14),
        ..ProptestConfig::default()
    }
}

prop_compose! {
    fn any_accuracy()(
        tolerance in number(1e-5..0.1),
        skin in number(0.05..2.0),
        gamma in number(0.25..2.0),
    ) -> Accuracy {
        Accuracy { tolerance, skin, gamma, max_steps: 60, ..Default::default() }
    }
}

/// No number in the parameters makes a rod panic, give NaN or never end; and many of the draws are rods that run.
#[test]
fn law_any_parameters_are_refused_or_run() {
    let (n_ran, n_refused) = (Cell::new(0), Cell::new(0));
    let drawn = (any_parameters(), any_accuracy(), any::<bool>());
    let done = TestRunner::new(config(600)).run(&drawn, |(parameters, accuracy, knotted)| {
        let count = if survives(&parameters, &accuracy, knotted) {
            &n_ran
        } else {
            &n_refused
        };
        count.set(count.get() + 1);
        Ok(())
    });
    println!("{} ran, {} refused", n_ran.get(), n_refused.get());
    if let Err(failed) = done {
        panic!("{failed}");
    }
    assert!(n_ran.get() > 200 && n_refused.get() > 100);
}

proptest! {
    #![proptest_config(config(600))]

    /// Numbers that are in range are accepted and run.
    #[test]
    fn law_parameters_in_range_run(
        twist in -4.0..4.0f64,
        stretch_ratio in 0.5..1000.0f64,
        n_edges in 8usize..80,
        friction in 0.0..10.0f64,
        contact in 5.0..500.0f64,
        reading in any_reading(),
        knotted in any::<bool>(),
    ) {
        let parameters = RodParameters {
            reading,
            n_edges,
            stretch_ratio,
            twist: Some(twist),
            contact: Some(ContactParameters { stiffness: contact }),
            friction: Some(FrictionParameters { ratio: friction, ..Default::default() }),
            ..Default::default()
        };
        let accuracy = Accuracy { max_steps: 60, ..Default::default() };
        prop_assert!(survives(&parameters, &accuracy, knotted));
    }
}
