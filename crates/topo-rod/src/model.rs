//! The rod as a system that the integrators of `topo-core` advance: only what the scene names is in it.

mod account;
mod approaching;
mod evaluate;
mod grips;
mod implicit;
mod memory;
mod motor;
mod named;
mod parts;

pub use account::WorkAccount;
pub use grips::GripForce;

use std::cell::Cell;

use nalgebra::Vector3;
use topo_core::{Ledger, Model, Rejection};

use crate::contact::ContactPairs;
use crate::drag::Drag;
use crate::ends::{GripSchedule, GripSegment, PlacedEnds};
use crate::energy::{
    At, ContactEnergy, EnergyTerm, Force, RodParts, Stiffness, Twist, checked_name, terms_of,
};
use crate::friction::Friction;
use crate::guard::{RiseBudget, certify, largest_displacement};
use crate::load::{EndLoad, Load};
use crate::newton::{NewtonMatrix, NewtonTwist};
use crate::viscosity::{CentrelineViscosity, TwistViscosity};
use crate::{
    Accuracy, Chain, Ends, Geometry, Guards, RodEnds, RodError, RodParameters, RodState, Tips, Tube,
};
use approaching::ApproachingPairs;
use motor::Motor;
use named::Named;
use parts::{Accepted, Frozen};

pub(crate) use memory::ModelMemory;
#[cfg(test)]
pub(crate) use memory::PARTS;
pub(crate) use motor::Drive;
pub(crate) use parts::{CHANNELS, LOAD};

/// Terms, mobility, guards and ledger of one rod.
pub struct RodModel {
    terms: Vec<Box<dyn EnergyTerm>>,
    parts: RodParts,
    /// Whether there are terms whose forces may act on the rod as a whole.
    has_own_terms: bool,
    twist: Option<Twist>,
    contact: Option<ContactEnergy>,
    expected: ApproachingPairs,
    friction: Option<Friction>,
    pairs: ContactPairs,
    has_strands: bool,
    ends: Vec<PlacedEnds>,
    is_driven: bool,
    load: Option<Box<Load>>,
    /// The ends in time, and what they do at present.
    driven: Option<Box<(GripSchedule, GripSegment)>>,
    /// What turns the ends of closed rods against each other.
    motor: Option<Box<Motor>>,
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
    rises: RiseBudget,
    ledger: Ledger,
    n_vertices: usize,
    n_edges: usize,
    n_layout_bytes: usize,
    n_rest_bytes: usize,
    at: Evaluation,
    accepted: Accepted,
    near: Vec<(u32, u32)>,
    probe: Vec<f64>,
    rate_there: Vec<f64>,
    rate_change: Vec<f64>,
    smoothed: Vec<f64>,
    stamps: Cell<u64>,
    n_evaluations: u64,
    n_term_evaluations: u64,
    n_friction_evaluations: u64,
    least_distance: f64,
    longest_step: f64,
}

/// Energies and forces at the state evaluated last.
#[derive(Default)]
struct Evaluation {
    stamp: Option<u64>,
    geometry: Geometry,
    force: Force,
    energies: Vec<f64>,
    couplings: Vec<(u32, u32, f64)>,
    /// Elastic torques of joints whose ends are turned against each other.
    joints: Vec<f64>,
}

/// `n` flags, those of `places` set.
fn marked(n: usize, places: impl Iterator<Item = usize>) -> Vec<bool> {
    let mut flags = vec![false; n];
    places.for_each(|place| flags[place] = true);
    flags
}

impl RodModel {
    /// A model for `state`, with only the terms that `parameters` name.
    ///
    /// # Errors
    /// A parameter out of range, or end conditions on a closed component.
    pub fn new(
        parameters: &RodParameters,
        tube: &Tube,
        accuracy: &Accuracy,
        guards: Guards,
        ends: impl Into<RodEnds>,
        state: &RodState,
    ) -> Result<Self, RodError> {
        let parameters = parameters.clone().checked()?;
        let accuracy = accuracy.checked()?;
        let named = Named::of(&parameters, tube);
        let Named {
            twist,
            contact,
            friction,
            reach,
        } = named;
        let ends = ends.into().placed(state, twist.is_some())?;
        let terms = terms_of(&parameters, tube, state);
        let pairs = named.pairs(accuracy.skin, state.is_closed());
        let (n_vertices, n_edges) = (state.n_vertices(), state.n_edges());
        let held_vertices: Vec<_> = ends.iter().flat_map(PlacedEnds::held_vertices).collect();
        let held_edges: Vec<_> = match twist {
            Some(_) => ends.iter().flat_map(PlacedEnds::held_edges).collect(),
            None => Vec::new(),
        };
        let fixed = marked(n_vertices, held_vertices.iter().map(|h| h.0));
        let turning = held_edges.iter().map(|h| h.0);
        let fixed_edges = marked(n_edges, turning.chain(state.unused_edges()));
        let drag = Drag::of(state, &fixed, parameters.drag);
        let names: Vec<&'static str> = terms.iter().map(|t| t.name()).collect();
        Ok(Self {
            parts: RodParts::of(&terms),
            has_own_terms: false,
            twist,
            contact,
            expected: ApproachingPairs::new(accuracy.tolerance),
            friction,
            pairs,
            has_strands: reach > 0.0,
            is_driven: ends.iter().any(|placed| placed.ends.is_driven()),
            load: None,
            driven: None,
            motor: None,
            ends,
            held_vertices,
            held_edges,
            centreline: CentrelineViscosity::new(fixed.clone()).with_drag(drag.clone()),
            rotation: twist.map(|_| TwistViscosity::new(fixed_edges.clone())),
            newton: NewtonMatrix::new(fixed).with_drag(drag),
            newton_twist: twist.map(|_| NewtonTwist::new(fixed_edges)),
            probe: Vec::new(),
            rate_there: Vec::new(),
            rate_change: Vec::new(),
            smoothed: Vec::new(),
            stiffness: Stiffness::default(),
            frozen: None,
            reuse: accuracy.reuse,
            guards,
            rises: RiseBudget::default(),
            ledger: Ledger::new(&names, &CHANNELS),
            n_vertices,
            n_edges,
            n_layout_bytes: state.layout().n_bytes(),
            n_rest_bytes: state.n_rest_bytes(),
            at: Evaluation::default(),
            accepted: Accepted::default(),
            near: Vec::new(),
            stamps: Cell::new(state.stamp()),
            n_evaluations: 0,
            n_term_evaluations: 0,
            n_friction_evaluations: 0,
            least_distance: f64::INFINITY,
            longest_step: f64::INFINITY,
            terms,
        })
    }

    /// The model with one more term, supplied by the caller, last in the account. Call it before [`start`](Self::start).
    ///
    /// # Errors
    /// A name that is no column of a table, or that another part of the energy account has.
    ///
    /// # Validation
    /// `val_straight_rod_in_a_trap_is_pressed_to_a_sinh`
    pub fn with(mut self, term: Box<dyn EnergyTerm>) -> Result<Self, RodError> {
        checked_name(&*term, &self.terms)?;
        self.terms.push(term);
        self.parts = RodParts::of(&self.terms);
        self.has_own_terms = true;
        self.newton.loosen_ground();
        self.ledger = self.empty_ledger();
        self.forget();
        Ok(self)
    }

    /// The model with a load at the ends of the open component `component`, attached where they are at `state`. What it takes up is
    /// the channel `load` of the energy account. Call it before [`start`](Self::start).
    ///
    /// # Errors
    /// A load that cannot be, or a component that is closed or missing.
    ///
    /// # Validation
    /// `law_what_is_released_is_work_and_heat`
    pub fn with_load(
        mut self,
        load: EndLoad,
        component: usize,
        state: &RodState,
    ) -> Result<Self, RodError> {
        let chain = *state.chain(component)?;
        if chain.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "a load",
                needed: "an open",
            });
        }
        let own = self.ends.iter().find(|placed| placed.chain == chain);
        let ends = own.map_or_else(Ends::default, |placed| placed.ends);
        let load = Load::attached(load.checked(&ends)?, &chain, state);
        self.centreline = self.centreline.with_load(load.line());
        self.newton = self.newton.with_load(load.line());
        self.load = Some(Box::new(load));
        self.ledger = self.empty_ledger();
        self.forget();
        Ok(self)
    }

    /// Parts of the stored energy, in the order of curves and tables.
    pub fn parts(&self) -> &RodParts {
        &self.parts
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

    /// Names the ends that a cut has made, of several components: [`set_cyclic`](Self::set_cyclic) is about them.
    pub fn set_joined(&mut self, tips: Option<Tips>) {
        self.pairs.set_joined(tips);
        self.forget();
    }

    /// Forgets cached evaluations and patterns.
    fn forget(&mut self) {
        self.at.stamp = None;
        self.frozen = None;
    }
}

impl Model for RodModel {
    type State = RodState;

    fn n_dof(&self) -> usize {
        self.drives().end + usize::from(self.has_clock())
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
        if self.has_clock() {
            to.set_clock(from.clock() + step[step.len() - 1]);
            if let Some(motor) = &self.motor {
                motor.twist(&step[self.drives()], to);
            }
        }
        Ok(())
    }

    /// Largest component of the displacement error in h; rotations count by the arc through which they move the surface.
    fn error_norm(&self, error: &[f64]) -> f64 {
        let (moved, turned) = error.split_at(3 * self.n_vertices);
        let turned = topo_core::max_norm(&turned[..self.n_turns() + self.drives().len()]);
        topo_core::max_norm(moved).max(ROTATION_WEIGHT * turned)
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
        let (x, y) = (from.vertices(), to.vertices());
        let turned = |chain: &Chain| {
            let edges = &mut chain.edges().map(|j| (j, chain.edge_end(j)));
            edges.any(|(a, b)| (x[b] - x[a]).dot(&(y[b] - y[a])) <= 0.0)
        };
        if from.components().iter().any(turned) {
            return Err(Rejection::Domain {
                what: "an edge turned by a right angle in one step",
            });
        }
        if self.has_strands {
            if self.pairs.ensure(from) {
                self.forget();
            }
            certify(from, step, moved, &self.pairs, &mut self.near)?;
        }
        self.evaluate(to)?;
        let total = self.total();
        let rise = total - self.accepted.total - self.external_work(from, step, dt).max(0.0);
        if rise > self.rises.allowed(&self.guards, self.accepted.total) {
            return Err(Rejection::EnergyRise {
                relative: rise / self.accepted.total.abs().max(1e-12),
            });
        }
        Ok(())
    }

    fn accepted(&mut self, from: &RodState, to: &RodState, step: &[f64], dt: f64) {
        let work = self.external_work(from, step, dt);
        self.expected.step();
        self.ledger.add_work(work);
        let total = self.total();
        self.rises.book(total - self.accepted.total - work.max(0.0));
        if self.is_driven {
            self.rises.widen(total);
        }
        self.dissipate(from, to, step, dt);
        self.ledger.set_stored(&self.at.energies);
        self.least_distance = self
            .pairs
            .least_distance()
            .unwrap_or(f64::INFINITY)
            .min(self.least_distance);
        self.remember(to);
        let (_, moved) = largest_displacement(step, self.n_vertices);
        self.longest_step = FORESEEN * self.guards.displacement * dt / moved.max(1e-300);
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn ledger(&self) -> Option<&Ledger> {
        Some(&self.ledger)
    }
}

/// Share of the displacement limit that a step may use up at the speed of the last one.
const FORESEEN: f64 = 0.9;
/// Share of an edge's rotation in the error norm.
const ROTATION_WEIGHT: f64 = 0.1;
