//! Which tables figures need.

use std::path::Path;

use topo_knots::{KnotTable, LinkTable};
use topo_lab::{Preset, Shard};
use topo_view::figures::Figure;
use topo_view::movies::Movie;

/// The tables that figures need.
#[derive(Debug)]
pub struct Order<'a> {
    /// Folder of the results.
    pub results: &'a Path,
    /// How much to compute.
    pub quality: Preset,
    /// Number of threads; 0 is one a processor.
    pub jobs: usize,
    /// Recompute finished runs.
    pub fresh: bool,
    /// The part of the cases computed here.
    pub shard: Option<Shard>,
    /// Compute nothing.
    pub as_is: bool,
    /// Whether the elastic sweep is needed.
    pub elastic: bool,
    /// Whether the nematic sweep is needed.
    pub nematic: bool,
    /// Whether the table of knots is needed.
    pub knots: bool,
    /// The knots there are, the user's own among them.
    pub table: &'a KnotTable,
    /// Figures drawn of them afterwards.
    pub figures: &'a [Figure],
    /// Movies made of them afterwards.
    pub movies: &'a [Movie],
}

/// Links whose tight shapes are known exactly for a draft, beyond it all of the table.
pub fn links_used(quality: Preset) -> Vec<String> {
    match quality {
        Preset::Draft => vec!["L2a1".to_owned(), "chain(3)".to_owned()],
        _ => LinkTable::builtin()
            .iter()
            .map(|link| link.name.clone())
            .collect(),
    }
}

/// Beyond draft the table of knots goes on to eight crossings, at the resolution of the standard preset, and always to the user's
/// own knots.
pub fn more_knots(quality: Preset, names: &[String], table: &KnotTable) -> Vec<String> {
    let builtin = KnotTable::builtin();
    let n_crossings = if quality == Preset::Draft { 0 } else { 8 };
    let primes = table.primes_up_to(n_crossings);
    let own = table.iter().filter(|k| builtin.get(&k.name).is_err());
    let all = primes.chain(own).map(|k| k.name.clone());
    let mut more: Vec<String> = all.filter(|k| !names.contains(k)).collect();
    more.sort();
    more.dedup();
    more
}
