//! Elastic energy density along the rod.

use crate::energy::{At, EnergyKind, EnergyTerm, RodParts};

/// Elastic energy per area and length at each vertex, in E_b: the sum of the elastic terms, in the order of tables.
///
/// ```math
/// w = \frac{\kappa^2 + \alpha\, \theta'^2}{8} + \frac{\gamma}{2} (|x'| - 1)^2, \qquad e = \sum_i w_i l_i
/// ```
///
/// Multiplied by A it is the density in E_b h² that the figures show. l_i is the arclength of vertex i.
pub(crate) fn energy_density(terms: &[Box<dyn EnergyTerm>], at: At<'_>) -> Vec<f64> {
    let mut density = vec![0.0; at.state.n_vertices()];
    for part in RodParts::of(terms).iter() {
        let mut own = terms.iter().filter(|term| term.name() == part.name);
        if let (EnergyKind::Elastic, Some(term)) = (part.kind, own.next()) {
            term.add_density(at, &mut density);
        }
    }
    density
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
pub(crate) mod tests;
