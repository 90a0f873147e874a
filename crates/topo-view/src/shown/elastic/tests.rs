//! A link from its scene to pictures, page and files: every component is there, closed or cut.

use crate::export::{self, Wanted};
use crate::plot::font::base64;
use crate::shown::Shown;
use crate::{folder, viewer};
use ndarray::{Array1, Array2, Array3};
use ndarray_npy::NpzReader;
use serde_json::{Value, json};
use std::fs::File;
use std::path::{Path, PathBuf};
use topo_core::Interrupt;
use topo_knots::KnotTable;
use topo_lab::{Elastic, ElasticScene, SweepSettings, run_sweep};

/// Two rings, each of 24 edges.
const HOPF: &str = "[rod]\nlink = \"hopf\"\ntwist = 0.5\n[rod.contact]\n[charge]\nduration = 0.02\n[discharge]\nuntil_released = 0.1\nlongest = 0.2\ncuts = 0.75\n[accuracy]\nedges = 48\ntolerance = 1e-2\n";
/// Vertices of a ring.
const N: usize = 24;

/// Results of the scene, and the folder of its case.
fn hopf(out: &Path) -> PathBuf {
    let mut scene = ElasticScene::parse(HOPF, Path::new("elastic.toml")).unwrap();
    (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
    let settings = SweepSettings::new(out);
    let report = run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap();
    assert!(report.failed.is_empty(), "{:?}", report.failed);
    out.join("elastic").join(&report.rows[0].case)
}

/// The data of the page on the states of a knot or link.
fn states(out: &Path, name: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(out.join(format!("viewer/elastic/{name}.js"))).unwrap();
    let text = text.split_once(", ").unwrap().1;
    serde_json::from_str(text.trim_end().trim_end_matches(");")).unwrap()
}

/// Indices as a VTK file has them.
fn indices(values: impl IntoIterator<Item = usize>) -> String {
    let bytes: Vec<u8> = values
        .into_iter()
        .flat_map(|i| (i as i64).to_le_bytes())
        .collect();
    let head = (bytes.len() as u64).to_le_bytes().to_vec();
    format!(">{}</DataArray>", base64(&[head, bytes].concat()))
}

fn check_page(out: &Path) {
    let section = viewer::sections(out).unwrap();
    assert!(section.contains("L2a1"));
    let state = &states(out, "L2a1")[0];
    assert_eq!(state["n"], json!([N, N]));
    let closed = state["closed"].as_array().unwrap();
    assert_eq!(closed[0], json!([true, true]));
    assert!(closed.len() > 2, "{closed:?}");
    assert!(
        closed[1..]
            .iter()
            .all(|shape| *shape == json!([true, false]))
    );
    // a point is six bytes, which are eight letters: the rings are not one
    let xyz = state["xyz"].as_str().unwrap();
    assert_ne!(xyz[..8 * N], xyz[8 * N..16 * N]);
    let bytes = state["w"].as_str().unwrap().len() / 4 * 3;
    assert!(bytes.abs_diff(2 * N * closed.len()) < 3, "{bytes}");
}

fn check_picture(out: &Path) {
    let batteries: [&dyn Shown; 1] = [&Elastic];
    let found = folder::find(&out.join("elastic"), &batteries).unwrap();
    folder::draw(&found, &Interrupt::new(), &|_| {}).unwrap();
    let file = |extension: &str| out.join(format!("elastic/figures/shapes.{extension}"));
    let csv = std::fs::read_to_string(file("csv")).unwrap();
    let of = |c: &str| {
        let rows = csv.lines().filter(|l| l.split(',').nth(1) == Some(c));
        rows.count()
    };
    assert_eq!((of("1"), of("2"), csv.lines().count()), (N, N, 1 + 2 * N));
    let png = std::fs::read(file("png")).unwrap();
    let picture = resvg::tiny_skia::Pixmap::decode_png(&png).unwrap();
    let colored = picture.pixels().iter().filter(|p| {
        let [r, g, b] = [p.red(), p.green(), p.blue()];
        r.max(g).max(b) - r.min(g).min(b) > 40
    });
    // two rings in a square of 180 units, four pixels each, and the colour bar
    let share = colored.count() as f64 / f64::from(picture.width() * picture.height());
    assert!(share > 0.1, "{share}");
}

fn check_files(case: &Path, to: &Path) {
    let wanted = Wanted {
        vtk: true,
        npz: true,
        nemaktis: None,
    };
    export::write(case, to, &wanted, &[&Elastic]).unwrap();
    let text = |name: &str| std::fs::read_to_string(to.join(name)).unwrap();
    let rings = (0..N).chain([0]).chain(N..2 * N).chain([N]);
    let charged = text("charged.vtp");
    assert!(charged.contains("NumberOfLines=\"2\"") && charged.contains(&indices(rings)));
    assert!(charged.contains(&indices([1, 2])), "components of lines");
    // the second ring is open: its first vertex is there twice
    let one = (0..N).chain([0]).chain(N..2 * N + 1);
    assert!(text("discharge-1-00.vtp").contains(&indices(one)));
    let mut npz = NpzReader::new(File::open(to.join("fibre.npz")).unwrap()).unwrap();
    let closed: Array1<bool> = npz.by_name("charged_closed").unwrap();
    assert_eq!(closed.to_vec(), [true, true]);
    let closed: Array1<bool> = npz.by_name("discharge1_closed").unwrap();
    assert_eq!(closed.to_vec(), [true, false]);
    let component: Array1<i64> = npz.by_name("discharge1_component").unwrap();
    let count = |k: i64| component.iter().filter(|c| **c == k).count();
    assert_eq!((count(1), count(2)), (N, N + 1));
    let points: Array2<f64> = npz.by_name("charged_points").unwrap();
    assert_eq!(points.dim(), (2 * N, 3));
    let points: Array3<f64> = npz.by_name("discharge1_points").unwrap();
    assert_eq!((points.dim().1, points.dim().2), (2 * N + 1, 3));
}

#[test]
fn a_link_has_all_its_components_in_pictures_pages_and_files() {
    let dir = tempfile::tempdir().unwrap();
    let case = hopf(dir.path());
    check_picture(dir.path());
    check_page(dir.path());
    check_files(&case, &dir.path().join("to"));
}

#[test]
fn tables_that_do_not_belong_together_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let case = hopf(dir.path());
    let charged = std::fs::read_to_string(case.join("charged.csv")).unwrap();
    let first = charged.lines().filter(|l| !l.starts_with("2,"));
    let first: Vec<&str> = first.collect();
    std::fs::write(case.join("charged.csv"), first.join("\n")).unwrap();
    let message = crate::data::snapshots(&case).unwrap_err().to_string();
    for word in ["snapshots.csv", "2 components", "charged.csv has 1"] {
        assert!(message.contains(word), "{message}");
    }
}
