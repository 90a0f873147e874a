//! An energy term from outside of the workspace, a harmonic trap: its closed forms, and where everything that follows the list of terms
//! has it.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use topo_analysis::{DischargeTimes, ELASTIC_SHARES};
use topo_core::{RunHooks, reference_energy, reference_time};
use topo_knots::KnotTable;
use topo_lab::{ElasticScene, SweepSettings, run_sweep};
use topo_rod::contact::ContactPairs;
use topo_rod::energy::{At, EnergyKind, EnergyTerm, Force, Stiffness, gradient_error};
use topo_rod::{
    Accuracy, ChargeSettings, CutSite, DischargeSettings, EndCondition, Ends, Guards, RodBattery,
    RodError, RodParameters, RodSample, cut_circle_energy,
};
use topo_tests::curves::{line, ring, trefoil};
use topo_tests::run::{Setup, rod, run_to, stored};

/// e = (k/2) ∫ |x − c|² ds.
#[derive(Debug, Clone, Copy)]
struct Trap {
    stiffness: f64,
    centre: Vector3<f64>,
}

impl Trap {
    fn of(stiffness: f64) -> Self {
        let centre = Vector3::zeros();
        Self { stiffness, centre }
    }

    fn density(&self, x: &Vector3<f64>) -> f64 {
        0.5 * self.stiffness * (x - self.centre).norm_squared()
    }
}

impl EnergyTerm for Trap {
    fn name(&self) -> &'static str {
        "trap"
    }

    fn energy(&self, at: At<'_>) -> f64 {
        let vertices = at.state.vertices().iter().enumerate();
        vertices.map(|(i, x)| self.density(x) * at.share(i)).sum()
    }

    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        for (i, x) in at.state.vertices().iter().enumerate() {
            force.vertex[i] -= (x - self.centre) * (self.stiffness * at.share(i));
        }
        self.energy(at)
    }

    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        for (i, block) in stiffness.diagonal.iter_mut().enumerate() {
            *block += Matrix3::from_diagonal_element(self.stiffness * at.share(i));
        }
    }

    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        for (w, x) in density.iter_mut().zip(at.state.vertices()) {
            *w += self.density(x);
        }
    }
}

/// The same energy under another name or as the penalty of a constraint.
struct Renamed(Trap, &'static str, EnergyKind);

impl EnergyTerm for Renamed {
    fn name(&self) -> &'static str {
        self.1
    }
    fn kind(&self) -> EnergyKind {
        self.2
    }
    fn energy(&self, at: At<'_>) -> f64 {
        self.0.energy(at)
    }
    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64 {
        self.0.add_force(at, force)
    }
    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness) {
        self.0.add_stiffness(at, stiffness);
    }
    fn add_density(&self, at: At<'_>, density: &mut [f64]) {
        self.0.add_density(at, density);
    }
}

/// A circle of rod without contact, on as many edges, of the length `slenderness`.
fn circle(n_edges: usize, slenderness: f64, tolerance: f64) -> RodBattery {
    let parameters = RodParameters {
        n_edges,
        slenderness,
        twist: None,
        contact: None,
        friction: None,
        ..Default::default()
    };
    let accuracy = Accuracy {
        tolerance,
        ..Default::default()
    };
    let curve = ring(n_edges, 1.0);
    RodBattery::new(&parameters, &accuracy, Guards::default(), &curve).unwrap()
}

#[test]
fn trap_force_is_the_gradient() {
    let trap = Trap {
        stiffness: 0.3,
        centre: Vector3::new(0.4, -1.0, 0.7),
    };
    let closed = rod(&trefoil(40, 3.0, 1.0), 0.5);
    for state in [closed.clone(), closed.cut_at(7).unwrap()] {
        let error = gradient_error(&trap, &state, &mut ContactPairs::new(0.0, 0.3), 2e-3);
        assert!(error < 1e-7, "{error:.1e}");
    }
}

/// A circle of radius R_0 in a trap at its centre: the bend of its polygon does not depend on the radius, so that
/// dR/dt = −γ (R − R_0) − k R_0² R, which ends at R_0/(1 + k R_0²/γ).
#[test]
fn val_circle_in_a_trap_shrinks_as_its_closed_form() {
    let (n, length, gamma, k) = (60, 20.0, 5.0, 1e-3);
    let battery = circle(n, length, 1e-6);
    let battery = battery.with(move |_| Box::new(Trap::of(k))).unwrap();
    let settings = ChargeSettings {
        duration: 0.1,
        ..Default::default()
    };
    let charged = battery.charge(&settings, &mut RunHooks::default()).unwrap();
    let record = charged.record();
    let (scale, t0) = (reference_energy(length), reference_time(length));
    let (l0, half) = (length / n as f64, PI / n as f64);
    let start = l0 / (2.0 * half.sin());
    let (rate, end) = (
        gamma + k * start * start,
        start / (1.0 + k * start * start / gamma),
    );
    let energies = |radius: f64| {
        let bend = n as f64 * half.tan().powi(2) / (2.0 * l0);
        let stretch = 0.5 * gamma * length * (radius / start - 1.0).powi(2);
        let trap = 0.5 * k * length * radius * radius;
        [bend, stretch, trap].map(|e| e / scale)
    };
    // every step of the charge
    let curve = &record.curve;
    let series = ["bend", "stretch", "trap"].map(|part| curve.series(part).unwrap());
    let mut worst: f64 = 0.0;
    for (i, time) in curve.time().iter().enumerate() {
        let exact = energies(end + (start - end) * (-rate * time * t0).exp());
        let scale = [
            exact[0],
            energies(end)[1],
            energies(start)[2] - energies(end)[2],
        ];
        for part in 0..3 {
            worst = worst.max((series[part][i] - exact[part]).abs() / scale[part]);
        }
    }
    println!("{} steps, energies off by {worst:.1e}", curve.len());
    assert!(curve.len() > 20 && worst < 3e-4, "{worst:.1e}");
    // and its end
    let exact = energies(end);
    let last = record.samples.last().unwrap();
    let books = &record.report.ledger;
    for (part, exact) in ["bend", "stretch", "trap"].iter().zip(exact) {
        assert!((last.stored.of(part) / exact - 1.0).abs() < 1e-6, "{part}");
        let booked = books.stored_in(part).unwrap() / scale;
        assert!((booked / exact - 1.0).abs() < 1e-6, "{part}");
    }
    let total: f64 = exact.iter().sum();
    assert!((last.elastic() / total - 1.0).abs() < 1e-6);
    assert!(record.report.ledger_residual < 1e-5);
    // the same at every vertex
    let density = charged.density().iter().map(|w| w * length / scale);
    assert!(density.into_iter().all(|w| (w / total - 1.0).abs() < 1e-6));
    // without the trap there is no such part
    let plain = circle(n, length, 1e-6).charge(&settings, &mut RunHooks::default());
    let plain = plain.unwrap();
    let last = plain.record().samples.last().unwrap();
    assert_eq!((last.stored.of("trap"), last.stored.len()), (0.0, 4));
}

/// Share of the bending energy of a cut circle of unit length that is left after `t`, in T_b, and (1/2) ∫ |x − x̄|² ds of its shape: its
/// tangent angle is −(8/π) Σ cos(nπs) e^{−n² t/2}/n² over odd n.
fn opened(t: f64) -> (f64, f64) {
    let m = 2000;
    let angle = |u: f64| -> f64 {
        let odd = (0..40).map(|k| f64::from(2 * k + 1));
        let term = |n: f64| (n * PI * u).cos() * (-0.5 * n * n * t).exp() / (n * n);
        -8.0 / PI * odd.map(term).sum::<f64>()
    };
    let mut x = vec![Vector3::zeros()];
    for j in 0..m {
        let angle = angle((f64::from(j) + 0.5) / f64::from(m));
        let last = x[x.len() - 1];
        x.push(last + Vector3::new(angle.cos(), angle.sin(), 0.0) / f64::from(m));
    }
    let share = |i: usize| if i == 0 || i == m as usize { 0.5 } else { 1.0 } / f64::from(m);
    let mean: Vector3<f64> = x.iter().enumerate().map(|(i, x)| x * share(i)).sum();
    let spread = x
        .iter()
        .enumerate()
        .map(|(i, x)| (x - mean).norm_squared() * share(i));
    (cut_circle_energy(t), 0.5 * spread.sum::<f64>())
}

/// A cut circle in a trap so weak that it hardly changes how the circle opens: bend is released as without it, and the trap takes up what
/// the opening shape costs in it, (k/24) L³ in the end against (k/8π²) L³ at the start. Released shares count both, which delays the last
/// of them by a third.
#[test]
fn val_cut_circle_in_a_weak_trap() {
    let (n, length) = (100, 50.0);
    let k = 5e-4 * (TAU / length).powi(4);
    let battery = circle(n, length, 1e-5);
    let battery = battery.with(move |_| Box::new(Trap::of(k))).unwrap();
    let charge = ChargeSettings {
        duration: 0.1,
        ..Default::default()
    };
    let settings = DischargeSettings {
        until_released: 0.991,
        ..Default::default()
    };
    let charged = battery.charge(&charge, &mut RunHooks::default()).unwrap();
    let cut = charged.cut(CutSite::At(0.0)).unwrap();
    let run = cut.discharge(&settings, &mut RunHooks::default()).unwrap();
    let record = &run.record;
    let bend = 0.125 * TAU * TAU / length;
    let stored = |t: f64| {
        let (share, spread) = opened(t);
        share * bend + k * length.powi(3) * spread
    };
    let start = stored(0.0);
    assert!((run.start * reference_energy(length) / start - 1.0).abs() < 1e-3);
    // t99 of all that is stored, and of bend alone as if the trap were not there
    let parts = record.report.own.parts.elastic();
    assert_eq!(parts, ["bend", "twist", "stretch", "trap"]);
    let found = DischargeTimes::of(&record.curve, &parts, run.start, &ELASTIC_SHARES);
    for share in ELASTIC_SHARES {
        let (mut low, mut high) = (0.0, 20.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if stored(middle) > (1.0 - share) * start {
                low = middle;
            } else {
                high = middle;
            }
        }
        let exact = low * length / (PI * PI);
        let time = found.at(share).unwrap().value;
        let error = time / exact - 1.0;
        println!("t{share}: {time:.3} T_0, {exact:.3} expected, off by {error:.1e}");
        assert!(error.abs() < 0.02, "{share}: {error:.1e}");
    }
    let without = DischargeTimes::of(&record.curve, &parts[..3], run.start, &ELASTIC_SHARES);
    let [all, bend_only] = [&found, &without].map(|times| times.at(0.99).unwrap().value);
    println!("t99 {all:.3} with the trap, {bend_only:.3} if it did not count");
    assert!(all > 1.15 * bend_only);
    // the discharge goes on until the share is released of all that is stored, no longer
    let goal = 0.009 * run.after_cut;
    let total = |i: usize| record.curve.stored_total(i);
    let last = record.curve.len() - 1;
    assert!(run.is_finished(), "{}", record.report.stop);
    assert!(total(last) <= goal && total(last - 1) > goal);
    // in the end a straight rod, and a book that closes
    let books = &record.report.ledger;
    let straight = k * length.powi(3) / 24.0;
    let trap = books.stored_in("trap").unwrap();
    assert!((trap / straight - 1.0).abs() < 0.03, "{}", trap / straight);
    println!("books open by {:.1e}", record.report.ledger_residual);
    assert!(record.report.ledger_residual < 2e-4);
    let open = battery.energy_density(&record.samples.last().unwrap().state);
    let l0 = length / n as f64;
    let ends = 0.5 * (open[0] + open[n]);
    let sum = (open[1..n].iter().sum::<f64>() + ends) * l0;
    assert!((sum / books.stored_total() - 1.0).abs() < 1e-9);
}

/// A straight rod whose one end is held in the middle of a trap is pressed to x(s) = sinh(q s)/(q cosh(q L)), q² = k/γ, at second order
/// in the edges.
#[test]
fn val_straight_rod_in_a_trap_is_pressed_to_a_sinh() {
    let (length, gamma, k) = (5.0, 5.0, 0.05_f64);
    let q = (k / gamma).sqrt();
    let pinned = Ends {
        conditions: [EndCondition::Pinned, EndCondition::Free],
        ..Default::default()
    };
    let error = |n: usize| {
        let setup = Setup::bare(1e-6).with_ends(pinned);
        let state = rod(&line(n, length), 0.0);
        let model = setup.model(&state).with(Box::new(Trap::of(k))).unwrap();
        let mut simulation = setup.simulation_of(model, state);
        run_to(&mut simulation, 6.0);
        let x = simulation.state().vertices();
        let exact = |i: usize| {
            let s = length * i as f64 / n as f64;
            (q * s).sinh() / (q * (q * length).cosh())
        };
        let off = (0..=n).map(|i| (x[i].x - exact(i)).abs());
        let worst = off.fold(0.0, f64::max) / (length - exact(n));
        let trap = 0.25 * k / (q * q * (q * length).cosh().powi(2))
            * ((2.0 * q * length).sinh() / (2.0 * q) - length);
        let found = stored(&simulation, "trap") / trap - 1.0;
        println!("{n} edges: shape off by {worst:.1e}, energy by {found:.1e}");
        assert!(simulation.model().account().relative_residual() < 1e-4);
        worst
    };
    let (coarse, fine) = (error(10), error(20));
    let order = (coarse / fine).log2();
    assert!(fine < 2e-3 && order > 1.8, "{fine:.1e}, order {order:.2}");
}

/// A free rod beside the middle of a trap stays where it is, since nothing outside resists it, and its books close all the same: the
/// force on the whole of it does no work.
#[test]
fn law_free_rods_keep_their_centroid_in_a_trap() {
    let trap = Trap {
        stiffness: 0.02,
        centre: Vector3::new(2.0, 3.0, -1.0),
    };
    let closed = rod(&trefoil(60, 3.0, 1.0), 0.0);
    for state in [closed.clone(), closed.cut_at(11).unwrap()] {
        let setup = Setup::bare(1e-5);
        let centroid = |x: &[Vector3<f64>]| x.iter().sum::<Vector3<f64>>() / x.len() as f64;
        let before = centroid(state.vertices());
        let model = setup.model(&state).with(Box::new(trap)).unwrap();
        let mut simulation = setup.simulation_of(model, state);
        let start = simulation.model().account().stored_total();
        run_to(&mut simulation, 20.0);
        let moved = (centroid(simulation.state().vertices()) - before).norm();
        let account = simulation.model().account();
        let released = 1.0 - account.stored_total() / start;
        let (open, n_steps) = (account.relative_residual(), simulation.n_steps());
        println!("{n_steps} steps, {released:.2} released, books open by {open:.1e}");
        assert!(moved < 1e-9, "{moved:.1e}");
        assert!(released > 0.2 && open < 2e-5, "{released} {open:.1e}");
        // long steps, as of a rod whose matrix has the trap and no hold at one vertex
        assert!(n_steps < 300, "{n_steps} steps");
    }
}

#[test]
fn names_that_cannot_stand_in_a_table_are_refused() {
    for name in ["bend", "contact", "friction", "", "My trap", "2nd", "a,b"] {
        let make = move |_: &_| -> Box<dyn EnergyTerm> {
            Box::new(Renamed(Trap::of(1.0), name, EnergyKind::Elastic))
        };
        let refused = circle(40, 20.0, 1e-3).with(make).unwrap_err();
        assert!(matches!(refused, RodError::Term { .. }), "{refused}");
    }
    let trap = |_: &_| -> Box<dyn EnergyTerm> { Box::new(Trap::of(1.0)) };
    let once = circle(40, 20.0, 1e-3).with(trap).unwrap();
    assert!(once.with(trap).unwrap_err().to_string().contains("trap"));
}

/// A quantity that no table has: the radius of gyration, L/2π of a circle and L/√12 of a straight rod, is a column of every table, in each
/// row that of its shape; its name may be no column's, and cases without it are not gone on with.
#[test]
fn law_an_observable_from_outside_is_found_in_every_table() {
    let folder = tempfile::tempdir().unwrap();
    let (table, settings) = (KnotTable::builtin(), SweepSettings::new(folder.path()));
    let gyration = |sample: &RodSample| {
        let state = &sample.state;
        let n = state.n_vertices();
        let share = |i: usize| {
            if state.is_interior(i) { 1.0 } else { 0.5 }
        };
        let total: f64 = (0..n).map(share).sum();
        let mean = |f: &dyn Fn(usize) -> Vector3<f64>| {
            (0..n).map(|i| f(i) * share(i)).sum::<Vector3<f64>>() / total
        };
        let x = state.vertices();
        let centre = mean(&|i| x[i]);
        let square = mean(&|i| Vector3::repeat((x[i] - centre).norm_squared()));
        square.x.sqrt()
    };
    let text = SCENE.replace("0.7", "0.9999");
    let plain = ElasticScene::parse(&text, Path::new("circle.toml")).unwrap();
    let run = |scene: &ElasticScene| run_sweep(scene, &table, &settings, &|_| {}).unwrap();
    assert_eq!(run(&plain).n_computed, 1);
    let scene = ElasticScene::parse(&text, Path::new("gyration.toml")).unwrap();
    let scene = scene.with_observable("gyration", gyration).unwrap();
    let report = run(&scene);
    assert_eq!((report.n_computed, report.failed.len()), (1, 0));
    let results = scene.results(folder.path());
    let case = results.join(&report.rows[0].case);
    let read = |path: &Path| Columns::read(path).of("gyration");
    let (circle, straight) = (50.0 / TAU, 50.0 / 12.0_f64.sqrt());
    let near = |found: f64, exact: f64| (found / exact - 1.0).abs() < 2e-3;
    let charge = read(&case.join("charge.csv"));
    assert!(
        charge.len() > 3 && charge.iter().all(|r| near(*r, circle)),
        "{charge:?}"
    );
    assert!(near(read(&results.join("sweep.csv"))[0], circle));
    let series = read(&case.join("series.csv"));
    assert!(near(series[0], circle), "{series:?}");
    assert!(near(series[series.len() - 1], straight), "{series:?}");
    assert!(
        series
            .windows(2)
            .all(|pair| pair[0] <= pair[1] * (1.0 + 1e-9))
    );
    assert_eq!((run(&scene).n_computed, run(&scene).n_reused), (0, 1));
    for name in ["writhe", "t99", "cut", "", "Radius", "two words"] {
        let refused = plain.clone().with_observable(name, gyration).unwrap_err();
        assert!(refused.to_string().contains("observable"), "{refused}");
    }
    let mut same = scene.clone();
    same.folder.clone_from(&plain.folder);
    assert!(run_sweep(&same, &table, &settings, &|_| {}).is_err());
    assert!(scene.with_observable("gyration", gyration).is_err());
}

const SCENE: &str = "[rod]\nknot = \"0_1\"\n[charge]\nduration = 0.1\n[discharge]\nuntil_released = 0.7\nclosures = 0\n[accuracy]\nedges = 60\ntolerance = 1e-3\n";

/// Columns of a table by name.
struct Columns(Vec<String>, Vec<Vec<String>>);

impl Columns {
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        let mut lines = text.lines();
        let header = cells(lines.next().unwrap());
        Self(header, lines.map(cells).collect())
    }

    fn of(&self, name: &str) -> Vec<f64> {
        let place = self.0.iter().position(|c| c == name).unwrap();
        let cell = |row: &Vec<String>| row[place].parse().unwrap_or(f64::NAN);
        self.1.iter().map(cell).collect()
    }
}

/// In the tables of a scene: a column behind the standard energies, in the energy and its density, in the times; a penalty is a column but
/// no part of the energy. Without a term of its own a scene has its columns alone, and never goes on with the cases of the other.
#[test]
fn law_a_term_from_outside_is_found_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let table = KnotTable::builtin();
    let plain = ElasticScene::parse(SCENE, Path::new("plain.toml")).unwrap();
    let k = 0.02 * (TAU / 50.0_f64).powi(4);
    let scene = |kind: EnergyKind, file: &str| {
        let scene = ElasticScene::parse(SCENE, Path::new(file)).unwrap();
        let make =
            move |_: &_| -> Box<dyn EnergyTerm> { Box::new(Renamed(Trap::of(k), "trap", kind)) };
        scene.with_term(&format!("{kind:?}{k:.3e}"), make)
    };
    let settings = SweepSettings::new(folder.path());
    let run = |scene: &ElasticScene| run_sweep(scene, &table, &settings, &|_| {}).unwrap();
    let results = |scene: &ElasticScene, file: &str| {
        let report = run(scene);
        assert!(report.failed.is_empty(), "{:?}", report.failed);
        let case = scene.results(folder.path()).join(&report.rows[0].case);
        let sweep = Columns::read(&scene.results(folder.path()).join("sweep.csv"));
        (sweep, Columns::read(&case.join(file)), case)
    };
    let trapped = scene(EnergyKind::Elastic, "trapped.toml");
    let held = scene(EnergyKind::Constraint, "held.toml");
    let (sweep, series, case) = results(&trapped, "series.csv");
    let (sweep_plain, series_plain, _) = results(&plain, "series.csv");
    for (with, without, last) in [
        (&sweep.0, &sweep_plain.0, "stretch"),
        (&series.0, &series_plain.0, "contact_energy"),
    ] {
        let place = with.iter().position(|c| c == "trap").unwrap();
        assert_eq!(with[place - 1], last);
        let others = with.iter().filter(|c| *c != "trap");
        assert!(others.eq(without.iter()));
    }
    for (columns, parts) in [(&sweep, "sweep"), (&series, "series")] {
        let of = |name: &str| columns.of(name);
        let (energy, trap) = (of("energy"), of("trap"));
        for (i, energy) in energy.iter().enumerate() {
            let sum = of("bend")[i] + of("twist_energy")[i] + of("stretch")[i] + trap[i];
            assert!(trap[i] > 0.01 * energy, "{parts}: {}", trap[i]);
            assert!((sum / energy - 1.0).abs() < 1e-12, "{parts}");
        }
    }
    // the time at which half of that energy is released, between two rows of the series
    let (time, energy) = (series.of("time"), series.of("energy"));
    let (t50, half) = (sweep.of("t50")[0], 0.5 * sweep.of("energy")[0]);
    let after = time.iter().position(|t| *t >= t50).unwrap();
    assert!(energy[after - 1] > half && energy[after] <= half, "{t50}");
    let stored = [series.of("bend"), series.of("stretch")];
    let without: f64 = stored.iter().map(|part| part[after - 1]).sum();
    assert!(without < 0.9 * half, "the trap is not at work");
    // its density, in E_b h² on L = 50 h
    let density = Columns::read(&case.join("charged.csv")).of("energy_density");
    let mean = density.iter().sum::<f64>() / density.len() as f64;
    assert!((mean / sweep.of("energy")[0] - 1.0).abs() < 1e-12);
    // as the penalty of a constraint it is in the books only
    let (sweep_held, series_held, _) = results(&held, "charge.csv");
    assert_eq!(sweep_held.of("trap"), sweep.of("trap"));
    let of = |name: &str| series_held.of(name);
    let sum = of("bend")[0] + of("twist_energy")[0] + of("stretch")[0];
    assert_eq!(of("energy")[0], sum);
    assert!(sweep_held.of("t50")[0] < 0.9 * t50);
    // resumed, and never mixed with another
    assert_eq!((run(&trapped).n_computed, run(&trapped).n_reused), (0, 1));
    let again = Columns::read(&trapped.results(folder.path()).join("sweep.csv"));
    assert_eq!((&again.0, &again.1), (&sweep.0, &sweep.1));
    let name = |scene: &ElasticScene| scene.case_name(&scene.cases(&table).unwrap()[0]);
    let names = [&plain, &trapped, &held].map(name);
    assert!(names[0] != names[1] && names[1] != names[2], "{names:?}");
    assert!(names[1].contains("_Elastic4.98"), "{names:?}");
    let mut same = plain.clone();
    same.folder.clone_from(&trapped.folder);
    assert!(run_sweep(&same, &table, &settings, &|_| {}).is_err());
}
