//! The knot table: one TOML file per knot, the built-in ones embedded, others from a folder.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::{LazyLock, OnceLock};

use crate::KnotError;
use crate::name::{self, Factor, KnotName, similar};
use include_dir::{Dir, include_dir};

mod census;
mod chirality;
mod entry;
mod file;

pub use chirality::Chirality;
pub use entry::KnotEntry;
pub(crate) use file::FileReference;

/// Beginning of the label of a knot without a name.
pub(crate) const UNKNOWN: &str = "unknown(";

static BUILTIN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/knots");

/// All knot types that are known by name.
///
/// Those with a file of their own are listed, drawn and tightened as a whole. Of the other primes to ten crossings the built-in table
/// knows words and invariants, so that they, and sums of anything, are found by [`get`](Self::get) and named by
/// [`identify`](crate::identify).
///
/// # Validation
/// `builtin_table_is_complete`.
#[derive(Debug, Clone, Default)]
pub struct KnotTable {
    /// The unknot, primes by crossing number, then sums.
    entries: BTreeMap<Rank, KnotEntry>,
    /// Where each name, alias and mirror image is found; the flag is set for mirror images.
    names: BTreeMap<String, (Rank, bool)>,
    mirrors: BTreeMap<Rank, KnotEntry>,
    /// Whether the primes to ten crossings without a file are known too.
    with_census: bool,
    derived: OnceLock<Derived>,
}

/// What follows from the entries, found when it is first needed.
#[derive(Debug, Clone)]
struct Derived {
    /// The prime knots known without a file.
    census: Vec<&'static KnotEntry>,
    complete_up_to: u32,
}

/// How many prime knots there are of each crossing number, mirror images left out.
const N_PRIMES: [(u32, u32); 8] = [
    (3, 1),
    (4, 1),
    (5, 2),
    (6, 3),
    (7, 7),
    (8, 21),
    (9, 49),
    (10, 165),
];

/// Place of a knot in the table: sums last, then crossing number, number in Rolfsen's table, name.
type Rank = (bool, u32, u32, String);

fn rank(entry: &KnotEntry) -> Rank {
    let index = entry.name.split_once('_').map_or("", |(_, index)| index);
    (
        entry.is_composite(),
        entry.crossing_number,
        index.parse().unwrap_or(u32::MAX),
        entry.name.clone(),
    )
}

impl KnotTable {
    /// The table that comes with the crate: the unknot, the 35 prime knots of up to eight crossings, 10_124 and three sums of knots; without a
    /// file, words and invariants of the other primes to ten crossings.
    pub fn builtin() -> Self {
        static TABLE: LazyLock<KnotTable> = LazyLock::new(KnotTable::embedded);
        TABLE.clone()
    }

    /// The built-in table with the knots of a folder.
    ///
    /// # Errors
    /// As [`with_folder`](Self::with_folder).
    pub fn builtin_and(folder: Option<&Path>) -> Result<Self, KnotError> {
        match folder {
            Some(folder) => Self::builtin().with_folder(folder),
            None => Ok(Self::builtin()),
        }
    }

    /// The built-in table, read from its files.
    fn embedded() -> Self {
        let mut table = Self {
            with_census: true,
            ..Self::default()
        };
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

    /// Adds a knot; one of the same name is replaced.
    pub fn insert(&mut self, entry: KnotEntry) {
        if let Some((old, false)) = self.names.get(&entry.name).cloned() {
            self.names.retain(|_, (rank, _)| *rank != old);
            self.entries.remove(&old);
            self.mirrors.remove(&old);
        }
        let rank = rank(&entry);
        let mirror = entry.mirror();
        for (knot, mirrored) in [(&mirror, true), (&entry, false)] {
            for name in knot.aliases.iter().chain([&knot.name]) {
                self.names.insert(name.clone(), (rank.clone(), mirrored));
            }
        }
        self.derived = OnceLock::new();
        self.mirrors.insert(rank.clone(), mirror);
        self.entries.insert(rank, entry);
    }

    /// The knot of that name or alias; `m3_1` is the mirror image of `3_1`, `granny` the knot `3_1#3_1`; a sum that has no file is made
    /// from its factors.
    ///
    /// # Errors
    /// [`KnotError::UnknownKnot`] with similar names, [`KnotError::SumWithoutWord`] for a sum that cannot be made.
    ///
    /// # Validation
    /// `any_sum_and_any_prime_to_ten_crossings_is_found`
    pub fn get(&self, name: &str) -> Result<Cow<'_, KnotEntry>, KnotError> {
        if let Some(entry) = self.listed(name) {
            return Ok(Cow::Borrowed(entry));
        }
        let sum = self.canonical_name(name);
        if name.contains('#')
            && let Some(entry) = self.listed(&sum.to_string())
        {
            return Ok(Cow::Borrowed(entry));
        }
        if !sum.is_sum() {
            return self.of_census(name).ok_or_else(|| self.unknown(name));
        }
        let factor = |factor: &Factor| self.get(&factor.to_string());
        let factors = sum.factors().iter().map(factor);
        let factors = factors.collect::<Result<Vec<_>, _>>()?;
        KnotEntry::sum(&sum, &factors, &|knot| self.is_amphichiral(knot)).map(Cow::Owned)
    }

    /// The entry that a file gave, or its mirror image.
    fn listed(&self, name: &str) -> Option<&KnotEntry> {
        let (rank, mirrored) = self.names.get(name)?;
        if *mirrored {
            self.mirrors.get(rank)
        } else {
            self.entries.get(rank)
        }
    }

    /// The prime knots known without a file.
    pub(crate) fn census(&self) -> impl Iterator<Item = &KnotEntry> {
        self.derived().census.iter().copied()
    }

    fn derived(&self) -> &Derived {
        self.derived.get_or_init(|| {
            let all = if self.with_census {
                census::entries()
            } else {
                &[]
            };
            let is_listed = |name: &str| self.names.contains_key(name);
            let census: Vec<_> = all.iter().filter(|knot| !is_listed(&knot.name)).collect();
            let own = census.iter().map(|knot| knot.name.as_str());
            let known: HashSet<&str> = self.names.keys().map(String::as_str).chain(own).collect();
            let all = |&(crossings, n): &(u32, u32)| {
                (1..=n).all(|k| known.contains(format!("{crossings}_{k}").as_str()))
            };
            let complete = N_PRIMES.iter().take_while(|c| all(c)).last();
            Derived {
                complete_up_to: complete.map_or(2, |(crossings, _)| *crossings),
                census,
            }
        })
    }

    fn of_census(&self, name: &str) -> Option<Cow<'_, KnotEntry>> {
        let known = |name: &str| self.census().find(|knot| knot.name == name);
        match (known(name), name.strip_prefix('m')) {
            (Some(entry), _) => Some(Cow::Borrowed(entry)),
            (None, Some(base)) => known(base).map(|entry| Cow::Owned(entry.mirror())),
            (None, None) => None,
        }
    }

    fn unknown(&self, name: &str) -> KnotError {
        let own = self.names.iter().filter(|(_, (_, mirrored))| !mirrored);
        let census = self.census().map(|knot| &knot.name);
        KnotError::UnknownKnot {
            name: name.to_owned(),
            near: similar(name, own.map(|(known, _)| known).chain(census)),
        }
    }

    /// Whether a knot equals its mirror image, as its file or the published tables say.
    pub(crate) fn is_amphichiral(&self, knot: &str) -> bool {
        match self.listed(knot) {
            Some(entry) => entry.chirality == Chirality::Amphichiral,
            None => name::is_amphichiral(knot),
        }
    }

    /// The one name of a type: aliases replaced, factors in order, no `m` at those that equal their mirror image.
    ///
    /// # Validation
    /// `labels_of_mirror_images`
    pub fn canonical_name(&self, name: &str) -> KnotName {
        let is_amphichiral = |knot: &str| self.is_amphichiral(knot);
        let factors = name.split('#').flat_map(|text| {
            let known = self.names.get(text);
            let base = known.map_or(text, |((.., base), _)| base);
            let name = KnotName::parse_with(base, &is_amphichiral);
            match known {
                Some((_, true)) => name.mirror_with(&is_amphichiral).into_factors(),
                _ => name.into_factors(),
            }
        });
        KnotName::of(factors.collect())
    }

    /// The label of the mirror image of what [`KnotType::label`](crate::KnotType::label) calls `label`.
    ///
    /// # Validation
    /// `labels_of_mirror_images`
    pub fn mirror_label(&self, label: &str) -> String {
        if label.is_empty() || label.starts_with(UNKNOWN) {
            return label.to_owned();
        }
        let mirror = |name: &str| {
            let name = self.canonical_name(name);
            name.mirror_with(&|knot| self.is_amphichiral(knot))
                .to_string()
        };
        let names: Vec<&str> = label.split('|').collect();
        let mirrored: Vec<String> = names.iter().map(|name| mirror(name)).collect();
        // `10_71|m10_71`: the handedness is not known, nor is that of the mirror image
        if mirrored.iter().all(|name| names.contains(&name.as_str())) {
            return label.to_owned();
        }
        mirrored.join("|")
    }

    /// Names of all knots, mirror images left out: the unknot, primes by crossing number, then sums.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.iter().map(|knot| knot.name.as_str())
    }

    /// All knots, mirror images left out: the unknot, primes by crossing number, then sums.
    pub fn iter(&self) -> impl Iterator<Item = &KnotEntry> {
        self.entries.values()
    }

    /// The prime knots of at most so many crossings; the unknot is not prime.
    pub fn primes_up_to(&self, crossing_number: u32) -> impl Iterator<Item = &KnotEntry> {
        self.iter().filter(move |knot| {
            !knot.is_unknot() && !knot.is_composite() && knot.crossing_number <= crossing_number
        })
    }

    /// The crossing number up to which no prime knot is missing.
    pub fn complete_up_to(&self) -> u32 {
        self.derived().complete_up_to
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

fn is_toml(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "toml")
}

#[cfg(test)]
mod tests;
