//! Viscous contact friction between strands.

use crate::contact::ActivePair;

/// Friction between strands closer than a range: a dissipative matrix C on the velocities, the same for the three components.
///
/// ```math
/// f_i = −(η_f/η) Σ_j w_i w_j W (v_i − v_j)/r_ij³   for r_ij < range
/// ```
///
/// The integral of the published law with the sign that takes energy out (its printed sign would pump energy in).
///
/// # Validation
/// `val_friction_of_two_sliding_rods_matches_the_integral`, `law_friction_never_adds_energy`.
///
/// # References
/// `patil2020discharging`, `patil2020topological`.
#[derive(Debug, Clone, Copy)]
pub struct Friction {
    /// η_f/η: no unit.
    pub ratio: f64,
    /// Distance below which strands rub, in h.
    pub range: f64,
}

impl Friction {
    /// Coefficient of a pair: −C_ij.
    #[inline]
    pub fn coefficient(&self, pair: &ActivePair) -> f64 {
        if pair.distance < self.range {
            self.ratio * pair.weight / pair.distance.powi(3)
        } else {
            0.0
        }
    }

    /// The pairs that rub, with their coefficients.
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

/// u·C v of two component-major displacements or velocities of `n` vertices; v·C v is the power that friction takes out.
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
