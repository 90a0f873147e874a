//! The knot table: one TOML file a knot, the built-in ones embedded, others from a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use include_dir::{Dir, include_dir};
use serde::{Deserialize, Serialize};
use topo_core::Polyline;

use crate::braid::check_word;
use crate::start_file::StartCurve;
use crate::{Invariants, KnotError, closed_braid};

static BUILTIN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/knots");

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
/// `invariants_of_the_table`, `files_with_faults_are_named`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct KnotEntry {
    /// Name as in Rolfsen's table; mirror images carry a leading `m`.
    pub name: String,
    /// Braid word whose closure is the knot; may be empty if a start curve is given.
    pub braid: Vec<i32>,
    /// Further words of the same knot, from whose closures tightening starts too.
    pub other_braids: Vec<Vec<i32>>,
    /// Least number of crossings of a diagram.
    pub crossing_number: u32,
    /// Whether the mirror image is another knot.
    pub chirality: Chirality,
    /// Alexander polynomial, determinant and signature.
    pub invariants: Invariants,
    /// Published length of the tight knot in units of the tube radius.
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
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileReference {
    length_over_radius: f64,
    source: String,
}

impl KnotEntry {
    /// Reads an entry; `load` opens files named in it, relative to the entry's own folder.
    fn parse(
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
        } = file.invariants;
        if path
            .file_stem()
            .is_none_or(|stem| stem != file.name.as_str())
        {
            return Err(fault(format!(
                "`name` is `{}`; it must equal the file's name",
                file.name
            )));
        }
        let at_minus_one: i64 = alexander
            .iter()
            .enumerate()
            .map(|(k, c)| if k % 2 == 0 { *c } else { -*c })
            .sum();
        if alexander.iter().ne(alexander.iter().rev())
            || alexander.first().is_none_or(|c| *c <= 0)
            || alexander.iter().sum::<i64>().abs() != 1
        {
            return Err(fault(format!(
                "`invariants.alexander` = {alexander:?} is not a knot's: give all coefficients, symmetric, the first positive, with sum 1 or -1"
            )));
        }
        if at_minus_one.unsigned_abs() != determinant {
            return Err(fault(format!(
                "`invariants.determinant` = {determinant} is not |Delta(-1)| = {} of `alexander`",
                at_minus_one.abs()
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
        Ok(Self {
            name: file.name,
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
        })
    }

    /// The entry of the mirror image: negated word and signature, name with a leading `m` added or removed.
    pub fn mirror(&self) -> Self {
        let name = match self.name.strip_prefix('m') {
            Some(rest) => rest.to_owned(),
            None => format!("m{}", self.name),
        };
        Self {
            name,
            braid: negated(&self.braid),
            other_braids: self.other_braids.iter().map(|word| negated(word)).collect(),
            invariants: self.invariants.mirror(),
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

/// All knot types that are known by name.
///
/// # Validation
/// `builtin_table_is_complete`.
#[derive(Debug, Clone, Default)]
pub struct KnotTable {
    entries: BTreeMap<String, KnotEntry>,
    mirrors: BTreeMap<String, KnotEntry>,
}

impl KnotTable {
    /// The table that comes with the crate: the fourteen prime knots of up to seven crossings.
    pub fn builtin() -> Self {
        let mut table = Self::default();
        for file in BUILTIN.files().filter(|f| is_toml(f.path())) {
            // The files are part of the crate: the test `builtin_table_is_complete` reads each of them.
            let Some(text) = file.contents_utf8() else {
                continue;
            };
            let load = |name: &Path| match BUILTIN.get_file(name).and_then(|f| f.contents_utf8()) {
                Some(text) => Ok(text.to_owned()),
                None => Err(KnotError::Table {
                    path: name.to_owned(),
                    problem: "no such embedded file".to_owned(),
                }),
            };
            if let Ok(entry) = KnotEntry::parse(file.path(), text, &load) {
                table.insert(entry);
            }
        }
        table
    }

    /// Adds the knots of all `*.toml` files of a folder; a name already present is replaced.
    ///
    /// # Errors
    /// [`KnotError::Io`] or [`KnotError::Table`], naming the file, the key and the remedy.
    pub fn with_folder(mut self, folder: impl AsRef<Path>) -> Result<Self, KnotError> {
        let folder = folder.as_ref();
        let io = |path: &Path, action| {
            let path = path.to_owned();
            move |source| KnotError::Io {
                path,
                action,
                source,
            }
        };
        let mut paths = Vec::new();
        for item in std::fs::read_dir(folder).map_err(io(folder, "list"))? {
            let path = item.map_err(io(folder, "list"))?.path();
            if is_toml(&path) {
                paths.push(path);
            }
        }
        paths.sort();
        for path in paths {
            let text = std::fs::read_to_string(&path).map_err(io(&path, "read"))?;
            let load = |name: &Path| {
                let path = folder.join(name);
                std::fs::read_to_string(&path).map_err(io(&path, "read"))
            };
            self.insert(KnotEntry::parse(&path, &text, &load)?);
        }
        Ok(self)
    }

    fn insert(&mut self, entry: KnotEntry) {
        let mirror = entry.mirror();
        self.mirrors.insert(mirror.name.clone(), mirror);
        self.entries.insert(entry.name.clone(), entry);
    }

    /// The knot of that name; `m3_1` is the mirror image of `3_1`.
    ///
    /// # Errors
    /// [`KnotError::UnknownKnot`] with the names that come near.
    pub fn get(&self, name: &str) -> Result<&KnotEntry, KnotError> {
        self.entries
            .get(name)
            .or_else(|| self.mirrors.get(name))
            .ok_or_else(|| {
                let mut near: Vec<(usize, &String)> = self
                    .entries
                    .keys()
                    .map(|known| (edit_distance(name, known), known))
                    .collect();
                near.sort();
                let near = near
                    .iter()
                    .filter(|(d, _)| *d <= 2)
                    .take(4)
                    .map(|(_, k)| (*k).clone());
                KnotError::UnknownKnot {
                    name: name.to_owned(),
                    near: near.collect(),
                }
            })
    }

    /// Names of all knots, mirror images left out, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(String::as_str)
    }

    /// All knots, mirror images left out, in alphabetical order.
    pub fn iter(&self) -> impl Iterator<Item = &KnotEntry> {
        self.entries.values()
    }

    /// Number of knots, mirror images left out.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether the table holds no knot.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

fn negated(word: &[i32]) -> Vec<i32> {
    word.iter().map(|g| -g).collect()
}

fn is_toml(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "toml")
}

/// Number of letters to insert, delete or replace.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut corner = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = corner + usize::from(x != *y);
            corner = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(corner + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests;
