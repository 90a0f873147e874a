//! What a curve was found to be.

use serde::{Deserialize, Serialize};

use super::known::Candidate;
use crate::name::{self, KnotName, UNKNOT};
use crate::table::UNKNOWN;
use crate::{Invariants, Jones};

/// Fewest crossings of a knot other than the unknot whose Alexander polynomial is 1.
pub(super) const LEAST_TRIVIAL_ALEXANDER: usize = 11;

/// Which of a knot and its mirror image a curve is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Handedness {
    /// As in the table; for the trefoil, right-handed.
    Tabulated,
    /// The mirror image of the knot in the table.
    Mirrored,
    /// The knot equals its mirror image.
    Amphichiral,
    /// The invariants do not distinguish the knot from its mirror image.
    Undecided,
}

impl Handedness {
    /// The hand that all candidates have in common, if they are of one type.
    pub(super) fn of(list: &[Candidate]) -> Self {
        match list {
            [only] if only.name == only.mirror => Self::Amphichiral,
            [only] if only.name < only.mirror => Self::Tabulated,
            [_] => Self::Mirrored,
            _ => Self::Undecided,
        }
    }
}

/// Type of a closed curve, as far as Alexander polynomial, determinant, signature, Jones and Kauffman polynomial determine it.
///
/// These separate all knots of at most ten crossings, sums included, from each other and from their mirror images; only the
/// hand of 10_71 stays open. Beyond, a name means that nothing contradicts it: see [`is_certain`](Self::is_certain).
///
/// # Validation
/// `all_types_to_ten_crossings_are_distinguished`, `names_the_table_and_its_mirrors`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub struct KnotType {
    /// What fits; empty if nothing known does.
    pub(super) candidates: Vec<Candidate>,
    /// Which of the knot and its mirror image it is; undecided if several types fit, or none.
    pub handedness: Handedness,
    /// The invariants found.
    pub invariants: Invariants,
    /// Jones polynomial, if it was needed to decide and its diagram was not too wide.
    pub jones: Option<Jones>,
    /// Crossings of the simplest diagram that was found.
    pub n_crossings: usize,
    /// Crossing number up to which every type was compared.
    pub(super) certain_to: u32,
}

impl KnotType {
    pub(super) fn unknot(n_crossings: usize) -> Self {
        let name = || KnotName::parse(UNKNOT);
        Self {
            candidates: vec![Candidate {
                name: name(),
                mirror: name(),
            }],
            handedness: Handedness::Amphichiral,
            invariants: Invariants::unknot(),
            jones: None,
            n_crossings,
            certain_to: LEAST_TRIVIAL_ALEXANDER as u32 - 1,
        }
    }

    /// The names that fit, each with its hand written out: `m3_1` is the mirror image of `3_1`, `0_1` the unknot; none if nothing known
    /// fits.
    pub fn candidates(&self) -> impl Iterator<Item = &KnotName> {
        self.candidates.iter().map(|candidate| &candidate.name)
    }

    /// The name with its hand, if only one fits.
    pub fn name(&self) -> Option<&KnotName> {
        match &self.candidates[..] {
            [only] => Some(&only.name),
            _ => None,
        }
    }

    /// The types that fit, a type and its mirror image under one name.
    pub fn types(&self) -> Vec<&KnotName> {
        let mut types: Vec<&KnotName> = Vec::new();
        for candidate in &self.candidates {
            if !types.contains(&candidate.unsided()) {
                types.push(candidate.unsided());
            }
        }
        types
    }

    /// Whether the curve was found to be the unknot.
    pub fn is_unknot(&self) -> bool {
        self.candidates().any(|name| name.to_string() == UNKNOT)
    }

    /// Whether the type is proved: only one fits, and the diagram has so few crossings that every type it could be was compared. The
    /// hand is too, unless [`handedness`](Self::handedness) is undecided, as that of 10_71.
    pub fn is_certain(&self) -> bool {
        self.types().len() == 1 && self.is_exhaustive()
    }

    /// Crossing number up to which every type was compared: with a diagram of no more crossings, a name that is the only one is certain.
    pub fn certain_to(&self) -> u32 {
        self.certain_to
    }

    fn is_exhaustive(&self) -> bool {
        self.n_crossings <= self.certain_to as usize
    }

    /// The name with its hand, `m3_1` for the mirror image of `3_1`; several that fit, separated by `|`; `unknown(...)` with the
    /// Alexander polynomial if none fits.
    ///
    /// # Validation
    /// `names_the_table_and_its_mirrors`
    pub fn label(&self) -> String {
        if self.candidates.is_empty() {
            return format!("{UNKNOWN}{})", self.invariants.alexander_text());
        }
        self.joined("|")
    }

    fn joined(&self, joint: &str) -> String {
        let names: Vec<String> = self.candidates().map(KnotName::to_string).collect();
        names.join(joint)
    }

    /// Whether the curve may be the knot `name`, its hand included: nothing that was found contradicts it.
    pub fn fits(&self, name: &str) -> bool {
        let is_amphichiral = |knot: &str| {
            let alone = |name: &KnotName| !name.is_sum() && name.to_string() == knot;
            let known = |c: &Candidate| c.name == c.mirror && alone(&c.name);
            name::is_amphichiral(knot) || self.candidates.iter().any(known)
        };
        let name = KnotName::parse_with(name, &is_amphichiral);
        self.candidates().any(|own| *own == name)
    }

    /// The finding as a sentence: a name with its hand and `(certain)`, `consistent with ...` where the diagram was too large for that,
    /// `one of 8_21, 3_1#4_1` where several fit, or `unknown` with the invariants.
    pub fn describe(&self) -> String {
        let types = self.types();
        let what = match (&types[..], self.handedness) {
            ([], _) => {
                let jones = self.jones.as_ref().map_or_else(String::new, |jones| {
                    format!(", Jones polynomial {}", jones.text())
                });
                return format!(
                    "unknown: no knot of the table nor sum of two or three has Alexander polynomial {}, signature {}{jones}",
                    self.invariants.alexander_text(),
                    self.invariants.signature
                );
            }
            ([name], _) if self.is_unknot() => format!("{name}, the unknot"),
            ([name], Handedness::Tabulated) => format!("{name}, as in the table"),
            ([name], Handedness::Mirrored) => {
                format!("{}, the mirror image of {name}", self.label())
            }
            ([name], Handedness::Amphichiral) => format!("{name}, equal to its mirror image"),
            ([name], Handedness::Undecided) => {
                format!("{name} or its mirror image, handedness unknown")
            }
            _ => self.joined(", "),
        };
        match (self.is_exhaustive(), types.len()) {
            (true, 1) => format!("{what} (certain)"),
            (true, _) => format!("one of {what}"),
            (false, 1) => format!("consistent with {what}"),
            (false, _) => format!("consistent with each of {what}"),
        }
    }
}
