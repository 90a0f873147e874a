//! Where commands meet the physics: the tables behind figures, and a user's own scene.

mod by_goal;
pub mod estimate;
mod order;
mod report;
mod scene;

use crate::error::CliError;
use crate::interrupt;
use crate::progress::{Progress, waiting};
pub use order::Order;
use order::{knots_used, links_used};
pub use report::Failures;
pub use scene::scene;
use scene::sweep;
use std::time::Instant;
use topo_core::Interrupt;
use topo_knots::TightenSettings;
use topo_lab::{
    ElasticScene, Event, LabError, NematicScene, Rods, SweepSettings, tight_links, tight_shapes,
    with_jobs, write_knots, write_links,
};
use topo_view::provenance::Provenance;

/// Computes the tables, reusing finished runs, and notes presets, seeds and times; gives the cases that failed.
pub fn tables(
    order: &Order,
    stop: &Interrupt,
    provenance: &mut Provenance,
) -> Result<Failures, CliError> {
    let scene = ElasticScene::published(order.quality);
    let mut failures = Failures::default();
    note_presets(&scene, provenance);
    let settings = SweepSettings {
        jobs: order.jobs,
        fresh: order.fresh,
        interrupt: stop.clone(),
        shard: order.shard,
        only_finished: order.as_is,
        ..SweepSettings::new(order.results)
    };
    topo_lab::writable(order.results)?;
    estimate::print(&waiting("estimating the work", || {
        estimate::of_order(order, &settings)
    })?);
    if (order.knots || order.links) && !order.as_is {
        knots(order, &scene, stop, provenance)?;
    }
    if order.elastic {
        elastic(order, &scene, &settings, provenance, &mut failures)?;
    }
    if order.nematic {
        nematic(order, &settings, provenance, &mut failures)?;
    }
    Ok(failures)
}

fn note_presets(scene: &ElasticScene, provenance: &mut Provenance) {
    for (name, value) in [
        ("Tolerance", format!("{} h", scene.accuracy.tolerance)),
        ("Edges", scene.rod.n_edges.to_string()),
        ("Cuts", String::from(scene.cuts.clone())),
        ("Seed", scene.seed.to_string()),
    ] {
        provenance.presets.insert(name.to_owned(), value);
    }
}

fn note_time(name: &str, start: Instant, provenance: &mut Provenance) {
    let seconds = start.elapsed().as_secs_f64();
    provenance.wall_seconds.insert(name.to_owned(), seconds);
}

/// Tight shapes of all knots and links in the figures, and their tables.
fn knots(
    order: &Order,
    scene: &ElasticScene,
    stop: &Interrupt,
    provenance: &mut Provenance,
) -> Result<(), CliError> {
    let table = order.table;
    let start = Instant::now();
    let (names, more) = knots_used(order, scene)?;
    let links = links_used(order);
    let progress = Progress::start("knots", names.len() + more.len() + links.len());
    let report = |event: Event<'_>| {
        if let Event::Knot { name, .. } = event {
            progress.done(name);
        }
    };
    let (shapes, links) = with_jobs(order.jobs, || {
        let mut shapes = tight_shapes(&names, table, &scene.tighten, order.results, stop, &report)?;
        let standard = TightenSettings::standard();
        let more = tight_shapes(&more, table, &standard, order.results, stop, &report)?;
        shapes.extend(more);
        let links = tight_links(&links, &scene.tighten, order.results, stop, &report)?;
        Ok::<_, LabError>((shapes, links))
    })??;
    progress.finish();
    interrupt::check(stop)?;
    if order.knots {
        write_knots(&shapes, table, order.results)?;
    }
    if order.links {
        write_links(&links, order.results)?;
    }
    note_time("knots", start, provenance);
    Ok(())
}

/// The sweep of rods and its variants.
fn elastic(
    order: &Order,
    scene: &ElasticScene,
    settings: &SweepSettings,
    provenance: &mut Provenance,
    failures: &mut Failures,
) -> Result<(), CliError> {
    let start = Instant::now();
    let rods = Rods::of(scene, order.table);
    let swept = sweep(&rods, settings)?;
    failures.add(swept.failed(), &scene.results(order.results));
    provenance.estimated("elastic sweep", swept.estimate(), swept.wall_seconds());
    note_time("elastic sweep", start, provenance);
    let runs = format!(
        "{} computed, {} reused",
        swept.n_computed(),
        swept.n_reused()
    );
    provenance.presets.insert("Elastic runs".to_owned(), runs);
    let start = Instant::now();
    for variant in scene.variants() {
        let rods = Rods::of(&variant.scene, order.table);
        let swept = sweep(&rods, settings)?;
        failures.add(swept.failed(), &variant.scene.results(order.results));
    }
    note_time("variants", start, provenance);
    Ok(())
}

/// The sweep of colloids.
fn nematic(
    order: &Order,
    settings: &SweepSettings,
    provenance: &mut Provenance,
    failures: &mut Failures,
) -> Result<(), CliError> {
    let start = Instant::now();
    let scene = NematicScene::published(order.quality);
    let swept = sweep(&scene, settings)?;
    failures.add(swept.failed(), &scene.results(order.results));
    provenance.estimated("nematic sweep", swept.estimate(), swept.wall_seconds());
    let radius = format!("radius {} ξ_N", scene.nematic.radius);
    provenance.presets.insert("Colloid".to_owned(), radius);
    let runs = format!(
        "{} computed, {} reused",
        swept.n_computed(),
        swept.n_reused()
    );
    provenance.presets.insert("Nematic runs".to_owned(), runs);
    note_time("nematic sweep", start, provenance);
    Ok(())
}
