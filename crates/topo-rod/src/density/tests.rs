//! The density that decides where a rod is cut: closed forms, and its sum against the energy of the terms.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use topo_core::Polyline;

use super::*;
use crate::contact::ContactPairs;
use crate::energy::{Bend, Stretch, Twist, terms_of};
use crate::{Geometry, RodParameters, RodState};

pub(crate) const N: usize = 400;

/// A rod of length `rest` on a ring of N edges and radius 3, or on a helix of pitch 2π q about the same axis.
pub(crate) fn coil(rest: f64, pitch: Option<f64>, twist: f64) -> RodState {
    let turn = |k: usize| TAU * k as f64 / N as f64;
    let point = |u: f64| Vector3::new(3.0 * u.cos(), 3.0 * u.sin(), pitch.unwrap_or(0.0) * u);
    let vertices = (0..N + usize::from(pitch.is_some())).map(|k| point(turn(k)));
    let curve = Polyline::new(vertices.collect(), pitch.is_none()).unwrap();
    RodState::new(&curve, rest * curve.length(), twist).unwrap()
}

fn density_of(rod: &RodParameters, state: &RodState) -> Vec<f64> {
    let at = At {
        state,
        geometry: &Geometry::new(state),
        pairs: &ContactPairs::new(0.0, 0.1),
    };
    energy_density(&terms_of(rod, &rod.tube(50.0).unwrap(), state), at)
}

/// (κ² + α θ'²)/8 + (γ/2)(|x'| − 1)² at every vertex of a ring and of a helix: κ = R/(R² + q²), and both strained by a quarter.
#[test]
fn val_density_of_a_bent_twisted_stretched_coil() {
    let rod = RodParameters::default();
    let (alpha, gamma, twist) = (1.0 / 1.3, 5.0, 0.7);
    for pitch in [None, Some(2.0)] {
        let q: f64 = pitch.unwrap_or(0.0);
        let curvature = 3.0 / (9.0 + q * q);
        for rest in [1.0, 0.8] {
            let state = coil(rest, pitch, twist);
            // the curvature counts per natural length
            let bend = (curvature / rest).powi(2) / 8.0;
            let stretch = 0.5 * gamma * (1.0 / rest - 1.0).powi(2);
            let exact = bend + alpha * twist * twist / 8.0 + stretch;
            let density = density_of(&rod, &state);
            for i in state.interior() {
                let error = (density[i] / exact - 1.0).abs();
                assert!(error < 3e-4, "vertex {i}: off by {error:.1e}");
            }
            if pitch.is_some() {
                // free ends bear no moment
                assert!((density[0] - stretch).abs() < 3e-5);
                assert!((density[N] - stretch).abs() < 3e-5);
            }
            let untwisted = RodParameters {
                twist: None,
                ..Default::default()
            };
            let density = density_of(&untwisted, &state);
            assert!((density[N / 2] / (bend + stretch) - 1.0).abs() < 3e-4);
        }
    }
}

/// Its sum over the arclength is the elastic energy, whatever the shape.
#[test]
fn law_density_sums_to_the_elastic_energy() {
    let rod = RodParameters::default();
    for closed in [true, false] {
        let vertices = (0..60).map(|k| {
            let u = TAU * f64::from(k) / 60.0;
            let r = 2.0 + (3.0 * u).cos();
            Vector3::new(
                r * (2.0 * u).cos(),
                r * (2.0 * u).sin(),
                1.1 * (3.0 * u).sin(),
            )
        });
        let curve = Polyline::new(vertices.collect(), true).unwrap();
        let state = RodState::new(&curve, 30.0, 0.9).unwrap();
        let state = if closed {
            state
        } else {
            state.cut_at(11).unwrap()
        };
        let geometry = Geometry::new(&state);
        let pairs = ContactPairs::new(0.0, 0.1);
        let at = At {
            state: &state,
            geometry: &geometry,
            pairs: &pairs,
        };
        let (twist, stretch) = (Twist { ratio: 1.0 / 1.3 }, Stretch { ratio: 5.0 });
        let parts = [Bend.energy(at), twist.energy(at), stretch.energy(at)];
        let l0 = state.rest_length();
        let density = density_of(&rod, &state);
        let last = density.len() - 1;
        let share = |i: usize| {
            if !closed && (i == 0 || i == last) {
                0.5 * l0
            } else {
                l0
            }
        };
        let sum: f64 = (0..=last).map(|i| density[i] * share(i)).sum();
        let energy: f64 = parts.iter().sum();
        assert!(parts.iter().all(|part| *part > 0.05 * energy), "{parts:?}");
        assert!((sum / energy - 1.0).abs() < 1e-12, "{sum} of {energy}");
    }
}

/// Means over π h of arc, π being half the turn of a tube bent as tightly as it can be: those of a spike, a ramp and a constant.
#[test]
fn val_density_is_smoothed_over_half_a_turn_of_the_tube() {
    let (n, l0) = (2000, 0.01);
    // a unit of energy at the seam of a closed rod, in the middle of an open one
    for (closed, at) in [(true, 5), (false, 1000)] {
        let mut spike = vec![0.0; n];
        spike[at] = 1.0 / l0;
        let mean = smoothed_density(&spike, l0, closed);
        assert!((mean[at] * PI - 1.0).abs() < 1.1 * l0 / PI);
        let width = mean.iter().filter(|m| **m > 1e-9).count() as f64 * l0;
        assert!((width - PI).abs() < 0.04, "{width}");
        let sum: f64 = mean.iter().map(|m| m * l0).sum();
        assert!((sum - 1.0).abs() < 1e-12);
        let flat = smoothed_density(&vec![2.5; n], l0, closed);
        assert!(flat.iter().all(|m| (m - 2.5).abs() < 1e-12));
    }
    let ramp: Vec<f64> = (0..n).map(|i| i as f64).collect();
    let mean = smoothed_density(&ramp, l0, false);
    assert!((mean[1000] - 1000.0).abs() < 1e-9);
    // at a free end only the half that is there counts: a quarter of π h further in
    assert!((mean[0] * l0 - 0.25 * PI).abs() < 0.01);
    // a rod shorter than the window: the mean of all of it
    let short = smoothed_density(&[1.0, 2.0, 6.0], 0.1, true);
    assert!(short.iter().all(|m| (m - 3.0).abs() < 1e-12));
}
