//! Bend and twist of a rod that is curved or twisted at rest.

use nalgebra::Vector3;

use super::{At, Bend, EnergyTerm, Force, Stiffness, Twist};
use crate::Chain;

type V = Vector3<f64>;

/// Bending energy about a natural curvature, by the curvature in the directors of the material.
///
/// ```math
/// e = \sum_i \frac{|\omega_i - l_0 \kappa_i|^2}{8 l_0}, \qquad
/// \omega_i = \frac12 \sum_{j = i - 1}^{i} \left( \kappa b_i \cdot d_1^j,\ \kappa b_i \cdot d_2^j \right), \quad
/// d_2^j = t_j \times d_1^j
/// ```
///
/// Directors are carried along by the motion of their edge and turn with it, and kb_i is across both tangents: so the force is that
/// of kb alone, and an edge has the torque (w_2 d_1 − w_1 d_2) · kb/2 with w = (ω − l_0 κ)/(4 l_0). Of a rod that is straight at
/// rest it is [`Bend`] up to the share of kb that directors lose by the twist of a vertex, tan²(m/2).
///
/// # Validation
/// `bend_about_a_natural_curvature_has_its_gradient`, `val_half_a_turn_opened_straight`
///
/// # References
/// [bergou2008]
///
/// [bergou2008]: https://doi.org/10.1145/1360612.1360662
#[derive(Debug, Clone, Copy)]
pub struct CurvedBend;

/// A vertex as its natural curvature sees it.
struct Bent {
    /// d_1 and d_2 of the edges before and after it.
    edges: [[V; 2]; 2],
    /// Their means over the two edges.
    directors: [V; 2],
    /// ω − l_0 κ.
    excess: [f64; 2],
}

impl Bent {
    #[inline]
    fn at(at: At<'_>, c: usize, chain: &Chain, i: usize) -> Self {
        let g = at.geometry;
        let natural = at.state.rest().map_or([0.0; 2], |rest| rest.curvature[i]);
        let edges = g.directors_at(c, chain, i);
        let mean = |k: usize| (edges[0][k] + edges[1][k]) * 0.5;
        let directors = [mean(0), mean(1)];
        let excess = |k: usize| g.binormal[i].dot(&directors[k]) - chain.rest_length() * natural[k];
        Self {
            edges,
            directors,
            excess: [excess(0), excess(1)],
        }
    }

    fn energy(&self, chain: &Chain) -> f64 {
        let [a, b] = self.excess;
        (a * a + b * b) / (8.0 * chain.rest_length())
    }

    /// (ω − l_0 κ)/(4 l_0).
    fn moments(&self, chain: &Chain) -> [f64; 2] {
        self.excess.map(|x| x / (4.0 * chain.rest_length()))
    }

    /// Torque on the edge before the vertex or on that after it, where the curvature binormal is `kb`.
    fn torque(&self, chain: &Chain, kb: &V, side: usize) -> f64 {
        let (w, [one, two]) = (self.moments(chain), &self.edges[side]);
        0.5 * (w[1] * kb.dot(one) - w[0] * kb.dot(two))
    }
}

impl CurvedBend {
    /// Torque on the edge behind vertex `i` of component `c` by the bend of that vertex alone, per area, in E_b h.
    pub(crate) fn torque_behind(at: At<'_>, c: usize, i: usize) -> f64 {
        let chain = &at.state.components()[c];
        Bent::at(at, c, chain, i).torque(chain, &at.geometry.binormal[i], 1)
    }
}

impl EnergyTerm for CurvedBend {
    fn name(&self) -> &'static str {
        Bend.name()
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let of = |(c, chain): (usize, &Chain)| {
            let each = chain
                .interior()
                .map(|i| Bent::at(at, c, chain, i).energy(chain));
            each.sum::<f64>()
        };
        at.state.components().iter().enumerate().map(of).sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        let g = at.geometry;
        let mut energy = 0.0;
        for (c, chain) in at.state.components().iter().enumerate() {
            for i in chain.interior() {
                let (before, after) = (chain.edge_before(i), i);
                let (bent, kb) = (Bent::at(at, c, chain, i), g.binormal[i]);
                energy += bent.energy(chain);
                let w = bent.moments(chain);
                let on_kb = bent.directors[0] * w[0] + bent.directors[1] * w[1];
                let (l0, l1) = (g.edge_length[before], g.edge_length[after]);
                let (e0, e1) = (g.tangent[before] * l0, g.tangent[after] * l1);
                let d = 1.0 / (l0 * l1 + e0.dot(&e1));
                let along = kb.dot(&on_kb) * d;
                // transposed Jacobians of kb with respect to the two edges
                let on_before =
                    e1.cross(&on_kb) * (2.0 * d) - (g.tangent[before] * l1 + e1) * along;
                let on_after = e0.cross(&on_kb) * (-2.0 * d) - (g.tangent[after] * l0 + e0) * along;
                force.vertex[before] += on_before;
                force.vertex[i] += on_after - on_before;
                force.vertex[chain.edge_end(after)] -= on_after;
                for (side, j) in [before, after].into_iter().enumerate() {
                    force.torque[j] += bent.torque(chain, &kb, side);
                }
            }
        }
        energy
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        Bend.add_stiffness(at, stiffness);
    }

    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        for (c, chain) in at.state.components().iter().enumerate() {
            for i in chain.interior() {
                density[i] += Bent::at(at, c, chain, i).energy(chain) / chain.rest_length();
            }
        }
    }
}

/// Twist energy about a natural twist, e = Σ_i α (m_i − l_0 θ'_0)²/(8 l_0).
///
/// # Validation
/// `twist_about_a_natural_twist_has_its_gradient`
#[derive(Debug, Clone, Copy)]
pub struct CurvedTwist(pub Twist);

impl EnergyTerm for CurvedTwist {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let of = |chain: &Chain| {
            let squares = chain.interior().map(|i| at.state.excess_twist(i).powi(2));
            self.0.ratio * squares.sum::<f64>() / (8.0 * chain.rest_length())
        };
        at.state.components().iter().map(of).sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        self.0.add_torques(at, force, |i| at.state.excess_twist(i));
        self.energy(at)
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        self.0.add_stiffness(at, stiffness);
    }

    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        for chain in at.state.components() {
            let l0 = chain.rest_length();
            for i in chain.interior() {
                let excess = at.state.excess_twist(i);
                density[i] += self.0.ratio * excess * excess / (8.0 * l0 * l0);
            }
        }
    }
}
