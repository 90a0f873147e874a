//! Energy terms that a program adds to a scene.

use serde::{Serialize, Serializer};
use topo_rod::energy::{EnergyTerm, TermFactory};
use topo_rod::{RodBattery, RodError, RodState};

/// An energy term of the caller's own: how it is made, and a label that tells it apart.
#[derive(Debug, Clone)]
pub struct OwnTerm {
    label: String,
    factory: TermFactory,
}

impl OwnTerm {
    /// A term that `make` makes for the state from which a phase starts; `label` is a word for the term and all its numbers.
    pub fn new(
        label: &str,
        make: impl Fn(&RodState) -> Box<dyn EnergyTerm> + Send + Sync + 'static,
    ) -> Self {
        Self {
            label: label.to_owned(),
            factory: TermFactory::new(make),
        }
    }

    /// Its label.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The battery with the term.
    pub(super) fn added_to(&self, battery: RodBattery) -> Result<RodBattery, RodError> {
        let factory = self.factory.clone();
        battery.with(move |state| factory.make(state))
    }
}

/// Terms of one label are taken for the same.
impl PartialEq for OwnTerm {
    fn eq(&self, other: &Self) -> bool {
        self.label == other.label
    }
}

/// What a term is to a scene: its label.
impl Serialize for OwnTerm {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.label)
    }
}
