//! Buckling thresholds and post-buckled shapes with closed forms: Michell–Zajac ring, Euler column, localised helix.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Vector3;
use topo_rod::{EndCondition, EndMotion, Ends, RodState};
use topo_tests::curves::{from_tangents, line, polyline, ring};
use topo_tests::run::{RodSimulation, Setup, run_to};

/// B/A of the reduced units.
const BENDING: f64 = 0.25;

/// Logarithmic growth of `amplitude` between two times.
fn growth(
    mut simulation: RodSimulation,
    times: [f64; 2],
    amplitude: impl Fn(&RodState) -> f64,
) -> f64 {
    let [early, late] = times.map(|time| {
        run_to(&mut simulation, time);
        amplitude(simulation.state())
    });
    (late / early).ln() / (times[1] - times[0])
}

/// Where `growth` changes sign between `stable` and `unstable`.
fn threshold(growth: impl Fn(f64) -> f64, mut stable: f64, mut unstable: f64) -> f64 {
    assert!(growth(stable) < 0.0, "grows at {stable}");
    assert!(growth(unstable) > 0.0, "decays at {unstable}");
    for _ in 0..10 {
        let middle = 0.5 * (stable + unstable);
        if growth(middle) < 0.0 {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    0.5 * (stable + unstable)
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found / expected - 1.0).abs();
    println!("{what}: {found:.6} against {expected:.6}, off by {error:.2e}");
    assert!(error < tolerance, "{what}: off by {error:.2e}");
}

/// A ring whose twist exceeds the angle 2π√3/α leaves its plane; contact is left out.
///
/// # References
/// [michell1889], [zajac1962], [goriely2006].
#[test]
fn val_michell_zajac_ring_buckles_at_the_critical_twist() {
    let (n, length) = (120, 30.0);
    for ratio in [1.0 / 1.3, 1.0] {
        let mut setup = Setup::bare(1e-7).with_twist().with_stretch_ratio(200.0);
        setup.parameters.twist_ratio = ratio;
        let amplitude = |state: &RodState| {
            // the mode of two waves; one wave is a tilt
            let wave = |f: fn(f64) -> f64| -> f64 {
                let x = state.vertices().iter().enumerate();
                x.map(|(i, v)| v.z * f(2.0 * TAU * i as f64 / n as f64))
                    .sum()
            };
            wave(f64::cos).hypot(wave(f64::sin))
        };
        let grows = |angle: f64| {
            let flat = ring(n, length / TAU);
            let bent = flat.vertices().iter().enumerate().map(|(i, v)| {
                let u = 2.0 * TAU * i as f64 / n as f64;
                v + Vector3::z() * (1e-3 * u.cos())
            });
            let curve = polyline(bent.collect(), true);
            let state = RodState::new(&curve, length, angle / length).unwrap();
            growth(setup.simulation(state), [200.0, 400.0], amplitude)
        };
        let truth = TAU * 3f64.sqrt() / ratio;
        let found = threshold(grows, 0.82 * truth, 1.2 * truth);
        assert_close(found, truth, 0.02, "critical twist of a ring");
    }
}

/// A column of `n` edges under compressive strain, with a trace of a mode given at each vertex.
fn column(n: usize, length: f64, strain: f64, mode: impl Fn(f64) -> f64) -> RodState {
    let straight = line(n, length * (1.0 - strain));
    let bent = straight
        .vertices()
        .iter()
        .enumerate()
        .map(|(i, v)| v + Vector3::y() * (1e-3 * mode(i as f64)));
    RodState::new(&polyline(bent.collect(), false), length, 0.0).unwrap()
}

fn largest_deflection(state: &RodState) -> f64 {
    state
        .vertices()
        .iter()
        .map(|v| v.y.abs())
        .fold(0.0, f64::max)
}

/// Euler's loads P = π² B/ℓ² with ℓ = L for pinned ends, L/2 for clamped ones and 2L for a clamped and a free end; a clamp
/// holds the first edge, so the arc that can bend ends at that edge's middle. Stretch makes it P (1 − P/γ).
///
/// # References
/// [timoshenko1961].
#[test]
fn val_euler_column_buckles_at_the_critical_load() {
    let (n, length) = (100, 20.0);
    let edge = length / n as f64;
    let setup = Setup::bare(1e-7);
    let stretch = setup.parameters.stretch_ratio;
    let critical = |l: f64| {
        let load = BENDING * (PI / l).powi(2);
        0.5 * stretch * (1.0 - (1.0 - 4.0 * load / stretch).sqrt())
    };
    type Mode = fn(f64) -> f64;
    // clamped: the first two vertices stay in line
    let held: [(EndCondition, f64, Mode); 2] = [
        (EndCondition::Pinned, length, |i| (PI * i / 100.0).sin()),
        (EndCondition::Clamped, 0.5 * (length - edge), |i| {
            (PI / 99.0).cos() - (TAU * (i - 0.5) / 99.0).cos()
        }),
    ];
    for (condition, free_length, mode) in held {
        let truth = critical(free_length);
        let times = [0.2, 2.0].map(|t| t / truth);
        let setup = setup.clone().with_ends(Ends {
            conditions: [condition; 2],
            ..Default::default()
        });
        let grows = |load: f64| {
            let state = column(n, length, load / stretch, mode);
            growth(setup.simulation(state), times, largest_deflection)
        };
        let found = threshold(grows, 0.82 * truth, 1.2 * truth);
        assert_close(found, truth, 0.01, &format!("Euler load, {condition:?}"));
    }
    // a dead load on the free end of a cantilever
    let truth = critical(2.0 * (length - 0.5 * edge));
    let grows = |load: f64| {
        let mut ends = Ends {
            conditions: [EndCondition::Clamped, EndCondition::Free],
            ..Default::default()
        };
        ends.motions[1].force = [-load, 0.0, 0.0];
        let state = column(n, length, load / stretch, |i| {
            (FRAC_PI_2 / 199.0).cos() - (PI * (i - 0.5) / 199.0).cos()
        });
        let times = [0.5, 4.0].map(|t| t / truth);
        growth(
            setup.clone().with_ends(ends).simulation(state),
            times,
            largest_deflection,
        )
    };
    let found = threshold(grows, 0.82 * truth, 1.2 * truth);
    assert_close(found, truth, 0.01, "Euler load, Clamped and Free");
}

/// The localised helix of a long rod under tension T and torque M between clamps that approach by D and turn by R.
///
/// ```math
/// \sin\frac{\theta}{2} = u\, \mathrm{sech}\bigl(u s \sqrt{T/B}\bigr), \quad u^2 = 1 - \frac{M^2}{4 B T}, \quad
/// D = 4 u \sqrt{B/T}, \quad R = \frac{M L}{C} + 4 \arccos\frac{M}{2 \sqrt{B T}}
/// ```
///
/// The rod starts from the shape of one member of the family with the twist of another; D and R are what it keeps.
///
/// # References
/// [coyne1990], [vanderheijden2000].
#[test]
fn val_localised_helix_between_clamps() {
    let (n, length, ratio) = (480, 120.0, 1.0 / 1.3);
    let edge = length / n as f64;
    // the clamps hold the first and the last edge
    let twisted = length - edge;
    let (approach, u_start, density) = (10.0, 0.4f64, 0.454);
    let setup = {
        let mut setup = Setup::bare(2e-4).with_twist().with_stretch_ratio(1000.0);
        setup.parameters.twist_ratio = ratio;
        setup.with_ends(Ends {
            conditions: [EndCondition::Clamped; 2],
            motions: [EndMotion::default(); 2],
        })
    };
    let wavenumber = 4.0 * u_start / approach;
    let moment = 2.0 * (1.0 - u_start * u_start).sqrt() * wavenumber;
    let mut azimuth = 0.0;
    let tangents: Vec<_> = (0..n)
        .map(|j| {
            let s = (j as f64 + 0.5) * edge - 0.5 * length;
            let half = (u_start / (u_start * wavenumber * s).cosh()).asin();
            let c = (2.0 * half).cos();
            azimuth += edge * moment / (1.0 + c);
            if j == 0 || j + 1 == n {
                return Vector3::z();
            }
            let s = (2.0 * half).sin();
            Vector3::new(s * f64::cos(azimuth), s * f64::sin(azimuth), c)
        })
        .collect();
    let curve = from_tangents(n, edge, |j| tangents[j]);
    // the two clamps on one axis
    let (first, last) = (curve.vertices()[0], curve.vertices()[n]);
    let aligned = curve.vertices().iter().enumerate().map(|(i, v)| {
        let share = (i.clamp(1, n - 1) - 1) as f64 / (n - 2) as f64;
        let offset = last - first;
        v - Vector3::new(offset.x, offset.y, 0.0) * share
    });
    let curve = polyline(aligned.collect(), false);
    let state = RodState::new(&curve, length, density).unwrap();
    let approach_kept = length - (curve.vertices()[n].z - curve.vertices()[0].z);
    // R of the family at fixed D, and the member with the R of the start
    let rotation = |u: f64| {
        8.0 * u * (1.0 - u * u).sqrt() * twisted / (ratio * approach_kept) + 4.0 * u.asin()
    };
    let turned = density * twisted + 4.0 * u_start.asin();
    let (mut low, mut high) = (0.05, 0.7);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rotation(middle) < turned {
            low = middle;
        } else {
            high = middle;
        }
    }
    let u = 0.5 * (low + high);
    let mut simulation = setup.simulation(state);
    run_to(&mut simulation, 8000.0);
    let state = simulation.state().clone();
    let steepest = (0..n)
        .map(|j| state.tangent(j).z)
        .fold(f64::INFINITY, f64::min);
    let torque = ratio * state.twists()[n / 2] / (4.0 * edge);
    let tension = simulation.modify(|model, state| {
        model.force(state).unwrap().vertex[0].z + model.force(state).unwrap().vertex[1].z
    });
    let wave = 4.0 * u / approach_kept;
    assert_close(
        torque,
        2.0 * BENDING * wave * (1.0 - u * u).sqrt(),
        0.01,
        "torque",
    );
    assert_close(tension, BENDING * wave * wave, 0.01, "tension");
    assert_close(1.0 - steepest, 2.0 * u * u, 0.01, "deflection");
}
