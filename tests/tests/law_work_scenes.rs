//! Scenes with loads, twisting in time and pulled fibres: what their tables say.

use std::path::Path;

use topo_analysis::{SweepRow, Warning};
use topo_knots::KnotTable;
use topo_lab::{ElasticReport, ElasticScene, SweepSettings, run_sweep};
use topo_tests::curves;

const QUICK: &str = "[rod.contact]\n[rod.friction]\n";

fn run(text: &str, folder: &Path) -> ElasticReport {
    let path = folder.join("work.toml");
    let scene = ElasticScene::parse(text, &path).unwrap_or_else(|e| panic!("{e}"));
    // the scene with all values written out is the same one
    assert_eq!(ElasticScene::parse(&scene.text(), &path).unwrap(), scene);
    let mut scene = scene;
    (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
    let settings = SweepSettings {
        jobs: 1,
        ..SweepSettings::new(folder)
    };
    let report = run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap();
    assert!(report.failed.is_empty(), "{:?}", report.failed);
    report
}

/// Columns of a table of a case, by name.
fn columns(folder: &Path, row: &SweepRow, file: &str) -> Vec<(String, Vec<String>)> {
    let path = folder.join("work").join(&row.case).join(file);
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let rows: Vec<_> = lines.collect();
    header
        .into_iter()
        .enumerate()
        .map(|(k, name)| (name, rows.iter().map(|row| row[k].clone()).collect()))
        .collect()
}

fn column<'a>(all: &'a [(String, Vec<String>)], name: &str) -> Option<&'a [String]> {
    all.iter().find(|c| c.0 == name).map(|c| c.1.as_slice())
}

const DISCHARGE: &str =
    "[charge]\nduration = 0.3\n[discharge]\nuntil_released = 0.5\nclosures = 0\ncuts = 0.25\n";
const ACCURACY: &str = "[accuracy]\nedges = 60\ntolerance = 5e-4\n";

/// Without a load, the price of the charge and the heat are there, and nothing of a load; with one, its work, which is the rest.
#[test]
fn law_tables_say_where_the_energy_went() {
    let folder = tempfile::tempdir().unwrap();
    let knot = "[rod]\nknot = \"3_1\"\ntwist = 0.5\n";
    let plain = run(
        &format!("{knot}{QUICK}{DISCHARGE}{ACCURACY}"),
        folder.path(),
    );
    let row = &plain.rows[0];
    assert_eq!(
        (row.work, row.efficiency, row.peak_power, row.load_dashpot),
        (None, None, None, None)
    );
    assert!(row.energy_in.unwrap() > row.energy && row.heat.unwrap() > 0.0);
    assert!((row.energy_per_mass.unwrap() - row.energy / std::f64::consts::PI).abs() < 1e-15);
    let series = columns(folder.path(), row, "series.csv");
    assert!(
        series
            .iter()
            .all(|c| !c.0.starts_with("grip") && c.0 != "work_load")
    );
    let folder = tempfile::tempdir().unwrap();
    let load = "[discharge.load]\nspring = 0.001\ndashpot = [0.01, 0.1]\n";
    let loaded = run(
        &format!("{knot}{QUICK}{DISCHARGE}{load}{ACCURACY}"),
        folder.path(),
    );
    let dashpots: Vec<_> = loaded
        .rows
        .iter()
        .map(|r| r.load_dashpot.unwrap())
        .collect();
    assert_eq!(dashpots, [0.01, 0.1]);
    for row in &loaded.rows {
        assert_eq!(
            (row.energy_in, row.energy),
            (plain.rows[0].energy_in, plain.rows[0].energy)
        );
        let (work, energy_in) = (row.work.unwrap(), row.energy_in.unwrap());
        assert!((row.efficiency.unwrap() - work / energy_in).abs() < 1e-15 && work > 0.0);
        assert!(row.peak_power.unwrap() > 0.0 && row.residual.unwrap() < 1e-3);
        let series = columns(folder.path(), row, "series.csv");
        let taken = column(&series, "work_load").unwrap();
        let number = |text: &String| text.parse::<f64>().unwrap();
        assert!((number(taken.last().unwrap()) - work).abs() < 1e-12);
        assert!(column(&series, "grip0_fx").is_none());
    }
    assert_ne!(loaded.rows[0].case, loaded.rows[1].case);
}

/// Twisted in time, the same knot costs less, and keeps its twist.
#[test]
fn law_a_scene_twists_in_time() {
    let of = |twisting: &str| {
        let folder = tempfile::tempdir().unwrap();
        let text =
            format!("[rod]\nknot = \"3_1\"\ntwist = 0.5\n{QUICK}{DISCHARGE}{twisting}{ACCURACY}");
        run(&text, folder.path()).rows.remove(0)
    };
    let (at_once, slow) = (of(""), of("[charge.twisting]\nover = 40.0\n"));
    println!("{:?} {:?}", at_once.energy_in, slow.energy_in);
    assert!(slow.energy_in < at_once.energy_in && slow.energy_in.unwrap() > slow.energy);
    let link = |r: &SweepRow| r.writhe + r.total_twist;
    assert!(
        (link(&slow) - link(&at_once)).abs() < 0.05,
        "{} {}",
        link(&slow),
        link(&at_once)
    );
}

/// An open curve in a file is pulled by its ends, held and let go; the tables hold the forces of the grips.
#[test]
fn law_a_scene_pulls_an_open_curve() {
    let folder = tempfile::tempdir().unwrap();
    let vertices = curves::overhand(120, 8.0);
    let lines = vertices
        .vertices()
        .iter()
        .map(|v| format!("{},{},{}\n", v.x, v.y, v.z));
    let text: String = std::iter::once("x,y,z\n".to_owned()).chain(lines).collect();
    std::fs::write(folder.path().join("overhand.csv"), text).unwrap();
    let rod = "[rod]\ncurve = \"overhand.csv\"\nslenderness = 80\n";
    let pull = "[pull]\nduration = 4\noutputs = 8\ngrips = [{ condition = \"pinned\" }, { condition = \"pinned\", displacement = [{ to = 8.0, over = 3.0 }, 0.0, 0.0] }]\n";
    let run = run(
        &format!("{rod}{QUICK}{pull}[discharge]\nlongest = 2.0\nclosures = 4\n{ACCURACY}"),
        folder.path(),
    );
    let row = &run.rows[0];
    assert!(row.name.ends_with("3_1"), "{}", row.name);
    // it is still tied, by most of its closures
    let retied = |w: &Warning| matches!(w, Warning::Retied { .. });
    assert!(!row.warnings.iter().any(retied), "{}", row.warnings);
    let charge = columns(folder.path(), row, "charge.csv");
    let [fx, other] = ["grip1_fx", "grip0_fx"].map(|name| column(&charge, name).unwrap());
    let number = |text: &String| text.parse::<f64>().unwrap();
    assert_eq!(fx[0], "");
    // pinned ends alone hold a rod at rest: their forces are opposite
    let (f, g) = (number(fx.last().unwrap()), number(other.last().unwrap()));
    assert!(f > 0.0 && (f + g).abs() < 0.02 * f, "{f} {g}");
    let work = number(column(&charge, "work").unwrap().last().unwrap());
    assert!(work > 0.0 && row.energy_in.unwrap() > work);
    assert!(column(&columns(folder.path(), row, "series.csv"), "grip1_fx").is_none());
}

/// An open curve that is held is cut between its grips, at given places and where it stores most: two fibres in the tables, without a
/// knot type, the grips of their outer ends with it.
#[test]
fn law_a_scene_cuts_an_open_curve() {
    let vertices = curves::overhand(120, 4.0);
    let lines = vertices.vertices().iter();
    let lines = lines.map(|v| format!("{},{},{}\n", v.x, v.y, v.z));
    let curve: String = std::iter::once("x,y,z\n".to_owned()).chain(lines).collect();
    let rod = "[rod]\ncurve = \"overhand.csv\"\nslenderness = 60\n";
    let pull = "[pull]\nduration = 1\noutputs = 2\ngrips = [{ condition = \"clamped\" }, { condition = \"clamped\" }]\n";
    let ends = "[discharge.ends]\nconditions = [\"clamped\", \"clamped\"]\n";
    for (cuts, places) in [("[0.4, 0.5]", 2), ("\"all:2\"", 2), ("\"tension\"", 1)] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("overhand.csv"), &curve).unwrap();
        let discharge = format!("[discharge]\ncuts = {cuts}\nlongest = 2.0\n{ends}");
        let text = format!("{rod}{QUICK}{pull}{discharge}{ACCURACY}");
        let run = run(&text, folder.path());
        assert_eq!(run.rows.len(), places);
        let row = &run.rows[0];
        assert!(
            (0.1..0.9).contains(&row.cut) && row.t_untie.is_none(),
            "{}",
            row.cut
        );
        let series = columns(folder.path(), row, "series.csv");
        let last = |name: &str| column(&series, name).unwrap().last().unwrap().clone();
        assert_eq!(last("knot"), "");
        assert!(!last("grip0_fx").is_empty() && !last("grip1_fx").is_empty());
        let shapes = columns(folder.path(), row, "snapshots.csv");
        let components = column(&shapes, "component").unwrap();
        assert!(["1", "2"].iter().all(|c| components.iter().any(|x| x == c)));
    }
}

/// What cannot be is refused with file, line, key, value and remedy.
#[test]
fn law_pulls_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let rod = "[rod]\ncurve = \"open.csv\"\n";
    let grips = |second: &str| {
        format!("{rod}[pull]\nduration = 4\ngrips = [{{ condition = \"clamped\" }}, {second}]\n")
    };
    for (text, words) in [
        (
            grips("{ force = [[[0, 0], [2, 1], [1, 1]], 0, 0] }"),
            ["line 5: pull.grips", "order of time"],
        ),
        (
            grips("{ condition = \"pinned\", force = [1, 0, 0] }"),
            ["line 5: pull.grips", "free it"],
        ),
        (
            grips("{ displacement = [{ to = 1, over = 1 }, 0, 0] }"),
            ["line 5: pull.grips", "pin or clamp it"],
        ),
        (
            grips("{ condition = \"pinned\", displacement = [1, 0, 0] }"),
            ["line 5: pull.grips", "begins at 0"],
        ),
        (
            format!("{rod}[pull]\nduration = 0\ngrips = [{{}}, {{}}]\n"),
            ["line 4: pull.duration = 0", "above zero"],
        ),
        (
            grips("{}") + "[charge]\nduration = 1\n",
            ["charge.duration = 1", "pulled, not charged"],
        ),
        (
            grips("{}") + "[discharge]\ncuts = [0.5, 0.999]\n",
            ["line 7: discharge.cuts", "at an end of the open fibre"],
        ),
        (
            grips("{}") + "[discharge]\ncuts = 0.5\n[discharge.load]\ndashpot = 1\n",
            ["line 8: discharge.load", "four ends"],
        ),
        (
            "[rod]\nknot = \"3_1\"\n[pull]\nduration = 1\ngrips = [{}, {}]\n".to_owned(),
            ["line 3: pull", "rod.curve"],
        ),
    ] {
        let error = ElasticScene::parse(&text, &folder.path().join("bad.toml"))
            .expect_err(&text)
            .to_string();
        for word in words.iter().chain(&["bad.toml"]) {
            assert!(error.contains(word), "{text} gives {error} without {word}");
        }
    }
}
