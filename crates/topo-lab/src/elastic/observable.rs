//! Quantities that a program adds to the tables of a scene.

use std::fmt;
use std::sync::Arc;

use serde::{Serialize, Serializer};
use topo_analysis::{Further, SweepRow, columns};
use topo_rod::RodSample;

use super::record::SeriesRow;
use crate::LabError;

/// A quantity of the caller's own, measured at every output time: a column of its name in the tables.
#[derive(Clone)]
pub struct Observable {
    name: String,
    measure: Arc<Measure>,
}

type Measure = dyn Fn(&RodSample) -> f64 + Send + Sync;

impl Observable {
    /// The quantity `measure` under a name that tables do not have yet.
    ///
    /// # Errors
    /// A name that is no column's (lower case letters, digits and `_`), or that a column of the tables has.
    pub(super) fn new(
        name: &str,
        measure: impl Fn(&RodSample) -> f64 + Send + Sync + 'static,
    ) -> Result<Self, LabError> {
        let wrong = |reason: &str| {
            Err(LabError::Observable {
                name: name.to_owned(),
                reason: reason.to_owned(),
            })
        };
        let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(is_plain) {
            return wrong("use lower case letters, digits and _, as tables do");
        }
        let taken = columns(&SweepRow::default())?
            .into_iter()
            .chain(columns(&SeriesRow::default())?);
        if taken.into_iter().any(|column| column == name) {
            return wrong("the tables have a column of that name");
        }
        Ok(Self {
            name: name.to_owned(),
            measure: Arc::new(measure),
        })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Energies of further terms, and what the observables measure, of a sample.
pub(super) fn further(sample: &RodSample, observables: &[Observable]) -> Further {
    let energies = sample
        .stored
        .further()
        .map(|(name, energy)| (name.to_owned(), energy));
    let measured = observables
        .iter()
        .map(|o| (o.name.clone(), (o.measure)(sample)));
    energies.chain(measured).collect()
}

impl fmt::Debug for Observable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Observable").field(&self.name).finish()
    }
}

/// Quantities of one name are taken for the same.
impl PartialEq for Observable {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// What a quantity is to a scene: its name.
impl Serialize for Observable {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.name)
    }
}
