//! The elastic battery: charge (twist, relax closed) → release (cut) → discharge.

pub(crate) mod charge;
pub(crate) mod cut;
pub(crate) mod discharge;
pub(crate) mod hooks;
mod phase;
pub(crate) mod protocol;
pub(crate) mod record;
mod simulation;
mod tips;

use topo_core::Polyline;

use crate::contact::ContactPairs;
use crate::energy::{At, EnergyTerm, TermFactory, terms_of};
use crate::{Accuracy, Ends, Geometry, Guards, RodError, RodModel, RodParameters, RodState, Tube};

/// A tied fibre, ready to be twisted, fused and charged.
#[derive(Debug, Clone)]
pub struct RodBattery {
    parameters: RodParameters,
    accuracy: Accuracy,
    guards: Guards,
    tube: Tube,
    ropelength: f64,
    /// In its own unit.
    centreline: Polyline,
    start: RodState,
    /// Terms supplied by the caller.
    own_terms: Vec<TermFactory>,
}

impl RodBattery {
    /// Farthest displacement of a disturbed start, in h, with room for rounding.
    const FARTHEST: f64 = 0.5 + 1e-9;

    /// Edges at which the ropelength is measured: contact diameters must not depend on the edges of the rod.
    const FINE_EDGES: usize = 800;
    /// Ropelength from which on a curve counts as touching itself.
    const LONGEST_ROPE: f64 = 1e6;
    /// Equal edges: within this relative difference they are left as they are.
    const EDGE_SPREAD: f64 = 1e-9;

    /// A battery on a closed centreline, in any unit.
    ///
    /// The ropelength (length over thickness) is measured on the given curve, so that the tube of the reading does not overlap
    /// itself. The curve is then resampled to the number of edges in `parameters` and scaled as the reading says.
    ///
    /// # Errors
    /// A parameter out of range, or a curve that is open, touches itself or is unusable.
    ///
    /// # Validation
    /// `law_ropelength_is_that_of_the_curve`
    pub fn new(
        parameters: &RodParameters,
        accuracy: &Accuracy,
        guards: Guards,
        centreline: &Polyline,
    ) -> Result<Self, RodError> {
        let parameters = parameters.clone().checked()?;
        let accuracy = accuracy.checked()?;
        if !centreline.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "a battery",
                needed: "a closed",
            });
        }
        let fine = centreline.resampled(Self::FINE_EDGES)?;
        let ropelength = fine.ropelength();
        if !(0.0..Self::LONGEST_ROPE).contains(&ropelength) {
            return Err(RodError::TouchesItself {
                thickness: topo_core::thickness(&fine).tau,
                length: fine.length(),
            });
        }
        let tube = parameters.tube(ropelength)?;
        let edges = centreline.edge_lengths();
        let mean = centreline.length() / edges.len() as f64;
        let is_even = |edge: &f64| (edge / mean - 1.0).abs() <= Self::EDGE_SPREAD;
        let centreline = if edges.len() == parameters.n_edges && edges.iter().all(is_even) {
            centreline.clone()
        } else {
            centreline.resampled(parameters.n_edges)?
        };
        let start = start_of(&centreline, &tube, &parameters)?;
        Ok(Self {
            parameters,
            accuracy,
            guards,
            tube,
            ropelength,
            centreline,
            start,
            own_terms: Vec::new(),
        })
    }

    /// The same battery with one more energy term, supplied by the caller, in every phase: `make` is called with the state from
    /// which a phase starts, closed for the charge and open for the discharge.
    ///
    /// Vertices of the open rod are numbered from the cut, so a term that treats vertices differently must identify them by
    /// their position.
    ///
    /// # Errors
    /// A name that is no column of a table, or that another part of the energy account has.
    ///
    /// # Validation
    /// `val_circle_in_a_trap_shrinks_as_its_closed_form`, `val_cut_circle_in_a_weak_trap`
    pub fn with(
        mut self,
        make: impl Fn(&RodState) -> Box<dyn EnergyTerm> + Send + Sync + 'static,
    ) -> Result<Self, RodError> {
        self.own_terms.push(TermFactory::new(make));
        self.model(&self.start, Ends::default())?;
        Ok(self)
    }

    /// The model of a phase that starts from `state`.
    pub(crate) fn model(&self, state: &RodState, ends: Ends) -> Result<RodModel, RodError> {
        let (accuracy, guards) = (&self.accuracy, self.guards);
        let model = RodModel::new(&self.parameters, &self.tube, accuracy, guards, ends, state)?;
        let mut own = self.own_terms.iter();
        own.try_fold(model, |model, term| model.with(term.make(state)))
    }

    /// Elastic energy per area and length at each vertex of `state`, in E_b: that of bend, twist, stretch and further elastic terms.
    ///
    /// Multiplied by A it is the density in E_b h² that the figures show. Multiplied by the arclengths of the vertices and
    /// summed, it is the elastic energy.
    ///
    /// # Validation
    /// `val_density_of_a_bent_twisted_stretched_coil`, `law_density_sums_to_the_elastic_energy`
    pub fn energy_density(&self, state: &RodState) -> Vec<f64> {
        let mut terms = terms_of(&self.parameters, &self.tube);
        terms.extend(self.own_terms.iter().map(|term| term.make(state)));
        let range = self.tube.contact_diameter.max(self.tube.friction_range);
        let mut pairs = ContactPairs::new(range, self.accuracy.skin);
        if !self.own_terms.is_empty() {
            pairs.set_cyclic(state.is_closed());
            pairs.update(state);
        }
        let at = At {
            state,
            geometry: &Geometry::new(state),
            pairs: &pairs,
        };
        crate::density::energy_density(&terms, at)
    }

    /// The same battery started from `curve`: its [`centreline`](Self::centreline) with small displacements, like the
    /// imperfections of a real fibre. The tube stays that of the undisturbed curve.
    ///
    /// # Errors
    /// A curve with another number of vertices, or one that is anywhere more than h/2 from the undisturbed one.
    pub fn disturbed(&self, curve: &Polyline) -> Result<Self, RodError> {
        let h = self.centreline.length() / self.tube.start_length;
        let pairs = self.centreline.vertices().iter().zip(curve.vertices());
        let moved = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / h;
        let is_alike = curve.is_closed() && curve.n_vertices() == self.centreline.n_vertices();
        if !is_alike || moved > Self::FARTHEST {
            return Err(RodError::Disturbance {
                moved: if is_alike { moved } else { f64::INFINITY },
                most: Self::FARTHEST,
            });
        }
        Ok(Self {
            centreline: curve.clone(),
            start: start_of(curve, &self.tube, &self.parameters)?,
            ..self.clone()
        })
    }

    /// The same battery started from the mirror image of its curve; the twist is not mirrored.
    ///
    /// # Errors
    /// As [`new`](Self::new); none in practice, since the curve itself was accepted.
    pub fn mirrored(&self) -> Result<Self, RodError> {
        let centreline = self.centreline.mirrored();
        Ok(Self {
            start: start_of(&centreline, &self.tube, &self.parameters)?,
            centreline,
            ..self.clone()
        })
    }

    /// The start curve of as many equal edges as the rod has, in the unit of the curve that was given.
    pub fn centreline(&self) -> &Polyline {
        &self.centreline
    }

    /// Length over thickness of the curve that was given.
    pub fn ropelength(&self) -> f64 {
        self.ropelength
    }

    /// The state before charging: the twist is tied in, nothing has relaxed.
    pub fn start(&self) -> &RodState {
        &self.start
    }

    /// Lengths after the reading was applied.
    pub fn tube(&self) -> Tube {
        self.tube
    }

    /// Parameters of the rod.
    pub fn parameters(&self) -> &RodParameters {
        &self.parameters
    }

    /// The accuracy settings.
    pub fn accuracy(&self) -> &Accuracy {
        &self.accuracy
    }
}

/// The rod on a centreline that is scaled as the reading says.
fn start_of(
    centreline: &Polyline,
    tube: &Tube,
    parameters: &RodParameters,
) -> Result<RodState, RodError> {
    let curve = centreline.scaled(tube.start_length / centreline.length())?;
    RodState::new(&curve, tube.length, parameters.twist.unwrap_or(0.0))
}

#[cfg(test)]
mod tests;
