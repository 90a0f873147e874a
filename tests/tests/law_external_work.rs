//! Work done on the ends of a rod: closed forms of the work, and books that balance with it.

use topo_core::Polyline;
use topo_rod::{EndCondition, EndMotion, Ends, FrictionParameters};
use topo_tests::curves::{from_tangents, line};
use topo_tests::run::{RodSimulation, Setup, rod, run_to, stored};

const N_EDGES: usize = 50;
const LENGTH: f64 = 20.0;

fn assert_close(found: f64, expected: f64, what: &str) {
    let error = (found / expected - 1.0).abs();
    println!("{what}: {found:.8} against {expected:.8}, off by {error:.2e}");
    assert!(error < 1e-3, "{what}: off by {error:.2e}");
}

fn assert_balanced(simulation: &RodSimulation) {
    let residual = simulation.model().account().relative_residual();
    println!("residual {residual:.2e}");
    assert!(residual < 1e-3, "residual {residual:.2e}");
}

/// A vector of that length along no axis.
fn along(size: f64) -> [f64; 3] {
    [2.0, -3.0, 6.0].map(|x| size * x / 7.0)
}

/// A straight line in that direction, so that each component of a motion counts.
fn skew_line() -> Polyline {
    from_tangents(N_EDGES, LENGTH / N_EDGES as f64, |_| along(1.0).into())
}

fn ends(conditions: [EndCondition; 2], last: EndMotion) -> Ends {
    Ends {
        conditions,
        motions: [EndMotion::default(), last],
    }
}

/// A dead pull F stretches by F L/γ, does twice the work that stays stored, and dissipates the other half.
#[test]
fn law_work_of_an_end_force() {
    let pull = 0.3;
    let motion = EndMotion {
        force: along(pull),
        ..Default::default()
    };
    let setup =
        Setup::bare(1e-5).with_ends(ends([EndCondition::Pinned, EndCondition::Free], motion));
    let mut simulation = setup.simulation(rod(&skew_line(), 0.0));
    run_to(&mut simulation, 5.0);
    let gamma = setup.parameters.stretch_ratio;
    let account = simulation.model().account();
    assert_close(account.work(), pull * pull * LENGTH / gamma, "work");
    assert_close(
        stored(&simulation, "stretch"),
        0.5 * account.work(),
        "stored",
    );
    assert_close(
        account.dissipated_total(),
        0.5 * account.work(),
        "dissipated",
    );
    assert_balanced(&simulation);
}

/// A pinned end drawn at the speed V does the work γ ε² L/2 against the spring and V ε against viscosity.
#[test]
fn law_work_of_a_prescribed_displacement() {
    let (speed, time) = (0.4, 3.0);
    let motion = EndMotion {
        velocity: along(speed),
        ..Default::default()
    };
    let setup = Setup::bare(1e-5).with_ends(ends([EndCondition::Pinned; 2], motion));
    let mut simulation = setup.simulation(rod(&skew_line(), 0.0));
    run_to(&mut simulation, time);
    let strain = speed * time / LENGTH;
    let spring = 0.5 * setup.parameters.stretch_ratio * strain * strain * LENGTH;
    assert_close(stored(&simulation, "stretch"), spring, "stored");
    let account = simulation.model().account();
    assert_close(account.dissipated_total(), speed * strain, "dissipated");
    assert_close(account.work(), spring + speed * strain, "work");
    assert_balanced(&simulation);
    // a steady motion is linear in time: it must not be followed by the stiff time scale
    assert!(simulation.n_steps() < 100, "{} steps", simulation.n_steps());
}

/// A torque Q turns the free end by 4 Q ℓ/α, ℓ the arc between the first edge, which the clamp holds, and the last.
#[test]
fn law_work_of_an_end_torque() {
    let torque = 0.05;
    let motion = EndMotion {
        torque,
        ..Default::default()
    };
    let setup = Setup::bare(1e-5)
        .with_twist()
        .with_ends(ends([EndCondition::Clamped, EndCondition::Free], motion));
    let mut simulation = setup.simulation(rod(&line(N_EDGES, LENGTH), 0.0));
    run_to(&mut simulation, 40.0);
    let twisted = LENGTH * (1.0 - 1.0 / N_EDGES as f64);
    let turned = 4.0 * torque * twisted / setup.parameters.twist_ratio;
    let found: f64 = simulation.state().twists().iter().sum();
    assert_close(found, turned, "rotation");
    assert_close(simulation.model().account().work(), torque * turned, "work");
    assert_close(
        stored(&simulation, "twist"),
        0.5 * torque * turned,
        "stored",
    );
    assert_balanced(&simulation);
}

/// A clamp turned at the rate ω does the work α R²/(8 ℓ) against the spring and ω R/(2 ℓ) against twist viscosity.
#[test]
fn law_work_of_a_prescribed_rotation() {
    let (rate, time) = (0.7, 4.0);
    let motion = EndMotion {
        rotation_rate: rate,
        ..Default::default()
    };
    let setup = Setup::bare(1e-5)
        .with_twist()
        .with_ends(ends([EndCondition::Clamped; 2], motion));
    let mut simulation = setup.simulation(rod(&line(N_EDGES, LENGTH), 0.0));
    run_to(&mut simulation, time);
    let (twisted, turned) = (LENGTH * (1.0 - 1.0 / N_EDGES as f64), rate * time);
    let spring = setup.parameters.twist_ratio * turned * turned / (8.0 * twisted);
    let viscous = 0.5 * rate * turned / twisted;
    assert_close(stored(&simulation, "twist"), spring, "stored");
    let account = simulation.model().account();
    assert_close(account.dissipated_total(), viscous, "dissipated");
    assert_close(account.work(), spring + viscous, "work");
    assert_balanced(&simulation);
    assert!(simulation.n_steps() < 100, "{} steps", simulation.n_steps());
}

/// A clamp moved and turned at once while the rod buckles in space: the books still balance.
#[test]
fn law_books_balance_while_a_driven_rod_writhes() {
    let motion = EndMotion {
        velocity: [-0.005, 0.0, 0.0],
        rotation_rate: 0.02,
        ..Default::default()
    };
    let setup = Setup::bare(1e-4)
        .with_twist()
        .with_stretch_ratio(50.0)
        .with_ends(ends([EndCondition::Clamped; 2], motion));
    let curve = line(N_EDGES, LENGTH);
    let bent = curve.vertices().iter().map(|v| {
        let u = (v.x / LENGTH * std::f64::consts::PI).sin().powi(4);
        v + nalgebra::Vector3::new(0.0, 0.1 * u, 0.05 * u)
    });
    let state = rod(&topo_tests::curves::polyline(bent.collect(), false), 0.0);
    let mut simulation = setup.simulation(state);
    run_to(&mut simulation, 600.0);
    assert!(stored(&simulation, "bend") > 0.1, "it did not buckle");
    let account = simulation.model().account();
    println!(
        "work {} stored {:?} dissipated {}",
        account.work(),
        account.stored(),
        account.dissipated_total()
    );
    assert!(account.work() > 0.0 && account.dissipated_total() > 0.0);
    assert_balanced(&simulation);
}

/// A held tip dragged along another strand of its rod pays for the friction there: the books still balance.
#[test]
fn law_books_balance_while_a_held_tip_rubs() {
    let motion = EndMotion {
        velocity: [-0.4, 0.1, 0.2],
        ..Default::default()
    };
    let ends = Ends {
        conditions: [EndCondition::Pinned, EndCondition::Clamped],
        motions: [motion, EndMotion::default()],
    };
    let mut setup = Setup::bare(1e-4).with_ends(ends);
    setup.parameters.friction = Some(FrictionParameters {
        ratio: 2.0,
        ..Default::default()
    });
    // a hairpin: out, half a turn of diameter 1.5, and back past the first tip
    let (edge, out, turn) = (0.2, 40, 12);
    let angle = |j: usize| (j as f64 - out as f64 + 0.5) / turn as f64;
    let curve = from_tangents(140, edge, |j| {
        let (sin, cos) = (std::f64::consts::PI * angle(j).clamp(0.0, 1.0)).sin_cos();
        nalgebra::Vector3::new(cos, sin, 0.0)
    });
    let mut simulation = setup.simulation(rod(&curve, 0.0));
    run_to(&mut simulation, 2.0);
    let account = simulation.model().account();
    let rubbed = account.dissipated_by("friction").unwrap_or_default();
    println!("work {} friction {rubbed}", account.work());
    assert!(rubbed > 0.2 * account.work(), "the tip hardly rubs");
    assert_balanced(&simulation);
}
