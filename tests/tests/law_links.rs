//! Laws of rods that are several: what a component keeps, and what the components of a link owe each other.

use nalgebra::Vector3;
use topo_analysis::{Timeline, TimelineSettings};
use topo_core::{Polyline, RunHooks};
use topo_knots::LinkTable;
use topo_rod::{
    Accuracy, ChargeSettings, ChargedRod, ContactParameters, CutSite, DischargeSettings,
    EndCondition, EndMotion, Ends, FrictionParameters, Guards, RodBattery, RodParameters, RodState,
};
use topo_tests::{curves, run};

type V = Vector3<f64>;

/// A ring of radius `r` in the plane through `centre` spanned by x and `across`, with a little wave along `wave`.
fn ring(n: usize, r: f64, centre: V, across: V, wave: V) -> Polyline {
    curves::closed(n, |u| {
        let shape = 1.0 + 0.05 * (2.0 * u).cos();
        centre + (V::x() * u.cos() + across * u.sin()) * (r * shape) + wave * (3.0 * u).sin()
    })
}

/// Two rings of different length that each run through the other.
fn hopf_link() -> [Polyline; 2] {
    let flat = ring(300, 2.0, V::zeros(), V::y(), V::z() * 0.1);
    let upright = ring(300, 2.2, V::x() * 2.1, V::z(), V::y() * 0.1);
    [flat, upright]
}

/// Three rings in a row, each linked with the next.
fn chain_of_three() -> [Polyline; 3] {
    let [a, b] = hopf_link();
    let c = ring(300, 1.9, V::x() * 4.2, V::y(), V::z() * -0.1);
    [a, b, c]
}

fn parameters(slenderness: f64, n_edges: usize, twist: f64) -> RodParameters {
    RodParameters {
        slenderness,
        n_edges,
        twist: Some(twist),
        ..RodParameters::default()
    }
}

fn battery(parameters: &RodParameters, curves: &[Polyline]) -> RodBattery {
    let accuracy = Accuracy::default();
    RodBattery::link(parameters, &accuracy, Guards::default(), curves).unwrap()
}

fn charged(parameters: &RodParameters, curves: &[Polyline], duration: f64) -> ChargedRod {
    let settings = ChargeSettings {
        duration,
        ..ChargeSettings::default()
    };
    let battery = battery(parameters, curves);
    battery.charge(&settings, &mut RunHooks::default()).unwrap()
}

/// Elastic energy per component, by its density.
fn energies(charged: &ChargedRod) -> Vec<f64> {
    let (state, density) = (charged.state(), charged.density());
    let of = |i: usize| density[i] * state.chain_of(i).share(i);
    let chains = state.components().iter();
    chains.map(|c| c.vertices().map(of).sum()).collect()
}

/// Lk = Tw + Wr of each component and the linking numbers of each two are kept, and the books balance, while tight twisted links of
/// either sign of twist press on each other.
#[test]
fn law_linking_numbers_are_kept_through_a_charge() {
    for (curves, twist) in [
        (&hopf_link()[..], 2.0),
        (&hopf_link()[..], -2.0),
        (&chain_of_three()[..], 2.0),
    ] {
        let n = curves.len();
        let parameters = parameters(13.0 * n as f64, 45 * n, twist);
        let charged = charged(&parameters, curves, 0.5);
        let record = charged.record();
        let report = &record.report;
        assert!(report.stop.is_success(), "{:?}", report.stop);
        let touched = record.samples.iter().map(|s| s.n_contacts).max();
        assert!(touched > Some(0), "the components never touch");
        let own = report.own.link_drift.unwrap();
        assert!(own < 1e-10, "Tw + Wr drifts by {own:.1e}");
        assert_eq!(report.own.linking.len(), n * (n - 1) / 2);
        for pair in &report.own.linking {
            let [a, b] = pair.components;
            let expected = if b == a + 1 { 1.0 } else { 0.0 };
            assert!((pair.start.abs() - expected).abs() < 1e-10, "{pair:?}");
            assert!(pair.drift < 1e-10, "{pair:?}");
        }
        let residual = report.ledger_residual;
        println!("{n} components, θ' = {twist}: books {residual:.1e}, Lk {own:.1e}");
        assert!(residual < 2e-3, "{residual:.1e}");
    }
}

/// Two rings out of reach of each other relax as each alone, step by step: same energies, same shapes, same twist.
#[test]
fn law_components_out_of_reach_move_as_each_alone() {
    let mut setup = run::Setup::bare(1e-3).with_twist();
    setup.parameters.contact = Some(ContactParameters::default());
    setup.parameters.friction = Some(FrictionParameters::default());
    let rod = |centre: V| {
        let curve = ring(60, 4.0, centre, V::y(), V::z() * 0.6);
        RodState::new(&curve, 25.0, 0.4).unwrap()
    };
    let (near, far) = (rod(V::zeros()), rod(V::new(16.0, 10.0, 14.0)));
    let mut alone = setup.simulation(near.clone());
    let mut both = setup.simulation(RodState::link([&near, &far]).unwrap());
    for until in [0.5, 5.0, 50.0] {
        run::run_to(&mut alone, until);
        run::run_to(&mut both, until);
        assert_eq!(alone.n_steps(), both.n_steps());
        for term in ["bend", "stretch", "twist"] {
            let (one, two) = (run::stored(&alone, term), run::stored(&both, term));
            assert!(
                (two - 2.0 * one).abs() < 1e-12 * (1.0 + two),
                "{term} at {until}"
            );
        }
        for c in 0..2 {
            let taken = both.state().component(c).unwrap();
            let by = taken.vertices()[0] - alone.state().vertices()[0];
            let pairs = alone.state().vertices().iter().zip(taken.vertices());
            let apart = pairs.map(|(a, b)| (b - a - by).norm()).fold(0.0, f64::max);
            assert!(apart < 1e-11, "component {c} at {until}: {apart:.1e}");
            let twists = alone.state().twists().iter().zip(taken.twists());
            let apart = twists.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-11, "twist of {c} at {until}: {apart:.1e}");
        }
    }
    // it has moved on its way
    assert!(run::stored(&alone, "bend") < 0.9 * run::stored(&setup.simulation(near), "bend"));
}

/// The ends of a component are held, moved and loaded as if it were alone, wherever in a link it stands; the work is the same.
#[test]
fn law_ends_of_a_component_are_those_of_it_alone() {
    let held = Ends {
        conditions: [EndCondition::Clamped, EndCondition::Pinned],
        motions: [
            EndMotion {
                rotation_rate: 0.03,
                ..EndMotion::default()
            },
            EndMotion {
                velocity: [-0.02, 0.01, 0.02],
                torque: 0.01,
                ..EndMotion::default()
            },
        ],
    };
    let setup = run::Setup::bare(1e-5).with_twist().with_ends(held);
    let bent = curves::from_tangents(40, 0.5, |j| {
        let angle = 0.02 * j as f64;
        V::new(angle.cos(), angle.sin(), 0.0)
    });
    let rod = RodState::new(&bent, 20.0, 0.1).unwrap();
    // at rest but for its drag, of which a ring without a net force has none
    let circle = ring(60, 4.0, V::z() * 30.0, V::y(), V::zeros());
    let ring = RodState::new(&circle, circle.length(), 0.0).unwrap();
    let mut alone = setup.simulation(rod.clone());
    run::run_to(&mut alone, 20.0);
    for (place, parts) in [(0, [&rod, &ring]), (1, [&ring, &rod])] {
        let state = RodState::link(parts).unwrap();
        let mut link = setup.simulation(state.clone());
        run::run_to(&mut link, 20.0);
        let taken = link.state().component(place).unwrap();
        let pairs = taken.vertices().iter().zip(alone.state().vertices());
        let apart = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        let works = [&alone, &link].map(|s| s.model().account().work());
        println!("{place}: {apart:.1e}, work {works:?}");
        assert!(apart < 1e-4, "{place}: {apart:.1e}");
        assert!(
            (works[1] / works[0] - 1.0).abs() < 1e-3 && works[0].abs() > 1e-3,
            "{works:?}"
        );
        let twists = [&taken, alone.state()].map(RodState::total_twist);
        assert!((twists[0] - twists[1]).abs() < 1e-5, "{twists:?}");
    }
}

/// The order in which components are given changes nothing but the order of the results.
#[test]
fn law_components_may_be_given_in_any_order() {
    let [a, b, c] = chain_of_three();
    let parameters = parameters(36.0, 135, 2.0);
    let first = charged(&parameters, &[a.clone(), b.clone(), c.clone()], 0.4);
    let second = charged(&parameters, &[c, a, b], 0.4);
    let (x, y) = (energies(&first), energies(&second));
    let size: f64 = x.iter().sum();
    for (k, place) in [1, 2, 0].into_iter().enumerate() {
        assert!((x[k] - y[place]).abs() < 1e-9 * size, "{x:?} {y:?}");
        let (p, q) = (first.state(), second.state());
        let (p, q) = (p.component(k).unwrap(), q.component(place).unwrap());
        let pairs = p.vertices().iter().zip(q.vertices());
        let apart = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        println!(
            "component {k}: {:.1e}, {apart:.1e}",
            (x[k] - y[place]).abs()
        );
        assert!(apart < 1e-8, "{k}: {apart:.1e}");
    }
    let touched = first.record().samples.iter().map(|s| s.n_contacts).max();
    assert!(touched > Some(0), "the components never touch");
}

/// The centroid of a link, weighted by the lengths of its components, stays where it is while they push each other away.
#[test]
fn law_the_centroid_of_a_link_is_kept() {
    let curves = hopf_link();
    let parameters = parameters(26.0, 90, 2.0);
    let battery = battery(&parameters, &curves);
    let charged = charged(&parameters, &curves, 0.3);
    let mean = |state: &RodState, c: usize| -> V {
        let own = &state.vertices()[state.components()[c].vertices()];
        own.iter().sum::<V>() / own.len() as f64
    };
    let weights: Vec<f64> = charged
        .state()
        .components()
        .iter()
        .map(|c| c.length())
        .collect();
    let moved: Vec<V> = (0..2)
        .map(|c| mean(charged.state(), c) - mean(battery.start(), c))
        .collect();
    let whole = moved[0] * weights[0] + moved[1] * weights[1];
    assert!(moved.iter().all(|m| m.norm() > 0.01), "{moved:?}");
    assert!(whole.norm() < 1e-11, "{:.1e}", whole.norm());
}

/// One ring of a Hopf link cut and straightened: what is left of their linking integral, how far apart they are, and whether the types over time end with
/// a free rod.
fn cut_and_straightened(at: f64) -> (f64, f64, bool) {
    let charged = charged(&parameters(26.0, 90, 1.0), &hopf_link(), 0.2);
    let linked = charged.state().linking(0, 1).unwrap();
    assert!((linked.abs() - 1.0).abs() < 1e-10);
    let cut = charged.cut(CutSite::On { component: 1, at }).unwrap();
    assert_eq!(
        (cut.component, cut.state.components()[0].is_closed()),
        (1, true)
    );
    assert!(!cut.state.components()[1].is_closed());
    let settings = DischargeSettings {
        longest: 40.0,
        ..DischargeSettings::default()
    };
    let discharge = cut.discharge(&settings, &mut RunHooks::default()).unwrap();
    let report = &discharge.record.report;
    let last = discharge.record.samples.last().unwrap();
    println!(
        "{:?} {} steps, books {:.1e}",
        report.stop, report.n_steps, report.ledger_residual
    );
    assert!(report.stop.is_success(), "{:?}", report.stop);
    // the ring that stays closed keeps its own linking number; nothing is said of the pair
    assert!(report.own.link_drift.unwrap() < 1e-10 && report.own.linking.is_empty());
    assert!(report.ledger_residual < 2e-3);
    let (state, chain) = (&last.state, last.state.components()[1]);
    let gap = state.vertices()[chain.vertices()].iter().flat_map(|x| {
        let ring = &state.vertices()[state.components()[0].vertices()];
        ring.iter().map(move |y| (x - y).norm())
    });
    let gap = gap.fold(f64::INFINITY, f64::min);
    let left = state.linking(0, 1).unwrap();
    assert!(last.end_to_end > 0.98 * chain.length());
    let timed: Vec<_> = discharge
        .record
        .samples
        .iter()
        .map(|s| (s.time, s.state.component_vertices().collect()))
        .collect();
    let settings = TimelineSettings::default();
    let types = Timeline::of_links(&timed, 1, LinkTable::builtin(), settings, 0).unwrap();
    println!("gap {gap}, integral {left}, types {:?}", types.sequence());
    assert_eq!(types.sequence()[0], "L2a1");
    let is_free = types.samples().last().unwrap().is_free;
    assert_eq!(is_free, types.untying_time().is_some());
    (left.abs(), gap, is_free)
}

/// A Hopf link with one ring cut: as long as both are closed they are linked. The cut one opens and slips out when cut where they touch; cut on the other
/// side it stays threaded, a straight rod through a ring, whose integral is near 0.9.
#[test]
fn law_a_cut_component_slips_out_of_its_link() {
    let (left, gap, is_free) = cut_and_straightened(0.5);
    assert!(left < 0.1 && gap > 1.5 && is_free, "{left} {gap}");
    let (left, _, is_free) = cut_and_straightened(0.0);
    assert!(left > 0.8 && !is_free, "{left}");
}

/// Further components take no byte and no solve of a rod that has none, and their counters say where they are.
#[test]
fn law_absent_components_cost_nothing() {
    let [a, b] = hopf_link();
    let alone = charged(&parameters(13.0, 45, 1.0), std::slice::from_ref(&a), 0.05);
    let work = alone.record().report.own.work;
    assert_eq!((work.component_bytes, work.n_component_solves), (0, 0));
    assert!(alone.record().report.own.linking.is_empty());
    let both = charged(&parameters(26.0, 90, 1.0), &[a, b], 0.05);
    let work = both.record().report.own.work;
    assert!(work.component_bytes > 0 && work.n_component_solves > 10);
}

/// The drag is a regularisation: over two decades of ζ the charged energy, and that at two times of a discharge in which a component
/// slips out of the other, hardly change. So relative motion is decided by friction and contact.
#[test]
fn law_results_do_not_depend_on_the_drag() {
    let runs = [0.1, 1.0, 10.0].map(|drag| {
        let parameters = RodParameters {
            drag,
            ..parameters(26.0, 90, 1.0)
        };
        let charged = charged(&parameters, &hopf_link(), 0.5);
        let site = CutSite::On {
            component: 0,
            at: 0.25,
        };
        let settings = DischargeSettings {
            longest: 4.0,
            ..DischargeSettings::default()
        };
        let cut = charged.cut(site).unwrap();
        let run = cut.discharge(&settings, &mut RunHooks::default()).unwrap();
        let curve = &run.record.curve;
        let at = |time: f64| {
            let k = curve.time().iter().position(|t| *t >= time).unwrap();
            let share = (time - curve.time()[k - 1]) / (curve.time()[k] - curve.time()[k - 1]);
            let [before, after] = [k - 1, k].map(|k| curve.stored_total(k));
            before + share * (after - before)
        };
        let stored = [curve.stored_total(0), at(0.3), at(2.0)];
        println!("ζ = {drag}: {stored:?}");
        stored
    });
    for (k, most) in [1e-6, 1e-2, 1e-3].into_iter().enumerate() {
        for run in &runs {
            let off = (run[k] / runs[1][k] - 1.0).abs();
            assert!(off < most, "{k}: {off:.1e}");
        }
    }
    // it does slip out while it is followed
    assert!(runs[1][1] < 0.8 * runs[1][0] && runs[1][2] < 0.95 * runs[1][1]);
}
