//! Contact energy: strands repel below the contact diameter.

use super::{At, EnergyTerm, Force, Stiffness};

/// Penalty between vertices of different strands, weighted by their share of arclength and by the window W that leaves
/// neighbours along the rod out.
///
/// ```math
/// e = Σ_{i<j} w_i w_j W(|s_i − s_j|) V(r_ij),   V(r) = (k_c/2) (d_c − r)₊² (d_c/r)⁴
/// ```
///
/// The factor (d_c/r)⁴ makes a deep overlap expensive without making the touch stiff.
#[derive(Debug, Clone, Copy)]
pub struct ContactEnergy {
    /// k_c.
    pub stiffness: f64,
    /// d_c.
    pub diameter: f64,
}

impl ContactEnergy {
    /// V and −dV/dr.
    #[inline]
    fn potential(&self, r: f64) -> (f64, f64) {
        let gap = self.diameter - r;
        if gap <= 0.0 {
            return (0.0, 0.0);
        }
        let q2 = (self.diameter / r).powi(2);
        let q4 = q2 * q2;
        let v = 0.5 * self.stiffness * gap * gap * q4;
        (v, self.stiffness * gap * q4 + 4.0 * v / r)
    }

    /// d²V/dr², positive wherever V is.
    #[inline]
    fn curvature(&self, r: f64) -> f64 {
        let gap = self.diameter - r;
        if gap <= 0.0 {
            return 0.0;
        }
        let q2 = (self.diameter / r).powi(2);
        let k = self.stiffness * q2 * q2;
        k * (1.0 + 8.0 * gap / r + 10.0 * gap * gap / (r * r))
    }
}

impl EnergyTerm for ContactEnergy {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn energy(&self, at: At<'_>) -> f64 {
        at.pairs
            .active()
            .iter()
            .map(|p| p.weight * self.potential(p.distance).0)
            .sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        let mut sum = 0.0;
        for p in at.pairs.active() {
            let (v, push) = self.potential(p.distance);
            sum += p.weight * v;
            let f = p.normal * (p.weight * push);
            force.vertex[p.i as usize] += f;
            force.vertex[p.j as usize] -= f;
        }
        sum
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        for (k, p) in at.pairs.active().iter().enumerate() {
            let block = p.normal * p.normal.transpose() * (p.weight * self.curvature(p.distance));
            stiffness.diagonal[p.i as usize] += block;
            stiffness.diagonal[p.j as usize] += block;
            stiffness.contact[k] -= block;
        }
    }
}
