//! What a scene leaves out takes no byte and no call, and what it names at strength zero changes nothing.

use topo_core::{DischargeCurve, Interrupt, Polyline};
use topo_nematic::{
    ChargeSettings as Relaxation, DischargeSettings as Release, ExternalField, FlowParameters,
    Material, NematicAccuracy, NematicBattery, NematicParameters, RunHooks, SurfacePattern,
    SwitchSettings,
};
use topo_rod::{
    Accuracy, ChargeSettings, ContactParameters, CutSite, Discharge, DischargeSettings, EndLoad,
    FrictionParameters, Guards, PhaseReport, RodBattery, RodParameters,
};
use topo_tests::curves;

fn circle() -> Polyline {
    curves::ring(60, 8.0)
}

fn trefoil() -> Polyline {
    curves::trefoil(60, 2.0, 1.0)
}

/// A rod of few edges; what it has is set by each test.
fn rod() -> RodParameters {
    RodParameters {
        n_edges: 60,
        twist: None,
        contact: None,
        friction: None,
        ..RodParameters::default()
    }
}

/// Charge and most of the discharge of a rod.
fn run_rod(parameters: &RodParameters, curve: &Polyline) -> (PhaseReport, Discharge) {
    let accuracy = Accuracy::default();
    let guards = Guards::default();
    let battery = RodBattery::new(parameters, &accuracy, guards, curve).unwrap();
    let charge = ChargeSettings {
        duration: 0.2,
        ..ChargeSettings::default()
    };
    let none = &mut topo_core::RunHooks::default();
    let charged = battery.charge(&charge, none).unwrap();
    let settings = DischargeSettings {
        until_released: 0.5,
        ..DischargeSettings::default()
    };
    let cut = charged.cut(CutSite::At(0.1)).unwrap();
    let discharge = cut.discharge(&settings, none).unwrap();
    (charged.record().report.clone(), discharge)
}

/// A colloid that is charged and discharged in about a second.
fn colloid() -> NematicParameters {
    NematicParameters {
        radius: 4.5,
        spacing: 1.5,
        cell: [4.0, 4.0, 4.0],
        pattern: SurfacePattern::Winding(2),
        ..NematicParameters::default()
    }
}

fn run_colloid(
    parameters: &NematicParameters,
    flow: Option<FlowParameters>,
) -> topo_nematic::Discharge {
    let battery = NematicBattery::new(parameters, &NematicAccuracy::default()).unwrap();
    let interrupt = Interrupt::new();
    let charge = Relaxation {
        tolerance: 1e-5,
        order_tolerance: 1e-3,
        ..Relaxation::default()
    };
    let charged = battery
        .charge(&charge, &mut RunHooks::new(&interrupt))
        .unwrap();
    let released = charged.switch(&SwitchSettings::default()).unwrap();
    let settings = Release {
        until_released: 0.9,
        flow,
        ..Release::default()
    };
    released
        .discharge(&settings, &mut RunHooks::new(&interrupt))
        .unwrap()
}

fn bits(curve: &DischargeCurve) -> Vec<u64> {
    let stored = curve.stored().iter().flatten();
    let dissipated = curve.dissipated().iter().flatten();
    curve
        .time()
        .iter()
        .chain(stored)
        .chain(dissipated)
        .map(|x| x.to_bits())
        .collect()
}

#[test]
fn law_absent_terms_of_a_rod_cost_nothing() {
    let (closed, open) = run_rod(&rod(), &trefoil());
    for work in [closed.own.work, open.record.report.own.work] {
        assert!(work.n_evaluations > 10);
        let calls = [
            work.n_contact_evaluations,
            work.n_friction_evaluations,
            work.n_twist_evaluations,
            work.n_twist_factorisations,
            work.n_list_rebuilds,
        ];
        assert_eq!(calls, [0; 5]);
        let bytes = [work.contact_bytes, work.friction_bytes, work.twist_bytes];
        assert_eq!(bytes, [0; 3]);
        assert_eq!((work.n_load_evaluations, work.load_bytes), (0, 0));
        assert_eq!((work.n_rest_evaluations, work.rest_bytes), (0, 0));
        assert_eq!((work.n_component_solves, work.component_bytes), (0, 0));
    }
    // Each counter tells a term that is there.
    let everything = RodParameters {
        twist: Some(0.5),
        contact: Some(ContactParameters::default()),
        friction: Some(FrictionParameters::default()),
        ..rod()
    };
    let (closed, open) = run_rod(&everything, &trefoil());
    for work in [closed.own.work, open.record.report.own.work] {
        assert!(work.n_contact_evaluations > 10 && work.contact_bytes > 0);
        assert!(work.n_friction_evaluations > 10 && work.friction_bytes > 0);
        assert!(work.n_twist_evaluations > 10 && work.twist_bytes > 0);
        assert!(work.n_twist_factorisations > 10 && work.n_list_rebuilds > 0);
    }
}

#[test]
fn law_absent_terms_of_a_nematic_cost_nothing() {
    let plain = run_colloid(&colloid(), None).record.report.own;
    assert_eq!((plain.bytes.flow, plain.bytes.second), (0, 0));
    assert_eq!((plain.flow, plain.n_second_passes), (None, 0));
    let everything = NematicParameters {
        material: Material {
            second_elastic_constant: Some(0.3),
            ..Material::default()
        },
        ..colloid()
    };
    let full = run_colloid(&everything, Some(FlowParameters::default()))
        .record
        .report
        .own;
    assert!(full.bytes.flow > 0 && full.flow.unwrap().counters.n_updates > 10);
    assert!(full.bytes.second > 0 && full.n_second_passes > 10);
    // The rest takes what it took.
    assert_eq!(full.bytes.geometry, plain.bytes.geometry);
}

/// A natural shape is held and used where there is one, at one that is straight too, which changes nothing to rounding.
#[test]
fn law_a_natural_shape_is_there_where_it_is_named() {
    let (parameters, accuracy) = (rod(), Accuracy::default());
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &circle()).unwrap();
    let none = &mut topo_core::RunHooks::default();
    let mut charged = |battery: &RodBattery| {
        let charged = battery.charge(&ChargeSettings::default(), none).unwrap();
        charged.record().report.clone()
    };
    let absent = charged(&battery);
    let straight = charged(&battery.with_rest(|_, _| [0.0; 2], |_, _| 0.0).unwrap());
    assert_eq!(
        (
            absent.own.work.n_rest_evaluations,
            absent.own.work.rest_bytes
        ),
        (0, 0)
    );
    // two curvatures and a twist of each vertex, and a director
    assert_eq!(straight.own.work.rest_bytes, 8 * (3 * 60 + 3));
    let work = straight.own.work;
    assert!(work.n_rest_evaluations as u64 == work.n_evaluations && work.n_evaluations > 10);
    assert_eq!(absent.n_steps, straight.n_steps);
}

/// A load is evaluated where there is one; one too weak to move anything leaves what the rod does, to rounding.
#[test]
fn law_a_load_is_there_where_it_is_named() {
    let battery = RodBattery::new(&rod(), &Accuracy::default(), Guards::default(), &circle());
    let none = &mut topo_core::RunHooks::default();
    let charged = battery.unwrap().charge(&ChargeSettings::default(), none);
    let cut = charged.unwrap().cut(CutSite::At(0.1)).unwrap();
    let mut run = |load| {
        let settings = DischargeSettings {
            load,
            ..DischargeSettings::default()
        };
        cut.discharge(&settings, none).unwrap()
    };
    let weak = EndLoad {
        dashpot: 1e-14,
        ..EndLoad::default()
    };
    let (without, with) = (run(None), run(Some(weak)));
    let [absent, present] = [&without, &with].map(|d| d.record.report.own.work);
    assert_eq!((absent.n_load_evaluations, absent.load_bytes), (0, 0));
    assert!(present.n_load_evaluations > 10 && present.load_bytes > 0);
    assert!(without.record.report.own.load.is_none());
    assert!(without.record.samples.iter().all(|s| s.load_work.is_none()));
    assert!(with.record.report.own.load.unwrap().work < 1e-9);
    let (a, b) = (&with.record.curve, &without.record.curve);
    assert_eq!(a.len(), b.len(), "steps");
    for k in 0..a.len() {
        assert!((a.stored_total(k) - b.stored_total(k)).abs() <= 1e-9 * b.stored_total(0));
    }
}

/// Friction of ratio zero is no friction, to the bit.
#[test]
fn law_friction_of_strength_zero_changes_nothing() {
    let touching = RodParameters {
        twist: Some(0.5),
        contact: Some(ContactParameters::default()),
        ..rod()
    };
    let smooth = RodParameters {
        friction: Some(FrictionParameters {
            ratio: 0.0,
            ..FrictionParameters::default()
        }),
        ..touching.clone()
    };
    let (_, without) = run_rod(&touching, &trefoil());
    let (_, with) = run_rod(&smooth, &trefoil());
    assert_eq!(bits(&with.record.curve), bits(&without.record.curve));
    assert_eq!(with.record.report.own.work.n_friction_evaluations, 0);
    let rough = RodParameters {
        friction: Some(FrictionParameters::default()),
        ..touching
    };
    let (_, rubbed) = run_rod(&rough, &trefoil());
    assert_ne!(bits(&rubbed.record.curve), bits(&without.record.curve));
}

/// A planar rod has no writhe that could turn into twist: modelled, its twist stays zero, to rounding, and nothing else changes.
#[test]
fn law_twist_of_strength_zero_changes_nothing() {
    let modelled = RodParameters {
        twist: Some(0.0),
        ..rod()
    };
    let ring = circle();
    let (_, without) = run_rod(&rod(), &ring);
    let (_, with) = run_rod(&modelled, &ring);
    let (a, b) = (&with.record.curve, &without.record.curve);
    assert_eq!(a.len(), b.len(), "steps");
    let twist = a.series("twist").unwrap();
    assert!(twist.iter().all(|e| *e < 1e-24), "{twist:?}");
    for k in 0..a.len() {
        assert!((a.time()[k] - b.time()[k]).abs() <= 1e-9 * b.time()[k]);
        // The last bits of a direction may differ, and a step's length follows the cube root of an error made of them.
        assert!((a.stored_total(k) - b.stored_total(k)).abs() <= 1e-9 * b.stored_total(0));
    }
}

/// Contact without touch: strands that never come near feel nothing, to the bit.
#[test]
fn law_contact_out_of_reach_changes_nothing() {
    let touching = RodParameters {
        contact: Some(ContactParameters { stiffness: 1e-6 }),
        ..rod()
    };
    let (_, without) = run_rod(&rod(), &circle());
    let (_, with) = run_rod(&touching, &circle());
    assert_eq!(
        with.record
            .curve
            .series("contact")
            .unwrap()
            .iter()
            .sum::<f64>(),
        0.0
    );
    assert_eq!(bits(&with.record.curve), bits(&without.record.curve));
}

/// A second elastic constant of zero and a field of zero are none, to the bit.
#[test]
fn law_nematic_terms_of_strength_zero_change_nothing() {
    let without = run_colloid(&colloid(), None);
    let zero = NematicParameters {
        material: Material {
            second_elastic_constant: Some(0.0),
            ..Material::default()
        },
        field: Some(ExternalField {
            vector: [0.0; 3],
            anisotropy: 1.0,
        }),
        ..colloid()
    };
    let with = run_colloid(&zero, None);
    assert_eq!(bits(&with.record.curve), bits(&without.record.curve));
    assert_eq!(with.state, without.state);
    let report = with.record.report;
    assert_eq!(
        (report.own.n_second_passes, report.own.bytes.second),
        (0, 0)
    );
    let weak = NematicParameters {
        field: Some(ExternalField {
            vector: [0.0, 0.0, 0.1],
            anisotropy: 1.0,
        }),
        ..colloid()
    };
    assert_ne!(
        bits(&run_colloid(&weak, None).record.curve),
        bits(&without.record.curve)
    );
}

/// The velocity goes as 1/η: a fluid of viscosity 1e13 stands still, and the director does what it does without flow.
///
/// Flow has no strength that can be zero, and its rate is added in a pass of its own, so that sums round differently: energies
/// agree to 1e-9 of the start, not to the bit.
#[test]
fn law_a_fluid_that_stands_still_changes_nothing() {
    let stiff = NematicParameters {
        material: Material {
            viscosity: 1e13,
            ..Material::default()
        },
        ..colloid()
    };
    let without = run_colloid(&stiff, None).record;
    let with = run_colloid(&stiff, Some(FlowParameters::default())).record;
    let (a, b) = (&with.curve, &without.curve);
    assert_eq!(a.len(), b.len(), "steps");
    for k in 0..a.len() {
        let (x, y) = (a.stored_total(k), b.stored_total(k));
        assert!((x - y).abs() <= 1e-9 * b.stored_total(0), "{k}: {x} {y}");
        assert!(
            (a.time()[k] - b.time()[k]).abs() <= 1e-7 * b.time()[k],
            "{k}"
        );
    }
}
