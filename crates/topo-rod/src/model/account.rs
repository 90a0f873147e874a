//! The account of the model: energy by term, dissipation by channel, work of the ends, and computational work by component.

use nalgebra::Vector3;
use topo_core::{Ledger, LinearlyImplicit, Rejection};

use super::RodModel;
use super::parts::{CHANNELS, LOAD};
use crate::drag::DragCorrection;
use crate::friction::friction_form;
use crate::guard::RiseBudget;
use crate::load::LoadCorrection;
use crate::newton::NewtonTwist;
use crate::relaxation::excess;
use crate::viscosity::{TwistViscosity, centreline_form, twist_form};
use crate::{Layout, RodState};

/// Computational work of a run by component; a component that the scene leaves out stays at zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct WorkAccount {
    /// Evaluations of energy and force.
    pub n_evaluations: u64,
    /// Builds of the contact list.
    pub n_list_rebuilds: u64,
    /// Factorisations of the centreline mobility.
    pub n_mobility_factorisations: u64,
    /// Symbolic analyses of the centreline mobility.
    pub n_mobility_patterns: u64,
    /// Factorisations of the twist mobility.
    pub n_twist_factorisations: u64,
    /// Factorisations of the Newton matrix.
    pub n_newton_factorisations: u64,
    /// Symbolic analyses of the Newton matrix.
    pub n_newton_patterns: u64,
    /// Evaluations of the contact energy and its force.
    pub n_contact_evaluations: u64,
    /// Evaluations of the twist energy and its torques.
    pub n_twist_evaluations: u64,
    /// Evaluations of the couplings by friction.
    pub n_friction_evaluations: u64,
    /// Bytes held by the list of near pairs, which contact and friction share.
    pub contact_bytes: usize,
    /// Bytes held by matrices and factors of the twist.
    pub twist_bytes: usize,
    /// Bytes held by the couplings by friction.
    pub friction_bytes: usize,
    /// Bytes held by matrices and factors of the centreline.
    pub matrix_bytes: usize,
    /// Bytes held for further components: where they are, and what resists each as a whole.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub component_bytes: usize,
    /// Solves for what resists each component as a whole.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub n_component_solves: usize,
    /// Evaluations of a load.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub n_load_evaluations: usize,
    /// Bytes held for a load.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub load_bytes: usize,
    /// Evaluations with a natural shape.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub n_rest_evaluations: usize,
    /// Bytes held for a natural shape.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rest_bytes: usize,
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

impl WorkAccount {
    /// Bytes held by all components together.
    pub fn n_bytes(&self) -> u64 {
        let bytes = [
            self.contact_bytes,
            self.twist_bytes,
            self.friction_bytes,
            self.matrix_bytes,
            self.component_bytes,
            self.load_bytes,
            self.rest_bytes,
        ];
        bytes.iter().sum::<usize>() as u64
    }
}

impl RodModel {
    /// Starts the account at `state`. Call it once, at the start of a run.
    ///
    /// # Errors
    /// A rod that folds back on itself has no energy.
    pub fn start(&mut self, state: &RodState) -> Result<(), Rejection> {
        self.evaluate(state)?;
        self.remember(state);
        self.rises = RiseBudget::new(self.accepted.total);
        self.ledger.set_stored(&self.at.energies);
        Ok(())
    }

    /// Records the energy that a cut removed before this run started: the account then starts at the energy of the closed rod.
    pub(crate) fn record_cut(&mut self, closed: f64, removed: f64) {
        let open = self.at.energies.clone();
        let mut ledger = self.empty_ledger();
        let mut before = open.clone();
        if let Some(first) = before.first_mut() {
            *first += closed - open.iter().sum::<f64>();
        }
        ledger.set_stored(&before);
        ledger.record_event("cut", 0.0, removed);
        ledger.set_stored(&open);
        self.ledger = ledger;
    }

    /// The empty account of all terms.
    pub(super) fn empty_ledger(&self) -> Ledger {
        let names: Vec<&'static str> = self.terms.iter().map(|t| t.name()).collect();
        match self.load {
            Some(_) => Ledger::new(&names, &[&CHANNELS[..], &[LOAD]].concat()),
            None => Ledger::new(&names, &CHANNELS),
        }
    }

    /// Energy account of the run.
    pub fn account(&self) -> &Ledger {
        &self.ledger
    }

    /// Computational work so far, by component.
    pub fn work(&self) -> WorkAccount {
        let mobility = self
            .rotation
            .as_ref()
            .map_or(0, TwistViscosity::n_factorisations);
        let newton = self
            .newton_twist
            .as_ref()
            .map_or(0, NewtonTwist::n_factorisations);
        // Each evaluation calls every term that the model has, once.
        let calls = |name: &str| match self.terms.iter().find(|term| term.name() == name) {
            Some(_) => self.n_term_evaluations,
            None => 0,
        };
        let several = self.centreline.drag();
        let per_factor = several.map_or(0, DragCorrection::n_columns) as u64;
        let solves = self.centreline.n_factorisations() + 3 * self.newton.n_factorisations;
        let couplings = self.at.couplings.capacity() + self.accepted.couplings.capacity();
        let twist_matrices = self.rotation.as_ref().map_or(0, TwistViscosity::n_bytes)
            + self.newton_twist.as_ref().map_or(0, NewtonTwist::n_bytes);
        WorkAccount {
            n_evaluations: self.n_evaluations,
            n_contact_evaluations: calls("contact"),
            n_twist_evaluations: calls("twist"),
            n_friction_evaluations: self.n_friction_evaluations,
            twist_bytes: twist_matrices,
            friction_bytes: couplings * size_of::<(u32, u32, f64)>(),
            n_list_rebuilds: self.pairs.n_rebuilds(),
            n_mobility_factorisations: self.centreline.n_factorisations(),
            n_mobility_patterns: self.centreline.n_patterns(),
            n_twist_factorisations: mobility + newton,
            n_newton_factorisations: self.newton.n_factorisations,
            n_newton_patterns: self.newton.n_patterns,
            contact_bytes: self.pairs.n_bytes(),
            component_bytes: several.map_or(0, DragCorrection::n_bytes)
                + self.newton.n_component_bytes()
                + self.n_layout_bytes,
            n_load_evaluations: match self.load {
                Some(_) => self.n_term_evaluations as usize,
                None => 0,
            },
            load_bytes: self.load.as_ref().map_or(0, |load| size_of_val(&**load))
                + self.centreline.load().map_or(0, LoadCorrection::n_bytes),
            n_rest_evaluations: match self.n_rest_bytes {
                0 => 0,
                _ => self.n_evaluations as usize,
            },
            rest_bytes: self.n_rest_bytes,
            n_component_solves: (per_factor * solves) as usize,
            matrix_bytes: 8 * (self.centreline.n_nonzeros() + self.newton.n_nonzeros()),
        }
    }

    /// Keeps of the evaluated state what the next step's account needs.
    pub(super) fn remember(&mut self, state: &RodState) {
        let a = &mut self.accepted;
        a.stamp = Some(state.stamp());
        a.total = self.at.energies.iter().sum();
        if let Some(load) = &mut self.load {
            load.accept();
            a.total += load.here.energy;
        }
        a.cosine.clone_from(&self.at.geometry.cosine);
        a.couplings.clone_from(&self.at.couplings);
        a.joints.clone_from(&self.at.joints);
        if self.is_driven {
            a.force.clone_from(&self.at.force);
        }
    }

    /// Work of loads and of prescribed motions over a step, with the mean of the forces at its two ends.
    pub(super) fn external_work(&self, from: &RodState, step: &[f64], dt: f64) -> f64 {
        if !self.is_driven {
            return 0.0;
        }
        let n = self.n_vertices;
        let moved = |i: usize| Vector3::new(step[i], step[n + i], step[2 * n + i]);
        let turned = |j: usize| {
            if self.twist.is_some() {
                step[3 * n + j]
            } else {
                0.0
            }
        };
        let mut work = 0.0;
        if let Some(motor) = &self.motor {
            let cosine = |i: usize| 0.5 * (self.accepted.cosine[i] + self.at.geometry.cosine[i]);
            let joints = [&self.accepted.joints[..], &self.at.joints[..]];
            let middle = from.clock() + 0.5 * dt;
            work += motor.work(middle, joints, &step[3 * n..], self.n_edges, cosine, dt);
        }
        for placed in &self.ends {
            let ends = self.ends_at(placed, from.clock() + 0.5 * dt);
            for (end, motion) in ends.motions.iter().enumerate() {
                work += Vector3::from(motion.force).dot(&moved(placed.vertices()[end]));
                work += motion.torque * turned(placed.edges()[end]);
            }
        }
        // what a hold must supply: viscous resistance less the rod's own pull
        for &(i, _) in &self.held_vertices {
            let (old, new) = (&self.accepted.couplings, &self.at.couplings);
            let mut resistance = self.resistance(from, i, moved, &[(old, 0.5), (new, 0.5)], dt);
            if let Some(load) = &self.load {
                resistance += load.resistance(i, moved) / dt;
            }
            let pull = (self.accepted.force.vertex[i] + self.at.force.vertex[i]) * 0.5;
            work += (resistance - pull).dot(&moved(i));
        }
        for &(j, _) in &self.held_edges {
            let cosine = |i: usize| 0.5 * (self.accepted.cosine[i] + self.at.geometry.cosine[i]);
            let resistance = self.resistance_to_turns(from, j, turned, cosine, dt);
            work += (resistance - 0.5 * (self.accepted.force.torque[j] + self.at.force.torque[j]))
                * turned(j);
        }
        work
    }

    /// Energy that viscosity and friction dissipate in a step.
    ///
    /// A mode that decays as e^(−λt) dissipates its secant form δ·M δ/dt times φ(z) = (z/2) coth(z/2), z = λ dt, and the rate
    /// changes over the step by a dt = −λ δ. Modes of all λ are summed by a fraction in W = 1 + g Z, Z = dt M⁻¹H, that has
    /// the limits of φ − 1 for slow modes, z²/12, and for fast ones, z/2:
    ///
    /// ```math
    /// D\, dt = \delta \cdot M \delta + \tfrac{dt^4}{12} \left[ 6 g\, a \cdot M W^{-1} a + (1 - 6 g)\, (W^{-1} a) \cdot M W^{-1} a \right]
    /// ```
    ///
    /// As φ is concave in z², one mode with the mean z² dissipates at least as much as all: that bound is used without W.
    pub(super) fn dissipate(&mut self, from: &RodState, to: &RodState, step: &[f64], dt: f64) {
        let mut rate = std::mem::take(&mut self.rate_there);
        rate.resize(step.len(), 0.0);
        let solved = self.solve_rate(to, &mut rate).is_ok();
        let mut turning = Vector3::zeros();
        if solved && self.accepted.rate_stamp == Some(from.stamp()) {
            self.rate_change.clear();
            let change = rate.iter().zip(&self.accepted.rate);
            self.rate_change
                .extend(change.map(|(new, old)| (new - old) * dt));
            if let Some(load) = &self.load {
                turning = load.turning(&self.accepted.rate, &rate) * dt;
            }
        } else {
            self.rate_change.clear();
            self.rate_change.resize(step.len(), 0.0);
        }
        let mut smoothed = std::mem::take(&mut self.smoothed);
        smoothed.clone_from(&self.rate_change);
        let g = self.resolvent_of(dt, &mut smoothed);
        let a = &self.rate_change;
        let (n, layout) = (self.n_vertices, from.layout());
        let rubbed = |u: &[f64], v: &[f64]| {
            let (old, new) = (&self.accepted.couplings, &self.at.couplings);
            0.5 * (friction_form(old, u, v, n) + friction_form(new, u, v, n))
        };
        let dragged = |u: &[f64], v: &[f64]| {
            let several = self.centreline.drag();
            several.map_or(0.0, |several| several.drag().form(u, v))
        };
        let smooth = |u: &[f64], v: &[f64]| centreline_form(layout, u, v) + dragged(u, v);
        let centreline = |u: &[f64], v: &[f64]| smooth(u, v) + rubbed(u, v);
        let friction = rubbed(step, step);
        let slow = smooth(step, step) + friction;
        let factor = 1.0 + excess(slow, g, &a[..], &smoothed[..], centreline);
        self.ledger.dissipate(0, (slow - friction) * factor / dt);
        self.ledger.dissipate(2, friction * factor / dt);
        let changes = [&a[..], &smoothed[..]];
        if let Some(load) = &self.load {
            let work = load.work(step, dt, changes.map(|u| load.relative(u) - turning), g);
            self.ledger.dissipate(CHANNELS.len(), work);
        }
        if self.twist.is_some() {
            let heat = self.heat_of_twist(layout, step, dt, changes, g);
            self.ledger.dissipate(1, heat);
        }
        self.smoothed = smoothed;
        self.rate_there = std::mem::replace(&mut self.accepted.rate, rate);
        self.accepted.rate_stamp = solved.then(|| to.stamp());
    }

    /// What twist viscosity dissipates in a step, given a and W⁻¹ a.
    fn heat_of_twist(
        &self,
        layout: &Layout,
        step: &[f64],
        dt: f64,
        changes: [&[f64]; 2],
        g: Option<f64>,
    ) -> f64 {
        let (old, new) = (&self.accepted.cosine, &self.at.geometry.cosine);
        let cosine = |i: usize| 0.5 * (old[i] + new[i]);
        let (motor, n_edges) = (self.motor.as_deref(), self.n_edges);
        let driven =
            |u: &[f64], v: &[f64]| motor.map_or(0.0, |motor| motor.form(n_edges, cosine, u, v));
        let twist = |u: &[f64], v: &[f64]| twist_form(layout, cosine, u, v) + driven(u, v);
        let turned = 3 * self.n_vertices..self.drives().end;
        let slow = twist(&step[turned.clone()], &step[turned.clone()]);
        let [a, smoothed] = changes.map(|u| &u[turned.clone()]);
        slow * (1.0 + excess(slow, g, a, smoothed, twist)) / dt
    }

    /// a ← W⁻¹ a with the Newton matrix of the step, W = 1 + g Z; gives g, or `None` where there is no use of it.
    fn resolvent_of(&mut self, dt: f64, a: &mut [f64]) -> Option<f64> {
        let g = self.frozen.as_ref()?.g_dt() / dt;
        (g <= COARSEST_RESOLVENT && self.solve(a).is_ok()).then_some(g)
    }
}

/// Largest g whose fraction is nearer to φ than the bound is.
const COARSEST_RESOLVENT: f64 = 1.0;
