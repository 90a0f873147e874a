//! Scenes that say by a link, a word or a file what is tied: fibres keep what closed curves keep, and the same curve gives the same run.

use std::path::Path;

use topo_analysis::SweepRow;
use topo_knots::{KnotTable, TightKnot, write_curve};
use topo_lab::{ElasticReport, ElasticScene, SweepSettings, run_sweep, tight_shapes};

/// Runs a scene whose file lies in `folder`.
fn sweep(rod: &str, more: &str, folder: &Path) -> ElasticReport {
    let text = format!("[rod]\n{rod}\n[rod.contact]\n[rod.friction]\n{more}");
    let mut scene = ElasticScene::parse(&text, &folder.join("tied.toml")).unwrap();
    (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
    let settings = SweepSettings {
        jobs: 1,
        ..SweepSettings::new(&folder.join(scene.tie.is_some().to_string()))
    };
    run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap()
}

fn run_json(report: &ElasticReport, folder: &Path) -> serde_json::Value {
    let case = folder.join("true/tied").join(&report.rows[0].case);
    serde_json::from_str(&std::fs::read_to_string(case.join("run.json")).unwrap()).unwrap()
}

/// Of a ring cut in a link the sweep says when it is free, if it becomes so: it slips off the other ring when cut where they touch, and stays threaded
/// through it when cut elsewhere.
#[test]
fn law_a_cut_ring_has_a_time_of_untying() {
    let folder = tempfile::tempdir().unwrap();
    let more = "[charge]\nduration = 0.3\n[discharge]\nlongest = 10.0\ncuts = [0.0, 0.25]\n[accuracy]\nedges = 64\n";
    let report = sweep("link = \"hopf\"", more, folder.path());
    assert!(report.failed.is_empty(), "{:?}", report.failed);
    let run = run_json(&report, folder.path());
    let types = |k: usize| run["cuts"][k]["knot_sequence"].clone();
    println!("{} {:?}", types(0), report.rows[0].t_untie);
    assert_eq!(types(0), serde_json::json!(["L2a1", "0_1+0_1"]));
    assert_eq!(types(1), serde_json::json!(["L2a1"]));
    assert!(report.rows[0].t_untie.is_some_and(|t| t < 5.0));
    assert!(report.rows[1].t_untie.is_none());
}

/// Two linked rings: one is cut, and until then each has its Tw + Wr and both their linking number; the energy account closes in the
/// charge and in the discharge.
#[test]
fn law_a_link_from_a_scene_keeps_its_linking_number() {
    let folder = tempfile::tempdir().unwrap();
    let more = "[charge]\nduration = 0.3\n[discharge]\nuntil_released = 0.2\nlongest = 3.0\ncuts = [0.25, 0.75]\n[accuracy]\nedges = 64\n";
    let report = sweep("link = \"hopf\"\ntwist = 0.7", more, folder.path());
    assert!(report.failed.is_empty(), "{:?}", report.failed);
    let lk = report.rows[0].linking.clone();
    assert!(["1", "-1"].contains(&lk.as_str()), "{lk}");
    for (row, place) in report.rows.iter().zip([0.25, 0.75]) {
        let tied = (row.name.as_str(), row.components, &row.linking);
        assert_eq!(tied, ("L2a1", 2, &lk));
        // the nearest of 64 vertices
        assert!((row.cut - place).abs() <= 0.5 / 64.0, "{}", row.cut);
    }
    let run = run_json(&report, folder.path());
    let linking = &run["charge"]["linking"][0];
    assert_eq!(linking["components"], serde_json::json!([0, 1]));
    let drift = linking["drift"].as_f64().unwrap();
    let start = linking["start"].as_f64().unwrap().abs();
    assert!(
        drift < 1e-10 && (start - 1.0).abs() < 1e-10,
        "{start} {drift:.1e}"
    );
    assert!(report.rows[0].link_drift.unwrap() < 1e-10);
    // the second place is on the second ring, half way along it
    let cuts = run["cuts"].as_array().unwrap();
    let components: Vec<_> = cuts.iter().map(|cut| cut["component"].as_u64()).collect();
    assert_eq!(components, [Some(1), Some(2)]);
    let residual = run["ledger_residual"].as_f64().unwrap();
    println!("linking number moved by {drift:.1e}, energy account open by {residual:.1e}");
    assert!(residual < 5e-3, "{residual:.1e}");
    // both rings are in the tables, each with its own arclength
    let case = folder.path().join("true/tied").join(&report.rows[0].case);
    let shape = std::fs::read_to_string(case.join("charged.csv")).unwrap();
    assert!(shape.starts_with("component,s,x,y,z,"), "{}", &shape[..60]);
    let of = |c: &str| shape.lines().filter(|l| l.starts_with(c)).count();
    assert_eq!((of("1,"), of("2,")), (32, 32));
}

/// The tight trefoil written to a file and laid as it is: the run of `knot` to the bit, since the same vertices are smoothed and
/// followed, and its tables say the same but for the folder of the case.
#[test]
fn law_a_knot_and_its_curve_give_one_discharge() {
    let folder = tempfile::tempdir().unwrap();
    let more =
        "[charge]\nduration = 0.2\n[discharge]\nuntil_released = 0.9\n[accuracy]\nedges = 60\n";
    let of_knot = sweep("knot = \"3_1\"\ntwist = 0.5", more, folder.path());
    write_curve(&folder.path().join("a.vect"), &tight(folder.path()).curve).unwrap();
    let of_curve = sweep("curve = \"a.vect\"\ntwist = 0.5", more, folder.path());
    assert!(of_curve.rows[0].case.starts_with("3_1_curve-"));
    let plain = |report: &ElasticReport| -> Vec<SweepRow> {
        let row = |r: &SweepRow| SweepRow {
            case: String::new(),
            cpu_seconds: 0.0,
            ..r.clone()
        };
        report.rows.iter().map(row).collect()
    };
    assert_eq!(plain(&of_curve), plain(&of_knot));
    assert!(of_knot.rows[0].t90.is_some());
}

/// The scenes of links and natural shapes that come with the project, with fewer edges and one twist: charged, cut, and followed for a
/// while; what is released is what was stored.
#[test]
fn law_example_scenes_of_links_and_natural_shapes_run() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let out = tempfile::tempdir().unwrap();
    for (name, components) in [("elastic-hopf", 2), ("elastic-natural-curvature", 1)] {
        let mut scene = ElasticScene::read(&scenes.join(format!("{name}.toml"))).unwrap();
        (scene.rod.n_edges, scene.twists) = (48, vec![1.0]);
        (scene.charge.duration, scene.discharge.longest) = (0.3, 1.0);
        (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
        let settings = SweepSettings {
            jobs: 1,
            ..SweepSettings::new(out.path())
        };
        let report = run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap();
        assert!(report.failed.is_empty(), "{name}: {:?}", report.failed);
        let row = &report.rows[0];
        assert_eq!(row.components, components);
        let case = out.path().join(name).join(&row.case);
        let run = std::fs::read_to_string(case.join("run.json")).unwrap();
        let run: serde_json::Value = serde_json::from_str(&run).unwrap();
        let residual = run["ledger_residual"].as_f64().unwrap();
        println!(
            "{name}: {:.3} E_0, energy account open by {residual:.1e}",
            row.energy
        );
        assert!(
            row.energy > 0.1 && residual < 1e-2,
            "{name}: {residual:.1e}"
        );
        assert_eq!(run["case"]["rest"].is_object(), components == 1);
    }
}

/// The shape that the sweep of the knot kept.
fn tight(folder: &Path) -> TightKnot {
    let mut scene = ElasticScene::parse("[rod]\nknot = \"3_1\"\n", Path::new("s.toml")).unwrap();
    (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
    let table = KnotTable::builtin();
    let interrupt = topo_core::Interrupt::new();
    let out = folder.join("false");
    let shapes = tight_shapes(
        &["3_1".to_owned()],
        &table,
        &scene.tighten,
        &out,
        &interrupt,
        &|_| {},
    );
    shapes.unwrap().remove("3_1").unwrap()
}
