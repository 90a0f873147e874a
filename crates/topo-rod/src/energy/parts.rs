//! The parts of the stored energy: what curves, tables, stop conditions and discharge times follow.

use std::ops::Deref;
use std::sync::Arc;

use serde::{Deserialize, Serialize, Serializer};
use topo_core::Ledger;

use super::EnergyTerm;

/// Whether the energy of a term counts as stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EnergyKind {
    /// It is stored by the charge and released by the discharge: it counts for the energy density, the end of a discharge and its
    /// times.
    Elastic,
    /// It is the penalty of a constraint, as that of contact: it is in the energy account, but not part of what is released.
    Constraint,
}

/// A part of the stored energy: one term.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct EnergyPart {
    /// Name of the term.
    pub name: &'static str,
    /// Whether its energy counts as stored.
    pub kind: EnergyKind,
}

/// Parts that every curve and table has, in their order; a rod without one of them reports 0.
const STANDARD: [EnergyPart; 4] = {
    const fn elastic(name: &'static str) -> EnergyPart {
        EnergyPart {
            name,
            kind: EnergyKind::Elastic,
        }
    }
    let contact = EnergyPart {
        name: "contact",
        kind: EnergyKind::Constraint,
    };
    [
        elastic("bend"),
        elastic("twist"),
        elastic("stretch"),
        contact,
    ]
};

/// The parts of a rod's stored energy, in the order of curves and tables: bend, twist, stretch and contact, then any further term.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct RodParts(#[serde(serialize_with = "listed")] Arc<[EnergyPart]>);

fn listed<S: Serializer>(parts: &Arc<[EnergyPart]>, to: S) -> Result<S::Ok, S::Error> {
    parts[..].serialize(to)
}

impl Default for RodParts {
    fn default() -> Self {
        Self(STANDARD.into())
    }
}

impl Deref for RodParts {
    type Target = [EnergyPart];

    fn deref(&self) -> &[EnergyPart] {
        &self.0
    }
}

impl RodParts {
    /// The parts of a rod with these terms.
    pub(crate) fn of(terms: &[Box<dyn EnergyTerm>]) -> Self {
        let mut parts = STANDARD.to_vec();
        for term in terms {
            if parts.iter().all(|part| part.name != term.name()) {
                parts.push(EnergyPart {
                    name: term.name(),
                    kind: term.kind(),
                });
            }
        }
        Self(parts.into())
    }

    /// Names of all parts.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.iter().map(|part| part.name)
    }

    /// Names of the elastic parts: what is released.
    pub fn elastic(&self) -> Vec<&'static str> {
        let elastic = self.iter().filter(|p| p.kind == EnergyKind::Elastic);
        elastic.map(|part| part.name).collect()
    }

    /// Elastic energy in the account of a rod with these parts.
    pub(crate) fn elastic_of(&self, books: &Ledger) -> f64 {
        let constraints = self.iter().filter(|p| p.kind == EnergyKind::Constraint);
        let held: f64 = constraints
            .map(|part| books.stored_in(part.name).unwrap_or(0.0))
            .sum();
        books.stored_total() - held
    }
}

/// Stored energy by part. Serialised as numbers alone, in the order of the parts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StoredEnergy {
    #[serde(skip)]
    parts: RodParts,
    pub(crate) energies: Vec<f64>,
}

impl Deref for StoredEnergy {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.energies
    }
}

impl StoredEnergy {
    /// As many energies as parts.
    pub(crate) fn new(parts: RodParts, energies: Vec<f64>) -> Self {
        debug_assert_eq!(parts.len(), energies.len());
        Self { parts, energies }
    }

    /// Every part with its energy.
    pub fn by_part(&self) -> impl Iterator<Item = (EnergyPart, f64)> + '_ {
        self.parts
            .iter()
            .copied()
            .zip(self.energies.iter().copied())
    }

    /// Energy of the part `name`; 0 for a term that the rod does not have.
    pub fn of(&self, name: &str) -> f64 {
        let mut parts = self.by_part();
        parts.find(|(p, _)| p.name == name).map_or(0.0, |(_, e)| e)
    }

    /// Sum of the elastic parts.
    pub fn elastic(&self) -> f64 {
        let elastic = self
            .by_part()
            .filter(|(p, _)| p.kind == EnergyKind::Elastic);
        elastic.map(|(_, energy)| energy).sum()
    }

    /// Terms besides bend, twist, stretch and contact.
    pub fn further(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        let further = self.by_part().skip(STANDARD.len());
        further.map(|(part, energy)| (part.name, energy))
    }
}
