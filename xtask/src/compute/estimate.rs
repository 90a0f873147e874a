//! What a command will take, told before the work, and what it took.

use super::{Order, preset};
use crate::error::XtaskError;
use std::collections::BTreeMap;
use topo_analysis::{
    ElasticScene, Estimate, NematicScene, SweepSettings, estimate_nematic_sweep, estimate_sweep,
};
use topo_knots::TightenSettings;

/// What the tables of an order are expected to take, by stage; the drawing is not counted.
pub fn of_order(
    order: &Order,
    settings: &SweepSettings,
) -> Result<BTreeMap<&'static str, Estimate>, XtaskError> {
    let mut stages = BTreeMap::new();
    let table = order.table;
    let scene = ElasticScene::published(preset(order.quality));
    if (order.elastic || order.knots) && !order.as_is {
        let shapes = |names: &[String], tighten| {
            Estimate::of_shapes(names, table, tighten, order.results, order.jobs)
        };
        let names = super::knots_of(&scene, table)?;
        let mut all = shapes(&names, &scene.tighten)?;
        if order.knots {
            let more = super::more_knots(order.quality, &names, table);
            all = all.then(shapes(&more, &TightenSettings::standard())?);
        }
        stages.insert("tight shapes", all);
    }
    if order.elastic {
        stages.insert("elastic", estimate_sweep(&scene, table, settings)?);
        let mut variants = Estimate::default();
        for variant in scene.variants() {
            variants = variants.then(estimate_sweep(&variant.scene, table, settings)?);
        }
        stages.insert("variants", variants);
    }
    if order.nematic {
        let scene = NematicScene::published(preset(order.quality));
        stages.insert("nematic", estimate_nematic_sweep(&scene, settings)?);
    }
    stages.retain(|_, e| e.n_cases > 0);
    Ok(stages)
}

/// Tells the estimate of an order on the terminal.
pub fn tell(stages: &BTreeMap<&'static str, Estimate>) {
    for (name, estimate) in stages {
        eprintln!("estimate, {name}: {}", text(estimate));
    }
    if stages.len() > 1 {
        let all = stages
            .values()
            .fold(Estimate::default(), |sum, e| sum.then(*e));
        eprintln!("estimate, together: {}", text(&all));
    }
}

/// An estimate in words.
pub fn text(e: &Estimate) -> String {
    let basis = if e.n_calibrated > 0 {
        format!(
            "; speed of this machine from {} finished cases",
            e.n_calibrated
        )
    } else {
        String::new()
    };
    format!(
        "{} cases, {} on {} threads ({} of one processor), up to {}{basis}",
        e.n_cases,
        duration(e.wall_seconds),
        e.threads,
        duration(e.cpu_seconds),
        size(e.bytes)
    )
}

/// Seconds as a reader says them.
pub fn duration(seconds: f64) -> String {
    if seconds < 90.0 {
        format!("{seconds:.0} s")
    } else if seconds < 5400.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

fn size(bytes: u64) -> String {
    let mega = bytes as f64 / 1e6;
    if mega < 1000.0 {
        format!("{mega:.0} MB")
    } else {
        format!("{:.1} GB", mega / 1000.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_are_told_in_fitting_units() {
        let mut e = Estimate {
            n_cases: 238,
            cpu_seconds: 202.0,
            wall_seconds: 109.0,
            threads: 2,
            bytes: 120_000_000,
            n_calibrated: 0,
        };
        assert_eq!(
            text(&e),
            "238 cases, 2 min on 2 threads (3 min of one processor), up to 120 MB"
        );
        e.n_calibrated = 7;
        e.wall_seconds = 20_000.0;
        e.bytes = 2_300_000_000;
        let told = text(&e);
        assert!(told.contains("5.6 h") && told.contains("2.3 GB") && told.contains("7 finished"));
    }
}
