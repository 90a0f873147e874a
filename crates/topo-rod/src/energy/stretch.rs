//! Stretch energy.

use nalgebra::Matrix3;

use super::{At, EnergyTerm, Force, Stiffness};
use crate::{Chain, RodParameters};

/// Stretch energy of edges e_j of natural length l_0, with γ = E/E_b.
///
/// ```math
/// e = \frac{\gamma}{2} \sum_j l_0 \left( \frac{|e_j|}{l_0} - 1 \right)^2
/// ```
///
/// # Validation
/// `val_stretch_decay_rate_of_a_straight_rod`.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    /// Ratio γ of stretching to bending modulus: no unit.
    pub ratio: f64,
}

impl Stretch {
    /// That of the parameters.
    pub(crate) fn of(rod: &RodParameters) -> Self {
        Self {
            ratio: rod.stretch_ratio,
        }
    }
}

impl EnergyTerm for Stretch {
    fn name(&self) -> &'static str {
        "stretch"
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let of = |chain: &Chain| {
            let l0 = chain.rest_length();
            let lengths = at.geometry.edge_length[chain.edges()].iter();
            let sum: f64 = lengths.map(|l| (l / l0 - 1.0).powi(2)).sum();
            0.5 * self.ratio * l0 * sum
        };
        at.state.components().iter().map(of).sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        let g = at.geometry;
        let mut energy = 0.0;
        for chain in at.state.components() {
            let l0 = chain.rest_length();
            let mut sum = 0.0;
            for j in chain.edges() {
                let strain = g.edge_length[j] / l0 - 1.0;
                sum += strain * strain;
                let tension = g.tangent[j] * (self.ratio * strain);
                force.vertex[j] += tension;
                force.vertex[chain.edge_end(j)] -= tension;
            }
            energy += 0.5 * self.ratio * l0 * sum;
        }
        energy
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        let g = at.geometry;
        for chain in at.state.components() {
            let l0 = chain.rest_length();
            for j in chain.edges() {
                let t = g.tangent[j];
                // a rod under tension also resists turning; under compression that part is negative and left out
                let across =
                    (self.ratio * (g.edge_length[j] / l0 - 1.0) / g.edge_length[j]).max(0.0);
                let along = self.ratio / l0 - across;
                let block = t * t.transpose() * along + Matrix3::from_diagonal_element(across);
                stiffness.diagonal[j] += block;
                stiffness.diagonal[chain.edge_end(j)] += block;
                stiffness.next[j] -= block;
            }
        }
    }

    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        for chain in at.state.components() {
            let (l0, last) = (chain.rest_length(), chain.last());
            let of = |j: usize| 0.5 * self.ratio * (at.geometry.edge_length[j] / l0 - 1.0).powi(2);
            for i in chain.vertices() {
                density[i] += if chain.interior().contains(&i) {
                    0.5 * (of(chain.edge_before(i)) + of(i))
                } else {
                    of(if i == last { last - 1 } else { i })
                };
            }
        }
    }
}
