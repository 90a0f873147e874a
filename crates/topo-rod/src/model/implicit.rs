//! What implicit and stabilised integrators need from the rod: the Newton matrix, and a bound of the spectrum.

use topo_core::{LinearlyImplicit, Model, Rejection, SpectralBound};

use super::parts::{Frozen, unsolvable};
use super::{At, RodModel};
use crate::RodState;
use crate::load::Load;

impl LinearlyImplicit for RodModel {
    fn prepare(&mut self, state: &RodState, g_dt: f64) -> Result<(), Rejection> {
        self.expected.look_out(state.stamp());
        if let Some(frozen) = self
            .frozen
            .take()
            .filter(|frozen| self.serves(frozen, g_dt))
        {
            let n_uses = frozen.n_uses + 1;
            self.frozen = Some(Frozen { n_uses, ..frozen });
            return Ok(());
        }
        self.evaluate(state)?;
        self.stiffness
            .reset(self.n_vertices, self.pairs.active().len());
        let at = At {
            state,
            geometry: &self.at.geometry,
            pairs: &self.pairs,
        };
        for term in &self.terms {
            term.add_stiffness(at, &mut self.stiffness);
        }
        if let Some(contact) = self.contact {
            let rate =
                (self.accepted.rate_stamp == Some(state.stamp())).then_some(&self.accepted.rate);
            let diameter = contact.diameter;
            self.expected
                .update(state, &self.pairs, diameter, rate.map(|v| &v[..]), g_dt);
            contact.add_expected(self.expected.pairs(), &mut self.stiffness);
        }
        if let Some(load) = &self.load {
            load.add_stiffness(g_dt, &mut self.stiffness);
            self.newton.damp(load.here.damping);
        }
        self.newton
            .prepare(
                state,
                &self.pairs,
                &self.stiffness,
                g_dt,
                &self.at.couplings,
            )
            .map_err(|e| unsolvable(e, "the Newton matrix"))?;
        if let (Some(newton), Some(twist)) = (self.newton_twist.as_mut(), self.twist) {
            newton
                .prepare(
                    state,
                    &self.at.geometry.cosine,
                    g_dt * twist.torque(1.0, state.components()[0].rest_length()),
                )
                .map_err(|e| unsolvable(e, "the twist matrix"))?;
        }
        self.frozen = Some(Frozen { g_dt, n_uses: 1 });
        Ok(())
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection> {
        let (moved, turned) = rhs.split_at_mut(3 * self.n_vertices);
        self.newton.solve(moved);
        if let Some(newton) = self.newton_twist.as_mut() {
            let (turned, behind) = turned.split_at_mut(self.n_edges);
            newton.solve(turned, behind);
        }
        Ok(())
    }
}

impl RodModel {
    /// Whether a Newton matrix is good for another step: the order holds for any matrix, so one may serve several of about its length.
    fn serves(&self, frozen: &Frozen, g_dt: f64) -> bool {
        let is_stale = |load: &Load| self.newton.is_stale(&load.accepted.damping);
        frozen.n_uses < self.reuse
            && self.expected.pairs().is_empty()
            && !self.load.as_deref().is_some_and(is_stale)
            && (0.6..=1.3).contains(&(g_dt / frozen.g_dt))
    }
}

impl SpectralBound for RodModel {
    /// Power iteration on finite differences of the rate, warm-started, with a margin.
    fn spectral_radius(&mut self, state: &RodState) -> Result<f64, Rejection> {
        let n = self.n_dof();
        let (mut base, mut shifted, mut there) = (vec![0.0; n], vec![0.0; n], state.clone());
        self.rate(state, &mut base)?;
        let mut direction = std::mem::take(&mut self.probe);
        if direction.len() != n {
            // every wavelength is in it, the shortest most
            direction = (0..n)
                .map(|k| (k as f64 * 2.5).sin() + if k % 2 == 0 { 1.0 } else { -1.0 })
                .collect();
        }
        let mut radius = 0.0;
        for _ in 0..POWER_ITERATIONS {
            let size = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
            if size.is_nan() || size < 1e-300 {
                break;
            }
            let step = PROBE_LENGTH / size;
            direction.iter_mut().for_each(|d| *d *= step);
            self.advance(state, &direction, &mut there)?;
            self.rate(&there, &mut shifted)?;
            direction
                .iter_mut()
                .zip(shifted.iter().zip(&base))
                .for_each(|(d, (s, b))| *d = s - b);
            let found = direction.iter().map(|d| d * d).sum::<f64>().sqrt() / PROBE_LENGTH;
            let settled = f64::abs(found - radius) < 0.02 * found;
            radius = found;
            if settled {
                break;
            }
        }
        self.probe = direction;
        Ok(POWER_MARGIN * radius)
    }
}

/// Length of the perturbation that probes the rate, in h (root of the sum of squares over the rod).
const PROBE_LENGTH: f64 = 1e-5;
/// Most iterations of a probe; the vector is kept, so that later probes start near the answer.
const POWER_ITERATIONS: usize = 40;
/// Power iteration finds the radius from below.
const POWER_MARGIN: f64 = 1.2;
