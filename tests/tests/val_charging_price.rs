//! What it takes to charge a rod: the work of twisting it, at once and in time.

use std::f64::consts::{PI, TAU};

use topo_core::{Polyline, RunHooks};
use topo_rod::{Accuracy, ChargeSettings, ChargedRod, Guards, RodBattery, RodParameters, Twisting};
use topo_tests::curves;

fn charged(curve: &Polyline, twist: f64, twisting: Option<Twisting>, tolerance: f64) -> ChargedRod {
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
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), curve).unwrap();
    let settings = ChargeSettings {
        duration: 0.5,
        twisting,
        ..ChargeSettings::default()
    };
    let charged = battery.charge(&settings, &mut RunHooks::default()).unwrap();
    let report = &charged.record().report;
    assert!(report.stop.is_success(), "{}", report.stop);
    assert!(report.ledger_residual < 1e-3, "{}", report.ledger_residual);
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
        let charged = charged(&ring, twist, Some(Twisting { over }), 1e-4);
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
    let slow = charged(&curve, 1.0, Some(Twisting { over: 40.0 }), 5e-4);
    let price = |rod: &ChargedRod| rod.energy_in().unwrap();
    let stored = slow.record().samples.last().unwrap().elastic();
    println!("{} {} {stored}", price(&at_once), price(&slow));
    assert!(price(&slow) < price(&at_once) && stored < price(&slow));
}
