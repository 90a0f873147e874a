//! Rods that are curved or twisted at rest.

use std::f64::consts::{PI, TAU};

use std::path::Path;

use nalgebra::Vector3;
use topo_analysis::SweepRow;
use topo_core::Model;
use topo_knots::KnotTable;
use topo_lab::{ElasticScene, SweepSettings, identity, run_sweep};
use topo_rod::RodState;
use topo_tests::{curves, run};

/// A ring whose natural curvature is its own, (2/l) tan(π/N) for a polygon, stores nothing and pulls at nothing; cut, it stays.
#[test]
fn val_a_naturally_curved_ring_is_free_of_stress() {
    let (n, radius) = (120, 4.0);
    let curve = curves::ring(n, radius);
    let edge = curve.length() / n as f64;
    let natural = 2.0 / edge * (PI / n as f64).tan();
    let ring = RodState::new(&curve, curve.length(), 0.0).unwrap();
    let ring = ring.with_rest(|_, _| [natural, 0.0], |_, _| 0.0).unwrap();
    let setup = run::Setup::bare(1e-3).with_twist();
    for state in [ring.clone(), ring.cut_at(31).unwrap()] {
        let mut model = setup.model(&state);
        let energies = model.energies(&state).unwrap();
        assert!(energies.iter().all(|e| *e < 1e-12), "{energies:?}");
        let force = model.force(&state).unwrap();
        let largest = force.vertex.iter().map(|f| f.norm()).fold(0.0, f64::max);
        println!("force {largest:.1e}, energies {energies:?}");
        assert!(largest < 1e-12 && force.torque.iter().all(|t| t.abs() < 1e-12));
        let mut rate = vec![0.0; model.n_dof()];
        model.rate(&state, &mut rate).unwrap();
        assert!(topo_core::max_norm(&rate) < 1e-9);
    }
    // the same ring of a straight rod stores π B/R, of one curved the other way four times that
    for (factor, expected) in [(0.0, 1.0), (-1.0, 4.0)] {
        let state = ring.clone();
        let state = state
            .with_rest(|_, _| [factor * natural, 0.0], |_, _| 0.0)
            .unwrap();
        let stored = setup.model(&state).energies(&state).unwrap()[0];
        let by_hand = expected * 0.25 * PI / radius;
        assert!((stored / by_hand - 1.0).abs() < 1e-3, "{stored} {by_hand}");
    }
}

/// A rod that is half a turn at rest stores B L κ_0²/2 when it is straight, whichever way its material is turned, and curls up to a half circle.
#[test]
fn val_half_a_turn_opened_straight() {
    let length = 20.0;
    let natural = PI / length;
    let expected = 0.25 * length * natural * natural / 2.0;
    let fine = RodState::new(&curves::line(1600, length), length, 0.0).unwrap();
    for angle in [0.0, 0.4, 2.1] {
        let curvature = [natural * f64::cos(angle), natural * f64::sin(angle)];
        let state = fine
            .clone()
            .with_rest(|_, _| curvature, |_, _| 0.0)
            .unwrap();
        let stored = run::Setup::bare(1e-3)
            .model(&state)
            .energies(&state)
            .unwrap()[0];
        assert!(
            (stored / expected - 1.0).abs() < 1e-3,
            "{stored} {expected}"
        );
    }
    let line = RodState::new(&curves::line(100, length), length, 0.0).unwrap();
    let line = line
        .with_rest(|_, _| [0.6 * natural, 0.8 * natural], |_, _| 0.0)
        .unwrap();
    let mut run = run::Setup::bare(1e-5).with_twist().simulation(line);
    let start = run::stored(&run, "bend");
    run::run_to(&mut run, 2000.0);
    let left = run::stored(&run, "bend") / start;
    let across = run.state().end_to_end();
    println!(
        "left {left:.1e}, across {across}, books {:.1e}",
        run.model().account().relative_residual()
    );
    assert!(left < 1e-5, "{left:e}");
    assert!(
        (across / (2.0 * length / PI) - 1.0).abs() < 2e-3,
        "{across}"
    );
    assert!(run.model().account().relative_residual() < 2e-3);
}

/// A straight rod of natural twist θ'_0 winds itself up to it, at the rate of any twist, and stores nothing then; its natural
/// curvature, wound about it, makes a helix of curvature κ_0 and torsion θ'_0.
#[test]
fn val_natural_twist_and_curvature_make_a_helix() {
    let (length, natural, twist) = (12.0, 0.3, 0.5);
    let line = RodState::new(&curves::line(60, length), length, 0.0).unwrap();
    let twisted = line
        .clone()
        .with_rest(|_, _| [0.0; 2], |_, _| twist)
        .unwrap();
    let mut run = run::Setup::bare(1e-3).with_twist().simulation(twisted);
    run::run_to(&mut run, 60.0);
    let turns = twist * length * 59.0 / 60.0 / TAU;
    assert!((run.state().total_twist() / turns - 1.0).abs() < 1e-6);
    assert!(run::stored(&run, "twist") < 1e-9);
    let both = line.with_rest(|_, _| [natural, 0.0], |_, _| twist).unwrap();
    let mut run = run::Setup::bare(1e-3).with_twist().simulation(both);
    run::run_to(&mut run, 3000.0);
    let elastic = run::stored(&run, "bend") + run::stored(&run, "twist");
    // radius κ/(κ² + τ²), pitch 2πτ/(κ² + τ²): the chord of the helix
    let rate = f64::hypot(natural, twist);
    let (radius, rise) = (natural / (rate * rate), twist / rate);
    let chord = f64::hypot(rise * length, 2.0 * radius * (0.5 * rate * length).sin());
    let found = run.state().end_to_end();
    println!("left {elastic:.1e}, chord {found} of {chord}");
    assert!(elastic < 1e-6, "{elastic:e}");
    assert!((found / chord - 1.0).abs() < 5e-3, "{found} {chord}");
    let right_handed = run.state().writhe() > 0.0;
    let x = run.state().vertices();
    let (a, b, c): (Vector3<f64>, _, _) = (x[21] - x[20], x[31] - x[30], x[41] - x[40]);
    println!("writhe {}, triple {}", right_handed, a.dot(&b.cross(&c)));
    assert!(a.dot(&b.cross(&c)) > 0.0, "a left-handed helix");
}

/// Charges the ring of a scene, 50 h of fibre in 80 edges, and cuts it.
fn ring_of_scene(rest: &str, folder: &Path) -> SweepRow {
    let text = format!(
        "[rod]\nknot = \"0_1\"\nimperfection = 0.0\n{rest}\n[charge]\nduration = 0.1\n[discharge]\nlongest = 0.5\nclosures = 0\ncuts = 0.4\n[accuracy]\nedges = 80\n"
    );
    let scene = ElasticScene::parse(&text, &folder.join("ring.toml")).unwrap();
    let settings = SweepSettings {
        jobs: 1,
        ..SweepSettings::new(&folder.join(identity(&rest.into())))
    };
    let report = run_sweep(&scene, &KnotTable::builtin(), &settings, &|_| {}).unwrap();
    let case = settings.out.join("ring").join(&report.rows[0].case);
    let run = std::fs::read_to_string(case.join("run.json")).unwrap();
    assert_eq!(run.contains("\"rest\""), !rest.is_empty(), "{run}");
    report.rows[0].clone()
}

/// A ring of a fibre that is as curved at rest stores nothing, by a number or a file, and keeps its shape when it is cut; that of a
/// straight fibre stores B L κ²/2 = π/8 (2π/50)² in E_0, and one curved the other way four times that.
#[test]
fn val_a_naturally_curved_ring_of_a_scene_stores_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (n, length) = (80.0, 50.0);
    let natural = 2.0 * n / length * f64::tan(PI / n);
    let file =
        format!("s,curvature_2,curvature_1\n0,0,{natural}\n0.3,0,{natural}\n1,0,{natural}\n");
    std::fs::write(folder.path().join("ring.csv"), file).unwrap();
    let row = |rest: &str| ring_of_scene(rest, folder.path());
    let straight = row("").energy;
    let by_hand = PI / 8.0 * (TAU / length).powi(2);
    println!("straight {straight:.4e}, by hand {by_hand:.4e}");
    assert!(
        (straight / by_hand - 1.0).abs() < 2e-3,
        "{straight} {by_hand}"
    );
    let number = row(&format!("[rod.rest]\ncurvature = {natural}"));
    let along = row("[rod.rest]\ncurvature = \"ring.csv\"");
    for ring in [&number, &along] {
        println!("curved {:.1e}", ring.energy);
        assert!(ring.energy < 1e-6 * straight, "{:e}", ring.energy);
    }
    assert_eq!(number.energy, along.energy);
    assert_ne!(number.case, along.case);
    let other = row(&format!("[rod.rest]\ncurvature = [{}, 0.0]", -natural)).energy;
    assert!((other / (4.0 * straight) - 1.0).abs() < 2e-3, "{other}");
}
