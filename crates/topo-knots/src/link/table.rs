//! The table of links: one TOML file per link, embedded, and the families of chains and torus links by rule.

use std::borrow::Cow;
use std::f64::consts::PI;
use std::sync::LazyLock;

use include_dir::{Dir, include_dir};

use super::LinkEntry;
use crate::name::{mirror_name, similar};
use crate::{Chirality, KnotError};

static BUILTIN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/links");

/// Chains listed in the table, and torus links T(Q,Q).
const CHAINS: std::ops::RangeInclusive<usize> = 3..=5;
const TORUS: std::ops::RangeInclusive<usize> = 4..=6;
/// Most rings of a chain or a torus link that [`LinkTable::get`] makes.
const MOST_RINGS: usize = 8;
/// Best published polygonal ropelengths of T(4,4), T(5,5) and T(6,6), in tube radii.
const KLOTZ: [(usize, f64); 3] = [(4, 77.47), (5, 109.00), (6, 144.21)];

/// All link types that are known by name: the prime links of at most seven crossings, straight chains of rings, and the torus links
/// T(Q,Q), whose strands all turn about each other once.
///
/// Names are Thistlethwaite's, hands those of LinkInfo; order and orientations of components are left aside.
///
/// # Validation
/// `the_table_of_links_is_complete`, `invariants_of_the_links`
#[derive(Debug, Clone, Default)]
pub struct LinkTable {
    entries: Vec<LinkEntry>,
}

impl LinkTable {
    /// The table that comes with the crate.
    pub fn builtin() -> &'static Self {
        static TABLE: LazyLock<LinkTable> = LazyLock::new(LinkTable::embedded);
        &TABLE
    }

    fn embedded() -> Self {
        // The files are part of the crate: the test `the_table_of_links_is_complete` reads each of them.
        let files = BUILTIN.files().filter_map(|file| {
            let text = file.contents_utf8()?;
            LinkEntry::parse(file.path(), text).ok()
        });
        let mut entries: Vec<LinkEntry> = files.collect();
        let families = CHAINS.map(chain).chain(TORUS.map(torus));
        entries.extend(families.filter_map(Result::ok));
        entries.sort_by_cached_key(place);
        Self { entries }
    }

    /// The link of that name or alias; `m` before it means the mirror image. `chain(N)` and `T(Q,Q)` are made for N and Q to 8.
    ///
    /// # Errors
    /// [`KnotError::UnknownLink`] with similar names.
    ///
    /// # Validation
    /// `links_are_found_by_name_and_alias`
    pub fn get(&self, name: &str) -> Result<Cow<'_, LinkEntry>, KnotError> {
        let is_named = |entry: &LinkEntry, name: &str| {
            entry.name == name || entry.aliases.iter().any(|alias| alias == name)
        };
        if let Some(entry) = self.entries.iter().find(|entry| is_named(entry, name)) {
            return Ok(Cow::Borrowed(entry));
        }
        let mirror = mirror_name(name);
        if let Some(entry) = self.entries.iter().find(|entry| is_named(entry, &mirror)) {
            return Ok(Cow::Owned(entry.mirror()));
        }
        let (plain, turned) = match name.strip_prefix('m') {
            Some(plain) => (plain, true),
            None => (name, false),
        };
        match made(plain) {
            Some(entry) if turned => Ok(Cow::Owned(entry?.mirror())),
            Some(entry) => Ok(Cow::Owned(entry?)),
            None => Err(self.unknown(name)),
        }
    }

    fn unknown(&self, name: &str) -> KnotError {
        let names = self
            .entries
            .iter()
            .flat_map(|e| e.aliases.iter().chain([&e.name]));
        KnotError::UnknownLink {
            name: name.to_owned(),
            near: similar(name, names),
        }
    }

    /// All links, mirror images left out: by crossing number, then as in Thistlethwaite's table, families last.
    pub fn iter(&self) -> impl Iterator<Item = &LinkEntry> {
        self.entries.iter()
    }

    /// Number of links, mirror images left out.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether the table holds no link.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

/// Families last, then crossing number, alternating before others, number, name.
fn place(entry: &LinkEntry) -> (bool, u32, bool, u32, String) {
    let name = &entry.name;
    let number = name.rsplit(['a', 'n']).next().and_then(|n| n.parse().ok());
    (
        !name.starts_with('L'),
        entry.crossing_number,
        name.contains('n'),
        number.unwrap_or(u32::MAX),
        name.clone(),
    )
}

/// The member of a family that a name means.
fn made(name: &str) -> Option<Result<LinkEntry, KnotError>> {
    let served = |n: &usize| (2..=MOST_RINGS).contains(n);
    let inner = |head: &str| name.strip_prefix(head)?.strip_suffix(')');
    if let Some(n) = inner("chain(").and_then(|n| n.parse().ok()).filter(served) {
        return Some(chain(n));
    }
    let (p, q) = inner("T(")?.split_once(',')?;
    let q = q.trim().parse().ok().filter(served)?;
    (p.trim().parse() == Ok(q)).then(|| torus(q))
}

/// A straight chain of n rings: between two circles of radius 2, stadiums of length 4 pi + 4.
fn chain(n: usize) -> Result<LinkEntry, KnotError> {
    let braid = (1..n as i32).flat_map(|g| [g, g]).collect();
    let length = 8.0 * PI + (n as f64 - 2.0) * (4.0 * PI + 4.0);
    let crossings = 2 * (n as u32 - 1);
    let reference = Some((length, "cantarella2002"));
    let name = format!("chain({n})");
    LinkEntry::of_family(name, braid, crossings, Chirality::Amphichiral, reference)
}

/// The torus link T(q,q): q fibres of the Hopf fibration.
fn torus(q: usize) -> Result<LinkEntry, KnotError> {
    let braid = (1..q as i32).collect::<Vec<_>>().repeat(q);
    let reference = KLOTZ.iter().find(|(known, _)| *known == q);
    let reference = reference.map(|(_, length)| (*length, "klotz2026"));
    let (name, crossings) = (format!("T({q},{q})"), (q * (q - 1)) as u32);
    LinkEntry::of_family(name, braid, crossings, Chirality::Chiral, reference)
}

#[cfg(test)]
mod tests;
