//! The knot table: one TOML file a knot, the built-in ones embedded, others from a folder.

use std::collections::BTreeMap;
use std::path::Path;

use crate::KnotError;
use crate::identify::UNKNOWN;
use include_dir::{Dir, include_dir};

mod entry;

pub use entry::{Chirality, KnotEntry, mirror_name};

static BUILTIN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/knots");

/// All knot types that are known by name.
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
    /// The table that comes with the crate: the unknot, the 35 prime knots of up to eight crossings, 10_124 and three sums of knots.
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
        self.mirrors.insert(rank.clone(), mirror);
        self.entries.insert(rank, entry);
    }

    /// The knot of that name or alias; `m3_1` is the mirror image of `3_1`, `granny` the knot `3_1#3_1`.
    ///
    /// # Errors
    /// [`KnotError::UnknownKnot`] with the names that come near.
    pub fn get(&self, name: &str) -> Result<&KnotEntry, KnotError> {
        let known = self.names.get(name).and_then(|(rank, mirrored)| {
            if *mirrored {
                self.mirrors.get(rank)
            } else {
                self.entries.get(rank)
            }
        });
        known.ok_or_else(|| {
            let mut near: Vec<(usize, &String)> = self
                .names
                .iter()
                .filter(|(_, (_, mirrored))| !mirrored)
                .map(|(known, _)| (edit_distance(name, known), known))
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

    /// The label of the mirror image of what [`KnotType::label`](crate::KnotType::label) calls `label`.
    ///
    /// # Validation
    /// `labels_of_mirror_images`
    pub fn mirror_label(&self, label: &str) -> String {
        let is_amphichiral = |name: &str| {
            let known = |name: &str| self.get(name).map(|knot| knot.chirality);
            match known(name) {
                Ok(chirality) => chirality == Chirality::Amphichiral,
                // a sum that is not in the table
                Err(_) => name
                    .split('#')
                    .all(|factor| known(factor).is_ok_and(|c| c == Chirality::Amphichiral)),
            }
        };
        if label.is_empty() || label.starts_with(UNKNOWN) {
            return label.to_owned();
        }
        let names: Vec<&str> = label.split('|').collect();
        let mirrored: Vec<String> = names
            .iter()
            .map(|name| match is_amphichiral(name) {
                true => (*name).to_owned(),
                false => mirror_name(name),
            })
            .collect();
        // `6_1|m6_1`: the handedness is not known, nor is that of the mirror image
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
        let all = |&(crossings, n): &(u32, u32)| {
            (1..=n).all(|k| self.names.contains_key(&format!("{crossings}_{k}")))
        };
        let complete = N_PRIMES.iter().take_while(|c| all(c)).last();
        complete.map_or(2, |(crossings, _)| *crossings)
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

/// Number of letters to insert, delete or replace.
pub(crate) fn edit_distance(a: &str, b: &str) -> usize {
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
