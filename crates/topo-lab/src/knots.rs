//! Tight shapes for a sweep, and the table of knots.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use topo_core::{Interrupt, Snapshot};
use topo_knots::{
    KnotEntry, KnotError, KnotTable, TightKnot, TightenSettings, ideal_until, is_kept,
};

use crate::LabError;
use crate::cost::{Cost, Estimate, Speed, estimate, threads};
use crate::elastic::ROD_PROBE;
use crate::folder::make_folder;
use crate::progress::Event;
use topo_analysis::{KnotRow, write_table};

/// Tight shapes by name.
pub type Shapes = BTreeMap<String, TightKnot>;

/// Tight shapes of the knots `names`, in parallel; those found below `out` are read instead of computed.
///
/// Stops early, with what is there, when interrupted.
///
/// # Errors
/// An unknown knot, or one that cannot be tightened.
pub fn tight_shapes(
    names: &[String],
    table: &KnotTable,
    settings: &TightenSettings,
    out: &Path,
    interrupt: &Interrupt,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<Shapes, LabError> {
    let entries: Vec<Cow<'_, KnotEntry>> = names
        .iter()
        .map(|n| table.get(n))
        .collect::<Result<_, _>>()?;
    let cache = knots_folder(out).join("cache");
    let made: Vec<Option<(String, TightKnot)>> = entries
        .par_iter()
        .with_max_len(1)
        .map(|entry| {
            if interrupt.is_requested() {
                return Ok(None);
            }
            let tight = match ideal_until(entry, settings, Some(&cache), interrupt) {
                Err(KnotError::Interrupted { .. }) => return Ok(None),
                made => made?,
            };
            progress(Event::Knot {
                name: &entry.name,
                length_over_radius: tight.length_over_radius,
            });
            Ok(Some((entry.name.clone(), tight)))
        })
        .collect::<Result<_, LabError>>()?;
    Ok(made.into_iter().flatten().collect())
}

impl Estimate {
    /// What [`tight_shapes`] is expected to take for those of the knots that are not kept below `out`.
    ///
    /// # Errors
    /// An unknown knot.
    pub fn of_shapes(
        names: &[String],
        table: &KnotTable,
        settings: &TightenSettings,
        out: &Path,
        jobs: usize,
    ) -> Result<Self, LabError> {
        let cache = knots_folder(out).join("cache");
        let mut costs = Vec::new();
        for name in names {
            let entry = table.get(name)?;
            if !is_kept(&entry, settings, &cache) {
                costs.push(cost(entry.crossing_number, settings));
            }
        }
        Ok(estimate(
            &costs,
            Speed::of(&ROD_PROBE, &[]),
            threads(jobs),
            true,
        ))
    }
}

/// What the tight shape of a knot or link of so many crossings costs.
pub(crate) fn cost(crossing_number: u32, settings: &TightenSettings) -> Cost {
    // searches of the fine preset are longer; levels finer than four a unit cost by their vertices
    let searches = 1.0 + settings.n_kicks as f64 / 4.0;
    let levels = (settings.per_unit / 4.0).powf(LEVEL_POWER);
    let size = (f64::from(crossing_number) / 6.0).powf(CROSSINGS_POWER);
    Cost {
        seconds: size * (SEARCH_SECONDS * searches + LEVEL_SECONDS * levels),
        bytes: SHAPE_BYTES,
    }
}

/// Growth with the number of crossings.
const CROSSINGS_POWER: f64 = 0.85;
/// Processor seconds of the search for a knot of six crossings, a unit being a start and four kicks.
const SEARCH_SECONDS: f64 = 1.64;
/// The same of tightening it at four vertices a unit of ropelength.
const LEVEL_SECONDS: f64 = 0.17;
/// Growth with the vertices a unit.
const LEVEL_POWER: f64 = 2.3;
/// Bytes that a knot holds.
const SHAPE_BYTES: u64 = 60_000_000;

/// Where the table of knots lies below an output folder.
pub fn knots_folder(out: &Path) -> std::path::PathBuf {
    out.join("knots")
}

/// Writes `knots/table.csv` and a curve a knot, `knots/<knot>.csv`, at thickness 1.
///
/// # Errors
/// A file that cannot be written.
pub fn write_knots(
    shapes: &Shapes,
    table: &KnotTable,
    out: &Path,
) -> Result<Vec<KnotRow>, LabError> {
    let folder = knots_folder(out);
    make_folder(&folder)?;
    let mut rows = Vec::new();
    // by crossings and then by number: 8_2 before 8_10
    let place = |name: &str| -> Option<(u32, u32)> {
        let (crossings, number) = name.split_once('_')?;
        Some((crossings.parse().ok()?, number.parse().ok()?))
    };
    let mut ordered: Vec<_> = shapes.iter().collect();
    ordered.sort_by_key(|(name, _)| (place(name).is_none(), place(name)));
    for (name, tight) in ordered {
        let reference = table.get(name)?.length_over_radius;
        let certificate = &tight.certificate;
        rows.push(KnotRow {
            knot: name.clone(),
            vertices: tight.curve.n_vertices(),
            length_over_radius: tight.length_over_radius,
            reference,
            excess_percent: reference.map(|r| 100.0 * (tight.length_over_radius / r - 1.0)),
            writhe: certificate.writhe,
            average_crossing_number: certificate.average_crossing_number,
            struts: certificate.n_struts,
            kinks: certificate.n_kinks,
            alexander: certificate.invariants.alexander_text(),
            determinant: certificate.invariants.determinant,
            signature: certificate.invariants.signature,
            cpu_seconds: tight.cpu_seconds,
        });
        Snapshot::new(tight.curve.vertices().to_vec())
            .write(&folder.join(format!("{name}.csv")))?;
    }
    write_table(&folder.join("table.csv"), &rows)?;
    Ok(rows)
}
