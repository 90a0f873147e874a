//! Where commands meet the physics: the tables behind figures, and a user's own scene.

mod by_wish;
mod elastic;
pub mod estimate;
mod nematic;
mod order;
mod report;

use crate::error::CliError;
use crate::interrupt;
use crate::progress::Progress;
pub use order::Order;
use order::{knots_of, more_knots};
pub use report::Failures;
use std::path::Path;
use std::time::Instant;
use topo_core::Interrupt;
use topo_knots::TightenSettings;
use topo_lab::{
    ElasticScene, Event, LabError, NematicScene, OwnKnots, Scene, SweepSettings, Wish,
    tight_shapes, with_jobs, write_knots,
};
use topo_view::provenance::Provenance;

/// Computes the tables, reusing finished runs, and notes presets, seeds and times; gives the cases that failed.
pub fn tables(
    order: &Order,
    stop: &Interrupt,
    provenance: &mut Provenance,
) -> Result<Failures, CliError> {
    let scene = ElasticScene::published(order.quality);
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
        let scene = NematicScene::published(order.quality);
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

/// Runs a user's scene and prints its table.
///
/// A `wish` stands above what the file says of accuracy.
pub fn scene(
    file: &Path,
    cuts: Option<&str>,
    wish: Option<Wish>,
    knots: Option<&Path>,
    settings: &SweepSettings,
) -> Result<(), CliError> {
    let refused = |key, value: String, remedy: &str| CliError::Argument {
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
