//! Released energy counts down to the state of equilibrium after the switch: in a field, to another pattern, where nothing is stored.

use topo_analysis::DischargeTimes;
use topo_core::Interrupt;
use topo_nematic::record::FinalSource;
use topo_nematic::{
    Anchoring, ChargeSettings, ChargedNematic, Discharge, DischargeSettings, EnergyParts,
    ExternalField, FlowParameters, Material, NematicAccuracy, NematicBattery, NematicParameters,
    RunHooks, SurfacePattern, SwitchSettings, SwitchTarget,
};

fn small(charge: i32) -> NematicParameters {
    NematicParameters {
        radius: 6.0,
        pattern: SurfacePattern::Winding(charge),
        ..Default::default()
    }
}

fn charge(parameters: &NematicParameters) -> ChargedNematic {
    let battery = NematicBattery::new(parameters, &NematicAccuracy::default()).unwrap();
    let hooks = &mut RunHooks::new(&Interrupt::new());
    let charged = battery.charge(&ChargeSettings::default(), hooks).unwrap();
    assert!(charged.report().is_converged(), "{:?}", charged.report());
    charged
}

fn discharge(charged: &ChargedNematic, switch: &SwitchSettings) -> Discharge {
    let settings = DischargeSettings::default();
    let hooks = &mut RunHooks::new(&Interrupt::new());
    let switched = charged.switch(switch).unwrap();
    switched.discharge(&settings, hooks).unwrap()
}

fn times(run: &Discharge) -> [Option<f64>; 2] {
    let shares = [0.5, 0.99];
    let ends = [run.start, run.final_state.energy];
    let times = DischargeTimes::between(&run.record.curve, &EnergyParts::NAMES, ends, &shares);
    shares.map(|share| times.at(share).map(|t| t.value))
}

fn to_pattern(pattern: SurfacePattern, ramp: Option<f64>) -> SwitchSettings {
    SwitchSettings {
        to: SwitchTarget::Pattern {
            pattern,
            anchoring: Anchoring::Strong,
        },
        ramp,
    }
}

#[test]
fn val_final_state_in_a_field_is_that_of_the_bulk() {
    let field = ExternalField {
        vector: [0.0, 0.0, 1.0],
        anisotropy: 0.005,
    };
    let in_field = charge(&NematicParameters {
        field: Some(field),
        ..small(2)
    });
    // Along the field f(S) - chi_a S E²/2 of each volume, least by a walk over S; but for thin layers at the plates.
    let m = Material::default();
    let density =
        |s: f64| m.uniaxial_density(s) - m.reference_density() - 0.5 * field.anisotropy * s;
    let least = (0..100_000)
        .map(|i| density(0.5 + 1e-6 * f64::from(i)))
        .fold(f64::INFINITY, f64::min);
    let grid = in_field.battery().grid();
    let sphere = 4.0 / 3.0 * std::f64::consts::PI * 6.0_f64.powi(3);
    let ground = (grid.extent().iter().product::<f64>() - sphere) * least;
    let run = discharge(&in_field, &SwitchSettings::default());
    let found = run.final_state;
    println!("ground state {ground:.4}, final state {found:?}");
    assert_eq!(found.source, FinalSource::Relaxed);
    assert!((found.energy / ground - 1.0).abs() < 2e-3);
    assert!(run.is_finished());
    // A field that hardly turns anything hardly changes the times: 0.40 when counted down to zero.
    let plain = discharge(&charge(&small(2)), &SwitchSettings::default());
    assert_eq!(plain.final_state.source, FinalSource::Uniform);
    assert_eq!(plain.final_state.energy, 0.0);
    for (a, b) in times(&run).into_iter().zip(times(&plain)) {
        let (a, b) = (a.unwrap(), b.unwrap());
        println!("{a:.4} in the field, {b:.4} without");
        assert!((a / b - 1.0).abs() < 0.04, "{a} {b}");
    }
    // The end of the run is the state that it was said to relax to.
    let last = run.record.curve.len() - 1;
    let left = (run.record.curve.stored_total(last) - found.energy) / run.stored.unwrap();
    assert!((0.0..1e-3).contains(&left), "{left}");
}

#[test]
fn law_ramps_to_another_pattern_end_in_its_charged_state() {
    let (two, one) = (charge(&small(2)), charge(&small(1)));
    let goal = one.energy().total();
    for ramp in [None, Some(5.0)] {
        let run = discharge(&two, &to_pattern(SurfacePattern::Winding(1), ramp));
        assert!(run.is_finished(), "{ramp:?} {:?}", run.record.report.stop);
        assert!(
            (run.final_state.energy / goal - 1.0).abs() < 1e-9,
            "{ramp:?}"
        );
        assert!(times(&run).iter().all(Option::is_some), "{ramp:?}");
        assert!(run.record.report.ledger_residual < 0.01);
    }
    // Up the other way work is done and nothing is released; the run still ends, where it relaxes to.
    let up = discharge(&one, &to_pattern(SurfacePattern::Winding(2), Some(5.0)));
    assert!(up.is_finished() && up.stored.unwrap() < 0.0);
    assert!((up.final_state.energy / two.energy().total() - 1.0).abs() < 1e-9);
    assert_eq!(times(&up), [None, None]);
}

#[test]
fn law_nothing_stored_has_no_times() {
    // Anchoring of no strength and no anchoring hold no energy; nor does a pattern that is kept.
    for anchoring in [Anchoring::Weak(0.0), Anchoring::Free] {
        let parameters = NematicParameters {
            anchoring,
            ..small(2)
        };
        let run = discharge(&charge(&parameters), &SwitchSettings::default());
        assert_eq!(
            (run.stored, run.record.report.n_steps),
            (None, 0),
            "{anchoring:?}"
        );
    }
    let keep = SwitchSettings {
        to: SwitchTarget::Keep,
        ramp: None,
    };
    let run = discharge(&charge(&small(2)), &keep);
    assert_eq!((run.stored, run.record.report.n_steps), (None, 0));
}

#[test]
fn law_a_driven_fluid_is_followed_where_nothing_is_stored() {
    // Moving plates shear a nematic at rest: there is no release to wait for, only the time asked for ends the run.
    let parameters = NematicParameters {
        particle: false,
        cells: Some([4, 4, 12]),
        radius: 1.0,
        ..Default::default()
    };
    let mut flow = FlowParameters::default();
    flow.drive.wall_velocity[2] = [[-0.02, 0.0, 0.0], [0.02, 0.0, 0.0]];
    let settings = DischargeSettings {
        longest: 20.0,
        flow: Some(flow),
        ..Default::default()
    };
    let keep = SwitchSettings {
        to: SwitchTarget::Keep,
        ramp: None,
    };
    let hooks = &mut RunHooks::new(&Interrupt::new());
    let switched = charge(&parameters).switch(&keep).unwrap();
    let run = switched.discharge(&settings, hooks).unwrap();
    assert!(run.record.report.time > 19.9 && run.stored.is_none());
    let curve = &run.record.curve;
    assert!(
        curve.stored_total(curve.len() - 1) > 1e-6,
        "the shear distorts the director"
    );
}
