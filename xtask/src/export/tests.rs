//! Files of real cases, read back with PyVista, meshio and numpy.

use super::{Wanted, write};
use crate::outside::Outside;
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_analysis::{
    ElasticScene, NematicScene, SweepSettings, run_nematic_sweep, run_sweep, write_table,
};
use topo_knots::KnotTable;

const FIBRE: &str = "[rod]\nknot = \"3_1\"\ntwist = 1.0\n[rod.contact]\n[charge]\nduration = 0.02\n[discharge]\nuntil_released = 0.6\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";
const COLLOID: &str = "[nematic]\nradius = 5\nspacing = 1.0\nq = 2\n[charge]\ntolerance = 1e-4\n[discharge]\nuntil_released = 0.9\n[flow]\n[accuracy]\ntolerance = 1e-3\n";

const ALL: Wanted = Wanted {
    vtk: true,
    npz: true,
    nemaktis: Some(0.01),
};

fn fibre(out: &Path) -> PathBuf {
    let scene = ElasticScene::parse(FIBRE, Path::new("scene.toml")).unwrap();
    let table = KnotTable::builtin();
    run_sweep(&scene, &table, &SweepSettings::new(out), &|_| {}).unwrap();
    out.join("elastic/3_1_twist+1.00_shrunk_n60")
}

fn colloid(out: &Path, keep_fields: bool) -> PathBuf {
    let scene = NematicScene::parse(COLLOID, Path::new("scene.toml")).unwrap();
    let settings = SweepSettings {
        keep_fields,
        ..SweepSettings::new(out)
    };
    let report = run_nematic_sweep(&scene, &settings, &|_| {}).unwrap();
    out.join(&scene.folder).join(&report.rows[0].case)
}

#[test]
#[ignore = "needs Python with numpy, pyvista and meshio: `cargo xtask test` runs it where there is one"]
fn python_reads_exported_cases_by_pyvista_meshio_and_numpy() {
    let needs = Outside::Python.needs();
    let python = Outside::Python.find().expect(needs);
    let dir = tempfile::tempdir().unwrap();
    let (rod, ball) = (fibre(dir.path()), colloid(dir.path(), true));
    let (a, b) = (dir.path().join("a"), dir.path().join("b"));
    let made = write(&rod, &a, &ALL).unwrap();
    assert!(made.files.iter().all(|f| f.exists()) && made.notes.is_empty());
    let made = write(&ball, &b, &ALL).unwrap();
    assert!(made.files.iter().all(|f| f.exists()) && made.notes.is_empty());
    let output = Command::new(python)
        .args(["-c", include_str!("read_back.py")])
        .args([&a, &b])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let told: serde_json::Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    let number = |key: &str| {
        told[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{key}: {told}"))
    };
    for key in [
        "npz_same",
        "field_npz_same",
        "nemaktis_mask",
        "meshio_same",
        "plane_same",
    ] {
        assert_eq!(told[key], true, "{key}: {told}");
    }
    assert_eq!(told["fibre_points"], 60);
    assert_eq!(
        told["fibre_arrays"],
        serde_json::json!([
            "curvature",
            "energy_density",
            "s",
            "stretch",
            "tangent",
            "twist"
        ])
    );
    // a knot's fibre turns by more than two turns in all, and is about as long as it was
    assert!((number("fibre_length") - 50.0).abs() < 5.0, "{told}");
    assert!(number("fibre_curvature") * 50.0 > 2.0 * std::f64::consts::TAU);
    assert!(number("tube_cells") > 0.0);
    assert_eq!(number("last_points"), 61.0);
    let times = told["fibre_times"].as_array().unwrap();
    assert!(
        times.len() > 2
            && times
                .windows(2)
                .all(|w| w[0].as_f64().unwrap() < w[1].as_f64().unwrap())
    );
    assert_eq!(
        told["field_arrays"],
        serde_json::json!(["Q", "director", "fluid", "order"])
    );
    assert!(number("traceless") < 1e-6 && number("eigen") < 1e-6 && number("unit") < 1e-6);
    assert!((number("bulk_order") - 0.53).abs() < 0.05, "{told}");
    assert!(number("speed") > 1e-6, "{told}");
    assert!(number("field_times") >= 4.0);
    assert_eq!(told["nemaktis_components"], serde_json::json!([3, 6]));
    assert!((number("nemaktis_order") - 1.0).abs() < 0.05, "{told}");
    assert!((number("nemaktis_spacing") - 0.01).abs() < 1e-6);
    let area = 4.0 * std::f64::consts::PI * 25.0;
    assert!((number("sphere_area") / area - 1.0).abs() < 0.01, "{told}");
    assert!(
        told["meshio_lines"]["line"].as_u64().unwrap() > 10,
        "{told}"
    );
    assert!(told["meshio_cells"]["triangle"].as_u64().unwrap() > 1000);
}

#[test]
fn fields_are_kept_where_asked_for_and_their_absence_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let case = colloid(dir.path(), false);
    let to = dir.path().join("to");
    let made = write(&case, &to, &ALL).unwrap();
    assert!(made.notes[0].contains("--fields"), "{:?}", made.notes);
    let only = Wanted {
        vtk: false,
        npz: false,
        nemaktis: Some(1.0),
    };
    let e = write(&case, &to, &only).unwrap_err();
    assert!(e.exit_code() == 2 && e.to_string().contains("--fields"));
    let run = std::fs::read_to_string(case.join("run.json")).unwrap();
    // asking for fields computes the finished case again, once
    colloid(dir.path(), true);
    let with = std::fs::read_to_string(case.join("run.json")).unwrap();
    assert!(!run.contains("n_fields") && with.contains("n_fields"));
    colloid(dir.path(), true);
    assert_eq!(
        with,
        std::fs::read_to_string(case.join("run.json")).unwrap()
    );
    assert!(write(&case, &to, &only).unwrap().notes.is_empty());
    let made = write(&case, &to, &ALL).unwrap();
    assert!(made.files.len() > 20 && made.files.iter().all(|f| f.exists()));
}

#[test]
fn a_fibre_leaves_every_file_that_is_told_of() {
    let dir = tempfile::tempdir().unwrap();
    let made = write(&fibre(dir.path()), &dir.path().join("to"), &ALL).unwrap();
    assert!(made.files.len() > 3 && made.files.iter().all(|f| f.exists()));
    assert!(made.notes.is_empty(), "{:?}", made.notes);
}

#[test]
fn folders_that_are_no_case_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let to = dir.path().join("to");
    let refusal = |words: &[&str]| {
        let e = write(dir.path(), &to, &ALL).unwrap_err();
        assert_eq!(e.exit_code(), 2);
        for word in words {
            assert!(e.to_string().contains(word), "{e}");
        }
    };
    refusal(&["run.json", "one finished case"]);
    let mark = dir.path().join("run.json");
    std::fs::write(&mark, "{").unwrap();
    refusal(&["run.json"]);
    std::fs::write(&mark, "{\"schema\":\"other/1\"}").unwrap();
    refusal(&["other/1"]);
    std::fs::write(&mark, "{\"schema\":\"topo-elastic-case/1\"}").unwrap();
    refusal(&["charged.csv"]);
    write_table(&dir.path().join("charged.csv"), &[(1.0, 2.0)]).unwrap();
    refusal(&["charged.csv"]);
}
