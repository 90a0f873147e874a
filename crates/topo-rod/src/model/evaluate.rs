//! Energies, forces and rates at a state.

use nalgebra::Vector3;
use topo_core::Rejection;

use super::RodModel;
use super::parts::unsolvable;
use crate::RodState;
use crate::ends::PlacedEnds;
use crate::energy::At;
use crate::viscosity::remove_mean;

impl RodModel {
    pub(super) fn evaluate(&mut self, state: &RodState) -> Result<(), Rejection> {
        if self.at.stamp == Some(state.stamp()) {
            return Ok(());
        }
        self.at.stamp = None;
        self.n_evaluations += 1;
        let sound = self.at.geometry.update(state);
        if !state.vertices().iter().all(|x| x.sum().is_finite()) {
            return Err(Rejection::NotFinite { what: "a vertex" });
        }
        if !sound {
            return Err(Rejection::Domain {
                what: "a collapsed edge, or a fold of a half turn",
            });
        }
        if self.has_strands {
            self.pairs.update(state);
        }
        let at = At {
            state,
            geometry: &self.at.geometry,
            pairs: &self.pairs,
        };
        self.at.force.reset(state);
        self.at.energies.clear();
        self.n_term_evaluations += 1;
        for term in &self.terms {
            let energy = term.add_force(at, &mut self.at.force);
            self.at.energies.push(energy);
        }
        if let Some(motor) = &self.motor {
            self.at.joints.clear();
            self.at.joints.extend(motor.torques(at));
        }
        let in_time = self.driven.is_some();
        let loaded = |placed: &&PlacedEnds| in_time || placed.ends.is_driven();
        for placed in self.ends.iter().filter(loaded) {
            let (vertices, edges) = (placed.vertices(), placed.edges());
            let ends = self.ends_at(placed, state.clock());
            for (end, motion) in ends.motions.iter().enumerate() {
                self.at.force.vertex[vertices[end]] += Vector3::from(motion.force);
                self.at.force.torque[edges[end]] += motion.torque;
            }
        }
        if let Some(load) = &mut self.load {
            load.add_force(state, &mut self.at.force);
        }
        if let Some(friction) = self.friction {
            self.n_friction_evaluations += 1;
            friction.couplings(self.pairs.active(), &mut self.at.couplings);
        }
        if !self.at.energies.iter().sum::<f64>().is_finite() {
            return Err(Rejection::NotFinite { what: "the energy" });
        }
        self.at.stamp = Some(state.stamp());
        Ok(())
    }

    /// Whether its state knows the time.
    pub(super) fn has_clock(&self) -> bool {
        self.driven.is_some() || self.motor.is_some()
    }

    /// Degrees of freedom of the twist.
    pub(super) fn n_turns(&self) -> usize {
        match self.twist {
            Some(_) => self.n_edges,
            None => 0,
        }
    }

    /// Energy that falls in time but for work of the ends: that of all terms and of the spring of a load.
    pub(super) fn total(&self) -> f64 {
        let stored: f64 = self.at.energies.iter().sum();
        match &self.load {
            Some(load) => stored + load.here.energy,
            None => stored,
        }
    }

    pub(super) fn solve_rate(
        &mut self,
        state: &RodState,
        rate: &mut [f64],
    ) -> Result<(), Rejection> {
        self.evaluate(state)?;
        let n = self.n_vertices;
        for (i, f) in self.at.force.vertex.iter().enumerate() {
            (rate[i], rate[n + i], rate[2 * n + i]) = (f.x, f.y, f.z);
        }
        for &(i, v) in &self.held_vertices {
            (rate[i], rate[n + i], rate[2 * n + i]) = (v.x, v.y, v.z);
        }
        if self.has_own_terms && self.centreline.is_floating() {
            remove_mean(rate, n);
        }
        self.centreline
            .prepare(state, &self.pairs, self.friction)
            .map_err(|e| unsolvable(e, "the centreline mobility"))?;
        if let Some(load) = &self.load {
            self.centreline.damp(load.here.damping);
        }
        self.centreline
            .solve(state, &self.at.couplings, &mut rate[..3 * n]);
        if let Some(rotation) = self.rotation.as_mut() {
            let (w, behind) = rate[3 * n..].split_at_mut(self.n_edges);
            w.copy_from_slice(&self.at.force.torque);
            if let Some(motor) = &self.motor {
                let (joints, cosine) = (&self.at.joints, &self.at.geometry.cosine);
                motor.balance(state.clock(), joints, cosine, w, behind);
            }
            for &(j, turn) in &self.held_edges {
                w[j] = turn;
            }
            rotation
                .prepare(state, &self.at.geometry.cosine, 0.0)
                .map_err(|e| unsolvable(e, "the twist mobility"))?;
            rotation.solve(state, &self.at.geometry.cosine, 0.0, w, behind);
        }
        if self.has_clock() {
            rate[self.drives().end] = 1.0;
        }
        Ok(())
    }
}
