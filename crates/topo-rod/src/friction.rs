//! Viscous contact friction between strands.

use crate::contact::ActivePair;

/// Friction between strands closer than a range: a dissipative matrix C on the velocities, the same for the three components.
///
/// ```math
/// f_i = -\frac{\eta_f}{\eta} \sum_{j:\ r_{ij} < \text{range}} w_i w_j\, W(|s_i - s_j|)\, \frac{v_i - v_j}{r_{ij}^3}
/// ```
///
/// This is the integral of the published law, with the sign that dissipates energy; the printed sign would add energy.
///
/// # Validation
/// `val_friction_of_two_sliding_rods_matches_the_integral`, `law_friction_never_adds_energy`.
///
/// # References
/// [patil2020discharging], [patil2020topological].
///
/// [patil2020discharging]: https://doi.org/10.1103/PhysRevResearch.2.043196
/// [patil2020topological]: https://doi.org/10.1126/science.aaz0135
#[derive(Debug, Clone, Copy)]
pub struct Friction {
    /// η_f/η: no unit.
    pub ratio: f64,
    /// Distance below which friction acts, in h.
    pub range: f64,
}

impl Friction {
    /// Coefficient −C_ij of a pair, in 1/h.
    #[inline]
    pub fn coefficient(&self, pair: &ActivePair) -> f64 {
        if pair.distance < self.range {
            self.ratio * pair.weight / pair.distance.powi(3)
        } else {
            0.0
        }
    }

    /// The pairs on which friction acts, with their coefficients.
    pub fn couplings(&self, active: &[ActivePair], out: &mut Vec<(u32, u32, f64)>) {
        out.clear();
        out.extend(
            active
                .iter()
                .map(|p| (p.i, p.j, self.coefficient(p)))
                .filter(|p| p.2 > 0.0),
        );
    }
}

/// u·C v of two component-major displacements or velocities of `n` vertices; v·C v is the power that friction dissipates.
pub fn friction_form(couplings: &[(u32, u32, f64)], u: &[f64], v: &[f64], n: usize) -> f64 {
    couplings
        .iter()
        .map(|&(i, j, c)| {
            let (i, j) = (i as usize, j as usize);
            let apart = |w: &[f64], k: usize| w[k * n + i] - w[k * n + j];
            c * (0..3).map(|k| apart(u, k) * apart(v, k)).sum::<f64>()
        })
        .sum()
}
