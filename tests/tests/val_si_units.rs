//! Results in seconds and joules, of a scene that says what its fibre is made of.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

use topo_knots::KnotTable;
use topo_lab::{ElasticScene, SweepSettings, run_sweep};

const CIRCLE: &str = "[rod]\nknot = \"0_1\"\n[accuracy]\nedges = 100\ntolerance = 1e-4\n";
const SILICONE: &str =
    "[si]\nradius = 2e-3\nbending_modulus = 1e7\nviscosity = 1e4\ndensity = 1100.0\n";

fn run(text: &str, folder: &Path) -> Vec<u8> {
    let scene = ElasticScene::parse(text, Path::new("circle.toml")).unwrap();
    let settings = SweepSettings {
        jobs: 1,
        ..SweepSettings::new(folder)
    };
    let report = run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap();
    assert!(report.failed.is_empty());
    std::fs::read(folder.join("circle/sweep.csv")).unwrap()
}

/// The one row of `sweep-si.csv`.
fn in_si(folder: &Path) -> BTreeMap<String, f64> {
    let text = std::fs::read_to_string(folder.join("circle/sweep-si.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(','));
    let (header, row) = (lines.next().unwrap(), lines.next().unwrap());
    let cells = header.zip(row);
    cells
        .filter_map(|(name, cell)| Some((name.to_owned(), cell.parse().ok()?)))
        .collect()
}

/// A circle of silicone, 10 cm of 4 mm thick fibre, stores E_b I (2π/L)² L/2 and, once cut, straightens with t99 = 4.395152 T_b,
/// T_b = 2 L² η/(π² h² E_b), which is 2.2266 s; the numbers here are from metres and pascals alone.
#[test]
fn val_the_cut_circle_in_seconds_and_joules() {
    let folder = tempfile::tempdir().unwrap();
    let plain = run(CIRCLE, folder.path());
    assert!(!folder.path().join("circle/sweep-si.csv").exists());
    // the case is not computed again, and its row keeps its bytes
    let with_units = run(&format!("{CIRCLE}{SILICONE}"), folder.path());
    assert_eq!(with_units, plain);
    let found = in_si(folder.path());
    let (length, radius): (f64, f64) = (0.1, 2e-3);
    let (modulus, viscosity) = (1e7, 1e4);
    let bending_time = 2.0 * length.powi(2) * viscosity / (PI * PI * radius.powi(2) * modulus);
    let inertia = 0.25 * PI * radius.powi(4);
    let energy = 0.5 * modulus * inertia * (2.0 * PI / length).powi(2) * length;
    let mass = 1100.0 * PI * radius.powi(2) * length;
    for (name, exact, error) in [
        ("length_metres", length, 1e-12),
        ("mass_kilograms", mass, 1e-12),
        ("t50_seconds", 0.485_414 * bending_time, 3e-3),
        ("t90_seconds", 2.092_567 * bending_time, 3e-3),
        ("t99_seconds", 4.395_152 * bending_time, 3e-3),
        ("energy_joules", energy, 1e-3),
        ("energy_joules_per_kilogram", energy / mass, 1e-3),
    ] {
        let off = found[name] / exact - 1.0;
        println!("{name}: {} for {exact}, off by {off:.1e}", found[name]);
        assert!(off.abs() < error, "{name}: {} for {exact}", found[name]);
    }
    // what is not said any more is not left behind
    run(CIRCLE, folder.path());
    assert!(!folder.path().join("circle/sweep-si.csv").exists());
}
