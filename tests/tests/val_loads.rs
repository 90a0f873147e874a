//! Loads at the ends of a rod: what they end in, and what they take up.

use nalgebra::Vector3;
use topo_core::{Ledger, RunHooks};
use topo_rod::{
    Accuracy, ChargeSettings, ContactParameters, CutSite, DischargeSettings, EndCondition, EndLoad,
    Ends, FrictionParameters, Guards, LoadPlace, RodBattery, RodParameters, RodSample,
};
use topo_tests::curves::{self, from_tangents};
use topo_tests::run::{RodSimulation, Setup, rod, run_to};

/// Bending stiffness per area of the cross-section, E_b h²/4.
const BENDING: f64 = 0.25;
const LENGTH: f64 = 50.0;

fn taken_up(books: &Ledger) -> f64 {
    books.dissipated_by("load").expect("a rod with a load")
}

/// An arc of that angle that begins along x, clamped there, with a load at its last end.
fn clamped_arc(n: usize, angle: f64, load: EndLoad, tolerance: f64) -> RodSimulation {
    let l0 = LENGTH / n as f64;
    // the held edge is straight, and what bends behind its middle has the angle in all
    let arc = from_tangents(n, l0, |j| {
        let turned = angle * j as f64 / n as f64;
        Vector3::new(turned.cos(), turned.sin(), 0.0)
    });
    let state = rod(&arc, 0.0);
    let ends = Ends {
        conditions: [EndCondition::Clamped, EndCondition::Free],
        ..Ends::default()
    };
    let setup = Setup::bare(tolerance)
        .with_ends(ends)
        .with_stretch_ratio(50.0);
    let model = setup
        .model(&state)
        .with_load(load, 0, &state)
        .expect("a load of a test");
    setup.simulation_of(model, state)
}

/// The spring far above draws the end straight up with F = k (w_0 − w), and w = F ℓ³/3B. The rod is free from the middle of the held edge on.
#[test]
fn val_clamped_rod_unbends_against_a_spring() {
    for (n, spring) in [(50, 2e-6), (50, 1e-5), (100, 1e-5)] {
        let load = EndLoad {
            between: LoadPlace::Last,
            spring,
            rest_length: 1e4,
            direction: Some([0.0, 1.0, 0.0]),
            ..EndLoad::default()
        };
        let mut simulation = clamped_arc(n, 0.2, load, 1e-5);
        let tip = |s: &RodSimulation| s.state().vertices()[n].y;
        let (start, begun) = (tip(&simulation), simulation.state().vertices()[n]);
        run_to(&mut simulation, 2e4);
        let free = LENGTH * (1.0 - 0.5 / n as f64);
        let compliance = free.powi(3) / (3.0 * BENDING);
        let force = spring * (start - tip(&simulation));
        let (found, expected) = (tip(&simulation), force * compliance);
        println!(
            "N {n} k {spring}: w/L {:.5}, off by {:.2e}",
            found / LENGTH,
            found / expected - 1.0
        );
        assert!((found / expected - 1.0).abs() < 5e-3);
        let books = simulation.model().account();
        let work = taken_up(books);
        let end = simulation.state().vertices()[n];
        let drawn = (Vector3::new(begun.x, begun.y + 1e4, 0.0) - end).norm() - 1e4;
        let stored = 0.5 * spring * drawn * drawn;
        assert!((work / stored - 1.0).abs() < 1e-6, "{work} {stored}");
        assert!(
            books.relative_residual() < 1e-3,
            "{}",
            books.relative_residual()
        );
    }
}

/// Tip of an inextensible rod of the length `free`, clamped along x, that a force per area at its end holds: B θ'' = F_x sin θ − F_y cos θ.
fn elastica_tip(free: f64, force: Vector3<f64>) -> Vector3<f64> {
    let n = 4000;
    let h = free / f64::from(n);
    let rate = |u: [f64; 4]| {
        let [angle, bend, _, _] = u;
        [
            bend,
            (force.x * angle.sin() - force.y * angle.cos()) / BENDING,
            angle.cos(),
            angle.sin(),
        ]
    };
    let shoot = |bend: f64| {
        let mut u = [0.0, bend, 0.0, 0.0];
        for _ in 0..n {
            let add = |a: [f64; 4], b: [f64; 4], s: f64| std::array::from_fn(|k| a[k] + s * b[k]);
            let k1 = rate(u);
            let k2 = rate(add(u, k1, 0.5 * h));
            let k3 = rate(add(u, k2, 0.5 * h));
            let k4 = rate(add(u, k3, h));
            u = std::array::from_fn(|k| {
                u[k] + h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k])
            });
        }
        u
    };
    // no moment at the free end; the moment at the clamp is bounded by the force times the length
    let most = force.norm() * free / BENDING;
    let (mut low, mut high) = (0.0, most);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shoot(middle)[1] > 0.0 {
            high = middle
        } else {
            low = middle
        }
    }
    let end = shoot(0.5 * (low + high));
    Vector3::new(end[2], end[3], 0.0)
}

/// A quarter of a circle unbends against a spring that was slack at its tip: far from straight, it ends in the elastica of that force.
#[test]
fn val_clamped_quarter_circle_ends_in_the_elastica() {
    let mut last = f64::INFINITY;
    for n in [50, 100] {
        let load = EndLoad {
            between: LoadPlace::Last,
            spring: 2e-5,
            ..EndLoad::default()
        };
        let mut simulation = clamped_arc(n, std::f64::consts::FRAC_PI_2, load, 1e-4);
        let l0 = LENGTH / n as f64;
        let start = simulation.state().vertices()[n];
        run_to(&mut simulation, 2e4);
        let tip = simulation.state().vertices()[n];
        let free = LENGTH - 0.5 * l0;
        let found = tip - Vector3::new(0.5 * l0, 0.0, 0.0);
        let expected = elastica_tip(free, (start - tip) * load.spring);
        let error = (found - expected).norm() / LENGTH;
        println!("N {n}: tip {:?}, off by {error:.2e} L", tip / LENGTH);
        assert!(tip.y > 0.1 * LENGTH, "hardly bent");
        assert!(error < 2e-3 && error < 0.6 * last);
        last = error;
        let books = simulation.model().account();
        assert!(
            books.relative_residual() < 1e-3,
            "{}",
            books.relative_residual()
        );
    }
}

/// Work over stored energy of a circle that is cut and opens against a dashpot between its tips.
fn work_of_a_circle(n: usize, dashpot: f64) -> f64 {
    let parameters = RodParameters {
        n_edges: n,
        twist: None,
        contact: None,
        friction: None,
        ..RodParameters::default()
    };
    let accuracy = Accuracy {
        tolerance: 3e-4,
        ..Accuracy::default()
    };
    let battery = RodBattery::new(
        &parameters,
        &accuracy,
        Guards::default(),
        &curves::ring(n, 8.0),
    )
    .unwrap();
    let none = &mut RunHooks::default();
    let charge = ChargeSettings {
        duration: 0.1,
        ..ChargeSettings::default()
    };
    let cut = battery
        .charge(&charge, none)
        .unwrap()
        .cut(CutSite::At(0.0))
        .unwrap();
    let settings = DischargeSettings {
        load: Some(EndLoad {
            dashpot,
            ..EndLoad::default()
        }),
        longest: 1e6,
        until_released: 0.99999,
        ..DischargeSettings::default()
    };
    let done = cut.discharge(&settings, none).unwrap();
    let report = &done.record.report;
    assert!(
        done.is_finished() && report.ledger_residual < 1e-3,
        "{} {}",
        report.stop,
        report.ledger_residual
    );
    let load = report.own.load.unwrap();
    println!(
        "N {n} c {dashpot}: {:.5}, peak {:.3e}, residual {:.1e}, {} steps",
        load.work / done.start,
        load.peak_power,
        report.ledger_residual,
        report.n_steps
    );
    load.work / done.start
}

/// A slow dashpot takes up all that the teardrop holds, which the circle relaxes to: 14.05495 of the 2π² B/L.
#[test]
fn val_cut_circle_works_on_a_dashpot() {
    let exact = 14.05495 / (2.0 * std::f64::consts::PI.powi(2));
    // with the resistance, at one resolution
    let by_dashpot = [1.0, 10.0, 100.0].map(|c| (work_of_a_circle(50, c) - exact).abs());
    // and with the resolution, for a slow one
    let by_edges = [50, 100, 200].map(|n| work_of_a_circle(n, 100.0) - exact);
    println!("{by_dashpot:?} {by_edges:?}");
    for pair in by_dashpot.windows(2) {
        assert!(pair[1] < 0.2 * pair[0]);
    }
    assert!(by_edges.iter().all(|error| error.abs() < 1.5e-3));
}

/// A number of [0, 1) from a seed.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// Energies of charged knots that discharge against random loads: all that is released is work on the load and heat.
#[test]
fn law_what_is_released_is_work_and_heat() {
    let mut seed = 20;
    let accuracy = Accuracy {
        tolerance: 2e-5,
        ..Accuracy::default()
    };
    for k in 0..8 {
        let parameters = RodParameters {
            n_edges: 60,
            twist: (k % 2 == 0).then(|| 2.0 * random(&mut seed) - 1.0),
            contact: Some(ContactParameters::default()),
            friction: (k % 3 > 0).then(FrictionParameters::default),
            ..RodParameters::default()
        };
        let curve = if k % 4 < 2 {
            curves::trefoil(60, 2.0, 1.0)
        } else {
            curves::figure_eight(60)
        };
        let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve).unwrap();
        let none = &mut RunHooks::default();
        let charge = ChargeSettings {
            duration: 0.2,
            ..ChargeSettings::default()
        };
        let cut = battery
            .charge(&charge, none)
            .unwrap()
            .cut(CutSite::At(random(&mut seed)))
            .unwrap();
        let one_end = k % 4 == 3;
        let mut strength = || 10f64.powf(3.0 * random(&mut seed) - 3.0);
        let load = EndLoad {
            between: if one_end {
                LoadPlace::Last
            } else {
                LoadPlace::Ends
            },
            spring: if k % 3 == 1 { 0.0 } else { 0.01 * strength() },
            dashpot: if k % 3 == 2 { 0.0 } else { strength() },
            rest_length: if k == 7 { 5.0 } else { 0.0 },
            direction: (k == 7).then_some([0.0, 3.0, -4.0]),
        };
        let held = if k == 3 {
            EndCondition::Pinned
        } else {
            EndCondition::Clamped
        };
        let settings = DischargeSettings {
            load: Some(load),
            ends: Ends {
                conditions: [
                    if one_end { held } else { EndCondition::Free },
                    EndCondition::Free,
                ],
                ..Ends::default()
            },
            longest: 20.0,
            ..DischargeSettings::default()
        };
        let done = cut.discharge(&settings, none).unwrap();
        let report = &done.record.report;
        let work = report.own.load.unwrap().work;
        let efficiency = work / done.start;
        println!(
            "{k} {load:?}: efficiency {efficiency:.4}, residual {:.1e}, {} steps, {}",
            report.ledger_residual, report.n_steps, report.stop
        );
        assert!(report.stop.is_success(), "{}", report.stop);
        assert!(report.ledger_residual < 1e-3);
        assert!((0.0..=1.0).contains(&efficiency) && efficiency > 1e-3);
        let rest = done
            .record
            .samples
            .last()
            .unwrap()
            .stored
            .iter()
            .sum::<f64>();
        let heat: f64 = done.record.samples.last().unwrap().dissipated.iter().sum();
        let after = done.record.curve.stored_total(0);
        assert!((after - rest - heat - work).abs() < 1e-3 * done.start.max(after));
    }
}

/// An end that is drawn away from the other against a dashpot between the two does the work c v² t on it, whichever end it is, besides that on the rod.
#[test]
fn val_a_drawn_end_works_on_a_dashpot() {
    let (speed, time, dashpot) = (0.4, 3.0, 0.7);
    for end in [0, 1] {
        let along = if end == 0 { -speed } else { speed };
        let mut ends = Ends {
            conditions: [EndCondition::Pinned; 2],
            ..Ends::default()
        };
        ends.motions[end].velocity = [along, 0.0, 0.0];
        let state = rod(&from_tangents(50, 1.0, |_| Vector3::x()), 0.0);
        let load = EndLoad {
            dashpot,
            ..EndLoad::default()
        };
        let setup = Setup::bare(1e-5).with_ends(ends);
        let model = setup.model(&state).with_load(load, 0, &state).unwrap();
        let mut simulation = setup.simulation_of(model, state);
        run_to(&mut simulation, time);
        let books = simulation.model().account();
        let expected = dashpot * speed * speed * time;
        println!("end {end}: {:.6} of {expected:.6}", taken_up(books));
        assert!((taken_up(books) / expected - 1.0).abs() < 1e-6);
        assert!(books.work() > expected && books.relative_residual() < 1e-3);
    }
}

/// A knot that opens against a slow dashpot: its ends go round each other while the line between them stays as long. Nothing is taken
/// up across that line, each step has a matrix of its own line, and the account closes to 10⁻³ at a tolerance of 10⁻⁴ h.
#[test]
fn law_ends_that_go_round_each_other_do_no_work() {
    let parameters = RodParameters {
        n_edges: 60,
        twist: None,
        friction: None,
        ..RodParameters::default()
    };
    let accuracy = Accuracy {
        tolerance: 1e-4,
        ..Accuracy::default()
    };
    let curve = curves::trefoil(200, 2.0, 1.0);
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve).unwrap();
    let none = &mut RunHooks::default();
    let charged = battery.charge(&ChargeSettings::default(), none).unwrap();
    let settings = DischargeSettings {
        load: Some(EndLoad {
            dashpot: 10.0,
            ..EndLoad::default()
        }),
        longest: 300.0,
        outputs_per_decade: 1e5,
        ..DischargeSettings::default()
    };
    let cut = charged.cut(CutSite::MaximumEnergyDensity).unwrap();
    let record = cut.discharge(&settings, none).unwrap().record;
    let report = &record.report;
    assert!(report.ledger_residual < 1e-3, "{}", report.ledger_residual);
    assert!(report.own.work.n_newton_factorisations >= report.n_steps);
    let line = |sample: &RodSample| {
        let x = sample.state.vertices();
        x[x.len() - 1] - x[0]
    };
    let (mut turned, mut taken, mut released) = (0.0, 0.0, 0.0);
    for pair in record.samples.windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(line);
        let across = before.normalize().cross(&after).norm();
        if before.norm() > 1.0 && across > 20.0 * (after.norm() - before.norm()).abs() {
            turned += across / before.norm();
            taken += pair[1].load_work.unwrap() - pair[0].load_work.unwrap();
            released += pair[0].elastic() - pair[1].elastic();
        }
    }
    println!("{turned} rad, {taken:.2e} of {released:.2e}");
    assert!(turned > 2.0 && taken < 1e-2 * released);
}
