//! Decay of a nearly straight free rod, and the bending energy of a circle: the linear truths of the discrete rod.

use std::f64::consts::PI;

use nalgebra::Vector3;
use topo_core::{Polyline, Sample, Schedule, Scheduled, SpectralBound};
use topo_rod::RodState;
use topo_tests::curves::{from_tangents, line, ring};
use topo_tests::run::{Setup, rod, run_to, stored};

const LENGTH: f64 = 50.0;
const N_EDGES: usize = 100;

/// Rate at which the energy of `term` decays over `time`.
fn energy_rate(setup: &Setup, state: RodState, term: &str, time: f64) -> f64 {
    let mut simulation = setup.simulation(state);
    let start = stored(&simulation, term);
    assert!(start > 0.0);
    run_to(&mut simulation, time);
    (start / stored(&simulation, term)).ln() / time
}

fn assert_rate(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found / expected - 1.0).abs();
    println!("{what}: rate {found:.8} against {expected:.8}, off by {error:.2e}");
    assert!(error < tolerance, "{what}: off by {error:.2e}");
}

/// Twist of a straight rod does not diffuse, it fades everywhere alike: the energy at the rate α E_b/η.
#[test]
fn val_twist_decay_rate_of_a_straight_rod() {
    for ratio in [1.0 / 1.3, 0.5] {
        let mut setup = Setup::bare(1e-4).with_twist();
        setup.parameters.twist_ratio = ratio;
        let state = rod(&line(N_EDGES, LENGTH), 0.3);
        let rate = energy_rate(&setup, state, "twist", 2.0);
        assert_rate(rate, ratio, 1e-3, "twist");
    }
}

/// A uniform strain fades at γ E_b/η whatever its size, its energy at twice that rate.
#[test]
fn val_stretch_decay_rate_of_a_straight_rod() {
    for (ratio, stretch) in [(5.0, 1.02), (100.0, 0.99)] {
        let curve = line(N_EDGES, LENGTH * stretch);
        let state = RodState::new(&curve, LENGTH, 0.0).unwrap();
        let setup = Setup::bare(1e-5).with_stretch_ratio(ratio);
        let rate = energy_rate(&setup, state, "stretch", 1.0 / ratio);
        assert_rate(rate, 2.0 * ratio, 1e-3, "stretch");
    }
}

/// With internal viscosity the tangent angle of a free rod diffuses, ∂φ/∂t = (E_b h²/4η) φ'', with φ' = 0 at the ends. The
/// slowest mode cos(π s/L) loses its energy at the rate π²/(2 L²), the mode k at k² times that.
#[test]
fn val_bending_decay_rate_of_a_straight_rod() {
    for mode in [1.0, 3.0] {
        let tangent = |j: usize| {
            let angle = 0.01 * (mode * PI * (j as f64 + 0.5) / N_EDGES as f64).cos();
            Vector3::new(angle.cos(), angle.sin(), 0.0)
        };
        let curve = from_tangents(N_EDGES, LENGTH / N_EDGES as f64, tangent);
        let state = RodState::new(&curve, LENGTH, 0.0).unwrap();
        let expected = (mode * PI / LENGTH).powi(2) / 2.0;
        let rate = energy_rate(&Setup::bare(1e-6), state, "bend", 1.0 / expected);
        // the second difference of the mode is smaller than its second derivative by (k π/N)²/12
        let tolerance = 1e-3 * mode;
        assert_rate(rate, expected, tolerance, "bend");
    }
}

/// The fastest rates of a straight rod: γ of stretch, α/2 of twist, and 1/l_0² of bending from edge to edge. The bound that the
/// stabilised integrator asks for lies above the largest by its margin, a fifth, and no more.
#[test]
fn val_spectral_radius_of_a_straight_rod() {
    for (ratio, length) in [(100.0, 50.0), (5.0, 50.0), (5.0, 10.0)] {
        let state = rod(&line(N_EDGES, length), 0.0);
        let edge = length / N_EDGES as f64;
        let setup = Setup::bare(1e-3).with_twist().with_stretch_ratio(ratio);
        let fastest = f64::max(ratio, 1.0 / (edge * edge));
        let bound = setup.model(&state).spectral_radius(&state).unwrap();
        println!("bound {bound}, fastest {fastest}");
        assert!(
            (1.05..1.3).contains(&(bound / fastest)),
            "{bound} {fastest}"
        );
    }
}

/// Bending energy π B/R of a circle, B/A = 1/4, with second order in the edge length.
#[test]
fn val_circle_bending_energy_converges_at_second_order() {
    let radius = LENGTH / (2.0 * PI);
    let truth = PI / (4.0 * radius);
    let energy = |n: usize| {
        let state = RodState::new(&ring(n, radius), LENGTH, 0.0).unwrap();
        stored(&Setup::bare(1e-3).simulation(state), "bend")
    };
    let errors: Vec<f64> = [50, 100, 200, 400]
        .map(|n| (energy(n) / truth - 1.0).abs())
        .to_vec();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        println!("errors {:.3e} {:.3e}, order {order:.4}", pair[0], pair[1]);
        assert!(order > 1.9, "order {order}");
    }
    assert!(errors[3] < 1e-4, "error at 400 edges: {:.2e}", errors[3]);
}

/// Every reading of L/h, over the whole range of ropelengths: a straight rod touches and rubs nothing.
#[test]
fn val_straight_rod_has_no_contact_energy_and_no_friction() {
    use topo_rod::{ContactParameters, FrictionParameters, Reading};
    let readings = [
        Reading::Shrunk,
        Reading::Hard,
        Reading::Tight,
        Reading::OwnLength,
    ];
    for reading in readings {
        for (ropelength, n_edges) in [(32.7, 200), (50.0, 800), (65.7, 100)] {
            let mut setup = Setup::bare(1e-3);
            setup.parameters.reading = reading;
            setup.parameters.contact = Some(ContactParameters::default());
            setup.parameters.friction = Some(FrictionParameters::default());
            setup.tube = setup.parameters.tube(ropelength).unwrap();
            let curve: Polyline = line(n_edges, setup.tube.start_length);
            let state = RodState::new(&curve, setup.tube.length, 0.0).unwrap();
            let mut simulation = setup.simulation(state);
            simulation.modify(|model, _| model.set_cyclic(false));
            run_to(&mut simulation, 1e-3);
            assert_eq!(stored(&simulation, "contact"), 0.0);
            assert!(simulation.model().pairs().active().is_empty());
            assert_eq!(
                simulation.model().account().dissipated_by("friction"),
                Some(0.0)
            );
        }
    }
}

/// A chord under an exponential decay, |δε|² L/dt, books too little dissipation; the books of the rod do better than chords.
#[test]
fn law_dissipation_of_a_decaying_mode_beats_its_chords() {
    let state = RodState::new(&line(N_EDGES, LENGTH * 1.02), LENGTH, 0.0).unwrap();
    let mut simulation = Setup::bare(1e-3).simulation(state);
    let mut strains = Vec::new();
    let mut look = |s: &Sample<'_, RodState>| {
        strains.push((s.time, s.state.end_to_end() / LENGTH - 1.0));
    };
    let mut observers = [Scheduled::new(Schedule::always(), &mut look)];
    simulation.run(1.0, &mut observers, &mut |_| None);
    let chords: f64 = strains
        .windows(2)
        .map(|w| LENGTH * (w[1].1 - w[0].1).powi(2) / (w[1].0 - w[0].0))
        .sum();
    let account = simulation.model().account();
    let released = account.stored_start() - account.stored_total();
    let (ours, theirs) = (account.residual().abs(), (released - chords).abs());
    println!("missing: {ours:.2e}, by chords {theirs:.2e}, of {released:.2e}");
    assert!(ours < 0.3 * theirs, "{ours:.2e} against {theirs:.2e}");
}
