//! What it takes to charge a rod: the work of twisting it, at once and in time.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use topo_core::{Polyline, RunHooks};
use topo_rod::{
    Accuracy, ChargeSettings, ChargedRod, Guards, Ramp, RodBattery, RodParameters, TimeCourse,
    Twisting,
};
use topo_tests::curves;

/// Twisting at a constant rate.
fn turned(over: f64) -> Option<Twisting> {
    Some(Twisting { over, torque: None })
}

/// Twisting by a torque, over the one that a straight rod of the twist carries.
fn driven(over: f64, torque: TimeCourse) -> Option<Twisting> {
    let torque = Some(torque);
    Some(Twisting { over, torque })
}

fn charged(curve: &Polyline, twist: f64, twisting: Option<Twisting>, tolerance: f64) -> ChargedRod {
    charged_link(std::slice::from_ref(curve), twist, twisting, tolerance)
}

fn charged_link(
    curves: &[Polyline],
    twist: f64,
    twisting: Option<Twisting>,
    tolerance: f64,
) -> ChargedRod {
    let parameters = RodParameters {
        n_edges: 60,
        twist: Some(twist),
        friction: None,
        ..RodParameters::default()
    };
    let accuracy = Accuracy {
        tolerance,
        ..Accuracy::default()
    };
    let battery = RodBattery::link(&parameters, &accuracy, Guards::default(), curves).unwrap();
    charge(&battery, twisting)
}

fn charge(battery: &RodBattery, twisting: Option<Twisting>) -> ChargedRod {
    let settings = ChargeSettings {
        duration: 0.5,
        twisting: twisting.clone(),
        ..ChargeSettings::default()
    };
    let charged = battery.charge(&settings, &mut RunHooks::default()).unwrap();
    let report = &charged.record().report;
    assert!(report.stop.is_success(), "{}", report.stop);
    assert!(
        report.ledger_residual < 1e-3,
        "{} {twisting:?} {:?}",
        report.ledger_residual,
        report.ledger
    );
    charged
}

/// Twist energy of a uniform twist density over E_0: A α θ'² h²/8.
fn twist_energy(twist: f64) -> f64 {
    PI * RodParameters::default().twist_ratio * twist * twist / 8.0
}

/// Twist that is tied in at once is paid with its energy, on top of what the untwisted start stores.
#[test]
fn val_price_of_a_twist_tied_in_at_once() {
    let curve = curves::trefoil(60, 2.0, 1.0);
    let price = |twist: f64| charged(&curve, twist, None, 5e-4).energy_in().unwrap();
    let untwisted = price(0.0);
    for twist in [-1.0, 0.5] {
        let (found, expected) = (price(twist), untwisted + twist_energy(twist));
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }
}

/// A circle twisted below its threshold stays one: its drive does the work of the twist energy, and more the faster it turns.
#[test]
fn val_price_of_a_slow_twist() {
    let (ring, twist) = (curves::ring(60, 8.0), 0.2);
    let of = |over: f64| {
        let charged = charged(&ring, twist, turned(over), 1e-4);
        let last = charged.record().samples.last().unwrap();
        let turns = twist * 50.0 / TAU;
        let link = last.total_twist + last.writhe;
        assert!((link - turns).abs() < 1e-9, "{link}");
        assert!((last.stored.of("twist") / twist_energy(twist) - 1.0).abs() < 1e-4);
        assert!(charged.record().report.own.link_drift.unwrap() < 1e-6);
        let first = charged.record().samples[0].elastic();
        assert!((charged.energy_in().unwrap() - first - last.work).abs() < 1e-3 * last.work);
        last.work / twist_energy(twist) - 1.0
    };
    let excess = [1.0, 2.0, 4.0].map(of);
    println!("{excess:?}");
    for pair in excess.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!(pair[1] > 0.0 && (1.9..2.1).contains(&ratio), "{ratio}");
    }
    // slowly, the twist stays uniform while the edges turn back from the seam: (4/α)(1 + π²/3) η/(E_b t) of the twist energy
    let slow = 4.0 / RodParameters::default().twist_ratio * (1.0 + PI * PI / 3.0) / 400.0;
    assert!((excess[2] / slow - 1.0).abs() < 0.01, "{slow}");
}

/// A knot twisted slowly has relaxed before and relaxes on the way: it costs less than twisting it at once, and more than it stores.
#[test]
fn law_slow_twisting_of_a_knot_costs_less() {
    let curve = curves::trefoil(60, 2.0, 1.0);
    let at_once = charged(&curve, 1.0, None, 5e-4);
    let slow = charged(&curve, 1.0, turned(40.0), 5e-4);
    let price = |rod: &ChargedRod| rod.energy_in().unwrap();
    let stored = slow.record().samples.last().unwrap().elastic();
    println!("{} {} {stored}", price(&at_once), price(&slow));
    assert!(price(&slow) < price(&at_once) && stored < price(&slow));
}

/// Turns of the ends of a circle by Lk = Tw + Wr.
fn turns(charged: &ChargedRod) -> f64 {
    let last = charged.record().samples.last().unwrap();
    last.total_twist + last.writhe
}

/// Turn of the ends of a circle of curvature κ, over θ'L, a time t after a torque is put on that holds θ' at rest. Every joint is a
/// spring α/4 beside a dashpot η/2, and edges that turn carry the joints' tangents round: τ' = (η/2) κ² w, so that the modes
/// sin(nπs/L), n odd, relax at the rates (α/2η) n²/(4 + n²) and share the turn like 8/(π²n²).
fn creep(t: f64) -> f64 {
    let rate = RodParameters::default().twist_ratio / 2.0;
    let mode = |k: usize| {
        let square = ((2 * k + 1) as f64).powi(2);
        8.0 / (PI * PI * square) * (1.0 - (-rate * square / (4.0 + square) * t).exp())
    };
    (0..10_000).map(mode).sum()
}

/// A torque at the seam of a circle turns its ends like springs and dashpots in a row, at last as far as it holds. Put on at once it
/// does twice the work that it stores; raised slowly, the turn lags behind by the mean time of the modes.
#[test]
fn val_a_torque_turns_the_ends_of_a_ring() {
    let (ring, twist) = (curves::ring(60, 8.0), 0.1);
    let whole = twist * 50.0 / TAU;
    for over in [0.002, 0.01, 0.05] {
        let constant = driven(over, TimeCourse::Constant(1.0));
        let found = turns(&charged(&ring, twist, constant, 1e-5)) / whole;
        let expected = creep(over * 100.0);
        println!("{over}: {found} {expected}");
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    }
    let at_once = charged(&ring, twist, driven(4.0, TimeCourse::Constant(1.0)), 1e-4);
    let (work, found) = (
        at_once.record().samples.last().unwrap().work,
        turns(&at_once),
    );
    println!("{} {}", work / twist_energy(twist), found / whole);
    assert!((found / whole - 1.0).abs() < 1e-4, "{found}");
    assert!((work / twist_energy(twist) - 2.0).abs() < 2e-3, "{work}");
    let slowly = driven(4.0, TimeCourse::Ramp(Ramp { to: 1.0, over: 4.0 }));
    let slow = charged(&ring, twist, slowly, 1e-4);
    let lag = 2.0 / RodParameters::default().twist_ratio * (1.0 + PI * PI / 3.0) / 400.0;
    let (work, found) = (slow.record().samples.last().unwrap().work, turns(&slow));
    println!(
        "{} {} {lag}",
        work / twist_energy(twist),
        1.0 - found / whole
    );
    assert!(((1.0 - found / whole) / lag - 1.0).abs() < 0.01, "{found}");
    assert!((work / twist_energy(twist) - 1.0).abs() < 2e-3, "{work}");
}

/// Each closed component of a link is twisted by the density of all, at a constant rate and by a torque that is raised slowly, and
/// linked as before.
#[test]
fn val_links_are_twisted_in_time() {
    let upright = |u: f64| Vector3::new(2.0 * u.cos() + 2.0, 0.0, 2.0 * u.sin());
    let rings = [curves::ring(200, 2.0), curves::closed(200, upright)];
    let (twist, share) = (0.1, 25.0 / TAU);
    let slowly = TimeCourse::Table(vec![[0.0, 0.0], [2.0, 0.5], [3.0, 1.0], [6.0, 1.0]]);
    for (twisting, by_torque) in [(turned(2.0), false), (driven(8.0, slowly), true)] {
        let charged = charged_link(&rings, twist, twisting, 2e-4);
        let report = &charged.record().report;
        let state = charged.state();
        for c in 0..2 {
            // a given torque is that of the twist; a given turn is linked
            let writhe = if by_torque {
                0.0
            } else {
                state.writhe_of(c).unwrap()
            };
            let found = state.total_twist_of(c).unwrap() + writhe;
            println!("{c}: {found} {}", twist * share);
            assert!((found / (twist * share) - 1.0).abs() < 1e-3, "{c}: {found}");
        }
        assert!(
            report.own.link_drift.unwrap() < 1e-9,
            "{:?}",
            report.own.link_drift
        );
        assert_eq!(report.own.linking.len(), 1);
        assert!(report.own.linking[0].drift < 1e-9);
    }
}

/// A rod with a natural twist is twisted against that: slowly the drive gets what the untwisted circle stored, and ends
/// that nothing turns find that twist by themselves.
#[test]
fn val_a_natural_twist_drives_the_drive() {
    let (ring, twist) = (curves::ring(60, 8.0), 0.15);
    let parameters = RodParameters {
        n_edges: 60,
        twist: Some(twist),
        friction: None,
        contact: None,
        ..RodParameters::default()
    };
    let accuracy = Accuracy {
        tolerance: 1e-4,
        ..Accuracy::default()
    };
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &ring)
        .unwrap()
        .with_rest(|_, _| [0.0; 2], |_, _| twist)
        .unwrap();
    for (twisting, gained) in [
        (turned(20.0), 1.0),
        (driven(4.0, TimeCourse::Constant(0.0)), 0.0),
    ] {
        let charged = charge(&battery, twisting);
        let samples = &charged.record().samples;
        let (first, last) = (&samples[0], samples.last().unwrap());
        let untwisted = first.stored.of("twist");
        println!("{untwisted} {} {}", last.stored.of("twist"), last.work);
        assert!(
            (untwisted / twist_energy(twist) - 1.0).abs() < 1e-9,
            "{untwisted}"
        );
        assert!(last.stored.of("twist") < 1e-4 * untwisted);
        assert!((last.work + gained * untwisted).abs() < 0.05 * untwisted);
    }
}
