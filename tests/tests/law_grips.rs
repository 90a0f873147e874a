//! Ends that are moved and loaded in time: closed forms of the work and of the forces of the grips, and books that balance.

use topo_core::Polyline;
use topo_rod::{EndCondition, Grip, Ramp, TimeCourse};
use topo_tests::curves::{from_tangents, line};
use topo_tests::run::{RodSimulation, Setup, rod, run_grips_to, stored};

const N_EDGES: usize = 50;
const LENGTH: f64 = 20.0;

fn assert_close(found: f64, expected: f64, what: &str) {
    let error = (found / expected - 1.0).abs();
    println!("{what}: {found:.8} against {expected:.8}, off by {error:.2e}");
    assert!(error < 1e-3, "{what}: off by {error:.2e}");
}

fn assert_balanced(simulation: &RodSimulation) {
    let residual = simulation.model().account().relative_residual();
    assert!(residual < 1e-3, "residual {residual:.2e}");
}

const DIRECTION: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];

/// A straight line in a direction along no axis.
fn skew_line() -> Polyline {
    from_tangents(N_EDGES, LENGTH / N_EDGES as f64, |_| DIRECTION.into())
}

fn along(course: &TimeCourse) -> [TimeCourse; 3] {
    let TimeCourse::Table(points) = course else {
        panic!("a table of a test")
    };
    DIRECTION.map(|d| TimeCourse::Table(points.iter().map(|[t, x]| [*t, d * x]).collect()))
}

fn held(condition: EndCondition) -> Grip {
    Grip {
        condition,
        ..Grip::default()
    }
}

fn gripped(setup: &Setup, curve: &Polyline, grips: [Grip; 2]) -> RodSimulation {
    let state = rod(curve, 0.0);
    let model = setup.model(&state).with_grips(&grips, 1.0, &state).unwrap();
    setup.simulation_of(model, state)
}

/// Component along the line of the force of a grip.
fn pull(simulation: &RodSimulation, end: usize) -> f64 {
    let grip = simulation.model().grip_forces(simulation.state())[end].expect("a grip");
    grip.force.iter().zip(DIRECTION).map(|(f, d)| f * d).sum()
}

/// An end drawn out, held and let back: each grip pulls with γ ε + ε̇ at all times, and the work is what that force does.
#[test]
fn law_grips_hold_what_the_rod_draws() {
    let course = TimeCourse::Table(vec![[0.0, 0.0], [3.0, 1.2], [5.0, 1.2], [6.0, 0.4]]);
    let drawn = Grip {
        displacement: along(&course),
        ..held(EndCondition::Pinned)
    };
    let setup = Setup::bare(1e-5);
    let gamma = setup.parameters.stretch_ratio;
    let mut simulation = gripped(&setup, &skew_line(), [held(EndCondition::Pinned), drawn]);
    let mut work = 0.0;
    // strain grows at ε̇: work γ (ε_1² − ε_0²) L/2 + ε̇² L t
    for (time, from, to, rate) in [
        (1.5, 0.0, 0.6, 0.4),
        (3.0, 0.6, 1.2, 0.4),
        (4.0, 1.2, 1.2, 0.0),
        (6.0, 1.2, 0.4, -0.8),
    ] {
        run_grips_to(&mut simulation, time);
        let [e0, e1, speed] = [from, to, rate].map(|x: f64| x / LENGTH);
        work += 0.5 * gamma * (e1 * e1 - e0 * e0) * LENGTH + (to - from) * speed;
        let force = gamma * e1 + speed;
        assert_close(pull(&simulation, 1), force, "pull");
        assert_close(pull(&simulation, 0), -force, "hold");
        assert_close(simulation.model().account().work(), work, "work");
    }
    assert_balanced(&simulation);
}

/// A force that grows as a t, then stays, then lets go: the strain follows it by the time 1/γ.
#[test]
fn law_work_of_ends_in_time() {
    let (rate, full) = (0.2, 3.0);
    let loaded = Grip {
        force: along(&TimeCourse::Table(vec![[0.0, 0.0], [full, rate * full]])),
        released: Some(5.0),
        ..Grip::default()
    };
    let setup = Setup::bare(1e-6);
    let gamma = setup.parameters.stretch_ratio;
    let mut simulation = gripped(&setup, &skew_line(), [held(EndCondition::Pinned), loaded]);
    let tip = |s: &RodSimulation| s.state().end_to_end() - LENGTH;
    let lagging = |t: f64| rate / gamma * (t - (1.0 - (-gamma * t).exp()) / gamma) * LENGTH;
    for time in [0.1, 1.0, 3.0] {
        run_grips_to(&mut simulation, time);
        assert_close(tip(&simulation), lagging(time), "growing");
        assert_close(pull(&simulation, 1), rate * time, "force");
    }
    let last = rate * full * LENGTH / gamma;
    run_grips_to(&mut simulation, 4.0);
    assert_close(
        tip(&simulation),
        last + (lagging(full) - last) * (-gamma).exp(),
        "staying",
    );
    assert_balanced(&simulation);
    let work = simulation.model().account().work();
    run_grips_to(&mut simulation, 5.3);
    let strain = (tip(&simulation), last * (-0.3 * gamma).exp());
    assert_close(strain.0, strain.1, "let go");
    assert!(simulation.model().grip_forces(simulation.state())[1].is_none());
    let after =
        last + (lagging(full) - last) * (-2.0 * gamma).exp() - tip_at(4.0, rate, full, gamma);
    assert!((simulation.model().account().work() - work - rate * full * after).abs() < 1e-6);
    assert_balanced(&simulation);
}

/// Elongation a time after a force has stopped growing.
fn tip_at(time: f64, rate: f64, full: f64, gamma: f64) -> f64 {
    let last = rate * full * LENGTH / gamma;
    let grown = rate / gamma * (full - (1.0 - (-gamma * full).exp()) / gamma) * LENGTH;
    last + (grown - last) * (-gamma * (time - full)).exp()
}

/// A clamp turned by R in a ramp against another one: its torque is α R/(4 ℓ) + Ṙ/(2 ℓ), and the opposite holds the other.
#[test]
fn law_torque_of_a_turned_grip() {
    let (to, over) = (3.0, 4.0);
    let turned = Grip {
        rotation: TimeCourse::Ramp(Ramp { to, over }),
        ..held(EndCondition::Clamped)
    };
    let setup = Setup::bare(1e-5).with_twist();
    let alpha = setup.parameters.twist_ratio;
    let twisted = LENGTH * (1.0 - 1.0 / N_EDGES as f64);
    let mut simulation = gripped(
        &setup,
        &line(N_EDGES, LENGTH),
        [held(EndCondition::Clamped), turned],
    );
    let torque = |s: &RodSimulation, end: usize| {
        s.model().grip_forces(s.state())[end]
            .expect("a clamp")
            .torque
    };
    for (time, rotation, rate) in [
        (2.0, 1.5, to / over),
        (4.0, 3.0, to / over),
        (6.0, 3.0, 0.0),
    ] {
        run_grips_to(&mut simulation, time);
        let expected = (0.25 * alpha * rotation + 0.5 * rate) / twisted;
        assert_close(torque(&simulation, 1), expected, "torque");
        assert_close(torque(&simulation, 0), -expected, "torque of the other");
    }
    assert_close(
        stored(&simulation, "twist"),
        0.125 * alpha * to * to / twisted,
        "stored",
    );
    assert_close(
        simulation.model().account().work(),
        0.125 * alpha * to * to / twisted + 0.5 * to * to / (over * twisted),
        "work",
    );
    assert_balanced(&simulation);
}

/// Constant courses are the ends that are the same at all times.
#[test]
fn law_constant_courses_are_constant_ends() {
    use topo_rod::{EndMotion, Ends};
    let curve = from_tangents(N_EDGES, LENGTH / N_EDGES as f64, |j| {
        let (sin, cos) = (0.05 * j as f64).sin_cos();
        nalgebra::Vector3::new(cos, sin, 0.1)
    });
    let (force, torque) = ([0.01, -0.02, 0.03], 0.02);
    let setup = Setup::bare(1e-5).with_twist();
    let ends = Ends {
        conditions: [EndCondition::Clamped, EndCondition::Free],
        motions: [
            EndMotion::default(),
            EndMotion {
                force,
                torque,
                ..EndMotion::default()
            },
        ],
    };
    let mut constant = setup.clone().with_ends(ends).simulation(rod(&curve, 0.0));
    let loaded = Grip {
        force: force.map(TimeCourse::Constant),
        torque: TimeCourse::Constant(torque),
        ..Grip::default()
    };
    let mut simulation = gripped(&setup, &curve, [held(EndCondition::Clamped), loaded]);
    for run in [&mut constant, &mut simulation] {
        run_grips_to(run, 30.0);
    }
    let (a, b) = (constant.state(), simulation.state());
    for (x, y) in a.vertices().iter().zip(b.vertices()) {
        assert!((x - y).norm() < 1e-12);
    }
    assert_eq!(constant.n_steps(), simulation.n_steps());
    assert_close(
        simulation.model().account().work(),
        constant.model().account().work(),
        "work",
    );
}
