//! One knot of the table, read from its TOML file and checked on the way.

use std::borrow::Cow;
use std::path::Path;

use super::chirality::Chirality;
use super::file::{File, FileInvariants};
use serde::Serialize;
use topo_core::Polyline;

use crate::braid::check_word;
use crate::name::{KnotName, is_mirror_image, mirror_name};
use crate::start_file::StartCurve;
use crate::{Invariants, Jones, KnotError, closed_braid, jones_polynomial};

/// One knot type of the table.
///
/// # Validation
/// `invariants_of_the_table`, `jones_polynomials_of_the_table`, `files_with_faults_are_named`.
///
/// # References
/// [livingston2026], [ashton2011]
///
/// [livingston2026]: https://knotinfo.org
/// [ashton2011]: https://doi.org/10.1080/10586458.2011.544581
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct KnotEntry {
    /// Name as in Rolfsen's table; mirror images carry a leading `m`.
    pub name: String,
    /// Braid word whose closure is the knot; may be empty if a start curve is given.
    pub braid: Vec<i32>,
    /// Further words of the same knot, from whose closures tightening starts too.
    pub other_braids: Vec<Vec<i32>>,
    /// Least number of crossings of a diagram; of an unnamed knot, those of the simplest diagram found.
    pub crossing_number: u32,
    /// Whether the mirror image is another knot.
    pub chirality: Chirality,
    /// Alexander polynomial, determinant and signature.
    pub invariants: Invariants,
    /// Jones polynomial; `None` if the file gives none and the knot's own diagram is too wide for it.
    #[serde(skip)]
    pub jones: Option<Jones>,
    /// Other names of the knot, such as `T(3,4)` or `granny`.
    #[serde(skip)]
    pub aliases: Vec<String>,
    /// Published length of the tight knot in units of the tube radius; `None` where none is published.
    pub length_over_radius: Option<f64>,
    /// Key of the publication of the length.
    pub source: Option<String>,
    /// A start curve instead of, or beside, the closed braid.
    pub start: Option<StartCurve>,
}

impl KnotEntry {
    /// Reads an entry from the text of its file; `path` names it, and `load` opens files named in it, relative to its own folder.
    ///
    /// # Errors
    /// [`KnotError::Table`] naming the key and the remedy, and those of `load`.
    ///
    /// # Validation
    /// `files_with_faults_are_named`.
    pub fn parse(
        path: &Path,
        text: &str,
        load: &dyn Fn(&Path) -> Result<String, KnotError>,
    ) -> Result<Self, KnotError> {
        let fault = |problem: String| KnotError::Table {
            path: path.to_owned(),
            problem,
        };
        let file: File = toml::from_str(text).map_err(|e| fault(e.to_string()))?;
        file.check_name(path).map_err(fault)?;
        file.check_invariants().map_err(fault)?;
        file.check_jones().map_err(fault)?;
        file.check_rest().map_err(fault)?;
        let start = match (&file.polygon, &file.fourier) {
            (Some(_), Some(_)) => {
                return Err(fault("give `polygon` or `fourier`, not both".to_owned()));
            }
            (Some(name), None) => Some(StartCurve::polygon(name, &load(name)?)?),
            (None, Some(name)) => Some(StartCurve::fourier(name, &load(name)?)?),
            (None, None) if file.braid.is_empty() => {
                return Err(fault(
                    "give a `braid` word, a `polygon` or a `fourier` file".to_owned(),
                ));
            }
            (None, None) => None,
        };
        let (length_over_radius, source) = match file.reference {
            Some(reference) => (Some(reference.length_over_radius), Some(reference.source)),
            None => (None, None),
        };
        let FileInvariants {
            alexander,
            determinant,
            signature,
            jones,
        } = file.invariants;
        let mut entry = Self {
            name: file.name,
            aliases: file.aliases,
            jones,
            braid: file.braid,
            other_braids: file.other_braids,
            crossing_number: file.crossing_number,
            chirality: file.chirality,
            invariants: Invariants {
                alexander,
                determinant,
                signature,
            },
            length_over_radius,
            source,
            start,
        };
        if entry.jones.is_none() {
            entry.jones = jones_polynomial(entry.start_curve()?.vertices())?;
        }
        Ok(entry)
    }

    /// The entry of a sum: words side by side, and what follows from the factors; `is_amphichiral` as for names.
    ///
    /// # Errors
    /// [`KnotError::SumWithoutWord`] if a factor has no braid word, and those of [`closed_braid`] for a word of too many strands;
    /// [`KnotError::TooComplicated`] for invariants beyond 64 bits.
    pub(super) fn sum(
        name: &KnotName,
        factors: &[Cow<'_, KnotEntry>],
        is_amphichiral: &dyn Fn(&str) -> bool,
    ) -> Result<Self, KnotError> {
        let mut braid: Vec<i32> = Vec::new();
        for factor in factors {
            if factor.braid.is_empty() {
                return Err(KnotError::SumWithoutWord {
                    name: name.to_string(),
                    factor: factor.name.clone(),
                });
            }
            let shift = braid.iter().map(|g| g.abs()).max().unwrap_or(0);
            braid.extend(factor.braid.iter().map(|g| g + shift * g.signum()));
        }
        check_word(&braid)?;
        let n_crossings = braid.len();
        let mut invariants = Invariants::unknot();
        let mut jones = Some(Jones::one());
        for factor in factors {
            let sum = invariants.sum(&factor.invariants);
            invariants = sum.ok_or(KnotError::TooComplicated { n_crossings })?;
            jones = jones
                .zip(factor.jones.as_ref())
                .and_then(|(a, b)| a.product(b));
        }
        let chirality = if name.mirror_with(is_amphichiral) == *name {
            Chirality::Amphichiral
        } else {
            Chirality::Chiral
        };
        Ok(Self {
            name: name.to_string(),
            aliases: Vec::new(),
            jones,
            braid,
            other_braids: Vec::new(),
            crossing_number: factors.iter().map(|factor| factor.crossing_number).sum(),
            chirality,
            invariants,
            length_over_radius: None,
            source: None,
            start: None,
        })
    }

    /// Whether the knot is a sum of others, such as `3_1#4_1`.
    pub fn is_composite(&self) -> bool {
        self.name.contains('#')
    }

    /// Whether it is the unknot, which has no crossing.
    pub fn is_unknot(&self) -> bool {
        self.crossing_number == 0
    }

    /// Whether it is the mirror image of the shape that comes first: the name begins with `m`, or a sum comes after its mirror
    /// image.
    pub fn is_mirror_image(&self) -> bool {
        is_mirror_image(&self.name)
    }

    /// The entry of the mirror image: negated word and signature, names as those of [`mirror_name`](crate::mirror_name).
    pub fn mirror(&self) -> Self {
        Self {
            name: mirror_name(&self.name),
            braid: negated(&self.braid),
            other_braids: self.other_braids.iter().map(|word| negated(word)).collect(),
            invariants: self.invariants.mirror(),
            jones: self.jones.as_ref().map(Jones::mirror),
            aliases: self.aliases.iter().map(|name| mirror_name(name)).collect(),
            start: self.start.as_ref().map(StartCurve::mirror),
            ..self.clone()
        }
    }

    /// A curve of this knot type to start tightening from: the given start curve, else the closed braid.
    ///
    /// # Errors
    /// Those of [`closed_braid`] and of the geometry.
    pub fn start_curve(&self) -> Result<Polyline, KnotError> {
        match &self.start {
            Some(start) => start.curve(),
            None => closed_braid(&self.braid),
        }
    }

    /// Compares the invariants of a curve with those of the entry.
    ///
    /// # Errors
    /// [`KnotError::Mismatch`] naming the invariant, and those of [`Invariants::of`].
    pub fn verify(&self, curve: &Polyline) -> Result<Invariants, KnotError> {
        let found = Invariants::of(curve.vertices())?;
        let mismatch = |what, expected: String, found: String| KnotError::Mismatch {
            knot: self.name.clone(),
            what,
            expected,
            found,
        };
        let expected = &self.invariants;
        if found.alexander != expected.alexander {
            return Err(mismatch(
                "alexander",
                expected.alexander_text(),
                found.alexander_text(),
            ));
        }
        if found.signature != expected.signature {
            return Err(mismatch(
                "signature",
                expected.signature.to_string(),
                found.signature.to_string(),
            ));
        }
        Ok(found)
    }
}

fn negated(word: &[i32]) -> Vec<i32> {
    word.iter().map(|g| -g).collect()
}
