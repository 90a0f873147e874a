//! Bending energy of an isotropic rod that is straight at rest.

use nalgebra::{Matrix3, Vector3};

use super::{At, EnergyTerm, Force, Stiffness};
use crate::Chain;

/// Bending energy, with the curvature per natural length l_0 of an edge. t_i is the unit tangent of edge i.
///
/// ```math
/// e = \sum_i \frac{|\kappa b_i|^2}{8 l_0} = \sum_i \frac{1 - c_i}{2 l_0 (1 + c_i)},
/// \qquad \kappa b_i = \frac{2\, t_{i-1} \times t_i}{1 + c_i}, \quad c_i = t_{i-1} \cdot t_i
/// ```
///
/// # Validation
/// `val_circle_bending_energy_converges_at_second_order`, `val_bending_decay_rate_of_a_straight_rod`.
#[derive(Debug, Clone, Copy)]
pub struct Bend;

impl EnergyTerm for Bend {
    fn name(&self) -> &'static str {
        "bend"
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let cosine = &at.geometry.cosine;
        let of = |chain: &Chain| {
            let turns = chain
                .interior()
                .map(|i| (1.0 - cosine[i]) / (1.0 + cosine[i]));
            turns.sum::<f64>() / (2.0 * chain.rest_length())
        };
        at.state.components().iter().map(of).sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        let g = at.geometry;
        let mut energy = 0.0;
        for chain in at.state.components() {
            let inverse = 1.0 / chain.rest_length();
            let mut sum = 0.0;
            for i in chain.interior() {
                let (before, after) = (chain.edge_before(i), i);
                let (c, t0, t1) = (g.cosine[i], g.tangent[before], g.tangent[after]);
                let q = 1.0 / (1.0 + c);
                sum += (1.0 - c) * q;
                let pull = inverse * q * q;
                // −∂e/∂e of the two edges, along the part of the other tangent across each
                let on_before = (t1 - t0 * c) * (pull / g.edge_length[before]);
                let on_after = (t0 - t1 * c) * (pull / g.edge_length[after]);
                force.vertex[before] -= on_before;
                force.vertex[i] += on_before - on_after;
                force.vertex[chain.edge_end(after)] += on_after;
            }
            energy += 0.5 * inverse * sum;
        }
        energy
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        let g = at.geometry;
        for chain in at.state.components() {
            let scale = 1.0 / (4.0 * chain.rest_length());
            for i in chain.interior() {
                let (before, after) = (chain.edge_before(i), i);
                let (l0, l1) = (g.edge_length[before], g.edge_length[after]);
                let (e0, e1) = (g.tangent[before] * l0, g.tangent[after] * l1);
                let d = 1.0 / (l0 * l1 + e0.dot(&e1));
                let kb = g.binormal[i];
                // Jacobians of kb with respect to the two edges
                let a = cross_matrix(&e1) * (-2.0 * d)
                    - kb * (g.tangent[before] * l1 + e1).transpose() * d;
                let b = cross_matrix(&e0) * (2.0 * d)
                    - kb * (g.tangent[after] * l0 + e0).transpose() * d;
                let (aa, ab, bb) = (
                    a.transpose() * a * scale,
                    a.transpose() * b * scale,
                    b.transpose() * b * scale,
                );
                stiffness.diagonal[before] += aa;
                stiffness.diagonal[i] += aa + bb - ab - ab.transpose();
                stiffness.diagonal[chain.edge_end(after)] += bb;
                stiffness.next[before] += ab - aa;
                stiffness.next[i] += ab - bb;
                stiffness.second[before] -= ab;
            }
        }
    }

    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        let cosine = &at.geometry.cosine;
        for chain in at.state.components() {
            let l0 = chain.rest_length();
            for i in chain.interior() {
                density[i] += (1.0 - cosine[i]) / (2.0 * l0 * l0 * (1.0 + cosine[i]));
            }
        }
    }
}

/// Matrix of v ↦ a × v.
#[inline]
fn cross_matrix(a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}
