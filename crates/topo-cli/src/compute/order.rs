//! Which tables figures need.

use std::path::Path;

use topo_knots::{KnotTable, LinkTable};
use topo_lab::{ElasticScene, LabError, Preset, Shard};
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
    /// Whether the table of links is needed.
    pub links: bool,
    /// The knots there are, the user's own among them.
    pub table: &'a KnotTable,
    /// Figures drawn of them afterwards.
    pub figures: &'a [Figure],
    /// Movies made of them afterwards.
    pub movies: &'a [Movie],
}

/// Links whose tight shapes the table of links shows: in a draft those to six crossings, beyond it all that are known by name.
pub fn links_used(order: &Order) -> Vec<String> {
    let most = match (order.links, order.quality) {
        (false, _) => 0,
        (true, Preset::Draft) => 6,
        (true, _) => u32::MAX,
    };
    let links = LinkTable::builtin().iter();
    let links = links.filter(|link| link.crossing_number <= most);
    links.map(|link| link.name.clone()).collect()
}

/// Knots whose tight shapes the table of knots shows: those of the sweep, tightened as it has them, and further ones.
///
/// # Errors
/// As [`ElasticScene::cases`].
pub fn knots_used(
    order: &Order,
    scene: &ElasticScene,
) -> Result<(Vec<String>, Vec<String>), LabError> {
    if !order.knots {
        return Ok((Vec::new(), Vec::new()));
    }
    let names = scene.knots_used(order.table)?;
    let more = more_knots(order.quality, &names, order.table);
    Ok((names, more))
}

/// Beyond draft the table of knots goes on to eight crossings, at the resolution of the standard preset, and always to the user's
/// own knots.
fn more_knots(quality: Preset, names: &[String], table: &KnotTable) -> Vec<String> {
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
