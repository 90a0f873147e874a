//! Scenes whose fibres break by themselves, or are cut by other criteria than the energy density.

use std::path::Path;

use topo_knots::KnotTable;
use topo_lab::{ElasticReport, ElasticScene, SweepSettings, run_sweep};

fn sweep(text: &str, folder: &Path) -> ElasticReport {
    let scene = ElasticScene::parse(text, Path::new("breaks.toml")).unwrap();
    let settings = SweepSettings {
        jobs: 1,
        ..SweepSettings::new(folder)
    };
    run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap()
}

/// A twisted ring, which buckles into a loop while it is charged.
fn ring(threshold: f64) -> String {
    format!(
        "[rod]\nknot = \"0_1\"\ntwist = 1.0\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.5\n[charge.break]\ncriterion = \"curvature\"\nthreshold = {threshold}\n[discharge]\nuntil_released = 0.5\nclosures = 0\n[accuracy]\nedges = 60\n"
    )
}

/// A ring with a twist beyond that at which it buckles curves more and more: where its curvature passes the threshold it breaks, and is
/// discharged from there; with a threshold that it never reaches it is charged to the end and not discharged, and the table says so.
#[test]
fn law_a_buckling_ring_breaks_where_it_curves_most() {
    let threshold = 0.3;
    let folder = tempfile::tempdir().unwrap();
    let report = sweep(&ring(threshold), folder.path());
    assert!(report.failed.is_empty());
    let row = &report.rows[0];
    let [time, value] = ["break_time", "break_value"].map(|name| row.further.of(name).unwrap());
    println!("broken after {time} T_0 at {} with {value}", row.cut);
    // the curvature of the circle is 2π/50; it broke later, and a step after the threshold
    assert!(time > 0.0 && time < 0.5);
    assert!(value > threshold && value < 1.1 * threshold);
    assert_eq!(row.cut_by, "curvature");
    assert!(row.t50.is_some() && row.warnings.is_empty());
    let case = folder.path().join("breaks").join(&row.case);
    let run = std::fs::read_to_string(case.join("run.json")).unwrap();
    let run: serde_json::Value = serde_json::from_str(&run).unwrap();
    assert_eq!(run["broken"]["time"].as_f64(), Some(time));
    assert_eq!(run["broken"]["site"]["at"].as_f64(), Some(row.cut));
    assert_eq!(run["charge"]["time"].as_f64(), Some(time));
    // the table has the columns
    let table = std::fs::read_to_string(folder.path().join("breaks/sweep.csv")).unwrap();
    assert!(
        table
            .lines()
            .next()
            .unwrap()
            .contains(",break_value,break_time,")
    );

    let folder = tempfile::tempdir().unwrap();
    let report = sweep(&ring(5.0), folder.path());
    let row = &report.rows[0];
    assert!(report.failed.is_empty() && row.t50.is_none() && row.cut_by.is_empty());
    assert_eq!(row.further.of("break_time"), None);
    let largest = row.further.of("break_value").unwrap();
    assert!(largest > threshold && largest < 5.0);
    let said = row.warnings.to_string();
    assert!(
        said.contains("not broken") && said.contains("of 5 1/h"),
        "{said}"
    );
}

/// One charge, cut once where each criterion is largest: every criterion is in exactly one row, that of the energy is the cut of
/// `argmax`, to the bit.
#[test]
fn law_each_criterion_has_its_cut() {
    let text = |cuts: &str| {
        format!(
            "[rod]\nknot = \"7_4\"\ntwist = 0.0\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.05\n[discharge]\ncuts = \"{cuts}\"\nuntil_released = 0.3\nclosures = 0\n[accuracy]\nedges = 80\ntolerance = 1e-2\n"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let of = |cuts: &str| sweep(&text(cuts), &folder.path().join(cuts)).rows;
    let all = of("criteria");
    let mut said: Vec<&str> = all.iter().flat_map(|row| row.cut_by.split(';')).collect();
    said.sort_unstable();
    assert_eq!(said, ["curvature", "energy", "tension", "von-mises"]);
    for name in ["energy", "argmax", "curvature", "tension", "von-mises"] {
        let [one] = &of(name)[..] else {
            panic!("{name} cuts once")
        };
        let by = if name == "argmax" { "energy" } else { name };
        assert_eq!(one.cut_by, by);
        let same = all
            .iter()
            .find(|row| row.cut_by.split(';').any(|c| c == by));
        let same = same.unwrap();
        assert_eq!((same.cut, same.t50), (one.cut, one.t50), "{name}");
    }
}
