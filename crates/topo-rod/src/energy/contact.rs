//! Contact energy: strands repel below the contact diameter.

use nalgebra::Vector3;

use super::{At, EnergyKind, EnergyTerm, Force, Stiffness};
use crate::contact::ActivePair;
use crate::{RodParameters, Tube};

/// Penalty between vertices of different strands. Each pair is weighted by the arclengths of its two vertices and by the
/// window W, which leaves out neighbours along the rod. Neighbours of a collapsing rod repel by the same law: see `contact::hard_core`.
///
/// ```math
/// e = \sum_{i<j} w_i w_j\, W(|s_i - s_j|)\, V(r_{ij}), \qquad
/// V(r) = \frac{k_c}{2} \max(0, d_c - r)^2 \left( \frac{d_c}{r} \right)^4
/// ```
///
/// The factor (d_c/r)⁴ makes a deep overlap expensive without making the touch stiff.
#[derive(Debug, Clone, Copy)]
pub struct ContactEnergy {
    /// Stiffness k_c, in E_b/h³.
    pub stiffness: f64,
    /// Contact diameter d_c, in h.
    pub diameter: f64,
}

impl ContactEnergy {
    /// That of the parameters; none without contact.
    pub(crate) fn of(rod: &RodParameters, tube: &Tube) -> Option<Self> {
        rod.contact.map(|contact| Self {
            stiffness: contact.stiffness,
            diameter: tube.contact_diameter,
        })
    }

    /// V and −dV/dr for the diameter `d`.
    #[inline]
    fn potential(&self, r: f64, d: f64) -> (f64, f64) {
        let gap = d - r;
        if gap <= 0.0 {
            return (0.0, 0.0);
        }
        let q2 = (d / r).powi(2);
        let q4 = q2 * q2;
        let v = 0.5 * self.stiffness * gap * gap * q4;
        (v, self.stiffness * gap * q4 + 4.0 * v / r)
    }

    /// d²V/dr², positive wherever V is.
    #[inline]
    fn curvature(&self, r: f64, d: f64) -> f64 {
        let gap = d - r;
        if gap <= 0.0 {
            return 0.0;
        }
        let q2 = (d / r).powi(2);
        let k = self.stiffness * q2 * q2;
        k * (1.0 + 8.0 * gap / r + 10.0 * gap * gap / (r * r))
    }
}

impl ContactEnergy {
    /// Adds the stiffness that pairs about to touch will have, as if they touched already.
    pub(crate) fn add_expected(&self, expected: &[ActivePair], stiffness: &mut Stiffness) {
        for p in expected {
            let block = p.normal * p.normal.transpose() * (p.weight * self.stiffness);
            stiffness.add_further(p.i, p.j, block);
        }
        stiffness.further.sort_by_key(|p| (p.0, p.1));
    }
}

impl EnergyTerm for ContactEnergy {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn kind(&self) -> EnergyKind {
        EnergyKind::Constraint
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let strands = at.pairs.active().iter();
        let core = at.pairs.core().iter();
        strands
            .map(|p| p.weight * self.potential(p.distance, self.diameter).0)
            .chain(core.map(|p| p.weight * self.potential(p.distance, p.limit).0))
            .sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        let mut sum = 0.0;
        let mut push =
            |i: u32, j: u32, weight: f64, normal: Vector3<f64>, (v, push): (f64, f64)| {
                sum += weight * v;
                let f = normal * (weight * push);
                force.vertex[i as usize] += f;
                force.vertex[j as usize] -= f;
            };
        for p in at.pairs.active() {
            push(
                p.i,
                p.j,
                p.weight,
                p.normal,
                self.potential(p.distance, self.diameter),
            );
        }
        for p in at.pairs.core() {
            push(
                p.i,
                p.j,
                p.weight,
                p.normal,
                self.potential(p.distance, p.limit),
            );
        }
        sum
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        for (k, p) in at.pairs.active().iter().enumerate() {
            let curvature = self.curvature(p.distance, self.diameter);
            let block = p.normal * p.normal.transpose() * (p.weight * curvature);
            stiffness.diagonal[p.i as usize] += block;
            stiffness.diagonal[p.j as usize] += block;
            stiffness.contact[k] -= block;
        }
        for p in at.pairs.core() {
            let curvature = self.curvature(p.distance, p.limit);
            let block = p.normal * p.normal.transpose() * (p.weight * curvature);
            stiffness.add_further(p.i, p.j, block);
        }
    }

    fn add_density(&self, _at: At<'_>, _density: &mut [f64]) {}
}
