//! Mirror images: a mirrored knot at the opposite twist is the mirror image of the knot, in every table of a sweep.

use std::path::Path;

use topo_analysis::{SweepRow, read_table};
use topo_core::{Polyline, RunHooks};
use topo_knots::{KnotTable, closed_braid};
use topo_lab::{ElasticScene, SweepSettings, run_sweep};
use topo_rod::{
    Accuracy, ChargeSettings, CutSite, DischargeSettings, Guards, RodBattery, RodError,
    RodParameters,
};
use topo_tests::curves::{closed, ring, trefoil};

#[derive(serde::Deserialize)]
struct Vertex {
    x: f64,
    y: f64,
    z: f64,
    twist: f64,
}

#[derive(serde::Deserialize)]
struct Moment {
    time: f64,
    energy: f64,
    writhe: f64,
    total_twist: f64,
    knot: Option<String>,
    knot_probability: Option<f64>,
}

fn sweep(knot: &str, twist: f64, table: &KnotTable, out: &Path) -> Vec<SweepRow> {
    let text = format!(
        "[rod]\nknot = {knot:?}\ntwist = {twist:.1}\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.3\n\
         [discharge]\nuntil_released = 0.97\ncuts = \"near-ties\"\n[accuracy]\nedges = 80\n"
    );
    let mut scene = ElasticScene::parse(&text, Path::new(knot)).unwrap();
    (scene.tighten.n_variants, scene.tighten.n_kicks) = (0, 0);
    let settings = SweepSettings {
        jobs: 1,
        ..SweepSettings::new(out)
    };
    run_sweep(&scene, table, &settings, &|_| {}).unwrap().rows
}

/// Rows of the mirror image as those of the knot itself must be.
fn mirrored(row: &SweepRow, name: &str, case: &str) -> SweepRow {
    SweepRow {
        case: case.to_owned(),
        knot: format!("m{name}"),
        name: format!("m{name}"),
        twist: -row.twist,
        writhe: -row.writhe,
        total_twist: -row.total_twist,
        cpu_seconds: 0.0,
        ..row.clone()
    }
}

/// A table with a trefoil of its own in `folder`, as a polygon.
fn table_with_own(folder: &Path) -> KnotTable {
    let text = "name = \"tre\"\ncrossing_number = 3\nchirality = \"chiral\"\npolygon = \"tre.csv\"\n\
        [invariants]\nalexander = [1, -1, 1]\ndeterminant = 3\nsignature = -2\n";
    std::fs::write(folder.join("tre.toml"), text).unwrap();
    let rows = closed_braid(&[1, 1, 2, -2, 1, 2]).unwrap();
    let rows = rows
        .vertices()
        .iter()
        .map(|x| format!("{},{},{}\n", x.x, x.y, x.z));
    let rows = format!("x,y,z\n{}", rows.collect::<String>());
    std::fs::write(folder.join("tre.csv"), rows).unwrap();
    KnotTable::builtin().with_folder(folder).unwrap()
}

/// The natural shape at s/L of a rod and, with hand −1, of its mirror image.
fn natural(s: f64, hand: f64) -> ([f64; 2], f64) {
    let angle = std::f64::consts::TAU * s;
    let curvature = [0.08 + 0.05 * angle.sin(), hand * 0.07 * angle.cos()];
    (curvature, hand * (0.2 + 0.1 * angle.cos()))
}

fn shaped(curve: &Polyline, hand: f64) -> RodBattery {
    let parameters = RodParameters {
        n_edges: 60,
        twist: Some(hand),
        ..RodParameters::default()
    };
    let (accuracy, guards) = (Accuracy::default(), Guards::default());
    let battery = RodBattery::new(&parameters, &accuracy, guards, curve).unwrap();
    let length = battery.tube().length;
    let at = |s: f64| natural(s / length, hand);
    battery.with_rest(|_, s| at(s).0, |_, s| at(s).1).unwrap()
}

/// Twisted fibres that are curved and twisted at rest: (κ_1, −κ_2) and −θ' along the mirrored curve at the opposite twist give the mirror
/// image of charge and discharge, to the bit. The same fibre along the mirrored curve is that of the mirrored shape at the opposite twist.
#[test]
fn law_fibres_with_a_natural_shape_are_mirrored_with_it() {
    let curve = trefoil(60, 2.0, 1.0);
    let (ours, image) = (shaped(&curve, 1.0), shaped(&curve.mirrored(), -1.0));
    let rest = ours.start().rest().unwrap().mirrored();
    assert_eq!(image.start().rest(), Some(&rest));
    let same = shaped(&curve, -1.0).mirrored().unwrap();
    let start = |battery: &RodBattery| {
        let state = battery.start();
        let twists = state.twists().to_vec();
        (state.vertices().to_vec(), twists, state.rest().cloned())
    };
    assert_eq!(start(&same), start(&image));
    let run = |battery: &RodBattery| {
        let charge = ChargeSettings {
            duration: 0.05,
            ..ChargeSettings::default()
        };
        let settings = DischargeSettings {
            until_released: 0.5,
            ..DischargeSettings::default()
        };
        let none = &mut RunHooks::default();
        let charged = battery.charge(&charge, none).unwrap();
        let cut = charged.cut(CutSite::At(0.3)).unwrap();
        let discharge = cut.discharge(&settings, none).unwrap();
        let samples = [&charged.record().samples[..], &discharge.record.samples].concat();
        samples
            .iter()
            .map(|s| {
                (
                    s.elastic(),
                    s.state.vertices().to_vec(),
                    s.state.twists().to_vec(),
                )
            })
            .collect::<Vec<_>>()
    };
    let (ours, theirs) = (run(&ours), run(&image));
    assert_eq!(ours.len(), theirs.len());
    for ((energy, x, twists), (e, y, turned)) in ours.iter().zip(&theirs) {
        assert_eq!(energy, e);
        assert!(
            x.iter()
                .zip(y)
                .all(|(a, b)| (a.x, a.y, a.z) == (b.x, b.y, -b.z))
        );
        assert!(twists.iter().zip(turned).all(|(a, b)| *a == -b));
    }
}

/// Energies, times, shapes, twists, writhe, knot types and cut sites of 3_1, 4_1, 6_3 and a knot of an own folder, to the bit.
#[test]
fn law_mirrored_knots_give_mirrored_runs() {
    let own = tempfile::tempdir().unwrap();
    let table = table_with_own(own.path());
    let out = tempfile::tempdir().unwrap();
    for name in ["3_1", "6_2", "6_3", "tre"] {
        let knot = sweep(name, 1.0, &table, out.path());
        let image = sweep(&format!("m{name}"), -1.0, &table, out.path());
        assert!(!knot.is_empty() && knot[0].t90.is_some());
        for (knot, image) in knot.iter().zip(&image) {
            println!(
                "{name}: t90 {:?} and {:?}, {}",
                knot.t90, image.t90, image.warnings
            );
            assert_eq!(
                mirrored(knot, name, &image.case),
                SweepRow {
                    cpu_seconds: 0.0,
                    ..image.clone()
                }
            );
            assert!(
                !image
                    .warnings
                    .iter()
                    .any(|w| matches!(w, topo_analysis::Warning::Retied { .. })),
                "{}",
                image.warnings
            );
        }
        assert_eq!(knot.len(), image.len());
        let folder = |row: &SweepRow| out.path().join(&row.knot).join(&row.case);
        let (ours, theirs) = (folder(&knot[0]), folder(&image[0]));
        for file in ["charged.csv", "snapshots.csv"] {
            let read = |folder: &Path| read_table::<Vertex>(&folder.join(file)).unwrap();
            for (a, b) in read(&ours).iter().zip(&read(&theirs)) {
                assert_eq!((a.x, a.y, a.z, a.twist), (b.x, b.y, -b.z, -b.twist));
            }
        }
        let read = |folder: &Path| read_table::<Moment>(&folder.join("series.csv")).unwrap();
        let mut n_named = 0;
        for (a, b) in read(&ours).iter().zip(&read(&theirs)) {
            let numbers =
                |m: &Moment, side: f64| (m.time, m.energy, side * m.writhe, side * m.total_twist);
            assert_eq!(numbers(a, 1.0), numbers(b, -1.0));
            assert_eq!(a.knot_probability, b.knot_probability);
            let named = a.knot.as_deref().map(|label| table.mirror_label(label));
            assert_eq!(b.knot, named);
            n_named += usize::from(named.is_some_and(|name| name.starts_with('m')));
        }
        assert!(n_named > 0, "{name}: no type of the mirror image");
    }
}

fn battery(curve: &Polyline) -> Result<RodBattery, RodError> {
    let parameters = RodParameters {
        n_edges: 60,
        ..Default::default()
    };
    RodBattery::new(&parameters, &Accuracy::default(), Guards::default(), curve)
}

/// The ropelength of a battery is that of its curve, whatever the unit and the polygon; a curve that touches itself has none.
#[test]
fn law_ropelength_is_that_of_the_curve() {
    let circle = battery(&ring(400, 3.0)).unwrap();
    assert!((circle.ropelength() / std::f64::consts::TAU - 1.0).abs() < 1e-4);
    assert!(circle.start().cut_at(0).is_ok());
    let knot = trefoil(400, 2.0, 1.0);
    let exact = knot.length() / topo_core::thickness_brute_force(&knot).tau;
    for curve in [
        knot.clone(),
        knot.scaled(7.0).unwrap(),
        trefoil(200, 2.0, 1.0),
    ] {
        let found = battery(&curve).unwrap();
        assert!((found.ropelength() / exact - 1.0).abs() < 2e-3);
        // strands of the tube touch at most: the tube is as fat as the curve allows
        let start = found.start().centreline().unwrap();
        let apart = 2.0 * topo_core::thickness(&start.resampled(800).unwrap()).tau;
        assert!(found.tube().contact_diameter < 1.001 * apart);
    }
    let eight = closed(200, |u| {
        nalgebra::Vector3::new(u.sin(), (2.0 * u).sin(), 0.0)
    });
    let refused = battery(&eight).unwrap_err();
    assert!(
        matches!(refused, RodError::TouchesItself { .. }),
        "{refused}"
    );
    assert!(refused.to_string().contains("touches itself"));
    let line = topo_tests::curves::line(60, 5.0);
    assert!(matches!(
        battery(&line),
        Err(RodError::WrongTopology { .. })
    ));
}

/// A start may be disturbed by half a radius, no further.
#[test]
fn law_disturbed_starts_stay_near() {
    let plain = battery(&trefoil(400, 2.0, 1.0)).unwrap();
    let h = plain.centreline().length() / plain.tube().start_length;
    let moved = |by: f64| {
        let mut vertices = plain.centreline().vertices().to_vec();
        vertices[7].z += by * h;
        plain.disturbed(&Polyline::new(vertices, true).unwrap())
    };
    let near = moved(0.4).unwrap();
    assert_eq!(near.tube(), plain.tube());
    assert_ne!(near.start().vertices(), plain.start().vertices());
    for refused in [moved(0.6), plain.disturbed(&ring(50, 1.0))] {
        assert!(matches!(refused, Err(RodError::Disturbance { .. })));
    }
    let charge = topo_rod::ChargeSettings {
        duration: 1e-3,
        ..Default::default()
    };
    let charged = near.charge(&charge, &mut RunHooks::default()).unwrap();
    assert!(charged.cut(CutSite::At(0.5)).is_ok());
}
