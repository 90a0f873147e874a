//! Rods that are curved or twisted at rest.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use topo_core::Model;
use topo_rod::RodState;
use topo_tests::{curves, run};

/// A ring whose natural curvature is its own, (2/l) tan(π/N) for a polygon, stores nothing and pulls at nothing; cut, it stays.
#[test]
fn val_a_naturally_curved_ring_is_free_of_stress() {
    let (n, radius) = (120, 4.0);
    let curve = curves::ring(n, radius);
    let edge = curve.length() / n as f64;
    let natural = 2.0 / edge * (PI / n as f64).tan();
    let ring = RodState::new(&curve, curve.length(), 0.0).unwrap();
    let ring = ring.with_rest(|_, _| [natural, 0.0], |_, _| 0.0).unwrap();
    let setup = run::Setup::bare(1e-3).with_twist();
    for state in [ring.clone(), ring.cut_at(31).unwrap()] {
        let mut model = setup.model(&state);
        let energies = model.energies(&state).unwrap();
        assert!(energies.iter().all(|e| *e < 1e-12), "{energies:?}");
        let force = model.force(&state).unwrap();
        let largest = force.vertex.iter().map(|f| f.norm()).fold(0.0, f64::max);
        println!("force {largest:.1e}, energies {energies:?}");
        assert!(largest < 1e-12 && force.torque.iter().all(|t| t.abs() < 1e-12));
        let mut rate = vec![0.0; model.n_dof()];
        model.rate(&state, &mut rate).unwrap();
        assert!(topo_core::max_norm(&rate) < 1e-9);
    }
    // the same ring of a straight rod stores π B/R, of one curved the other way four times that
    for (factor, expected) in [(0.0, 1.0), (-1.0, 4.0)] {
        let state = ring.clone();
        let state = state
            .with_rest(|_, _| [factor * natural, 0.0], |_, _| 0.0)
            .unwrap();
        let stored = setup.model(&state).energies(&state).unwrap()[0];
        let by_hand = expected * 0.25 * PI / radius;
        assert!((stored / by_hand - 1.0).abs() < 1e-3, "{stored} {by_hand}");
    }
}

/// A rod that is half a turn at rest stores B L κ_0²/2 when it is straight, whichever way its material is turned, and curls up to a half circle.
#[test]
fn val_half_a_turn_opened_straight() {
    let length = 20.0;
    let natural = PI / length;
    let expected = 0.25 * length * natural * natural / 2.0;
    let fine = RodState::new(&curves::line(1600, length), length, 0.0).unwrap();
    for angle in [0.0, 0.4, 2.1] {
        let curvature = [natural * f64::cos(angle), natural * f64::sin(angle)];
        let state = fine
            .clone()
            .with_rest(|_, _| curvature, |_, _| 0.0)
            .unwrap();
        let stored = run::Setup::bare(1e-3)
            .model(&state)
            .energies(&state)
            .unwrap()[0];
        assert!(
            (stored / expected - 1.0).abs() < 1e-3,
            "{stored} {expected}"
        );
    }
    let line = RodState::new(&curves::line(100, length), length, 0.0).unwrap();
    let line = line
        .with_rest(|_, _| [0.6 * natural, 0.8 * natural], |_, _| 0.0)
        .unwrap();
    let mut run = run::Setup::bare(1e-5).with_twist().simulation(line);
    let start = run::stored(&run, "bend");
    run::run_to(&mut run, 2000.0);
    let left = run::stored(&run, "bend") / start;
    let across = run.state().end_to_end();
    println!(
        "left {left:.1e}, across {across}, books {:.1e}",
        run.model().account().relative_residual()
    );
    assert!(left < 1e-5, "{left:e}");
    assert!(
        (across / (2.0 * length / PI) - 1.0).abs() < 2e-3,
        "{across}"
    );
    assert!(run.model().account().relative_residual() < 2e-3);
}

/// A straight rod of natural twist θ'_0 winds itself up to it, at the rate of any twist, and stores nothing then; its natural
/// curvature, wound about it, makes a helix of curvature κ_0 and torsion θ'_0.
#[test]
fn val_natural_twist_and_curvature_make_a_helix() {
    let (length, natural, twist) = (12.0, 0.3, 0.5);
    let line = RodState::new(&curves::line(60, length), length, 0.0).unwrap();
    let twisted = line
        .clone()
        .with_rest(|_, _| [0.0; 2], |_, _| twist)
        .unwrap();
    let mut run = run::Setup::bare(1e-3).with_twist().simulation(twisted);
    run::run_to(&mut run, 60.0);
    let turns = twist * length * 59.0 / 60.0 / TAU;
    assert!((run.state().total_twist() / turns - 1.0).abs() < 1e-6);
    assert!(run::stored(&run, "twist") < 1e-9);
    let both = line.with_rest(|_, _| [natural, 0.0], |_, _| twist).unwrap();
    let mut run = run::Setup::bare(1e-3).with_twist().simulation(both);
    run::run_to(&mut run, 3000.0);
    let elastic = run::stored(&run, "bend") + run::stored(&run, "twist");
    // radius κ/(κ² + τ²), pitch 2πτ/(κ² + τ²): the chord of the helix
    let rate = f64::hypot(natural, twist);
    let (radius, rise) = (natural / (rate * rate), twist / rate);
    let chord = f64::hypot(rise * length, 2.0 * radius * (0.5 * rate * length).sin());
    let found = run.state().end_to_end();
    println!("left {elastic:.1e}, chord {found} of {chord}");
    assert!(elastic < 1e-6, "{elastic:e}");
    assert!((found / chord - 1.0).abs() < 5e-3, "{found} {chord}");
    let right_handed = run.state().writhe() > 0.0;
    let x = run.state().vertices();
    let (a, b, c): (Vector3<f64>, _, _) = (x[21] - x[20], x[31] - x[30], x[41] - x[40]);
    println!("writhe {}, triple {}", right_handed, a.dot(&b.cross(&c)));
    assert!(a.dot(&b.cross(&c)) > 0.0, "a left-handed helix");
}
