//! Files of real cases, read back with VTK, PyVista and numpy.

mod opened;

use super::about::About;
use super::npz::Archive;
use super::{Made, Wanted, vtk};
use crate::error::ViewError;
use crate::outside::Outside;
use crate::shown::Shown;
use ndarray::ArrayD;
use ndarray_npy::NpzReader;
use serde_json::{Value, json};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_analysis::write_table;
use topo_knots::KnotTable;
use topo_lab::{
    Colloid, Elastic, ElasticScene, NematicScene, RESULTS_VERSION, SweepSettings,
    run_nematic_sweep, run_sweep,
};

/// Shorter than its ropelength, so that its tube is thinner than 2h.
const FIBRE: &str = "[rod]\nknot = \"3_1\"\ntwist = 1.0\nslenderness = 25\n[rod.contact]\n[charge]\nduration = 0.02\n[discharge]\ncuts = \"all:2\"\nuntil_released = 0.6\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";
/// Two rings of 30 edges, the second cut.
const LINK: &str = "[rod]\nlink = \"hopf\"\ntwist = 0.5\n[rod.contact]\n[charge]\nduration = 0.02\n[discharge]\nuntil_released = 0.1\nlongest = 0.2\ncuts = 0.75\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";
/// Followed until ring and lines are gone.
const COLLOID: &str = "[nematic]\nradius = 5\nspacing = 1.0\nq = 2\n[charge]\ntolerance = 1e-4\n[discharge]\nuntil_released = 0.9999\n[accuracy]\ntolerance = 1e-3\n";
const FLOW: &str = "[flow]\n";
/// Without a particle.
const CELL: &str = "[nematic]\nradius = 5\nspacing = 1.0\nparticle = false\n[charge]\ntolerance = 1e-4\n[switch]\nto = \"keep\"\n[discharge]\nuntil_released = 0.9\n[accuracy]\ntolerance = 1e-3\n";

const ALL: Wanted = Wanted {
    vtk: true,
    npz: true,
    nemaktis: Some(0.01),
};

fn write(case: &Path, folder: &Path, wanted: &Wanted) -> Result<Made, ViewError> {
    let batteries: [&dyn Shown; 2] = [&Elastic, &Colloid];
    super::write(case, folder, wanted, &batteries)
}

/// The folder of the only case below another, wherever it lies.
fn only_case(out: &Path) -> PathBuf {
    let mut found = Vec::new();
    let mut folders = vec![out.to_owned()];
    while let Some(folder) = folders.pop() {
        if folder.join("run.json").exists() {
            found.push(folder);
            continue;
        }
        let entries = std::fs::read_dir(&folder).unwrap().flatten();
        folders.extend(entries.map(|e| e.path()).filter(|p| p.is_dir()));
    }
    assert_eq!(found.len(), 1, "{found:?}");
    found.remove(0)
}

fn fibre(out: &Path) -> PathBuf {
    rod(out, FIBRE)
}

fn rod(out: &Path, scene: &str) -> PathBuf {
    let mut scene = ElasticScene::parse(scene, Path::new("scene.toml")).unwrap();
    if scene.tie.is_some() {
        (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
    }
    let table = KnotTable::builtin();
    run_sweep(&scene, &table, &SweepSettings::new(out), &|_| {}).unwrap();
    only_case(out)
}

fn colloid(out: &Path, scene: &str, keep_fields: bool) -> PathBuf {
    let scene = NematicScene::parse(scene, Path::new("scene.toml")).unwrap();
    let settings = SweepSettings {
        keep_fields,
        ..SweepSettings::new(out)
    };
    run_nematic_sweep(&scene, &settings, &|_| {}).unwrap();
    only_case(out)
}

/// What a program in Python says of arguments, as the JSON on its last line.
fn report(program: &str, arguments: &[&Path]) -> Value {
    let needs = Outside::Python.needs();
    let python = Outside::Python.find().expect(needs);
    let mut command = Command::new(python);
    let output = command.args(["-c", program]).args(arguments).output();
    let output = output.unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    serde_json::from_str(text.lines().last().unwrap()).unwrap()
}

#[test]
#[ignore = "needs Python with numpy, vtk and pyvista: `cargo xtask test` runs it where there is one"]
fn python_reads_exported_cases_by_pyvista_and_numpy() {
    let dir = tempfile::tempdir().unwrap();
    let rod = fibre(&dir.path().join("rod"));
    let ball = colloid(&dir.path().join("ball"), &format!("{COLLOID}{FLOW}"), true);
    let (a, b) = (dir.path().join("a"), dir.path().join("b"));
    let made = write(&rod, &a, &ALL).unwrap();
    assert!(made.files.iter().all(|f| f.exists()) && made.notes.is_empty());
    let made = write(&ball, &b, &ALL).unwrap();
    assert!(made.files.iter().all(|f| f.exists()) && made.notes.is_empty());
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/output.md");
    let report = report(include_str!("read_back.py"), &[&a, &b, &page]);
    for key in [
        "npz_same",
        "field_npz_same",
        "nemaktis_mask",
        "plane_same",
        "shown_array",
    ] {
        assert_eq!(report[key], true, "{key}: {report}");
    }
    check_fibre(&report);
    check_colloid(&report);
}

fn number(report: &Value, key: &str) -> f64 {
    let found = report[key].as_f64();
    found.unwrap_or_else(|| panic!("{key}: {report}"))
}

fn check_fibre(report: &Value) {
    let number = |key: &str| number(report, key);
    assert_eq!(report["fibre_points"], 60);
    assert_eq!(
        report["fibre_arrays"],
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
    assert!((number("fibre_length") - 25.0).abs() < 2.5, "{report}");
    assert!(number("fibre_curvature") * 25.0 > 2.0 * std::f64::consts::TAU);
    // a tight trefoil of length 25 h is as thick as its ropelength (ashton2011) says, and strands drawn so touch
    let diameter = number("contact_diameter");
    assert!((diameter / (2.0 * 25.0 / 32.7436) - 1.0).abs() < 0.01);
    assert!((number("tube_radius") - 0.5 * diameter).abs() < 1e-12);
    assert!((number("shown_radius") - 0.5 * diameter).abs() < 1e-5);
    let strands = number("strand_distance") / diameter;
    assert!((0.9..1.2).contains(&strands), "{strands} {report}");
    assert_eq!(number("last_points"), 61.0);
    let times = report["fibre_times"].as_array().unwrap();
    assert!(
        times.len() > 2
            && times
                .windows(2)
                .all(|w| w[0].as_f64().unwrap() < w[1].as_f64().unwrap())
    );
}

fn check_colloid(report: &Value) {
    let number = |key: &str| number(report, key);
    assert_eq!(
        report["field_arrays"],
        serde_json::json!(["Q", "director", "fluid", "order"])
    );
    assert!(number("traceless") < 1e-6 && number("eigen") < 1e-6 && number("unit") < 1e-6);
    assert!((number("bulk_order") - 0.53).abs() < 0.05, "{report}");
    assert!(number("speed") > 1e-6, "{report}");
    assert!(number("field_times") >= 4.0);
    assert_eq!(report["nemaktis_components"], serde_json::json!([3, 6]));
    assert!((number("nemaktis_order") - 1.0).abs() < 0.05, "{report}");
    assert!((number("nemaktis_spacing") - 0.01).abs() < 1e-6);
    let area = 4.0 * std::f64::consts::PI * 25.0;
    assert!(
        (number("sphere_area") / area - 1.0).abs() < 0.01,
        "{report}"
    );
    assert!(number("sphere_unit") < 1e-12);
    assert!(number("line_times") >= 4.0 && number("last_lines") == 0.0);
}

#[test]
fn fields_are_kept_where_asked_for_and_their_absence_is_reported() {
    let dir = tempfile::tempdir().unwrap();
    let case = colloid(dir.path(), COLLOID, false);
    let to = dir.path().join("to");
    let made = write(&case, &to, &ALL).unwrap();
    assert!(made.notes[0].contains("--fields"), "{:?}", made.notes);
    let only = Wanted {
        vtk: false,
        npz: false,
        nemaktis: Some(1.0),
    };
    let e = write(&case, &to, &only).unwrap_err();
    assert!(matches!(e, ViewError::Case { .. }) && e.to_string().contains("--fields"));
    let run = std::fs::read_to_string(case.join("run.json")).unwrap();
    // asking for fields computes the finished case again, once
    colloid(dir.path(), COLLOID, true);
    let with = std::fs::read_to_string(case.join("run.json")).unwrap();
    assert!(!run.contains("n_fields") && with.contains("n_fields"));
    colloid(dir.path(), COLLOID, true);
    assert_eq!(
        with,
        std::fs::read_to_string(case.join("run.json")).unwrap()
    );
    assert!(write(&case, &to, &only).unwrap().notes.is_empty());
    let made = write(&case, &to, &ALL).unwrap();
    assert!(made.files.len() > 20 && made.files.iter().all(|f| f.exists()));
}

#[test]
fn a_fibre_leaves_every_file_that_is_listed() {
    let dir = tempfile::tempdir().unwrap();
    let made = write(&fibre(dir.path()), &dir.path().join("to"), &ALL).unwrap();
    assert!(made.files.len() > 3 && made.files.iter().all(|f| f.exists()));
    assert!(made.notes.is_empty(), "{:?}", made.notes);
}

#[test]
fn folders_that_are_no_case_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let case = dir.path().join("case");
    let to = dir.path().join("to");
    let refusal_of = |folder: &Path, words: &[&str]| {
        let e = write(folder, &to, &ALL).unwrap_err();
        assert!(matches!(e, ViewError::Case { .. }), "{e}");
        for word in words {
            assert!(e.to_string().contains(word), "{e}");
        }
    };
    let refusal = |words: &[&str]| refusal_of(&case, words);
    refusal(&["no such folder", "one finished case"]);
    std::fs::create_dir(&case).unwrap();
    refusal(&["no run.json", "one finished case"]);
    let checkpoint = case.join("charge-1.checkpoint");
    std::fs::write(&checkpoint, "").unwrap();
    refusal(&["not finished"]);
    std::fs::remove_file(checkpoint).unwrap();
    let mark = case.join("run.json");
    let say = |text: &str| std::fs::write(&mark, text).unwrap();
    say("{");
    refusal(&["run.json", "damaged"]);
    // a file, and the folder above
    refusal_of(&mark, &["no such folder"]);
    refusal_of(dir.path(), &["cases (1)", "such as", "case"]);
    say("{\"schema\":\"other/1\"}");
    refusal(&[
        "other/1",
        "a knotted fibre (topo-elastic-case/1)",
        "a colloid (topo-nematic-case/1)",
    ]);
    for schema in ["topo-elastic-case/1", "topo-nematic-case/1"] {
        say(&format!("{{\"schema\":\"{schema}\"}}"));
        refusal(&["results version null"]);
        say(&format!(
            "{{\"schema\":\"{schema}\",\"versions\":{{\"results\":1,\"topo\":\"0.0.9\"}}}}"
        ));
        refusal(&["results version 1", "0.0.9", "run its scene again"]);
    }
    let tube = json!({ "length": 50.0, "contact_diameter": 2.0, "friction_range": 2.0, "start_length": 50.0 });
    let versions = json!({ "results": RESULTS_VERSION });
    let mut run = json!({ "schema": "topo-elastic-case/1", "versions": versions });
    say(&run.to_string());
    refusal(&["tube", "damaged"]);
    run["tube"] = tube;
    say(&run.to_string());
    refusal(&["charged.csv", "not found", "damaged"]);
    write_table(&case.join("charged.csv"), &[(1.0, 2.0)]).unwrap();
    refusal(&["charged.csv", "damaged"]);
    assert!(!to.exists());
}

#[test]
fn empty_pieces_say_that_they_are_empty() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("none.vtu");
    let about = About::default().at(Some(0.25));
    vtk::cells::<2>(&path, &about, &[], &[], &[]).unwrap();
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.contains("<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\">"));
    assert!(text.contains("Name=\"TimeValue\"") && text.contains(">0.25</DataArray>"));
    for tag in [
        "PointData",
        "Points",
        "Cells",
        "UnstructuredGrid",
        "VTKFile",
    ] {
        assert!(text.contains(&format!("</{tag}>")), "{tag}: {text}");
    }
}

#[test]
fn an_archive_reads_back_with_words_of_any_length() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("all.npz");
    let long = "θ".repeat(300);
    let about = About::default()
        .with("long", long.as_str())
        .with("empty", "")
        .with("length", 2.5);
    let mut archive = Archive::new(&about).unwrap();
    let wide: Vec<f64> = (0..24).map(|k| f64::from(k) / 7.0).collect();
    archive.add("wide", &[2, 3, 4], wide.clone()).unwrap();
    archive.add("single", &[2], vec![1.5_f32, -0.0]).unwrap();
    archive.add("whole", &[], vec![i64::MIN]).unwrap();
    archive.add("bytes", &[3], vec![0_u8, 7, 255]).unwrap();
    archive.add("truth", &[2], vec![true, false]).unwrap();
    archive.add("none", &[0, 3], Vec::<f64>::new()).unwrap();
    let refused = archive.add("short", &[5], vec![0.0; 4]).unwrap_err();
    assert!(refused.to_string().contains("array short: 4 values"));
    archive.write(&path).unwrap();

    let mut read = NpzReader::new(File::open(&path).unwrap()).unwrap();
    let found: ArrayD<f64> = read.by_name("wide").unwrap();
    assert_eq!(found, ArrayD::from_shape_vec(vec![2, 3, 4], wide).unwrap());
    let single: ArrayD<f32> = read.by_name("single").unwrap();
    assert_eq!(single.as_slice().unwrap(), [1.5, -0.0]);
    let whole: ArrayD<i64> = read.by_name("whole").unwrap();
    assert_eq!((whole.ndim(), whole.sum()), (0, i64::MIN));
    let bytes: ArrayD<u8> = read.by_name("bytes").unwrap();
    assert_eq!(bytes.as_slice().unwrap(), [0, 7, 255]);
    let truth: ArrayD<bool> = read.by_name("truth").unwrap();
    assert_eq!(truth.as_slice().unwrap(), [true, false]);
    let none: ArrayD<f64> = read.by_name("none").unwrap();
    assert_eq!(none.shape(), [0, 3]);
    let length: ArrayD<f64> = read.by_name("length").unwrap();
    assert_eq!(length.sum(), 2.5);
    for (name, words, n) in [("long", long.as_str(), 300), ("empty", "\0", 1)] {
        let mut zip = zip::ZipArchive::new(File::open(&path).unwrap()).unwrap();
        let mut bytes = Vec::new();
        let mut entry = zip.by_name(&format!("{name}.npy")).unwrap();
        entry.read_to_end(&mut bytes).unwrap();
        let values = bytes.len() - 4 * n;
        let header = String::from_utf8_lossy(&bytes[10..values]);
        assert!(header.contains(&format!("'<U{n}'")) && values % 64 == 0);
        let letter = |c: &[u8]| char::from_u32(u32::from_le_bytes(c.try_into().unwrap())).unwrap();
        let found: String = bytes[values..].chunks_exact(4).map(letter).collect();
        assert_eq!(found, words);
    }
}
