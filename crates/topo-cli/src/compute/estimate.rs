//! What a command will take, said before the work, and what it took.

use super::order::{Order, knots_used, links_used};
use crate::duration::{count, duration};
use crate::error::CliError;
use indicatif::DecimalBytes;
use topo_knots::TightenSettings;
use topo_lab::{
    Battery, Elastic, ElasticScene, Estimate, NematicScene, Preset, Stage, SweepSettings,
    estimate_nematic_sweep, estimate_sweep,
};

/// What the tables of an order are expected to take, and the drawing.
pub fn of_order(order: &Order, settings: &SweepSettings) -> Result<Vec<Stage>, CliError> {
    let mut stages = Vec::new();
    let table = order.table;
    let scene = ElasticScene::published(order.quality);
    if (order.elastic || order.knots || order.links) && !order.as_is {
        let shapes = |names: &[String], tighten| {
            Estimate::of_shapes(names, table, tighten, order.results, order.jobs)
        };
        let mut all = Estimate::default();
        if order.elastic || order.knots {
            all = all.then(shapes(&scene.knots_used(table)?, &scene.tighten)?);
        }
        let (_, more) = knots_used(order, &scene)?;
        all = all.then(shapes(&more, &TightenSettings::standard())?);
        let (links, out) = (links_used(order), order.results);
        all = all.then(Estimate::of_links(&links, &scene.tighten, out, order.jobs)?);
        stages.push(Stage::shapes(all));
    }
    if order.elastic {
        let sweep = estimate_sweep(&scene, table, settings)?;
        stages.push(stage("elastic", "case", sweep));
        let mut variants = Estimate::default();
        for variant in scene.variants() {
            variants = variants.then(estimate_sweep(&variant.scene, table, settings)?);
        }
        stages.push(stage("variants", "case", variants));
    }
    if order.nematic {
        let scene = NematicScene::published(order.quality);
        let sweep = estimate_nematic_sweep(&scene, settings)?;
        stages.push(stage("nematic", "case", sweep));
    }
    if order.shard.is_none() {
        stages.extend(of_drawing(order));
    }
    stages.retain(|stage| stage.estimate.n_cases > 0);
    Ok(stages)
}

fn stage(name: &'static str, part: &'static str, estimate: Estimate) -> Stage {
    Stage {
        name,
        part,
        estimate,
    }
}

fn of_drawing(order: &Order) -> [Stage; 2] {
    let parts = |names: Vec<&str>| {
        let of = |name: &&str| drawing_seconds(name) * drawing_factor(order.quality);
        let seconds: Vec<f64> = names.iter().map(of).collect();
        Estimate::of_parts(&seconds, order.jobs, Elastic.probe())
    };
    let figures = parts(order.figures.iter().map(|f| f.name).collect());
    let movies = parts(order.movies.iter().map(|m| m.name).collect());
    [
        stage("drawing", "figure", figures),
        stage("movies", "movie", movies),
    ]
}

/// Processor seconds of figures and movies at draft quality on the models' machine.
const DRAWING: [(&str, f64); 11] = [
    ("elastic-configurations", 22.0),
    ("elastic-charging", 3.0),
    ("elastic-discharge", 4.2),
    ("elastic-breaking", 1.0),
    ("elastic-work", 1.0),
    ("nematic-charging", 5.0),
    ("nematic-discharge", 1.0),
    ("knots-table", 5.6),
    ("links-table", 4.6),
    ("movie-elastic", 51.0),
    ("movie-nematic", 82.0),
];
/// The same of one that was not measured.
const OTHER_DRAWING: f64 = 5.0;

fn drawing_seconds(name: &str) -> f64 {
    let known = DRAWING.iter().find(|(known, _)| *known == name);
    known.map_or(OTHER_DRAWING, |(_, seconds)| *seconds)
}

/// What drawing a finer sweep costs over drawing the draft: more edges, more cells, more cuts.
fn drawing_factor(quality: Preset) -> f64 {
    match quality {
        Preset::Draft => 1.0,
        Preset::Standard => 1.4,
        Preset::Paper | Preset::Reference => 2.0,
    }
}

/// Prints the estimate of a command on the terminal.
pub fn print(stages: &[Stage]) {
    if let [only] = stages {
        note!("estimate: {}", text("case", &only.estimate));
        return;
    }
    for stage in stages {
        let said = text(stage.part, &stage.estimate);
        note!("estimate, {}: {said}", stage.name);
    }
    if let Some(all) = together(stages) {
        note!("estimate, together: {}", duration(all.wall_seconds));
    }
}

/// All stages, one after the other; `None` where there is nothing to do.
pub fn together(stages: &[Stage]) -> Option<Estimate> {
    stages.iter().map(|s| s.estimate).reduce(Estimate::then)
}

/// The estimate of so many parts in words.
fn text(part: &str, e: &Estimate) -> String {
    let mut text = format!(
        "{}, {} on {} ({} of one processor)",
        count(e.n_cases, part),
        duration(e.wall_seconds),
        count(e.threads, "thread"),
        duration(e.cpu_seconds),
    );
    if e.bytes > 0 {
        text += &format!(", up to {}", DecimalBytes(e.bytes));
    }
    if e.n_calibrated > 0 {
        text += &format!(
            "; speed of this machine from {}",
            count(e.n_calibrated, "finished case")
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_knots::KnotTable;
    use topo_lab::{Rods, Sweep};

    #[test]
    fn estimates_are_given_in_fitting_units() {
        let mut e = Estimate {
            n_cases: 238,
            cpu_seconds: 202.0,
            wall_seconds: 109.0,
            threads: 2,
            bytes: 120_000_000,
            ..Estimate::default()
        };
        assert_eq!(
            text("case", &e),
            "238 cases, 2 minutes on 2 threads (3 minutes of one processor), up to 120.00 MB"
        );
        e.n_calibrated = 7;
        e.wall_seconds = 20_000.0;
        e.bytes = 2_300_000_000;
        let found = text("knot", &e);
        assert!(found.starts_with("238 knots, 6 hours") && found.contains("2.30 GB"));
        assert!(found.contains("7 finished"));
        for (seconds, words) in [
            (0.2, "less than a second"),
            (12.4, "12 seconds"),
            (f64::INFINITY, "years"),
        ] {
            assert!(duration(seconds).contains(words), "{}", duration(seconds));
        }
    }

    #[test]
    fn every_figure_and_movie_has_its_cost() {
        let figures = topo_view::figures::ALL.iter().map(|f| f.name);
        let movies = topo_view::movies::ALL.iter().map(|m| m.name);
        let mut drawn: Vec<&str> = figures.chain(movies).collect();
        let mut known: Vec<&str> = DRAWING.iter().map(|(name, _)| *name).collect();
        drawn.sort_unstable();
        known.sort_unstable();
        assert_eq!(drawn, known);
    }

    #[test]
    fn a_scene_is_estimated_with_its_tight_shapes() {
        let folder = tempfile::tempdir().unwrap();
        let settings = SweepSettings {
            jobs: 1,
            ..SweepSettings::new(folder.path())
        };
        let mut scene = ElasticScene::published(topo_lab::Preset::Draft);
        (scene.knots, scene.twists) = (vec!["3_1".to_owned()], vec![0.0, 1.0]);
        let table = KnotTable::builtin();
        let rods = Rods::of(&scene, &table);
        let stages = rods.stages(&settings).unwrap();
        let parts = |s: &Stage| (s.name, s.part, s.estimate.n_cases);
        let parts: Vec<_> = stages.iter().map(parts).collect();
        assert_eq!(parts, [("tight shapes", "knot", 1), ("cases", "case", 2)]);
        let all = together(&stages).unwrap();
        assert!(all.reference_seconds > stages[1].estimate.reference_seconds + 1.0);
        // a shape that is kept, or not needed, costs nothing
        let settings = SweepSettings {
            only_finished: true,
            ..settings
        };
        assert!(rods.stages(&settings).unwrap().is_empty());
    }
}
