//! Twist energy.

use super::{At, EnergyTerm, Force, Stiffness};
use crate::{Chain, RodParameters};

/// Twist energy, with stiffness α relative to bending; m_i is the integrated twist of vertex i, in radians.
///
/// ```math
/// e = \sum_i \frac{\alpha\, m_i^2}{8 l_0}, \qquad
/// \frac{\partial m_i}{\partial e_{i-1}} = \frac{\kappa b_i}{2 |e_{i-1}|}, \quad
/// \frac{\partial m_i}{\partial e_i} = \frac{\kappa b_i}{2 |e_i|}
/// ```
///
/// Its second derivatives in x are left out of the Newton matrix: twist relaxes much faster by the rotation of the edges.
///
/// # Validation
/// `val_twist_decay_rate_of_a_straight_rod`, `val_michell_zajac_ring_buckles_at_the_critical_twist`.
#[derive(Debug, Clone, Copy)]
pub struct Twist {
    /// Ratio α of twist to bending stiffness: no unit.
    pub ratio: f64,
}

impl Twist {
    /// That of the parameters; none without twist.
    pub(crate) fn of(rod: &RodParameters) -> Option<Self> {
        rod.twist.map(|_| Self {
            ratio: rod.twist_ratio,
        })
    }

    /// Torque τ_i = ∂e/∂m_i carried by a vertex with integrated twist `m` (in radians), per area, in E_b h; `rest_length` is in
    /// h.
    #[inline]
    pub fn torque(&self, m: f64, rest_length: f64) -> f64 {
        self.ratio * m / (4.0 * rest_length)
    }

    /// Adds the forces and torques of vertices whose twist, in radians, is by `excess` more than the natural one.
    #[inline]
    pub(super) fn add_torques(&self, at: At<'_>, force: &mut Force, excess: impl Fn(usize) -> f64) {
        let g = at.geometry;
        for chain in at.state.components() {
            for i in chain.interior() {
                let (before, after) = (chain.edge_before(i), i);
                let torque = self.torque(excess(i), chain.rest_length());
                let pull = g.binormal[i] * (0.5 * torque);
                let on_before = pull / g.edge_length[before];
                let on_after = pull / g.edge_length[after];
                force.vertex[before] += on_before;
                force.vertex[i] += on_after - on_before;
                force.vertex[chain.edge_end(after)] -= on_after;
                force.torque[before] += torque;
                force.torque[after] -= torque;
            }
        }
    }
}

impl EnergyTerm for Twist {
    fn name(&self) -> &'static str {
        "twist"
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let twists = at.state.twists();
        let of = |chain: &Chain| {
            let sum: f64 = twists[chain.vertices()].iter().map(|m| m * m).sum();
            self.ratio * sum / (8.0 * chain.rest_length())
        };
        at.state.components().iter().map(of).sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        let m = at.state.twists();
        self.add_torques(at, force, |i| m[i]);
        self.energy(at)
    }

    fn add_stiffness(&self, _at: At<'_>, _stiffness: &mut Stiffness) {}

    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        let m = at.state.twists();
        for chain in at.state.components() {
            let l0 = chain.rest_length();
            for i in chain.interior() {
                density[i] += self.ratio * m[i] * m[i] / (8.0 * l0 * l0);
            }
        }
    }
}
