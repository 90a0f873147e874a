//! Which terms a rod has: those of this crate, and those of the caller.

use std::fmt;
use std::sync::Arc;

use super::{Bend, ContactEnergy, CurvedBend, CurvedTwist, EnergyTerm, RodParts, Stretch, Twist};
use crate::model::CHANNELS;
use crate::{RodError, RodParameters, RodState, Tube};

/// The terms that the parameters name, in the order in which their energies are summed. A further term of this crate is one
/// line here.
pub(crate) fn terms_of(
    rod: &RodParameters,
    tube: &Tube,
    state: &RodState,
) -> Vec<Box<dyn EnergyTerm>> {
    fn listed<T: EnergyTerm + 'static>(term: Option<T>) -> Option<Box<dyn EnergyTerm>> {
        term.map(|term| Box::new(term) as Box<dyn EnergyTerm>)
    }
    let curved = state.rest().is_some();
    let terms = [
        if curved {
            listed(Some(CurvedBend))
        } else {
            listed(Some(Bend))
        },
        listed(Some(Stretch::of(rod))),
        if curved {
            listed(Twist::of(rod).map(CurvedTwist))
        } else {
            listed(Twist::of(rod))
        },
        listed(ContactEnergy::of(rod, tube)),
    ];
    terms.into_iter().flatten().collect()
}

/// Checks the name of a caller's term that is added to `terms`.
///
/// # Errors
/// A name that is no column of a table, or that another part of the energy account has.
pub(crate) fn checked_name(
    term: &dyn EnergyTerm,
    terms: &[Box<dyn EnergyTerm>],
) -> Result<(), RodError> {
    let name = term.name();
    let wrong = |reason| Err(RodError::Term { name, reason });
    let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(is_plain) {
        return wrong("use lower case letters, digits and _, as tables do");
    }
    let parts = RodParts::of(terms);
    if parts.names().chain(CHANNELS).any(|taken| taken == name) {
        return wrong("another part of the energy account has that name");
    }
    Ok(())
}

/// How a term of the caller is made for the state from which a phase of a battery starts.
///
/// Cloned and shared between threads with the battery that has it.
#[derive(Clone)]
pub struct TermFactory(Arc<Make>);

type Make = dyn Fn(&RodState) -> Box<dyn EnergyTerm> + Send + Sync;

impl TermFactory {
    /// A factory that calls `make`.
    pub fn new(make: impl Fn(&RodState) -> Box<dyn EnergyTerm> + Send + Sync + 'static) -> Self {
        Self(Arc::new(make))
    }

    /// The term for a phase that starts from `state`.
    pub fn make(&self, state: &RodState) -> Box<dyn EnergyTerm> {
        (self.0)(state)
    }
}

impl fmt::Debug for TermFactory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("TermFactory")
    }
}
