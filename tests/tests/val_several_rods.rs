//! Rods that are several, against closed forms.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use topo_core::{Model, Polyline};
use topo_rod::energy::{At, EnergyKind, EnergyTerm, Force, Stiffness};
use topo_rod::{
    Accuracy, ContactParameters, Guards, Reading, RodBattery, RodParameters, RodState, Tube,
};
use topo_tests::{curves, run};

type V = Vector3<f64>;

/// A circle in the plane through `centre` spanned by x and `across`.
fn circle(n: usize, radius: f64, centre: V, across: V) -> Polyline {
    curves::closed(n, |u| {
        centre + (V::x() * u.cos() + across * u.sin()) * radius
    })
}

/// Two half circles of radius 2 about (±1, 0, 0), joined by straight lines of length 2.
fn stadium(n: usize) -> Polyline {
    let length = 4.0 * PI + 4.0;
    curves::closed(n, |u| {
        let s = length * u / TAU;
        let arc = |s: f64| (V::y() * -(0.5 * s).cos() + V::x() * (0.5 * s).sin()) * 2.0;
        if s < TAU {
            V::x() + arc(s)
        } else if s < TAU + 2.0 {
            V::new(1.0 - (s - TAU), 2.0, 0.0)
        } else if s < 2.0 * TAU + 2.0 {
            -V::x() - arc(s - TAU - 2.0)
        } else {
            V::new(-1.0 + (s - 2.0 * TAU - 2.0), -2.0, 0.0)
        }
    })
}

/// The tight Hopf link is two circles of radius 2 through each other's centre, 8π radii of rope; the tight chain of three is two
/// circles and a stadium, 12π + 4. Components share the natural length and the edges by their own length.
#[test]
fn val_tight_chains_of_rings_have_their_ropelength() {
    let ring = |x: f64| circle(400, 2.0, V::x() * x, V::z());
    let hopf = vec![circle(400, 2.0, V::zeros(), V::y()), ring(2.0)];
    let chain = vec![ring(-3.0), stadium(600), ring(3.0)];
    for (curves, expected) in [(hopf, 8.0 * PI), (chain, 12.0 * PI + 4.0)] {
        let parameters = RodParameters {
            reading: Reading::OwnLength,
            ..RodParameters::default()
        };
        let (accuracy, guards) = (Accuracy::default(), Guards::default());
        let battery = RodBattery::link(&parameters, &accuracy, guards, &curves).unwrap();
        let found = battery.ropelength();
        println!("{found} of {expected}");
        assert!(
            (found / expected - 1.0).abs() < 2e-4,
            "{found} of {expected}"
        );
        let start = battery.start();
        let edges: usize = start.components().iter().map(|c| c.n_edges()).sum();
        assert_eq!(edges, 200);
        assert!((start.length() / found - 1.0).abs() < 1e-12);
        let whole: f64 = curves.iter().map(Polyline::length).sum();
        for (chain, curve) in start.components().iter().zip(&curves) {
            let (own, given) = (chain.length() / found, curve.length() / whole);
            assert!((own / given - 1.0).abs() < 1e-3, "{own} {given}");
            assert!((chain.rest_length() / start.rest_length() - 1.0).abs() < 0.02);
        }
    }
}

/// A rod that bends, stretches and touches, with the drag ζ.
fn touching(drag: f64) -> run::Setup {
    let mut setup = run::Setup::bare(1e-4);
    setup.parameters.contact = Some(ContactParameters { stiffness: 20.0 });
    setup.parameters.drag = drag;
    setup.tube = Tube {
        contact_diameter: 2.0,
        ..setup.tube
    };
    setup
}

/// Two coaxial rings that overlap push each other along their axis. The speed of each is the sum of the contact forces, by the law
/// V(r) = 10 (2 − r)² (2/r)⁴, over its drag ζ L_c/L².
#[test]
fn val_speed_of_a_pushed_component_is_force_over_drag() {
    for (radii, n, drag) in [([4.0, 4.0], [60, 60], 1.0), ([4.0, 4.6], [60, 75], 0.2)] {
        let gap = 1.7;
        let heights = [0.0, gap];
        let [a, b]: [RodState; 2] = std::array::from_fn(|k| {
            let centre = V::z() * heights[k];
            let curve = circle(n[k], radii[k], centre, V::y());
            RodState::new(&curve, TAU * radii[k], 0.0).unwrap()
        });
        let lengths = [a.length(), b.length()];
        let mut force = V::zeros();
        for x in a.vertices() {
            for y in b.vertices() {
                let (d, r) = (x - y, (x - y).norm());
                if r < 2.0 {
                    let q = (2.0 / r).powi(4);
                    let push = 20.0 * (2.0 - r) * q + 40.0 * (2.0 - r).powi(2) * q / r;
                    force += d * (a.rest_length() * b.rest_length() * push / r);
                }
            }
        }
        assert!(force.z < -1.0, "{force}");
        let state = RodState::link([&a, &b]).unwrap();
        let mut model = touching(drag).model(&state);
        let mut rate = vec![0.0; model.n_dof()];
        model.rate(&state, &mut rate).unwrap();
        let total = state.n_vertices();
        for (c, sign) in [(0, 1.0), (1, -1.0)] {
            let own = state.components()[c].vertices();
            let mean = |k: usize| {
                let sum: f64 = own.clone().map(|i| rate[k * total + i]).sum();
                sum / own.len() as f64
            };
            let resistance = drag * lengths[c] / state.length().powi(2);
            let speed = V::new(mean(0), mean(1), mean(2));
            let expected = force * (sign / resistance);
            let error = (speed - expected).norm() / expected.norm();
            println!("component {c}: {speed:?}, off by {error:.1e}");
            assert!(error < 1e-9, "component {c}: {error:.1e}");
        }
    }
}

/// A constant force on the first component and its opposite on the second, spread over their vertices.
#[derive(Clone, Copy)]
struct Push(V);

impl Push {
    fn each(&self, at: At<'_>) -> impl Iterator<Item = (usize, V)> {
        let chains: Vec<_> = at.state.components().to_vec();
        let force = self.0;
        chains
            .into_iter()
            .zip([1.0, -1.0])
            .flat_map(move |(c, sign)| {
                let each = force * (sign / c.n_vertices() as f64);
                c.vertices().map(move |i| (i, each))
            })
    }
}

impl EnergyTerm for Push {
    fn name(&self) -> &'static str {
        "push"
    }

    fn kind(&self) -> EnergyKind {
        EnergyKind::Constraint
    }

    fn energy(&self, at: At<'_>) -> f64 {
        self.each(at)
            .map(|(i, f)| -f.dot(&at.state.vertices()[i]))
            .sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        self.each(at).for_each(|(i, f)| force.vertex[i] += f);
        self.energy(at)
    }

    fn add_stiffness(&self, _: At<'_>, _: &mut Stiffness) {}

    fn add_density(&self, _: At<'_>, _: &mut [f64]) {}
}

/// Components pushed by f and −f move apart at f L²/(ζ L_c), dissipate f²L²/ζ (1/L_a + 1/L_b), and deform as they would at rest; an
/// open component does as a closed one.
#[test]
fn val_pushed_components_drift_at_force_over_drag() {
    let (drag, time, f) = (0.5, 3.0, V::new(0.02, -0.01, 0.03));
    let closed = RodState::new(&circle(60, 4.0, V::zeros(), V::y()), 24.0, 0.0).unwrap();
    let line = curves::line(30, 12.0).vertices().to_vec();
    let line = line.iter().map(|x| x + V::new(0.0, 0.0, 20.0)).collect();
    let open = RodState::new(&curves::polyline(line, false), 12.0, 0.0).unwrap();
    for parts in [[&closed, &open], [&open, &closed]] {
        let state = RodState::link(parts).unwrap();
        let setup = touching(drag);
        let model = setup.model(&state).with(Box::new(Push(f))).unwrap();
        let mut pushed = setup.simulation_of(model, state.clone());
        let mut resting = setup.simulation(state.clone());
        run::run_to(&mut pushed, time);
        run::run_to(&mut resting, time);
        let mut power = 0.0;
        for (c, sign) in [(0, 1.0), (1, -1.0)] {
            let chain = state.components()[c];
            let mean = |s: &RodState| s.vertices()[chain.vertices()].iter().sum::<V>();
            let moved = (mean(pushed.state()) - mean(&state)) / chain.n_vertices() as f64;
            let resistance = drag * chain.length() / state.length().powi(2);
            let expected = f * (sign * time / resistance);
            let error = (moved - expected).norm() / expected.norm();
            println!(
                "component {c} moved by {:.3}, off by {error:.1e}",
                moved.norm()
            );
            assert!(error < 1e-9, "component {c}: {error:.1e}");
            power += f.norm_squared() / resistance;
            for (x, y) in chain
                .vertices()
                .map(|i| (pushed.state().vertices()[i], resting.state().vertices()[i]))
            {
                assert!((x - moved - y).norm() < 1e-3, "it deforms");
            }
        }
        let dissipated = |s: &run::RodSimulation| s.model().account().dissipated_by("viscosity");
        let by_drag = dissipated(&pushed).unwrap() - dissipated(&resting).unwrap();
        assert!((by_drag / (power * time) - 1.0).abs() < 1e-3, "{by_drag}");
        assert!(pushed.model().account().relative_residual() < 1e-3);
    }
}
