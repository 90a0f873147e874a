//! One knot of the table, read from its TOML file and checked on the way.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use topo_core::Polyline;

use crate::braid::check_word;
use crate::name::{KnotName, is_mirror_image, mirror_name};
use crate::start_file::StartCurve;
use crate::{
    Invariants, Jones, KnotError, KnotTable, KnotType, V, closed_braid, identify, jones_polynomial,
};

/// Most vertices of a start curve: many more than any level of the tightening has.
const LONGEST_START: usize = 4000;

/// Largest signature, power or number of coefficients of a file: far beyond any knot whose invariants can be computed.
const LARGEST_NUMBER: u32 = 10_000;

/// Whether a knot differs from its mirror image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Chirality {
    /// The mirror image is another knot.
    Chiral,
    /// The mirror image is the same knot.
    Amphichiral,
}

/// One knot type of the table.
///
/// # Validation
/// `invariants_of_the_table`, `jones_polynomials_of_the_table`, `files_with_faults_are_named`.
///
/// # References
/// `livingston2026`, `ashton2011`
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    #[serde(default)]
    aliases: Vec<String>,
    crossing_number: u32,
    chirality: Chirality,
    #[serde(default)]
    braid: Vec<i32>,
    #[serde(default)]
    other_braids: Vec<Vec<i32>>,
    polygon: Option<PathBuf>,
    fourier: Option<PathBuf>,
    invariants: FileInvariants,
    reference: Option<FileReference>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileInvariants {
    alexander: Vec<i64>,
    determinant: u64,
    signature: i32,
    jones: Option<Jones>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileReference {
    length_over_radius: f64,
    source: String,
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
        let FileInvariants {
            alexander,
            determinant,
            signature,
            jones,
        } = file.invariants;
        let canonical = KnotName::parse(&file.name).to_string();
        if file.name != canonical || file.name.starts_with('m') && !file.name.contains('#') {
            return Err(fault(format!(
                "`name` = `{}`: a leading `m` is that of a mirror image, and factors stand in the order of the table; `{}` would do",
                file.name,
                canonical.trim_start_matches('m')
            )));
        }
        if path
            .file_stem()
            .is_none_or(|stem| stem != file.name.as_str())
        {
            return Err(fault(format!(
                "`name` is `{}`; it must equal the file's name",
                file.name
            )));
        }
        // Any sum of numbers of 64 bits fits.
        let wide = || alexander.iter().map(|c| i128::from(*c));
        let at_minus_one: i128 = wide()
            .enumerate()
            .map(|(k, c)| if k % 2 == 0 { c } else { -c })
            .sum();
        if alexander.iter().ne(alexander.iter().rev())
            || alexander.first().is_none_or(|c| *c <= 0)
            || wide().sum::<i128>().abs() != 1
        {
            return Err(fault(format!(
                "`invariants.alexander` = {alexander:?} is not a knot's: give all coefficients, symmetric, the first positive, with sum 1 or -1"
            )));
        }
        if file.crossing_number == 0 && alexander != [1] {
            return Err(fault(format!(
                "`crossing_number` = 0 is the unknot's, whose `invariants.alexander` is [1] and not {alexander:?}"
            )));
        }
        if at_minus_one.unsigned_abs() != u128::from(determinant) {
            return Err(fault(format!(
                "`invariants.determinant` = {determinant} is not |Delta(-1)| = {} of `alexander`",
                at_minus_one.abs()
            )));
        }
        if signature.unsigned_abs() > LARGEST_NUMBER {
            return Err(fault(format!(
                "`invariants.signature` = {signature} is beyond {LARGEST_NUMBER}"
            )));
        }
        if signature % 2 != 0 {
            return Err(fault(format!(
                "`invariants.signature` = {signature} is odd; a knot's is even"
            )));
        }
        if file.chirality == Chirality::Amphichiral && signature != 0 {
            return Err(fault(format!(
                "`invariants.signature` = {signature} contradicts `chirality` = \"amphichiral\"; it must be 0"
            )));
        }
        if let Some(jones) = &jones
            && (jones.lowest.unsigned_abs() > LARGEST_NUMBER
                || !(1..=LARGEST_NUMBER as usize).contains(&jones.coefficients.len()))
        {
            return Err(fault(format!(
                "`invariants.jones` has {} coefficients from power {} on: 1 to {LARGEST_NUMBER}, and powers up to it, are possible",
                jones.coefficients.len(),
                jones.lowest
            )));
        }
        if let Some(jones) = &jones
            && !jones.fits_a_knot(determinant)
        {
            return Err(fault(format!(
                "`invariants.jones` = {} is not a knot's of determinant {determinant}: V(1) = 1, V'(1) = 0 and |V(-1)| = determinant must hold",
                jones.text()
            )));
        }
        if file.name.is_empty() || file.name.contains(['/', '\\', '|', ' ']) {
            return Err(fault(format!(
                "`name` = `{}` must have no blank, bar or slash",
                file.name
            )));
        }
        if let Some(reference) = &file.reference
            && !(reference.length_over_radius.is_finite() && reference.length_over_radius > 0.0)
        {
            return Err(fault(format!(
                "`reference.length_over_radius` = {} must be positive",
                reference.length_over_radius
            )));
        }
        if !file.braid.is_empty() {
            check_word(&file.braid)
                .map_err(|e| fault(format!("`braid` = {:?}: {e}", file.braid)))?;
        }
        for word in &file.other_braids {
            check_word(word).map_err(|e| fault(format!("`other_braids`: {word:?}: {e}")))?;
        }
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

    /// An entry for the closure of a braid word.
    ///
    /// A knot that is named for certain keeps its entry of the table, and the word becomes one more start; any other is called
    /// `unnamed` and has the invariants of its own closure.
    ///
    /// # Errors
    /// As [`closed_braid`], and those of [`identify`](crate::identify).
    ///
    /// # Validation
    /// `words_and_curves_become_entries`.
    pub fn of_braid(word: &[i32], table: &KnotTable) -> Result<Self, KnotError> {
        let curve = closed_braid(word)?;
        let (mut entry, known) = Self::of_type(&identify(curve.vertices(), table)?, table)?;
        if !known {
            entry.braid = word.to_vec();
        } else if entry.braid != word {
            entry.other_braids.push(word.to_vec());
        }
        Ok(entry)
    }

    /// An entry for a closed curve, as [`of_braid`](Self::of_braid) for a word; a curve of many vertices is resampled.
    ///
    /// # Errors
    /// [`KnotError::Curve`] for vertices that coincide, [`KnotError::Mismatch`] if resampling to 4000 vertices changes the type,
    /// and those of [`identify`](crate::identify).
    pub fn of_curve(vertices: &[V], table: &KnotTable) -> Result<Self, KnotError> {
        let (mut entry, known) = Self::of_type(&identify(vertices, table)?, table)?;
        let mut curve = Polyline::new(vertices.to_vec(), true)?;
        if vertices.len() > LONGEST_START {
            curve = curve.resampled(LONGEST_START)?;
            entry.verify(&curve)?;
        }
        if known {
            // The table's own word is one more start.
            entry.other_braids.push(entry.braid.clone());
        }
        entry.start = Some(StartCurve::Polygon(curve.into_vertices()));
        Ok(entry)
    }

    /// The entry of the table for a type, mirrored if need be, or a new one without a start; true if it is of the table.
    fn of_type(kind: &KnotType, table: &KnotTable) -> Result<(Self, bool), KnotError> {
        if let (true, Some(name)) = (kind.is_certain(), kind.name())
            && let Ok(entry) = table.get(&name.to_string())
        {
            return Ok((entry.into_owned(), true));
        }
        let own = Self {
            name: if kind.is_unknot() { "0_1" } else { "unnamed" }.to_owned(),
            aliases: Vec::new(),
            jones: kind.jones.clone(),
            braid: Vec::new(),
            other_braids: Vec::new(),
            crossing_number: kind.n_crossings as u32,
            chirality: if kind.is_unknot() {
                Chirality::Amphichiral
            } else {
                Chirality::Chiral
            },
            invariants: kind.invariants.clone(),
            length_over_radius: None,
            source: None,
            start: None,
        };
        Ok((own, false))
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

    /// Whether it is the mirror image of the shape that comes first: the name begins with `m`, or a sum stands after its mirror image.
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
