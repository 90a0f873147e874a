//! Where commands meet the physics: the tables behind figures, and a user's own scene.

mod by_wish;
mod elastic;
pub mod estimate;
mod nematic;
mod report;

use crate::error::XtaskError;
use crate::figures::{Figure, Quality};
use crate::interrupt;
use crate::movies::Movie;
use crate::progress::Progress;
use crate::provenance::Provenance;
pub use report::Failures;
use std::path::Path;
use std::time::Instant;
use topo_core::Interrupt;
use topo_knots::{KnotTable, TightenSettings};
use topo_lab::{
    ElasticScene, Event, LabError, NematicScene, OwnKnots, Preset, Scene, Shard, SweepSettings,
    Wish, tight_shapes, with_jobs, write_knots,
};

/// The tables that figures need.
#[derive(Debug)]
pub struct Order<'a> {
    /// Folder of the results.
    pub results: &'a Path,
    /// How much to compute.
    pub quality: Quality,
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

/// Computes the tables, reusing finished runs, and notes presets, seeds and times; gives the cases that failed.
pub fn tables(
    order: &Order,
    stop: &Interrupt,
    provenance: &mut Provenance,
) -> Result<Failures, XtaskError> {
    let scene = ElasticScene::published(preset(order.quality));
    let table = order.table;
    let mut failures = Failures::default();
    provenance.presets.insert(
        "Tolerance".to_owned(),
        format!("{} h", scene.accuracy.tolerance),
    );
    provenance
        .presets
        .insert("Edges".to_owned(), scene.rod.n_edges.to_string());
    provenance
        .presets
        .insert("Cuts".to_owned(), String::from(scene.cuts.clone()));
    provenance
        .presets
        .insert("Seed".to_owned(), scene.seed.to_string());
    let settings = SweepSettings {
        jobs: order.jobs,
        fresh: order.fresh,
        interrupt: stop.clone(),
        shard: order.shard,
        only_finished: order.as_is,
        ..SweepSettings::new(order.results)
    };
    topo_lab::writable(order.results)?;
    estimate::tell(&estimate::of_order(order, &settings)?);
    if order.knots && !order.as_is {
        let start = Instant::now();
        let names = knots_of(&scene, table)?;
        let more = more_knots(order.quality, &names, table);
        let progress = Progress::start("knots", names.len() + more.len());
        let told = |event: Event<'_>| {
            if let Event::Knot { name, .. } = event {
                progress.done(name);
            }
        };
        let shapes = with_jobs(order.jobs, || {
            let mut shapes =
                tight_shapes(&names, table, &scene.tighten, order.results, stop, &told)?;
            let standard = TightenSettings::standard();
            let more = tight_shapes(&more, table, &standard, order.results, stop, &told)?;
            shapes.extend(more);
            Ok::<_, LabError>(shapes)
        })??;
        progress.finish();
        interrupt::check(stop)?;
        write_knots(&shapes, table, order.results)?;
        provenance
            .wall_seconds
            .insert("knots".to_owned(), start.elapsed().as_secs_f64());
    }
    if order.elastic {
        let start = Instant::now();
        let report = elastic::sweep(&scene, table, &settings)?;
        failures.add(&report.failed, &scene.results(order.results));
        provenance.estimated("elastic sweep", &report.estimate, report.wall_seconds);
        provenance
            .wall_seconds
            .insert("elastic sweep".to_owned(), start.elapsed().as_secs_f64());
        let runs = format!("{} computed, {} reused", report.n_computed, report.n_reused);
        provenance.presets.insert("Elastic runs".to_owned(), runs);
        let start = Instant::now();
        for variant in scene.variants() {
            let report = elastic::sweep(&variant.scene, table, &settings)?;
            failures.add(&report.failed, &variant.scene.results(order.results));
        }
        provenance
            .wall_seconds
            .insert("variants".to_owned(), start.elapsed().as_secs_f64());
    }
    if order.nematic {
        let start = Instant::now();
        let scene = NematicScene::published(preset(order.quality));
        let report = nematic::sweep(&scene, &settings)?;
        failures.add(&report.failed, &scene.results(order.results));
        provenance.estimated("nematic sweep", &report.estimate, report.wall_seconds);
        let radius = format!("radius {} ξ_N", scene.nematic.radius);
        provenance.presets.insert("Colloid".to_owned(), radius);
        let runs = format!("{} computed, {} reused", report.n_computed, report.n_reused);
        provenance.presets.insert("Nematic runs".to_owned(), runs);
        provenance
            .wall_seconds
            .insert("nematic sweep".to_owned(), start.elapsed().as_secs_f64());
    }
    Ok(failures)
}

/// Knots of a scene, each once.
fn knots_of(scene: &ElasticScene, table: &KnotTable) -> Result<Vec<String>, XtaskError> {
    let mut names: Vec<String> = scene.cases(table)?.into_iter().map(|c| c.knot).collect();
    names.dedup();
    Ok(names)
}

/// Beyond draft the table of knots goes on to eight crossings, at the resolution of the standard preset, and always to the user's
/// own knots.
fn more_knots(quality: Quality, names: &[String], table: &KnotTable) -> Vec<String> {
    let builtin = KnotTable::builtin();
    let n_crossings = if quality == Quality::Draft { 0 } else { 8 };
    let primes = table.primes_up_to(n_crossings);
    let own = table.iter().filter(|k| builtin.get(&k.name).is_err());
    let all = primes.chain(own).map(|k| k.name.clone());
    let mut more: Vec<String> = all.filter(|k| !names.contains(k)).collect();
    more.sort();
    more.dedup();
    more
}

/// Runs a user's scene and prints its table.
///
/// A `wish` stands above what the file says of accuracy.
pub fn scene(
    file: &Path,
    cuts: Option<&str>,
    wish: Option<Wish>,
    knots: Option<&Path>,
    settings: &SweepSettings,
) -> Result<(), XtaskError> {
    let refused = |key, value: String, remedy: &str| XtaskError::Argument {
        key,
        value,
        remedy: remedy.to_owned(),
    };
    match Scene::read(file)? {
        Scene::Elastic(_) if settings.keep_fields => Err(refused(
            "--fields",
            "given".to_owned(),
            "a fibre has no field to keep; leave it out",
        )),
        Scene::Elastic(mut scene) => {
            scene.wish = wish.or(scene.wish);
            if let Some(folder) = knots {
                scene.own_knots = Some(OwnKnots::at(folder));
            }
            elastic::scene(*scene, cuts, settings)
        }
        Scene::Nematic(_) if knots.is_some() => Err(refused(
            "--knots",
            "given".to_owned(),
            "a colloid has no knot; leave it out",
        )),
        Scene::Nematic(mut scene) => match cuts {
            None => {
                scene.wish = wish.or(scene.wish);
                nematic::scene(&scene, settings)
            }
            Some(text) => Err(refused(
                "--cuts",
                text.to_owned(),
                "a nematic scene has nothing to cut; leave it out",
            )),
        },
    }
}

pub fn preset(quality: Quality) -> Preset {
    match quality {
        Quality::Draft => Preset::Draft,
        Quality::Standard => Preset::Standard,
        Quality::Paper => Preset::Paper,
    }
}

impl From<LabError> for XtaskError {
    fn from(e: LabError) -> Self {
        Self::Input(e.to_string())
    }
}

impl From<topo_analysis::AnalysisError> for XtaskError {
    fn from(e: topo_analysis::AnalysisError) -> Self {
        Self::Input(e.to_string())
    }
}
