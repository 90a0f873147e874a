//! What a charge says of the state it ends in: closed forms of the lowest eigenvalue, saddles that are left, runs that go on.

use std::f64::consts::PI;

use topo_core::Interrupt;
use topo_core::Progress;
use topo_nematic::anchoring::Plate;
use topo_nematic::record::{ChargeStop, MinimumReport, MinimumState};
use topo_nematic::{
    ChargeSettings, ChargedNematic, ExternalField, NematicAccuracy, NematicBattery,
    NematicParameters, RunHooks, Sides, SurfacePattern, Threads,
};
use topo_tests::threads::on_threads;

fn charge(parameters: &NematicParameters, seed: f64, threads: Threads) -> ChargedNematic {
    let accuracy = NematicAccuracy {
        threads,
        ..Default::default()
    };
    let battery = NematicBattery::new(parameters, &accuracy).unwrap();
    let settings = ChargeSettings {
        seeds: vec![seed],
        ..Default::default()
    };
    let charged = battery
        .charge(&settings, &mut RunHooks::new(&Interrupt::new()))
        .unwrap();
    assert!(charged.report().is_converged(), "{:?}", charged.report());
    charged
}

fn minimum(charged: &ChargedNematic) -> MinimumReport {
    charged.report().minimum.unwrap()
}

/// A cell of this many unit spacings between strong plates, without a particle.
fn plates(height: usize) -> NematicParameters {
    NematicParameters {
        radius: 1.0,
        spacing: 1.0,
        cells: Some([6, 4, height]),
        particle: false,
        ..Default::default()
    }
}

#[test]
fn val_lowest_mode_between_plates_is_that_of_the_director() {
    for height in [20, 40, 80] {
        let found = minimum(&charge(&plates(height), 0.0, Threads::One));
        // sin(pi z/d) on cells: 4 L/h² sin²(pi h/2d)
        let exact = 4.0 * (0.5 * PI / height as f64).sin().powi(2);
        assert!(
            (found.lowest_eigenvalue / exact - 1.0).abs() < 1e-3,
            "{height}: {found:?} {exact}"
        );
        assert_eq!((found.state, found.n_kicks), (MinimumState::Minimum, 0));
    }
}

#[test]
fn val_saddle_above_the_freedericksz_threshold_is_left() {
    let height = 60;
    let order = topo_nematic::Material::default().order();
    let bend = 4.5 * order * order;
    // K = (9/2) L S² in E_c² = (pi/d)² 2K/(3 S chi_a)
    let critical = (PI / height as f64).powi(2) * 2.0 * bend / (3.0 * order);
    let unit = (PI / height as f64).powi(2);
    let at = |share: f64| {
        let parameters = NematicParameters {
            field: Some(ExternalField {
                vector: [(share * critical).sqrt(), 0.0, 0.0],
                anisotropy: 1.0,
            }),
            ..plates(height)
        };
        charge(&parameters, 0.0, Threads::One)
    };
    for share in [0.5, 0.95] {
        let charged = at(share);
        let found = minimum(&charged);
        // the field bends the order as well, at second order in E
        let expected = 1.0 - share;
        let lowest = found.lowest_eigenvalue / unit;
        assert!((lowest - expected).abs() < 0.01, "{share}: {lowest}");
        assert_eq!((found.state, found.n_kicks), (MinimumState::Minimum, 0));
        assert!(charged.order().magnitude() < 1e-6);
    }
    let charged = at(1.05);
    let found = minimum(&charged);
    assert_eq!((found.state, found.n_kicks), (MinimumState::Minimum, 1));
    assert!(found.lowest_eigenvalue > 0.0);
    let [x, y] = charged.order().tilt;
    assert!(x.abs() > 0.1 && y.abs() < 1e-3 * x.abs(), "{x} {y}");
}

/// A particle whose surface prefers one direction.
fn uniform(director: [f64; 3]) -> NematicParameters {
    NematicParameters {
        radius: 6.0,
        pattern: SurfacePattern::Uniform { director },
        ..Default::default()
    }
}

#[test]
fn law_a_turned_scene_charges_to_the_same_energy() {
    let along = charge(&uniform([1.0, 0.0, 0.0]), 0.05, Threads::One);
    let across = charge(&uniform([0.0, 1.0, 0.0]), 0.05, Threads::One);
    let energy = |c: &ChargedNematic| c.energy().total();
    assert!((energy(&across) / energy(&along) - 1.0).abs() < 1e-6);
    assert!((energy(&along) - 144.19).abs() < 0.01, "an independent run");
    assert_eq!(minimum(&along).n_kicks, 0);
    assert_eq!(minimum(&across).n_kicks, 1);
    for c in [&along, &across] {
        assert_eq!(minimum(c).state, MinimumState::Minimum);
    }
    let [x, y] = across.order().tilt;
    assert!(y.abs() > 0.2 && x.abs() < 1e-4, "{x} {y}");
    let turned = uniform([0.0, 1.0, 0.0]);
    let all = on_threads(3, || charge(&turned, 0.05, Threads::All));
    assert_eq!(all.state(), across.state());
    assert_eq!(minimum(&all), minimum(&across));
}

#[test]
fn law_a_charge_stopped_in_its_check_or_after_a_kick_goes_on_to_the_same_bits() {
    let accuracy = NematicAccuracy::default();
    let battery = NematicBattery::new(&uniform([0.0, 1.0, 0.0]), &accuracy).unwrap();
    let settings = ChargeSettings::default();
    let mut steps = Vec::new();
    let mut note = |p: &Progress| steps.push(p.step);
    let calm = &Interrupt::new();
    let mut hooks = RunHooks::new(calm).with_progress(&mut note);
    let whole = battery.charge(&settings, &mut hooks).unwrap();
    assert_eq!(minimum(&whole).n_kicks, 1);
    let kicked = steps.windows(2).position(|w| w[1] <= w[0]).unwrap() + 1;
    // at the last word of the first relaxation: in the check; at the third after the kick; at the last of all: in the last check
    for stop_at in [kicked, kicked + 3, steps.len()] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("charge.checkpoint");
        let stop = Interrupt::new();
        let mut n_reported = 0;
        let mut note_step = |_: &Progress| {
            n_reported += 1;
            if n_reported == stop_at {
                stop.request();
            }
        };
        let mut hooks = RunHooks::new(&stop)
            .with_progress(&mut note_step)
            .with_checkpoint(&path, 1e6);
        let part = battery.charge(&settings, &mut hooks).unwrap();
        assert_eq!(part.report().stop, ChargeStop::Interrupted, "{stop_at}");
        assert_eq!(part.report().minimum, None);
        let mut hooks = RunHooks::new(calm).with_checkpoint(&path, 1e6);
        let rest = battery.charge(&settings, &mut hooks).unwrap();
        assert_eq!(rest.state(), whole.state());
        assert_eq!(rest.report().n_steps, whole.report().n_steps);
        assert_eq!(rest.report().minimum, whole.report().minimum);
    }
}

#[test]
fn law_low_order_elsewhere_is_no_ring() {
    // low order at both poles only
    let planar = NematicParameters {
        radius: 6.0,
        pattern: SurfacePattern::Planar {
            axis: [0.0, 0.0, 1.0],
        },
        ..Default::default()
    };
    assert_eq!(charge(&planar, 0.05, Threads::One).ring(0.35), None);
    // sides that prefer their normal: low order where they meet the plates
    let walled = NematicParameters {
        sides: Sides::Walled(Plate::default()),
        pattern: SurfacePattern::Uniform {
            director: [0.0, 0.0, 1.0],
        },
        ..planar
    };
    assert_eq!(charge(&walled, 0.05, Threads::One).ring(0.35), None);
    let ringed = NematicParameters {
        sides: Sides::Periodic,
        pattern: SurfacePattern::Winding(1),
        ..walled
    };
    let ring = charge(&ringed, 0.05, Threads::One).ring(0.35).unwrap();
    assert!((1.0..1.4).contains(&(ring.radius / 6.0)), "{}", ring.radius);
}
