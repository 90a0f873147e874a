//! The elastic battery: charge (twist, relax closed) → release (cut) → discharge.

pub(crate) mod charge;
mod curves;
pub(crate) mod cut;
pub(crate) mod discharge;
pub(crate) mod hooks;
pub(crate) mod links;
mod phase;
pub(crate) mod protocol;
pub(crate) mod pull;
pub(crate) mod record;
mod simulation;
mod tips;

use topo_core::Polyline;

use self::curves::total_length;
use crate::contact::ContactPairs;
use crate::energy::{At, EnergyTerm, TermFactory, terms_of};
use crate::{
    Accuracy, Criterion, Geometry, Guards, RestShape, RodEnds, RodError, RodModel, RodParameters,
    RodState, Tube,
};

/// A tied fibre, or several, ready to be twisted, fused and charged.
#[derive(Debug, Clone)]
pub struct RodBattery {
    parameters: RodParameters,
    accuracy: Accuracy,
    guards: Guards,
    tube: Tube,
    ropelength: f64,
    /// One for each component, in their own unit.
    centrelines: Vec<Polyline>,
    start: RodState,
    /// The natural shape, if it is not straight and untwisted.
    rest: Option<RestShape>,
    /// Terms supplied by the caller.
    own_terms: Vec<TermFactory>,
}

impl RodBattery {
    /// Farthest displacement of a disturbed start, in h, with room for rounding.
    const FARTHEST: f64 = 0.5 + 1e-9;

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
        Self::link(
            parameters,
            accuracy,
            guards,
            std::slice::from_ref(centreline),
        )
    }

    /// A battery on the closed centrelines of a link, in any common unit and where they are.
    ///
    /// Slenderness and ropelength are those of all components together: L is the natural length of the whole link, which the
    /// components share in proportion to their curves, and the thickness is that of the thickest tubes that overlap nowhere. So are
    /// the edges of `parameters`; the twist density is the same in all. Of one curve it is [`new`](Self::new).
    ///
    /// # Errors
    /// A parameter out of range, no curve, or curves that are open, touch themselves or each other or are unusable.
    ///
    /// # Validation
    /// `val_tight_chains_of_rings_have_their_ropelength`
    pub fn link(
        parameters: &RodParameters,
        accuracy: &Accuracy,
        guards: Guards,
        centrelines: &[Polyline],
    ) -> Result<Self, RodError> {
        if !centrelines.iter().all(Polyline::is_closed) {
            return Err(RodError::WrongTopology {
                operation: "a battery",
                needed: "a closed",
            });
        }
        Self::along(parameters, accuracy, guards, centrelines)
    }

    /// A fibre tied along an open centreline, in any unit, whose ends are [pulled](Self::pull) instead of fused.
    ///
    /// As [`new`](Self::new): slenderness and thickness are those of the whole curve. A curve as thick as it is long, such as a straight
    /// one, counts as one of the least ropelength there is, 6.
    ///
    /// # Errors
    /// A parameter out of range, or a curve that is closed, touches itself or is unusable.
    pub fn open(
        parameters: &RodParameters,
        accuracy: &Accuracy,
        guards: Guards,
        centreline: &Polyline,
    ) -> Result<Self, RodError> {
        if centreline.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "an open tangle",
                needed: "an open",
            });
        }
        Self::along(
            parameters,
            accuracy,
            guards,
            std::slice::from_ref(centreline),
        )
    }

    fn along(
        parameters: &RodParameters,
        accuracy: &Accuracy,
        guards: Guards,
        centrelines: &[Polyline],
    ) -> Result<Self, RodError> {
        let parameters = parameters.clone().checked()?;
        let accuracy = accuracy.checked()?;
        let is_open = centrelines.iter().any(|curve| !curve.is_closed());
        let least = if is_open { LEAST_ROPELENGTH } else { 0.0 };
        let ropelength = curves::ropelength(centrelines)?.max(least);
        let tube = parameters.tube(ropelength)?;
        let centrelines = curves::evened(centrelines, parameters.n_edges)?;
        let start = start_of(&centrelines, &tube, &parameters)?;
        Ok(Self {
            parameters,
            accuracy,
            guards,
            tube,
            ropelength,
            centrelines,
            start,
            rest: None,
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
        self.model(&self.start, RodEnds::default())?;
        Ok(self)
    }

    /// The same battery of rods that are curved or twisted at rest: natural curvature (κ_1, κ_2) in 1/h and twist in radians per h of
    /// component c at the arclength s in h, as in [`RodState::with_rest`] of the [`start`](Self::start). The tied-in twist is
    /// what the rods have, not what they have in excess.
    ///
    /// # Errors
    /// A number that is not finite.
    pub fn with_rest(
        self,
        curvature: impl Fn(usize, f64) -> [f64; 2],
        twist: impl Fn(usize, f64) -> f64,
    ) -> Result<Self, RodError> {
        let start = self.start.clone().with_rest(curvature, twist)?;
        Ok(Self {
            rest: start.rest().cloned(),
            start,
            ..self
        })
    }

    /// A start with the natural shape of this battery.
    fn resting(&self, start: RodState) -> RodState {
        match &self.rest {
            Some(shape) => start.with_shape(shape.clone()),
            None => start,
        }
    }

    /// The model of a phase that starts from `state`.
    pub(crate) fn model(&self, state: &RodState, ends: RodEnds) -> Result<RodModel, RodError> {
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
        self.measure(Criterion::Energy, state)
    }

    /// The measure of a criterion at each vertex of `state`, in its [unit](Criterion::unit), not smoothed; that of
    /// [`Criterion::Energy`] is the [`energy_density`](Self::energy_density).
    ///
    /// # Validation
    /// `val_stresses_of_a_bent_twisted_stretched_coil`
    pub fn measure(&self, criterion: Criterion, state: &RodState) -> Vec<f64> {
        let mut terms = terms_of(&self.parameters, &self.tube, state);
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
        criterion.measure(&self.parameters, &terms, at)
    }

    /// The same battery started from `curve`: its [`centreline`](Self::centreline) with small displacements, like the
    /// imperfections of a real fibre. The tube stays that of the undisturbed curve.
    ///
    /// # Errors
    /// A curve with another number of vertices, or one that is anywhere more than h/2 from the undisturbed one.
    pub fn disturbed(&self, curve: &Polyline) -> Result<Self, RodError> {
        self.disturbed_link(std::slice::from_ref(curve))
    }

    /// As [`disturbed`](Self::disturbed), with a curve for each component.
    ///
    /// # Errors
    /// Another number of curves; those of [`disturbed`](Self::disturbed).
    pub fn disturbed_link(&self, curves: &[Polyline]) -> Result<Self, RodError> {
        let h = total_length(&self.centrelines) / self.tube.start_length;
        let both = || self.centrelines.iter().zip(curves);
        let pairs = both().flat_map(|(own, curve)| own.vertices().iter().zip(curve.vertices()));
        let moved = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / h;
        let is_alike = self.centrelines.len() == curves.len()
            && both().all(|(own, curve)| {
                curve.is_closed() == own.is_closed() && curve.n_vertices() == own.n_vertices()
            });
        if !is_alike || moved > Self::FARTHEST {
            return Err(RodError::Disturbance {
                moved: if is_alike { moved } else { f64::INFINITY },
                most: Self::FARTHEST,
            });
        }
        Ok(Self {
            centrelines: curves.to_vec(),
            start: self.resting(start_of(curves, &self.tube, &self.parameters)?),
            ..self.clone()
        })
    }

    /// The same battery started from the mirror image of its curve.
    ///
    /// The rods are the same: neither their twist nor their natural shape is mirrored. It is the mirror image of this battery with the
    /// opposite twist and the [mirrored](RestShape::mirrored) natural shape.
    ///
    /// # Validation
    /// `law_fibres_with_a_natural_shape_are_mirrored_with_it`
    ///
    /// # Errors
    /// As [`new`](Self::new); none in practice, since the curve itself was accepted.
    pub fn mirrored(&self) -> Result<Self, RodError> {
        let centrelines: Vec<Polyline> = self.centrelines.iter().map(Polyline::mirrored).collect();
        Ok(Self {
            start: self.resting(start_of(&centrelines, &self.tube, &self.parameters)?),
            centrelines,
            ..self.clone()
        })
    }

    /// The start curve of as many equal edges as the rod has, in the unit of the curve that was given; that of the first component of a
    /// link.
    pub fn centreline(&self) -> &Polyline {
        &self.centrelines[0]
    }

    /// The start curve of each component, in the unit of the curves that were given.
    pub fn centrelines(&self) -> &[Polyline] {
        &self.centrelines
    }

    /// The same battery started from any state of as many edges.
    #[cfg(test)]
    pub(crate) fn starting_from(self, start: RodState) -> Self {
        Self { start, ..self }
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

/// Length over radius of the shortest thick ropes: below that of a circle, 2π.
const LEAST_ROPELENGTH: f64 = 6.0;

/// The rods on centrelines that are scaled as the reading says.
fn start_of(
    centrelines: &[Polyline],
    tube: &Tube,
    parameters: &RodParameters,
) -> Result<RodState, RodError> {
    let (length, twist) = (total_length(centrelines), parameters.twist.unwrap_or(0.0));
    let of = |centreline: &Polyline| {
        let curve = centreline.scaled(tube.start_length / length)?;
        let natural = match centrelines {
            [_] => tube.length,
            _ => tube.length * (centreline.length() / length),
        };
        RodState::new(&curve, natural, twist)
    };
    let rods: Vec<RodState> = centrelines
        .iter()
        .map(of)
        .collect::<Result<_, RodError>>()?;
    RodState::link(&rods)
}

#[cfg(test)]
mod tests;
