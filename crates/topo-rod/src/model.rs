//! The rod as a system that the integrators of `topo-core` advance: only what the scene names is in it.

use std::cell::Cell;

use nalgebra::Vector3;
use topo_core::{Ledger, LinearlyImplicit, Model, Rejection, SparseError, SpectralBound};

use crate::contact::ContactPairs;
use crate::energy::{At, Bend, ContactEnergy, EnergyTerm, Force, Stiffness, Stretch, Twist};
use crate::friction::{Friction, friction_form};
use crate::guard::{certify, largest_displacement};
use crate::newton::{NewtonMatrix, NewtonTwist};
use crate::viscosity::{CentrelineViscosity, TwistViscosity, centreline_form, twist_form};
use crate::{Accuracy, Ends, Geometry, Guards, RodError, RodParameters, RodState, Tube};

/// Channels of dissipation, in the order of the ledger.
pub(crate) const CHANNELS: [&str; 3] = ["viscosity", "twist_viscosity", "friction"];

/// What a run has worked, by component; a component that the scene leaves out stays at zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct WorkAccount {
    /// Evaluations of energy and force.
    pub n_evaluations: u64,
    /// Builds of the contact list.
    pub n_list_rebuilds: u64,
    /// Factorisations of the centreline mobility.
    pub n_mobility_factorisations: u64,
    /// Factorisations of the twist mobility.
    pub n_twist_factorisations: u64,
    /// Factorisations of the Newton matrix.
    pub n_newton_factorisations: u64,
    /// Symbolic analyses of the Newton matrix.
    pub n_newton_patterns: u64,
    /// Bytes held by the contact list.
    pub contact_bytes: usize,
    /// Bytes held by matrices and factors of the centreline.
    pub matrix_bytes: usize,
}

/// Terms, mobility, guards and ledger of one rod.
pub struct RodModel {
    terms: Vec<Box<dyn EnergyTerm>>,
    twist: Option<Twist>,
    friction: Option<Friction>,
    pairs: ContactPairs,
    has_strands: bool,
    ends: Ends,
    held_vertices: Vec<(usize, Vector3<f64>)>,
    held_edges: Vec<(usize, f64)>,
    centreline: CentrelineViscosity,
    rotation: Option<TwistViscosity>,
    newton: NewtonMatrix,
    newton_twist: Option<NewtonTwist>,
    stiffness: Stiffness,
    frozen: Option<Frozen>,
    reuse: usize,
    guards: Guards,
    ledger: Ledger,
    n_vertices: usize,
    n_edges: usize,
    at: Evaluation,
    accepted: Accepted,
    near: Vec<(u32, u32)>,
    probe: Vec<f64>,
    rate_there: Vec<f64>,
    rate_change: Vec<f64>,
    stamps: Cell<u64>,
    n_evaluations: u64,
    least_distance: f64,
}

/// The Newton matrix in use: made for which step length, and how often used.
#[derive(Debug, Clone, Copy)]
struct Frozen {
    g_dt: f64,
    n_uses: usize,
}

/// Energies and forces at the state evaluated last.
#[derive(Default)]
struct Evaluation {
    stamp: Option<u64>,
    geometry: Geometry,
    force: Force,
    energies: Vec<f64>,
    couplings: Vec<(u32, u32, f64)>,
}

/// What the ledger needs of the state accepted last.
#[derive(Default)]
struct Accepted {
    stamp: Option<u64>,
    total: f64,
    cosine: Vec<f64>,
    couplings: Vec<(u32, u32, f64)>,
    force: Force,
    rate: Vec<f64>,
    rate_stamp: Option<u64>,
}

impl RodModel {
    /// A model for `state`, with just what `parameters` name.
    ///
    /// # Errors
    /// A parameter out of range, or end conditions on a closed rod.
    pub fn new(
        parameters: &RodParameters,
        tube: &Tube,
        accuracy: &Accuracy,
        guards: Guards,
        ends: Ends,
        state: &RodState,
    ) -> Result<Self, RodError> {
        let parameters = parameters.clone().checked()?;
        let accuracy = accuracy.checked()?;
        let twist = parameters.twist.map(|_| Twist {
            ratio: parameters.twist_ratio,
        });
        let ends = ends.checked(twist.is_some())?;
        if state.is_closed() && !ends.is_free() {
            return Err(RodError::WrongTopology {
                operation: "an end condition",
                needed: "an open",
            });
        }
        let mut terms: Vec<Box<dyn EnergyTerm>> = vec![
            Box::new(Bend),
            Box::new(Stretch {
                ratio: parameters.stretch_ratio,
            }),
        ];
        if let Some(twist) = twist {
            terms.push(Box::new(twist));
        }
        let mut reach = 0.0;
        if let Some(contact) = parameters.contact {
            terms.push(Box::new(ContactEnergy {
                stiffness: contact.stiffness,
                diameter: tube.contact_diameter,
            }));
            reach = tube.contact_diameter;
        }
        let friction = parameters
            .friction
            .filter(|f| f.ratio > 0.0)
            .map(|f| Friction {
                ratio: f.ratio,
                range: tube.friction_range,
            });
        if let Some(friction) = friction {
            reach = reach.max(friction.range);
        }
        let mut pairs = ContactPairs::new(reach, accuracy.skin);
        pairs.set_cyclic(state.is_closed());
        let (n_vertices, n_edges) = (state.n_vertices(), state.n_edges());
        let held_vertices = ends.held_vertices(state);
        let held_edges = if twist.is_some() {
            ends.held_edges(state)
        } else {
            Vec::new()
        };
        let mut fixed = vec![false; n_vertices];
        held_vertices.iter().for_each(|h| fixed[h.0] = true);
        let mut fixed_edges = vec![false; n_edges];
        held_edges.iter().for_each(|h| fixed_edges[h.0] = true);
        let names: Vec<&'static str> = terms.iter().map(|t| t.name()).collect();
        Ok(Self {
            twist,
            friction,
            pairs,
            has_strands: reach > 0.0,
            ends,
            held_vertices,
            held_edges,
            centreline: CentrelineViscosity::new(fixed.clone()),
            rotation: twist.map(|_| TwistViscosity::new(fixed_edges.clone())),
            newton: NewtonMatrix::new(fixed),
            newton_twist: twist.map(|_| NewtonTwist::new(fixed_edges)),
            probe: Vec::new(),
            rate_there: Vec::new(),
            rate_change: Vec::new(),
            stiffness: Stiffness::default(),
            frozen: None,
            reuse: accuracy.reuse,
            guards,
            ledger: Ledger::new(&names, &CHANNELS),
            n_vertices,
            n_edges,
            at: Evaluation::default(),
            accepted: Accepted::default(),
            near: Vec::new(),
            stamps: Cell::new(state.stamp()),
            n_evaluations: 0,
            least_distance: f64::INFINITY,
            terms,
        })
    }

    /// Starts the account at `state` (a model is told once where its run starts).
    ///
    /// # Errors
    /// A rod that folds back on itself has no energy.
    pub fn start(&mut self, state: &RodState) -> Result<(), Rejection> {
        self.evaluate(state)?;
        self.remember(state);
        self.ledger.set_stored(&self.at.energies);
        Ok(())
    }

    /// Books the energy that a cut took before this run started: the account then starts at what the closed rod held.
    pub(crate) fn record_cut(&mut self, closed: f64, removed: f64) {
        let open = self.at.energies.clone();
        let names: Vec<&'static str> = self.terms.iter().map(|t| t.name()).collect();
        let mut ledger = Ledger::new(&names, &CHANNELS);
        let mut before = open.clone();
        if let Some(first) = before.first_mut() {
            *first += closed - open.iter().sum::<f64>();
        }
        ledger.set_stored(&before);
        ledger.record_event("cut", 0.0, removed);
        ledger.set_stored(&open);
        self.ledger = ledger;
    }

    /// Pairs of vertices in reach.
    pub fn pairs(&self) -> &ContactPairs {
        &self.pairs
    }

    /// Least distance of two vertices of different strands over all accepted steps, in h; infinite if none came in reach.
    pub fn least_distance(&self) -> f64 {
        self.least_distance
    }

    /// Energies per area by term at `state`, in the order of the ledger.
    ///
    /// # Errors
    /// As [`Model::rate`].
    pub fn energies(&mut self, state: &RodState) -> Result<Vec<f64>, Rejection> {
        self.evaluate(state)?;
        Ok(self.at.energies.clone())
    }

    /// Force −∂e/∂(x, θ) at `state`, loads at the ends included.
    ///
    /// # Errors
    /// As [`Model::rate`].
    pub fn force(&mut self, state: &RodState) -> Result<&Force, Rejection> {
        self.evaluate(state)?;
        Ok(&self.at.force)
    }

    /// Counts arclength for contact the shorter way round (closed rods, and cut ones until the tips have parted) or not.
    pub fn set_cyclic(&mut self, cyclic: bool) {
        if cyclic != self.pairs.is_cyclic() {
            self.pairs.set_cyclic(cyclic);
            self.forget();
        }
    }

    /// Forgets cached evaluations and patterns.
    fn forget(&mut self) {
        self.at.stamp = None;
        self.frozen = None;
        self.centreline.invalidate_pattern();
    }

    /// Energy books of the run.
    pub fn account(&self) -> &Ledger {
        &self.ledger
    }

    /// What was worked so far, by component.
    pub fn work(&self) -> WorkAccount {
        let mobility = self
            .rotation
            .as_ref()
            .map_or(0, TwistViscosity::n_factorisations);
        let newton = self
            .newton_twist
            .as_ref()
            .map_or(0, NewtonTwist::n_factorisations);
        WorkAccount {
            n_evaluations: self.n_evaluations,
            n_list_rebuilds: self.pairs.n_rebuilds(),
            n_mobility_factorisations: self.centreline.n_factorisations(),
            n_twist_factorisations: mobility + newton,
            n_newton_factorisations: self.newton.n_factorisations,
            n_newton_patterns: self.newton.n_patterns,
            contact_bytes: self.pairs.n_bytes(),
            matrix_bytes: 8 * (self.centreline.n_nonzeros() + self.newton.n_nonzeros()),
        }
    }

    fn evaluate(&mut self, state: &RodState) -> Result<(), Rejection> {
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
                what: "an edge without length, or a fold of a half turn",
            });
        }
        if self.has_strands && self.pairs.update(state) {
            self.centreline.invalidate_pattern();
        }
        let at = At {
            state,
            geometry: &self.at.geometry,
            pairs: &self.pairs,
        };
        self.at.force.reset(state);
        self.at.energies.clear();
        for term in &self.terms {
            let energy = term.add_force(at, &mut self.at.force);
            self.at.energies.push(energy);
        }
        if self.ends.is_driven() {
            let last = [0, self.n_vertices - 1];
            let last_edge = [0, self.n_edges - 1];
            for (end, motion) in self.ends.motions.iter().enumerate() {
                self.at.force.vertex[last[end]] += Vector3::from(motion.force);
                self.at.force.torque[last_edge[end]] += motion.torque;
            }
        }
        if let Some(friction) = self.friction {
            friction.couplings(self.pairs.active(), &mut self.at.couplings);
        }
        if !self.at.energies.iter().sum::<f64>().is_finite() {
            return Err(Rejection::NotFinite { what: "the energy" });
        }
        self.at.stamp = Some(state.stamp());
        Ok(())
    }

    /// Keeps of the evaluated state what the next step's account needs.
    fn remember(&mut self, state: &RodState) {
        let a = &mut self.accepted;
        a.stamp = Some(state.stamp());
        a.total = self.at.energies.iter().sum();
        a.cosine.clone_from(&self.at.geometry.cosine);
        a.couplings.clone_from(&self.at.couplings);
        if self.ends.is_driven() {
            a.force.clone_from(&self.at.force);
        }
    }

    /// Work of loads and of prescribed motions over a step, with the mean of the forces at its two ends.
    fn external_work(&self, from: &RodState, step: &[f64], dt: f64) -> f64 {
        if !self.ends.is_driven() {
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
        for (end, motion) in self.ends.motions.iter().enumerate() {
            work += Vector3::from(motion.force).dot(&moved([0, n - 1][end]));
            work += motion.torque * turned([0, self.n_edges - 1][end]);
        }
        // what a hold must supply: viscous resistance less the rod's own pull
        for &(i, _) in &self.held_vertices {
            let mut resistance = Vector3::zeros();
            let viscous = 1.0 / (from.rest_length() * dt);
            for j in [i.checked_sub(1), Some(i)]
                .into_iter()
                .flatten()
                .filter(|&j| j < self.n_edges)
            {
                let other = if j == i { i + 1 } else { i - 1 };
                resistance += (moved(i) - moved(other)) * viscous;
            }
            for (couplings, half) in [(&self.accepted.couplings, 0.5), (&self.at.couplings, 0.5)] {
                for &(a, b, c) in couplings
                    .iter()
                    .filter(|c| c.0 as usize == i || c.1 as usize == i)
                {
                    let other = if a as usize == i { b } else { a } as usize;
                    resistance += (moved(i) - moved(other)) * (half * c / dt);
                }
            }
            let pull = (self.accepted.force.vertex[i] + self.at.force.vertex[i]) * 0.5;
            work += (resistance - pull).dot(&moved(i));
        }
        for &(j, _) in &self.held_edges {
            let half = 0.5 / (from.rest_length() * dt);
            let mut resistance = 0.0;
            for i in [j, j + 1]
                .into_iter()
                .filter(|i| from.interior().contains(i))
            {
                let other = if i == j { j - 1 } else { j + 1 };
                let cosine = 0.5 * (self.accepted.cosine[i] + self.at.geometry.cosine[i]);
                resistance += half * (turned(j) - cosine * turned(other));
            }
            work += (resistance - 0.5 * (self.accepted.force.torque[j] + self.at.force.torque[j]))
                * turned(j);
        }
        work
    }

    /// Energy that viscosity and friction take over a step.
    ///
    /// With the secant velocity alone, D = δ·M δ/dt, a mode that decays as e^(−λt) is booked short by (λ dt)²/12. The change of
    /// the rate over the step, a, tells λ dt = z by z² = a·M a dt²/δ·M δ, and D grows by the exact factor (z/2) coth(z/2).
    fn dissipate(&mut self, from: &RodState, to: &RodState, step: &[f64], dt: f64) {
        let n = self.n_vertices;
        let mut rate = std::mem::take(&mut self.rate_there);
        rate.resize(step.len(), 0.0);
        let solved = self.solve_rate(to, &mut rate).is_ok();
        let known = solved && self.accepted.rate_stamp == Some(from.stamp());
        self.rate_change.clear();
        self.rate_change.extend(
            rate.iter()
                .zip(&self.accepted.rate)
                .map(|(new, old)| (new - old) * dt),
        );
        let change = |slow: f64, fast: f64| {
            if known && slow > 0.0 {
                relaxation_factor((fast / slow).sqrt())
            } else {
                1.0
            }
        };
        let chain = from.chain();
        let centreline = |v: &[f64]| {
            let rubbed = friction_form(&self.accepted.couplings, v, n)
                + friction_form(&self.at.couplings, v, n);
            (centreline_form(chain, v), 0.5 * rubbed)
        };
        let (slow, fast) = (
            centreline(step),
            if known {
                centreline(&self.rate_change)
            } else {
                (0.0, 0.0)
            },
        );
        let factor = change(slow.0 + slow.1, fast.0 + fast.1) / dt;
        let (old, new) = (&self.accepted.cosine, &self.at.geometry.cosine);
        let twist = |w: &[f64]| twist_form(chain, |i| 0.5 * (old[i] + new[i]), w);
        let twisted = self.twist.map(|_| {
            let slow = twist(&step[3 * n..]);
            slow * change(
                slow,
                if known {
                    twist(&self.rate_change[3 * n..])
                } else {
                    0.0
                },
            ) / dt
        });
        self.ledger.dissipate(0, slow.0 * factor);
        self.ledger.dissipate(2, slow.1 * factor);
        if let Some(energy) = twisted {
            self.ledger.dissipate(1, energy);
        }
        self.rate_there = std::mem::replace(&mut self.accepted.rate, rate);
        self.accepted.rate_stamp = solved.then(|| to.stamp());
    }

    fn solve_rate(&mut self, state: &RodState, rate: &mut [f64]) -> Result<(), Rejection> {
        self.evaluate(state)?;
        let n = self.n_vertices;
        for (i, f) in self.at.force.vertex.iter().enumerate() {
            (rate[i], rate[n + i], rate[2 * n + i]) = (f.x, f.y, f.z);
        }
        for &(i, v) in &self.held_vertices {
            (rate[i], rate[n + i], rate[2 * n + i]) = (v.x, v.y, v.z);
        }
        self.centreline
            .prepare(state.chain(), &self.pairs, self.friction)
            .map_err(|e| unsolvable(e, "the centreline mobility"))?;
        self.centreline
            .solve(state.chain(), &self.at.couplings, &mut rate[..3 * n]);
        if let Some(rotation) = self.rotation.as_mut() {
            let w = &mut rate[3 * n..];
            w.copy_from_slice(&self.at.force.torque);
            for &(j, turn) in &self.held_edges {
                w[j] = turn;
            }
            rotation
                .prepare(state.chain(), &self.at.geometry.cosine, 0.0)
                .map_err(|e| unsolvable(e, "the twist mobility"))?;
            rotation.solve(state.chain(), &self.at.geometry.cosine, 0.0, w);
        }
        Ok(())
    }
}

/// (z/2) coth(z/2): mean square of a velocity that decays by e^(−z) over a step, over the square of its mean.
fn relaxation_factor(z: f64) -> f64 {
    if z < 1e-3 {
        1.0 + z * z / 12.0
    } else {
        0.5 * z / (0.5 * z).tanh()
    }
}

fn unsolvable(error: SparseError, what: &'static str) -> Rejection {
    tracing::debug!(%error, what, "matrix refused");
    Rejection::Factorisation { what }
}

impl Model for RodModel {
    type State = RodState;

    fn n_dof(&self) -> usize {
        3 * self.n_vertices
            + if self.twist.is_some() {
                self.n_edges
            } else {
                0
            }
    }

    fn rate(&mut self, state: &RodState, rate: &mut [f64]) -> Result<(), Rejection> {
        if self.accepted.rate_stamp == Some(state.stamp()) {
            rate.copy_from_slice(&self.accepted.rate);
            return Ok(());
        }
        self.solve_rate(state, rate)
    }

    fn advance(&self, from: &RodState, step: &[f64], to: &mut RodState) -> Result<(), Rejection> {
        if !step.iter().all(|s| s.is_finite()) {
            return Err(Rejection::NotFinite { what: "the step" });
        }
        self.stamps.set(self.stamps.get() + 1);
        from.moved_by(step, self.twist.is_some(), self.stamps.get(), to);
        Ok(())
    }

    /// Largest component of the displacement error in h; rotations count with the arc they move the surface by.
    fn error_norm(&self, error: &[f64]) -> f64 {
        let (moved, turned) = error.split_at(3 * self.n_vertices);
        topo_core::max_norm(moved).max(ROTATION_WEIGHT * topo_core::max_norm(turned))
    }

    fn check(
        &mut self,
        from: &RodState,
        to: &RodState,
        step: &[f64],
        dt: f64,
    ) -> Result<(), Rejection> {
        let n = self.n_vertices;
        let (vertex, moved) = largest_displacement(step, n);
        if moved > self.guards.displacement {
            return Err(Rejection::Displacement {
                vertex,
                moved,
                limit: self.guards.displacement,
            });
        }
        for j in 0..self.n_edges {
            let (a, b) = (
                from.vertices()[from.edge_end(j)] - from.vertices()[j],
                to.vertices()[to.edge_end(j)] - to.vertices()[j],
            );
            if a.dot(&b) <= 0.0 {
                return Err(Rejection::Domain {
                    what: "an edge turned by a right angle in one step",
                });
            }
        }
        if self.has_strands {
            if self.pairs.ensure(from) {
                self.forget();
            }
            certify(from, step, moved, &self.pairs, &mut self.near)?;
        }
        self.evaluate(to)?;
        let total: f64 = self.at.energies.iter().sum();
        let rise = total - self.accepted.total - self.external_work(from, step, dt).max(0.0);
        let scale = self.accepted.total.abs().max(1e-12);
        if rise > self.guards.energy_rise * scale {
            return Err(Rejection::EnergyRise {
                relative: rise / scale,
            });
        }
        Ok(())
    }

    fn accepted(&mut self, from: &RodState, to: &RodState, step: &[f64], dt: f64) {
        let work = self.external_work(from, step, dt);
        self.ledger.add_work(work);
        self.dissipate(from, to, step, dt);
        self.ledger.set_stored(&self.at.energies);
        self.least_distance = self
            .pairs
            .least_distance()
            .unwrap_or(f64::INFINITY)
            .min(self.least_distance);
        self.remember(to);
    }

    fn ledger(&self) -> Option<&Ledger> {
        Some(&self.ledger)
    }
}

/// Share of an edge's rotation in the error norm.
const ROTATION_WEIGHT: f64 = 0.1;

impl LinearlyImplicit for RodModel {
    fn prepare(&mut self, state: &RodState, g_dt: f64) -> Result<(), Rejection> {
        // order two holds for any matrix, so one may serve several steps of about its length
        if let Some(frozen) = self.frozen.as_mut() {
            let ratio = g_dt / frozen.g_dt;
            if frozen.n_uses < self.reuse && (0.6..=1.3).contains(&ratio) {
                frozen.n_uses += 1;
                return Ok(());
            }
        }
        self.frozen = None;
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
                    state.chain(),
                    &self.at.geometry.cosine,
                    g_dt * twist.torque(1.0, state.rest_length()),
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
            newton.solve(turned);
        }
        Ok(())
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
