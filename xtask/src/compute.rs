//! Where commands meet the physics: the tables behind figures, and a user's own scene.

mod by_wish;
pub mod estimate;
mod nematic;

use crate::error::XtaskError;
use crate::figures::{Figure, Quality};
use crate::interrupt;
use crate::movies::Movie;
use crate::progress::Progress;
use crate::provenance::Provenance;
use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;
use topo_analysis::{
    ACCURACY_CASES, AnalysisError, Cuts, ElasticScene, Estimate, Event, NematicScene, Preset,
    Scene, Shard, SweepReport, SweepSettings, Wish, errors_of_rods, measure_accuracy, quantile,
    run_sweep, tight_shapes, with_jobs, write_knots, write_table,
};
use topo_core::Interrupt;
use topo_knots::{KnotTable, TightenSettings};

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
    /// Figures drawn of them afterwards.
    pub figures: &'a [Figure],
    /// Movies made of them afterwards.
    pub movies: &'a [Movie],
}

/// Computes the tables, reusing finished runs, and notes presets, seeds and times.
pub fn tables(
    order: &Order,
    stop: &Interrupt,
    provenance: &mut Provenance,
) -> Result<(), XtaskError> {
    let scene = ElasticScene::published(preset(order.quality));
    let table = KnotTable::builtin();
    provenance.presets.insert(
        "Tolerance".to_owned(),
        format!("{} h", scene.accuracy.tolerance),
    );
    provenance
        .presets
        .insert("Edges".to_owned(), scene.rod.n_edges.to_string());
    provenance
        .presets
        .insert("Cuts".to_owned(), String::from(scene.cuts));
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
    topo_analysis::writable(order.results)?;
    estimate::tell(&estimate::of_order(order, &settings)?);
    if order.knots && !order.as_is {
        let start = Instant::now();
        let names = knots_of(&scene, &table)?;
        let more = more_knots(order.quality, &names, &table);
        let progress = Progress::start("knots", names.len() + more.len());
        let told = |event: Event<'_>| {
            if let Event::Knot { name, .. } = event {
                progress.done(name);
            }
        };
        let shapes = with_jobs(order.jobs, || {
            let mut shapes =
                tight_shapes(&names, &table, &scene.tighten, order.results, stop, &told)?;
            let standard = TightenSettings::standard();
            let more = tight_shapes(&more, &table, &standard, order.results, stop, &told)?;
            shapes.extend(more);
            Ok::<_, AnalysisError>(shapes)
        })??;
        progress.finish();
        interrupt::check(stop)?;
        write_knots(&shapes, &table, order.results)?;
        provenance
            .wall_seconds
            .insert("knots".to_owned(), start.elapsed().as_secs_f64());
    }
    if order.elastic {
        let start = Instant::now();
        let report = sweep(&scene, &table, &settings)?;
        provenance.estimated("elastic sweep", &report.estimate, report.wall_seconds);
        provenance
            .wall_seconds
            .insert("elastic sweep".to_owned(), start.elapsed().as_secs_f64());
        let runs = format!("{} computed, {} reused", report.n_computed, report.n_reused);
        provenance.presets.insert("Elastic runs".to_owned(), runs);
        let start = Instant::now();
        for variant in scene.variants() {
            sweep(&variant.scene, &table, &settings)?;
        }
        provenance
            .wall_seconds
            .insert("variants".to_owned(), start.elapsed().as_secs_f64());
    }
    if order.nematic {
        let start = Instant::now();
        let scene = NematicScene::published(preset(order.quality));
        let report = nematic::sweep(&scene, &settings)?;
        provenance.estimated("nematic sweep", &report.estimate, report.wall_seconds);
        let radius = format!("radius {} ξ_N", scene.nematic.radius);
        provenance.presets.insert("Colloid".to_owned(), radius);
        let runs = format!("{} computed, {} reused", report.n_computed, report.n_reused);
        provenance.presets.insert("Nematic runs".to_owned(), runs);
        provenance
            .wall_seconds
            .insert("nematic sweep".to_owned(), start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// Knots of a scene, each once.
fn knots_of(scene: &ElasticScene, table: &KnotTable) -> Result<Vec<String>, XtaskError> {
    let mut names: Vec<String> = scene.cases(table)?.into_iter().map(|c| c.knot).collect();
    names.dedup();
    Ok(names)
}

/// Beyond draft the table of knots goes on to eight crossings, at the resolution of the standard preset.
fn more_knots(quality: Quality, names: &[String], table: &KnotTable) -> Vec<String> {
    if quality == Quality::Draft {
        return Vec::new();
    }
    let primes = table.primes_up_to(8).map(|k| k.name.clone());
    primes.filter(|k| !names.contains(k)).collect()
}

/// Compares the discharge times of a preset with much finer runs of the same cuts, prints and writes the table.
pub fn accuracy(preset: Preset, settings: &SweepSettings) -> Result<(), XtaskError> {
    let scene = ElasticScene::published(preset);
    let table = KnotTable::builtin();
    topo_analysis::writable(&settings.out)?;
    let mut names: Vec<String> = Vec::new();
    for (knot, _) in ACCURACY_CASES {
        if names.iter().all(|name| name != knot) {
            names.push(knot.to_owned());
        }
    }
    let stop = &settings.interrupt;
    let progress = Progress::start("accuracy", names.len() + ACCURACY_CASES.len());
    let told = |event: Event<'_>| match event {
        Event::Knot { name, .. } | Event::Case { name, .. } => progress.done(name),
        _ => {}
    };
    let rows = with_jobs(settings.jobs, || {
        let shapes = tight_shapes(&names, &table, &scene.tighten, &settings.out, stop, &told)?;
        measure_accuracy(&scene, &ACCURACY_CASES, &table, &shapes, stop, &told)
    })??;
    progress.finish();
    interrupt::check(stop)?;
    let path = settings.out.join("accuracy.csv");
    write_table(&path, &rows)?;
    say!(
        "knot    theta'h     cut     t50   error      t99   error  E/E_ref   CPU s  CPU s of reference"
    );
    for r in &rows {
        let cell = |t: Option<f64>| t.map_or_else(|| "      -".to_owned(), |t| format!("{t:7.3}"));
        let error =
            |e: Option<f64>| e.map_or_else(|| "      -".to_owned(), |e| format!("{e:+6.2}%"));
        say!(
            "{:6} {:+8.2} {:7.4} {} {}  {} {} {:8.4} {:7.2} {:7.2}",
            r.knot,
            r.twist,
            r.cut,
            cell(r.t50),
            error(r.t50_error_percent),
            cell(r.t99),
            error(r.t99_error_percent),
            r.energy_ratio,
            r.cpu_seconds,
            r.cpu_seconds_reference
        );
    }
    for (name, errors) in [
        (
            "t50",
            rows.iter()
                .filter_map(|r| r.t50_error_percent)
                .collect::<Vec<_>>(),
        ),
        (
            "t99",
            rows.iter().filter_map(|r| r.t99_error_percent).collect(),
        ),
    ] {
        let sizes = || errors.iter().map(|e| e.abs());
        if let (Some(median), Some(most)) = (quantile(sizes(), 0.5), quantile(sizes(), 0.9)) {
            say!(
                "{name}: error of {} cases, median {median:.2} %, 90th percentile {most:.2} %",
                errors.len()
            );
        }
    }
    say!("written to {}", path.display());
    Ok(())
}

/// Runs a user's scene and prints its table.
///
/// A `wish` stands above what the file says of accuracy.
pub fn scene(
    file: &Path,
    cuts: Option<&str>,
    wish: Option<Wish>,
    settings: &SweepSettings,
) -> Result<(), XtaskError> {
    match Scene::read(file)? {
        Scene::Elastic(mut scene) => {
            scene.wish = wish.or(scene.wish);
            elastic_scene(*scene, cuts, settings)
        }
        Scene::Nematic(mut scene) => match cuts {
            None => {
                scene.wish = wish.or(scene.wish);
                nematic::scene(&scene, settings)
            }
            Some(text) => Err(XtaskError::Argument {
                key: "--cuts",
                value: text.to_owned(),
                remedy: "a nematic scene has nothing to cut; leave it out".to_owned(),
            }),
        },
    }
}

fn elastic_scene(
    mut scene: ElasticScene,
    cuts: Option<&str>,
    settings: &SweepSettings,
) -> Result<(), XtaskError> {
    if let Some(text) = cuts {
        scene.cuts = Cuts::try_from(text.to_owned()).map_err(|remedy| XtaskError::Argument {
            key: "--cuts",
            value: text.to_owned(),
            remedy,
        })?;
    }
    let table = KnotTable::builtin();
    let (scene, grant) = scene.granted(&table, settings.jobs)?;
    if let Some(grant) = &grant {
        by_wish::tell_grant(grant, "edges");
    }
    estimate::tell(&estimate::of_elastic(&scene, &table, settings)?);
    let report = sweep(&scene, &table, settings)?;
    say!("knot    theta'h     cut    E/E0      Wr     t50     t90     t95     t99  untied");
    let cell = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.3}"));
    for r in &report.rows {
        say!(
            "{:6} {:+8.3} {:7.4} {:7.4} {:+7.3} {} {} {} {} {}",
            r.knot,
            r.twist,
            r.cut,
            r.energy,
            r.writhe,
            cell(r.t50),
            cell(r.t90),
            cell(r.t95),
            cell(r.t99),
            cell(r.t_untie)
        );
        for warning in r.warnings.split(';').filter(|w| !w.is_empty()) {
            say!("       warning: {warning}");
        }
    }
    tell_taken(&report.estimate, report.wall_seconds);
    if let Some(grant) = &grant {
        let check = scene.check_of(grant, &report.rows);
        let coarser = sweep(&check, &table, settings)?;
        let rows = errors_of_rods(grant, &report.rows, &coarser.rows);
        by_wish::tell_errors(grant, &rows, &scene.results(&settings.out))?;
    }
    say!("written to {}", scene.results(&settings.out).display());
    Ok(())
}

/// Tells what they took.
fn tell_taken(estimate: &Estimate, seconds: f64) {
    if estimate.n_cases > 0 {
        say!(
            "{} cases in {}; estimated {}",
            estimate.n_cases,
            estimate::duration(seconds),
            estimate::duration(estimate.wall_seconds)
        );
    }
}

fn sweep(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
) -> Result<SweepReport, XtaskError> {
    let teller = Teller::new("elastic");
    let report = run_sweep(scene, table, settings, &|event| teller.tell(event))?;
    teller.finish(report.interrupted)?;
    Ok(report)
}

/// Tells the events of a sweep on the terminal.
struct Teller {
    label: &'static str,
    progress: OnceLock<Progress>,
}

impl Teller {
    fn new(label: &'static str) -> Self {
        Self {
            label,
            progress: OnceLock::new(),
        }
    }

    fn tell(&self, event: Event<'_>) {
        let progress = self.progress.get();
        match (event, progress) {
            (
                Event::Begin {
                    n_cases,
                    n_reused,
                    estimate,
                },
                _,
            ) => {
                if n_reused > 0 {
                    note!("{n_reused} of {n_cases} cases are finished already");
                }
                self.progress
                    .get_or_init(|| Progress::expecting(self.label, n_cases - n_reused, estimate));
            }
            (Event::Replaced { names, reason }, _) => {
                let shown = names.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
                let more = if names.len() > 3 { ", ..." } else { "" };
                let text = format!(
                    "warning: computed again: {} of the earlier cases ({shown}{more}): {reason}",
                    names.len()
                );
                match progress {
                    Some(progress) => progress.note(&text),
                    None => note!("{text}"),
                }
            }
            (Event::Working { name, what }, Some(progress)) => {
                progress.working(&format!("{name}: {what}"));
            }
            (Event::Knot { .. }, Some(progress)) => progress.restart(),
            (
                Event::Case {
                    name,
                    expected,
                    warnings,
                    ..
                },
                Some(progress),
            ) => {
                progress.done_of(name, expected);
                if !warnings.is_empty() {
                    progress.note(&format!("warning: {name}: {warnings}"));
                }
            }
            _ => {}
        }
    }

    /// Ends the telling; a sweep that was interrupted becomes that error.
    fn finish(self, interrupted: bool) -> Result<(), XtaskError> {
        if let Some(progress) = self.progress.into_inner() {
            progress.finish();
        }
        if interrupted {
            Err(XtaskError::Interrupted)
        } else {
            Ok(())
        }
    }
}

pub fn preset(quality: Quality) -> Preset {
    match quality {
        Quality::Draft => Preset::Draft,
        Quality::Standard => Preset::Standard,
        Quality::Paper => Preset::Paper,
    }
}

impl From<AnalysisError> for XtaskError {
    fn from(e: AnalysisError) -> Self {
        Self::Input(e.to_string())
    }
}
