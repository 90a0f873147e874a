//! Contact and its friction of two straight strands against their integrals, and the mobility against its own equations.

use std::f64::consts::{FRAC_PI_3, PI};

use nalgebra::Vector3;
use topo_core::Model;
use topo_rod::friction::{Friction, friction_form};
use topo_rod::{ContactParameters, FrictionParameters, RodState};
use topo_tests::curves::{closed, polyline};
use topo_tests::run::Setup;

type V = Vector3<f64>;

/// One open curve with two straight strands that cross at `angle` and at distance `gap`, joined by a wide bow.
fn two_strands(n_edges: usize, angle: f64, gap: f64) -> RodState {
    let half = 4.0;
    let (a, b) = (V::x(), V::new(angle.cos(), angle.sin(), 0.0));
    // corners: end of the first strand, far out, up, and back to the start of the second
    let corners = [
        -a * half,
        a * half,
        V::new(14.0, 0.0, 0.0),
        V::new(14.0, -14.0, gap),
        -b * half * 3.0 + V::z() * gap,
        b * half + V::z() * gap,
    ];
    // points at equal arclength on the path: corners are cut by less than an edge
    let legs: Vec<(V, f64)> = corners
        .windows(2)
        .map(|c| (c[0], (c[1] - c[0]).norm()))
        .collect();
    let length: f64 = legs.iter().map(|l| l.1).sum();
    let point = |k: usize| {
        let mut s = length * k as f64 / n_edges as f64;
        let mut leg = 0;
        while leg + 1 < legs.len() && s > legs[leg].1 {
            s -= legs[leg].1;
            leg += 1;
        }
        corners[leg] + (corners[leg + 1] - corners[leg]) * (s / legs[leg].1)
    };
    let curve = polyline((0..=n_edges).map(point).collect(), false);
    RodState::new(&curve, length, 0.0).unwrap()
}

/// Two strands that slide past each other: the force between them is that of the integral
///
/// ```math
/// \frac{F}{A} = \eta_f \iint_{r < \ell} \frac{V}{r^3}\, ds\, ds'
///   = \eta_f V\, \frac{2\pi}{\sin\varphi} \left( \frac1d - \frac1\ell \right)
/// ```
///
/// for two lines at the angle φ and the distance d, and it opposes the motion.
///
/// # References
/// [patil2020discharging].
#[test]
fn val_friction_of_two_sliding_rods_matches_the_integral() {
    let (ratio, speed) = (0.1, 0.7);
    // the last one touches wider than it rubs
    for (angle, gap, range) in [
        (FRAC_PI_3, 1.0, 2.0),
        (PI / 2.0, 1.6, 2.0),
        (FRAC_PI_3, 1.0, 1.5),
    ] {
        let state = two_strands(6000, angle, gap);
        let mut setup = Setup::bare(1e-3);
        setup.parameters.friction = Some(FrictionParameters {
            ratio,
            ..Default::default()
        });
        setup.tube.friction_range = range;
        setup.parameters.contact = (range < 2.0).then(ContactParameters::default);
        let mut model = setup.model(&state);
        model.set_cyclic(false);
        model.energies(&state).unwrap();
        let friction = Friction { ratio, range };
        let mut couplings = Vec::new();
        friction.couplings(model.pairs().active(), &mut couplings);
        // the second strand moves along itself, the first and the bow rest
        let n = state.n_vertices();
        let way = V::new(angle.cos(), angle.sin(), 0.0);
        let moves = |i: usize| {
            let x = state.vertices()[i];
            (x.z - gap).abs() < 1e-9 && x.xy().norm() < 4.0
        };
        let velocity = |i: usize| if moves(i) { way * speed } else { V::zeros() };
        let mut force = V::zeros();
        for &(i, j, c) in &couplings {
            let (i, j) = (i as usize, j as usize);
            // strands only: the corners of the bow are far from where the strands cross
            if moves(i) != moves(j)
                && state.vertices()[i].norm().min(state.vertices()[j].norm()) < 3.0
            {
                let on_i = (velocity(i) - velocity(j)) * -c;
                force += if moves(i) { on_i } else { -on_i };
            }
        }
        let integral = ratio * speed * (2.0 * PI / angle.sin()) * (1.0 / gap - 1.0 / range);
        let error = (force.norm() / integral - 1.0).abs();
        println!(
            "friction at {angle:.3}, {gap}: {:.6} against {integral:.6}, off by {error:.2e}",
            force.norm()
        );
        assert!(error < 1e-3, "off by {error:.2e}");
        assert!(
            force.dot(&way) < -0.999 * force.norm(),
            "friction does not oppose the motion"
        );
        let mut flat = vec![0.0; 3 * n];
        for i in 0..n {
            for k in 0..3 {
                flat[k * n + i] = velocity(i)[k];
            }
        }
        let power = friction_form(&couplings, &flat, &flat, n);
        assert!(power >= 0.999 * integral * speed, "power {power}");
    }
}

/// Two strands that cross at a right angle at the distance d, the inflections of a wide figure of eight:
///
/// ```math
/// e = \iint V(r)\, ds\, ds' = 2\pi \int_d^{d_c} V(r)\, r\, dr
///   = \pi k_c d_c^4 \left[ \ln r + \frac{2 d_c}{r} - \frac{d_c^2}{2 r^2} \right]_d^{d_c}, \qquad k_c = 20
/// ```
#[test]
fn val_contact_of_two_crossing_rods_matches_the_integral() {
    for (gap, diameter) in [(1.6, 2.0), (1.9, 2.0), (1.3, 1.6)] {
        let curve = closed(8000, |u| {
            V::new(
                200.0 * u.sin(),
                200.0 * u.sin() * u.cos(),
                0.5 * gap * u.cos(),
            )
        });
        let curve = curve.resampled(8000).unwrap();
        let state = RodState::new(&curve, curve.length(), 0.0).unwrap();
        let mut setup = Setup::bare(1e-3);
        setup.parameters.contact = Some(ContactParameters::default());
        setup.tube.contact_diameter = diameter;
        let mut model = setup.model(&state);
        let energies = model.energies(&state).unwrap();
        let [_, _, found] = energies[..] else {
            panic!("bend, stretch and contact: {energies:?}");
        };
        let primitive = |r: f64| r.ln() + 2.0 * diameter / r - 0.5 * (diameter / r).powi(2);
        let integral = PI * 20.0 * diameter.powi(4) * (primitive(diameter) - primitive(gap));
        let error = (found / integral - 1.0).abs();
        println!("contact at {gap} of {diameter}: {found:.6} of {integral:.6}, off by {error:.1e}");
        assert!(error < 5e-3, "off by {error:.1e}");
    }
}

/// The velocity that the model gives solves [η K + η_f C] v = f, assembled here from the definitions.
#[test]
fn law_velocity_balances_force_and_resistance() {
    let ratio = 3.0;
    let state = {
        // a strained rod, so that something moves
        let free = two_strands(400, FRAC_PI_3, 1.2);
        RodState::new(&free.centreline().unwrap(), 0.9 * free.length(), 0.0).unwrap()
    };
    let mut setup = Setup::bare(1e-3);
    setup.parameters.friction = Some(FrictionParameters {
        ratio,
        ..Default::default()
    });
    let mut model = setup.model(&state);
    model.set_cyclic(false);
    model.start(&state).unwrap();
    let mut v = vec![0.0; model.n_dof()];
    model.rate(&state, &mut v).unwrap();
    let force = model.force(&state).unwrap().vertex.clone();
    let (n, l0) = (state.n_vertices(), state.rest_length());
    let velocity = |i: usize| V::new(v[i], v[n + i], v[2 * n + i]);
    let mut resistance = vec![V::zeros(); n];
    for j in 0..n - 1 {
        let d = (velocity(j + 1) - velocity(j)) / l0;
        resistance[j] -= d;
        resistance[j + 1] += d;
    }
    let (mut rubbing, mut rubbed) = (0, 0.0f64);
    let weight = |i: usize| if i == 0 || i + 1 == n { 0.5 * l0 } else { l0 };
    for i in 0..n {
        for j in i + 1..n {
            let r = (state.vertices()[i] - state.vertices()[j]).norm();
            // smooth step from the range to π/2 times it
            let u = ((j - i) as f64 * l0 - 2.0) / (PI - 2.0);
            let window = u.clamp(0.0, 1.0).powi(2) * (3.0 - 2.0 * u.clamp(0.0, 1.0));
            if r < 2.0 && window > 0.0 {
                let c = ratio * window * weight(i) * weight(j) / r.powi(3);
                let drag = (velocity(i) - velocity(j)) * c;
                resistance[i] += drag;
                resistance[j] -= drag;
                rubbing += 1;
                rubbed = rubbed.max(drag.norm());
            }
        }
    }
    let scale = force.iter().map(|f| f.norm()).fold(0.0, f64::max);
    let worst = (0..n)
        .map(|i| (resistance[i] - force[i]).norm())
        .fold(0.0, f64::max);
    println!("{rubbing} pairs, largest drag {rubbed:.2e} of {scale:.2e}, imbalance {worst:.2e}");
    assert!(rubbing > 50 && rubbed > 1e-4 * scale, "no friction at work");
    assert!(worst < 1e-9 * scale, "imbalance {worst:.2e} of {scale:.2e}");
    let mean: V = (0..n).map(velocity).sum();
    assert!(mean.norm() < 1e-9 * n as f64, "the rod drifts as a whole");
}
