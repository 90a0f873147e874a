//! Elastic energy density along the rod.

use crate::{Geometry, RodParameters, RodState};

/// Elastic energy per area and length at each vertex (bend, twist and stretch; contact left out), in E_b.
///
/// Times A it is the density in E_b h² that the figures show. Sums with the vertices' share of arclength to the elastic energy.
pub fn energy_density(parameters: &RodParameters, state: &RodState) -> Vec<f64> {
    let g = Geometry::new(state);
    let (l0, m, n) = (state.rest_length(), state.twists(), state.n_vertices());
    let twist_ratio = parameters.twist.map_or(0.0, |_| parameters.twist_ratio);
    let stretch = |j: usize| 0.5 * parameters.stretch_ratio * (g.edge_length[j] / l0 - 1.0).powi(2);
    (0..n)
        .map(|i| {
            if !state.is_closed() && (i == 0 || i + 1 == n) {
                return stretch(if i == 0 { 0 } else { n - 2 });
            }
            let bend = (1.0 - g.cosine[i]) / (2.0 * l0 * l0 * (1.0 + g.cosine[i]));
            let twist = twist_ratio * m[i] * m[i] / (8.0 * l0 * l0);
            bend + twist + 0.5 * (stretch(state.edge_before(i)) + stretch(i))
        })
        .collect()
}

/// Mean of a density over windows of width π h (the least arc over which a tube can turn back).
pub fn smoothed_density(density: &[f64], rest_length: f64, closed: bool) -> Vec<f64> {
    let n = density.len();
    // an even number of edges about the vertex; the ends of the window carry the fraction
    let half = (std::f64::consts::FRAC_PI_2 / rest_length).min(0.5 * (n - 1) as f64);
    let (whole, rest) = (half.floor() as usize, half.fract());
    (0..n as isize)
        .map(|i| {
            let (mut sum, mut weight) = (0.0, 0.0);
            for k in -(whole as isize + 1)..=whole as isize + 1 {
                let w = if k.unsigned_abs() <= whole { 1.0 } else { rest };
                let j = i + k;
                if closed || (0..n as isize).contains(&j) {
                    sum += w * density[j.rem_euclid(n as isize) as usize];
                    weight += w;
                }
            }
            sum / weight
        })
        .collect()
}

#[cfg(test)]
mod tests;
