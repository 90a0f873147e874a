//! The curves of a battery: their ropelength, and equal edges along them.

use topo_core::{Polyline, thickness_of_all};

use crate::{RodError, RodParameters};

/// Edges at which the ropelength is measured: contact diameters must not depend on the edges of the rod.
const FINE_EDGES: usize = 800;
/// Ropelength from which on a curve counts as touching itself.
const LONGEST_ROPE: f64 = 1e6;
/// Equal edges: within this relative difference they are left as they are.
const EDGE_SPREAD: f64 = 1e-9;

/// Length of all curves together.
pub(super) fn total_length(curves: &[Polyline]) -> f64 {
    curves.iter().map(Polyline::length).sum()
}

/// Length over thickness of all curves together.
///
/// # Errors
/// No curve, or curves that touch themselves or each other.
pub(super) fn ropelength(curves: &[Polyline]) -> Result<f64, RodError> {
    let counts = shared(curves, FINE_EDGES, RodParameters::LEAST_EDGES)?;
    let resampled = |(curve, n): (&Polyline, usize)| Ok(curve.resampled(n)?);
    let both = curves.iter().zip(counts);
    let fine: Vec<Polyline> = both.map(resampled).collect::<Result<_, RodError>>()?;
    let (length, thickness) = (total_length(&fine), thickness_of_all(&fine).tau);
    let ropelength = length / thickness;
    if (0.0..LONGEST_ROPE).contains(&ropelength) {
        Ok(ropelength)
    } else {
        Err(RodError::TouchesItself { thickness, length })
    }
}

/// The curves with equal edges, `n_edges` in all.
///
/// # Errors
/// Fewer edges than components need.
pub(super) fn evened(curves: &[Polyline], n_edges: usize) -> Result<Vec<Polyline>, RodError> {
    let counts = shared(curves, n_edges, RodParameters::LEAST_EDGES)?;
    let even = |(curve, n): (&Polyline, usize)| {
        let edges = curve.edge_lengths();
        let mean = curve.length() / edges.len() as f64;
        let is_even = |edge: &f64| (edge / mean - 1.0).abs() <= EDGE_SPREAD;
        if edges.len() == n && edges.iter().all(is_even) {
            Ok(curve.clone())
        } else {
            Ok(curve.resampled(n)?)
        }
    };
    curves.iter().zip(counts).map(even).collect()
}

/// Edges of each curve, `n_edges` in all, in proportion to their lengths and at least `least` each.
fn shared(curves: &[Polyline], n_edges: usize, least: usize) -> Result<Vec<usize>, RodError> {
    if curves.is_empty() {
        return Err(RodError::NoComponent);
    }
    let needed = least * curves.len();
    if n_edges < needed {
        return Err(RodError::TooFewEdges {
            n_edges,
            least: needed,
        });
    }
    let length = total_length(curves);
    let wanted = |curve: &Polyline| n_edges as f64 * curve.length() / length;
    let of = |curve: &Polyline| (wanted(curve).floor() as usize).max(least);
    let mut counts: Vec<usize> = curves.iter().map(of).collect();
    // the rest goes where it is missed most, and what is too much is taken where it is missed least
    let missed = |counts: &[usize], k: usize| wanted(&curves[k]) / counts[k] as f64;
    let order = |counts: &[usize], a: usize, b: usize| {
        missed(counts, a)
            .total_cmp(&missed(counts, b))
            .then(b.cmp(&a))
    };
    let (all, mut sum) = (0..curves.len(), counts.iter().sum::<usize>());
    while sum != n_edges {
        let may = |k: &usize| sum < n_edges || counts[*k] > least;
        let candidates = all.clone().filter(may);
        let found = if sum < n_edges {
            candidates.max_by(|&a, &b| order(&counts, a, b))
        } else {
            candidates.min_by(|&a, &b| order(&counts, a, b))
        };
        let Some(k) = found else { break };
        if sum < n_edges {
            counts[k] += 1;
            sum += 1;
        } else {
            counts[k] -= 1;
            sum -= 1;
        }
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn ring(radius: f64) -> Polyline {
        let at = |k: usize| {
            let u = std::f64::consts::TAU * k as f64 / 50.0;
            Vector3::new(radius * u.cos(), radius * u.sin(), 0.0)
        };
        Polyline::new((0..50).map(at).collect(), true).unwrap()
    }

    #[test]
    fn edges_are_shared_by_length_and_add_up() {
        let of = |radii: &[f64], n: usize| {
            let curves: Vec<Polyline> = radii.iter().map(|r| ring(*r)).collect();
            shared(&curves, n, 8).map_err(|e| e.to_string())
        };
        assert_eq!(of(&[3.0], 123).unwrap(), [123]);
        assert_eq!(of(&[1.0, 1.0], 200).unwrap(), [100, 100]);
        assert_eq!(of(&[1.0, 1.0], 201).unwrap(), [101, 100]);
        assert_eq!(of(&[1.0, 2.0, 1.0], 200).unwrap(), [50, 100, 50]);
        assert_eq!(of(&[0.01, 1.0], 40).unwrap(), [8, 32]);
        assert_eq!(of(&[0.01, 1.0, 0.01], 24).unwrap(), [8, 8, 8]);
        assert!(of(&[1.0, 1.0], 15).is_err() && of(&[], 100).is_err());
    }
}
