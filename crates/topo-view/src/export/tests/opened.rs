//! Every file of every kind of export, opened by VTK's own readers and numpy.

use super::{ALL, CELL, COLLOID, FLOW, LINK, colloid, fibre, report, rod, write};
use crate::data::read_csv;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use topo_analysis::{LinePoint, SlicePoint};
use topo_lab::FieldSnapshot;

/// What a reader of VTK must find.
struct Wanted {
    points: usize,
    cells: usize,
    arrays: Value,
    time: Option<f64>,
}

type All = BTreeMap<String, Wanted>;

/// Names as the export numbers them.
fn name(what: &str, k: usize, extension: &str) -> String {
    match k {
        0 => format!("{what}-charged.{extension}"),
        _ => format!("{what}-{k:02}.{extension}"),
    }
}

/// The files of defect lines and ring at `times`.
fn add_lines(case: &Path, times: &[Option<f64>], all: &mut All) {
    for what in ["lines", "ring"] {
        let points: Vec<LinePoint> = read_csv(&case.join(format!("{what}.csv"))).unwrap();
        for (k, time) in times.iter().enumerate() {
            let here: Vec<&LinePoint> = points.iter().filter(|p| p.time == *time).collect();
            let lines = here.chunk_by(|a, b| a.line == b.line);
            let cells = lines.map(|l| if l[0].closed { l.len() } else { l.len() - 1 });
            let wanted = Wanted {
                points: here.len(),
                cells: cells.sum(),
                arrays: json!({ "angle": 1, "line": 1 }),
                time: *time,
            };
            all.insert(name(what, k, "vtu"), wanted);
        }
    }
}

/// The files of a colloid, counted from its tables.
fn wanted_of_colloid(case: &Path, particle: bool, flow: bool) -> All {
    let slices: Vec<SlicePoint> = read_csv(&case.join("slices.csv")).unwrap();
    let mut all = All::new();
    let mut times = Vec::new();
    for (k, group) in slices.chunk_by(|a, b| a.time == b.time).enumerate() {
        let time = group[0].time;
        times.push(time);
        let columns = group.iter().filter(|p| p.z == group[0].z).count();
        let rows = group.iter().filter(|p| p.x == group[0].x).count();
        let mut arrays = json!({ "order": 1, "director": 3 });
        // the charged state and the moment of the switch are at rest
        if flow && group.iter().any(|p| p.ux.is_some()) {
            arrays["velocity_in_plane"] = 3.into();
            arrays["vorticity_y"] = 1.into();
        }
        let (points, cells) = (columns * rows, (columns - 1) * (rows - 1));
        let wanted = Wanted {
            points,
            cells,
            arrays,
            time,
        };
        all.insert(name("plane", k, "vti"), wanted);
    }
    add_lines(case, &times, &mut all);
    if particle {
        let wanted = Wanted {
            points: 49 * 96,
            cells: 2 * 47 * 96,
            arrays: json!({ "director": 3 }),
            time: None,
        };
        all.insert("particle.vtu".to_owned(), wanted);
    }
    for (k, path) in FieldSnapshot::files(case).unwrap().iter().enumerate() {
        let field = FieldSnapshot::read(path).unwrap();
        let mut arrays = json!({ "order": 1, "director": 3, "Q": 9, "fluid": 1 });
        if field.velocity.is_some() {
            arrays["velocity"] = 3.into();
        }
        for (what, arrays) in [
            ("field", arrays),
            ("nemaktis", json!({ "n": 3, "Q": 6, "domain_mask": 1 })),
        ] {
            let wanted = Wanted {
                points: field.cells.iter().product(),
                cells: field.cells.iter().map(|n| n - 1).product(),
                arrays,
                time: field.time,
            };
            all.insert(name(what, k, "vti"), wanted);
        }
    }
    all
}

/// Files of two cuts of a fibre of 60 edges.
fn wanted_of_fibre(report: &Value) -> All {
    let arrays = json!({ "s": 1, "tangent": 3, "curvature": 1, "stretch": 1, "energy_density": 1, "twist": 1 });
    let line = |points: usize, time: Option<f64>| Wanted {
        points,
        cells: 1,
        arrays: arrays.clone(),
        time,
    };
    let mut all = All::from([("charged.vtp".to_owned(), line(60, None))]);
    for cut in [1, 2] {
        let series = report[&format!("discharge-{cut}.pvd")]["files"].as_array();
        for entry in series.unwrap() {
            let file = entry[1].as_str().unwrap();
            assert!(file.starts_with(&format!("discharge-{cut}-")), "{file}");
            all.insert(file.to_owned(), line(61, entry[0].as_f64()));
        }
    }
    all
}

/// Each file opens in silence and holds what was wanted; all that is there was wanted.
fn check(report: &Value, wanted: &All, facts: &[(&str, Value)]) {
    for (file, found) in report.as_object().unwrap() {
        match file.rsplit('.').next().unwrap() {
            "pvd" => check_series(report, file, found),
            "npz" => check_facts(file, found, facts),
            _ => {
                let w = wanted.get(file).unwrap_or_else(|| panic!("{file}"));
                assert_eq!(found["said"], "", "{file}");
                assert_eq!(found["can_read"], true, "{file}");
                assert_eq!(found["points"], w.points, "{file}");
                assert_eq!(found["cells"], w.cells, "{file}");
                assert_eq!(found["arrays"], w.arrays, "{file}");
                // only angles may be unknown
                let bad = found["not_finite"].as_array().unwrap();
                assert!(bad.iter().all(|a| a == "angle"), "{file}: {bad:?}");
                assert_eq!(found["facts"]["TimeValue"].as_f64(), w.time, "{file}");
                check_facts(file, found, facts);
            }
        }
    }
    for file in wanted.keys() {
        assert!(report[file].is_object(), "{file} is not there");
    }
}

fn check_facts(file: &str, found: &Value, facts: &[(&str, Value)]) {
    for (name, value) in facts {
        assert_eq!(&found["facts"][*name], value, "{name} of {file}");
    }
}

/// The files of a series are there, in the order of their times, each knowing its own.
fn check_series(report: &Value, name: &str, found: &Value) {
    let files = found["files"].as_array().unwrap();
    assert!(!files.is_empty(), "{name}");
    let mut before = f64::NEG_INFINITY;
    for entry in files {
        let (time, file) = (entry[0].as_f64().unwrap(), entry[1].as_str().unwrap());
        assert!(time > before, "{name}: {file}");
        assert_eq!(report[file]["facts"]["TimeValue"], time, "{name}: {file}");
        before = time;
    }
}

#[test]
#[ignore = "needs Python with numpy, vtk and pyvista: `cargo xtask test` runs it where there is one"]
fn python_vtk_opens_every_file_of_every_export() {
    let dir = tempfile::tempdir().unwrap();
    let flowing = format!("{COLLOID}{FLOW}");
    let colloid = |name: &'static str, text: &str, fields: bool, flow: bool| {
        (name, colloid(&dir.path().join(name), text, fields), flow)
    };
    let cases = [
        ("rod", fibre(&dir.path().join("rod")), false),
        ("link", rod(&dir.path().join("link"), LINK), false),
        colloid("still", COLLOID, false, false),
        colloid("still-fields", COLLOID, true, false),
        colloid("flow", &flowing, false, true),
        colloid("flow-fields", &flowing, true, true),
        colloid("cell", CELL, true, false),
    ];
    let to: Vec<_> = cases
        .iter()
        .map(|(name, ..)| dir.path().join(format!("to-{name}")))
        .collect();
    for ((_, case, _), to) in cases.iter().zip(&to) {
        let made = write(case, to, &ALL).unwrap();
        let there = std::fs::read_dir(to).unwrap().flatten().map(|e| e.path());
        let there: BTreeSet<_> = there.collect();
        assert_eq!(there, made.files.into_iter().collect::<BTreeSet<_>>());
    }
    let folders: Vec<&Path> = to.iter().map(|t| t.as_path()).collect();
    let report = report(include_str!("../open_all.py"), &folders);
    let mut n_empty = 0;
    for ((name, case, flow), to) in cases.iter().zip(&to) {
        let report = &report[to.to_str().unwrap()];
        if *name == "rod" {
            check_fibre(report);
            continue;
        }
        if *name == "link" {
            check_link(report);
            continue;
        }
        let wanted = wanted_of_colloid(case, *name != "cell", *flow);
        let with_fields = name.ends_with("fields") || *name == "cell";
        assert_eq!(wanted.contains_key("field-charged.vti"), with_fields);
        n_empty += wanted.values().filter(|w| w.points == 0).count();
        let mut facts = vec![
            ("units.length", json!("xi_N")),
            ("units.time", json!("tau_N")),
            ("nematic.radius", json!(5.0)),
            ("nematic.spacing", json!(1.0)),
            ("nematic.material.b", json!(-2.34)),
            (
                "nematic.particle",
                json!(if *name == "cell" { 0.0 } else { 1.0 }),
            ),
        ];
        if *name != "cell" {
            facts.push(("q", json!(2.0)));
            facts.push(("nematic.pattern.charge", json!(2.0)));
        }
        check(report, &wanted, &facts);
        let flows = report["plane-03.vti"]["arrays"]["velocity_in_plane"].is_number();
        assert_eq!(flows, *flow, "{name}");
    }
    // ring and lines go, and leave files that say so
    assert!(n_empty > 20, "{n_empty}");
}

fn check_fibre(report: &Value) {
    let wanted = wanted_of_fibre(report);
    assert!(wanted.len() > 4);
    let facts = [
        ("knot", json!("3_1")),
        ("rod.twist", json!(1.0)),
        ("rod.slenderness", json!(25.0)),
        ("rod.reading", json!("shrunk")),
        ("length", json!(25.0)),
        ("units.length", json!("h")),
        ("units.time", json!("T_0 = 2 L eta/(h E_b)")),
        ("units.energy", json!("E_0 = E_b h^2 L")),
        ("units.energy_density", json!("E_b h^2")),
    ];
    check(report, &wanted, &facts);
    // the charged fibre ends where it began, a cut one does not
    let around: Vec<u64> = (0..60).chain([0]).collect();
    assert_eq!(report["charged.vtp"]["corners"], json!([around]));
    let along: Vec<u64> = (0..61).collect();
    assert_eq!(report["discharge-2-00.vtp"]["corners"], json!([along]));
    let facts = |file: &str| report[file]["facts"].clone();
    assert_eq!(facts("charged.vtp")["state"], "charged");
    assert_eq!(facts("discharge-1-01.vtp")["state"], "discharging");
    assert_eq!(facts("discharge-1-00.vtp")["cut"], 0.0);
    assert_eq!(facts("discharge-2-00.vtp")["cut"], 0.5);
    let archive = &report["fibre.npz"];
    assert_eq!(archive["facts"]["charged_closed"], true);
    assert_eq!(archive["facts"]["discharge2_closed"], false);
    assert_eq!(archive["arrays"]["charged_points"], json!([60, 3]));
    assert!(archive["not_finite"].as_array().unwrap().is_empty());
}

/// Two loops; one of them is cut.
fn check_link(report: &Value) {
    let arrays = json!({ "s": 1, "tangent": 3, "curvature": 1, "stretch": 1, "energy_density": 1, "twist": 1, "component": 1 });
    let line = |points: usize, time: Option<f64>| Wanted {
        points,
        cells: 2,
        arrays: arrays.clone(),
        time,
    };
    let mut wanted = All::from([("charged.vtp".to_owned(), line(60, None))]);
    for entry in report["discharge-1.pvd"]["files"].as_array().unwrap() {
        let file = entry[1].as_str().unwrap().to_owned();
        wanted.insert(file, line(61, entry[0].as_f64()));
    }
    assert!(wanted.len() > 2);
    check(report, &wanted, &[("knot", json!("L2a1"))]);
    let ring = |from: u64| (from..from + 30).chain([from]).collect::<Vec<u64>>();
    let open: Vec<u64> = (30..61).collect();
    let (charged, cut) = (&report["charged.vtp"], &report["discharge-1-00.vtp"]);
    assert_eq!(charged["corners"], json!([ring(0), ring(30)]));
    assert_eq!(cut["corners"], json!([ring(0), open]));
    for (file, n) in [(charged, 30), (cut, 31)] {
        let component = [vec![1; 30], vec![2; n]].concat();
        assert_eq!(file["component"], json!(component));
        assert_eq!(file["component_of_lines"], json!([1, 2]));
    }
    let archive = &report["fibre.npz"]["arrays"];
    assert_eq!(archive["charged_closed"], json!([2]));
    assert_eq!(archive["discharge1_component"], json!([61]));
}
