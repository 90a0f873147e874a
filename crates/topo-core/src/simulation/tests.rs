//! Tests of the loop on a decay whose every number is known.

use super::*;
use crate::integrate::{GAMMA_L_STABLE_LARGE, LinearlyImplicit, Rkc2, RosenbrockW, SpectralBound};
use crate::observe::Schedule;

/// u' = -u with energy u^2/2, and ways to misbehave.
#[derive(Clone, Default)]
struct Decay {
    w: f64,
    ledger: Option<Ledger>,
    forbidden_below: f64,
    fatal_after: Option<f64>,
    longest_allowed: Option<f64>,
    foresees: bool,
    moved: f64,
}

impl Model for Decay {
    type State = Vec<f64>;
    fn n_dof(&self) -> usize {
        1
    }
    fn rate(&mut self, u: &Vec<f64>, rate: &mut [f64]) -> Result<(), Rejection> {
        rate[0] = -u[0];
        Ok(())
    }
    fn advance(&self, from: &Vec<f64>, step: &[f64], to: &mut Vec<f64>) -> Result<(), Rejection> {
        to[0] = from[0] + step[0];
        Ok(())
    }
    fn check(&mut self, _: &Vec<f64>, to: &Vec<f64>, _: &[f64], dt: f64) -> Result<(), Rejection> {
        if to[0] < self.forbidden_below {
            return Err(Rejection::Domain { what: "below" });
        }
        if self.longest_allowed.is_some_and(|longest| dt > longest) {
            return Err(Rejection::Displacement {
                vertex: 0,
                moved: dt,
                limit: 0.0,
            });
        }
        match self.fatal_after {
            Some(limit) if to[0] < limit => Err(Rejection::Fatal { what: "planted" }),
            _ => Ok(()),
        }
    }
    fn accepted(&mut self, from: &Vec<f64>, to: &Vec<f64>, step: &[f64], dt: f64) {
        self.moved += step[0];
        if let Some(ledger) = &mut self.ledger {
            ledger.dissipate(0, step[0] * step[0] / dt);
            ledger.set_stored(&[0.5 * to[0] * to[0]]);
        }
        assert_eq!(from[0] + step[0], to[0]);
    }
    fn longest_step(&self) -> f64 {
        let limit = self.longest_allowed.filter(|_| self.foresees);
        limit.unwrap_or(f64::INFINITY)
    }
    fn ledger(&self) -> Option<&Ledger> {
        self.ledger.as_ref()
    }
}

impl LinearlyImplicit for Decay {
    fn prepare(&mut self, _: &Vec<f64>, g_dt: f64) -> Result<(), Rejection> {
        self.w = 1.0 + g_dt;
        Ok(())
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection> {
        rhs[0] /= self.w;
        Ok(())
    }
}

impl SpectralBound for Decay {
    fn spectral_radius(&mut self, _: &Vec<f64>) -> Result<f64, Rejection> {
        Ok(1.0)
    }
}

fn simulation(model: Decay, tolerance: f64) -> Simulation<Decay, RosenbrockW> {
    let control = StepControl::new(tolerance, 1e-2).unwrap();
    Simulation::new(
        model,
        vec![1.0],
        RosenbrockW::ros2w(GAMMA_L_STABLE_LARGE).unwrap(),
        control,
    )
}

fn never(_: &Sample<'_, Vec<f64>>) -> Option<String> {
    None
}

#[test]
fn decays_as_it_should() {
    let error = |tolerance: f64| {
        let mut ledger = Ledger::new(&["energy"], &["drag"]);
        ledger.set_stored(&[0.5]);
        let mut run = simulation(
            Decay {
                ledger: Some(ledger),
                ..Decay::default()
            },
            tolerance,
        );
        assert_eq!(run.run(3.0, &mut [], &mut never), StopReason::ReachedTime);
        assert_eq!(run.time(), 3.0);
        assert!((run.model().moved - (run.state()[0] - 1.0)).abs() < 1e-12);
        let ledger = run.sample().ledger;
        assert!(ledger.stored_total() < 2e-3 && ledger.relative_residual() < 30.0 * tolerance);
        (run.state()[0] - (-3.0_f64).exp()).abs()
    };
    let (coarse, fine) = (error(1e-4), error(1e-6));
    assert!(
        coarse < 5e-3 && fine < 5e-5 && fine < 0.1 * coarse,
        "{coarse:e} {fine:e}"
    );
}

#[test]
fn steps_that_the_guards_would_refuse_are_not_tried() {
    let refused = |foresees: bool| {
        let model = Decay {
            longest_allowed: Some(0.02),
            foresees,
            ..Decay::default()
        };
        let mut run = simulation(model, 1e-3);
        assert_eq!(run.run(1.0, &mut [], &mut never), StopReason::ReachedTime);
        assert!(run.n_steps() >= 50);
        run.rejections().count("displacement")
    };
    assert!(refused(false) > 5);
    assert_eq!(refused(true), 0);
}

#[test]
fn every_way_to_stop() {
    let mut run = simulation(Decay::default(), 1e-3);
    let reason = run.run(1e9, &mut [], &mut |s| {
        (s.state[0] < 0.5).then(|| "half".to_owned())
    });
    assert_eq!(reason, StopReason::Condition("half".to_owned()));
    assert!(run.state()[0] < 0.5 && reason.is_success());

    let mut run = simulation(
        Decay {
            forbidden_below: 0.7,
            ..Decay::default()
        },
        1e-3,
    );
    let reason = run.run(10.0, &mut [], &mut never);
    let StopReason::StepTooSmall { last, .. } = &reason else {
        panic!("{reason}")
    };
    assert_eq!(*last, Rejection::Domain { what: "below" });
    assert!(run.state()[0] >= 0.7 && run.rejections().count("domain") > 10);

    let mut run = simulation(
        Decay {
            fatal_after: Some(0.9),
            ..Decay::default()
        },
        1e-3,
    );
    assert_eq!(
        run.run(1e9, &mut [], &mut never),
        StopReason::Failed {
            why: Rejection::Fatal { what: "planted" }
        }
    );

    let mut run = simulation(Decay::default(), 1e-3);
    run.modify(|_, state| state[0] = f64::NAN);
    assert_eq!(run.run(1.0, &mut [], &mut never).name(), "step-too-small");
    assert_eq!(
        simulation(Decay::default(), 1e-3).run(f64::NAN, &mut [], &mut never),
        StopReason::ReachedTime
    );
    let report = serde_json::to_string(&StopReason::StepLimit { n: 7 }).unwrap();
    assert_eq!(report, r#"{"step-limit":{"n":7}}"#);
}

#[test]
fn limits_and_interrupts_stop_a_run() {
    let mut run = simulation(Decay::default(), 1e-3);
    *run.control_mut() = run.control().clone().with_max_trials(7);
    assert_eq!(
        run.run(1e9, &mut [], &mut never),
        StopReason::StepLimit { n: 7 }
    );
    assert_eq!(run.n_steps() + run.rejections().total(), 7);

    let interrupt = Interrupt::new();
    let mut run = simulation(Decay::default(), 1e-3).with_interrupt(interrupt.clone());
    let mut ask = |s: &Sample<'_, Vec<f64>>| {
        if s.step == 3 {
            interrupt.request();
        }
        None
    };
    assert_eq!(run.run(1e9, &mut [], &mut ask), StopReason::Interrupted);
    assert_eq!(run.n_steps(), 3);
}

#[test]
fn a_time_too_large_to_grow_ends_the_run() {
    let mut run = simulation(Decay::default(), 1e-3);
    run.steps.time = 1e30;
    assert_eq!(run.run(2e30, &mut [], &mut never).name(), "step-too-small");
}

/// Stopped after any number of steps and gone on from what was remembered, with either integrator and a guard that refuses steps.
#[test]
fn a_resumed_simulation_takes_the_same_steps() {
    fn check<S: Stepper<Decay> + Clone>(fresh: &Simulation<Decay, S>) {
        let mut whole = fresh.clone();
        whole.run(3.0, &mut [], &mut never);
        for n in [0, 1, 7, 20] {
            let mut part = fresh.clone();
            while part.n_steps() < n {
                assert_eq!(part.advance(3.0, &mut [], &mut never), None);
            }
            let bytes = serde_json::to_string(&part.memory()).unwrap();
            let memory: SimulationMemory = serde_json::from_str(&bytes).unwrap();
            assert_eq!(memory.flaw(fresh.control(), 3.0, 1), None);
            let mut rest = Simulation {
                model: part.model.clone(),
                ..fresh.clone()
            };
            rest.state.clone_from(&part.state);
            let mut rest = rest.resumed(memory);
            while rest.advance(3.0, &mut [], &mut never).is_none() {}
            assert_eq!((rest.state(), rest.time()), (whole.state(), whole.time()));
            assert_eq!(rest.memory(), whole.memory());
        }
    }
    let model = || Decay {
        longest_allowed: Some(0.2),
        ..Decay::default()
    };
    let rosenbrock = simulation(model(), 1e-4);
    check(&rosenbrock);
    let control = rosenbrock.control().clone();
    check(&Simulation::new(
        model(),
        vec![1.0],
        Rkc2::default(),
        control,
    ));
}

#[test]
fn what_does_not_fit_a_simulation_is_named() {
    let fresh = simulation(Decay::default(), 1e-3);
    let control = fresh.control().clone();
    let flaw = |change: fn(&mut SimulationMemory)| {
        let mut memory = fresh.memory();
        change(&mut memory);
        memory.flaw(&control, 3.0, 1)
    };
    assert_eq!(flaw(|_| {}), None);
    for (change, word) in [
        (
            (|m| m.steps.time = 4.0) as fn(&mut SimulationMemory),
            "time",
        ),
        (|m| m.steps.time = f64::NAN, "time"),
        (|m| m.steps.last_dt = f64::INFINITY, "time"),
        (
            |m| m.steps.control = StepControl::new(1e-2, 1.0).unwrap(),
            "control",
        ),
        (|m| m.stepper.rate = Some(vec![0.0; 2]), "integrator"),
        (|m| m.stepper.rate = Some(vec![f64::NAN]), "integrator"),
        (|m| m.stepper.radius = Some(-1.0), "integrator"),
        (|m| m.steps.n_trials = u64::MAX, "counter"),
        (|m| m.stepper.counters.n_solves = u64::MAX, "counter"),
    ] {
        let found = flaw(change);
        assert!(found.is_some_and(|f| f.contains(word)), "{word}: {found:?}");
    }
}

#[test]
fn observers_see_what_they_asked_for() {
    let mut all = Vec::new();
    let mut few: Vec<(f64, u64)> = Vec::new();
    let mut see_all = |s: &Sample<'_, Vec<f64>>| all.push(s.time);
    let mut see_few = |s: &Sample<'_, Vec<f64>>| few.push((s.time, s.step));
    let mut run = simulation(Decay::default(), 1e-4);
    let mut observers = [
        Scheduled::new(Schedule::always(), &mut see_all),
        Scheduled::new(Schedule::every(0.5).unwrap().exact(), &mut see_few),
    ];
    run.run(2.2, &mut observers, &mut never);
    assert_eq!(all.len() as u64, run.n_steps() + 1);
    assert!(all.windows(2).all(|t| t[0] < t[1]));
    assert_eq!(
        few.iter().map(|f| f.0).collect::<Vec<_>>(),
        [0.0, 0.5, 1.0, 1.5, 2.0]
    );
    assert_eq!(all.last(), Some(&2.2));
}

#[test]
fn looking_does_not_change_the_run() {
    let mut watched = simulation(Decay::default(), 1e-4);
    let mut look = |_: &Sample<'_, Vec<f64>>| {};
    let mut other = |_: &Sample<'_, Vec<f64>>| {};
    let mut observers = [
        Scheduled::new(Schedule::log_spaced(1e-3, 10.0).unwrap(), &mut look),
        Scheduled::new(Schedule::every_steps(2), &mut other),
    ];
    watched.run(2.0, &mut observers, &mut never);
    let mut alone = simulation(Decay::default(), 1e-4);
    alone.run(2.0, &mut [], &mut never);
    assert_eq!(
        (watched.state(), watched.n_steps()),
        (alone.state(), alone.n_steps())
    );
}

#[test]
fn guards_halve_the_step() {
    let mut run = simulation(
        Decay {
            longest_allowed: Some(3e-3),
            ..Decay::default()
        },
        1e-3,
    );
    run.run(0.1, &mut [], &mut never);
    assert!(run.rejections().count("displacement") >= 2 && run.n_steps() >= 33);
    assert_eq!(
        run.counters().n_trials,
        run.n_steps() + run.rejections().total()
    );
}
