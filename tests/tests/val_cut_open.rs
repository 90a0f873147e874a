//! Open fibres that are held at their ends and cut between them.

use topo_core::RunHooks;
use topo_rod::{
    Accuracy, ChargedRod, ContactParameters, CutSite, Discharge, DischargeSettings, EndCondition,
    Ends, FrictionParameters, Grip, Guards, PullSettings, RodBattery, RodParameters, Tips,
    cut_circle_energy,
};
use topo_tests::curves::{self, from_tangents};

/// An open fibre held at its ends, as it is tied.
fn held(
    parameters: &RodParameters,
    curve: &topo_core::Polyline,
    condition: EndCondition,
) -> ChargedRod {
    let accuracy = Accuracy {
        tolerance: 1e-4,
        ..Accuracy::default()
    };
    let battery = RodBattery::open(parameters, &accuracy, Guards::default(), curve).unwrap();
    let grip = Grip {
        condition,
        ..Grip::default()
    };
    let settings = PullSettings {
        grips: [grip.clone(), grip],
        duration: 0.2,
        outputs: 2,
    };
    let held = battery.pull(&settings, &mut RunHooks::default()).unwrap();
    assert!(held.record().report.stop.is_success());
    held
}

/// An arc of one radian and a half, cut in its middle: how much of its energy it holds at some times, over the exact share.
fn errors_of_an_arc(n: usize, contact: bool, conditions: [EndCondition; 2]) -> Vec<f64> {
    let parameters = RodParameters {
        n_edges: n,
        twist: Some(0.0),
        contact: contact.then(ContactParameters::default),
        friction: contact.then(FrictionParameters::default),
        ..RodParameters::default()
    };
    let arc = from_tangents(n, 1.0 / n as f64, |j| {
        let angle = 1.5 * (j as f64 + 0.5) / n as f64;
        topo_core::Vector3::new(angle.cos(), angle.sin(), 0.0)
    });
    let held = held(&parameters, &arc, EndCondition::Clamped);
    let settings = DischargeSettings {
        ends: Ends {
            conditions,
            ..Ends::default()
        },
        longest: 4.0,
        ..DischargeSettings::default()
    };
    let cut = held.cut(CutSite::At(0.5)).unwrap();
    assert_eq!((cut.tips, cut.at), (Some(Tips::Between(0)), 0.5));
    let done = cut.discharge(&settings, &mut RunHooks::default()).unwrap();
    let report = &done.record.report;
    assert!(report.ledger_residual < 1e-3, "{}", report.ledger_residual);
    // a half that is clamped is half of a free rod of the whole length; one that is free is one itself
    let held = conditions == [EndCondition::Clamped; 2];
    let relaxation = 50.0 / std::f64::consts::PI.powi(2) * if held { 1.0 } else { 0.25 };
    let samples = done.record.samples.iter().filter(|s| s.time > 0.05);
    let error = |s: &topo_rod::RodSample| {
        s.elastic() / done.start / cut_circle_energy(s.time / relaxation) - 1.0
    };
    samples.map(error).collect()
}

/// The tangent angle of each half diffuses: clamped at its outer end, a half does what one of a free rod of the length of both does.
#[test]
fn val_halves_of_an_arc_straighten_as_their_series() {
    let largest = |errors: &[f64]| errors.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    for conditions in [[EndCondition::Clamped; 2], [EndCondition::Free; 2]] {
        let [coarse, fine] = [50, 100].map(|n| largest(&errors_of_an_arc(n, false, conditions)));
        println!("{conditions:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine < 0.04 && fine < 0.6 * coarse, "{coarse} {fine}");
        // tips in one place do not push each other
        let with_contact = largest(&errors_of_an_arc(50, true, conditions));
        assert!(
            (with_contact - coarse).abs() < 1e-6,
            "{with_contact} {coarse}"
        );
    }
}

fn overhand(cut: CutSite) -> Discharge {
    let parameters = RodParameters {
        slenderness: 60.0,
        n_edges: 120,
        twist: Some(0.3),
        ..RodParameters::default()
    };
    let held = held(
        &parameters,
        &curves::overhand(120, 4.0),
        EndCondition::Clamped,
    );
    let settings = DischargeSettings {
        ends: Ends {
            conditions: [EndCondition::Clamped, EndCondition::Free],
            ..Ends::default()
        },
        longest: 20.0,
        ..DischargeSettings::default()
    };
    let cut = held.cut(cut).unwrap();
    cut.discharge(&settings, &mut RunHooks::default()).unwrap()
}

/// An overhand knot that is held and cut in itself: two fibres that push each other but never cross, the first of them held, and an
/// account that closes. The grip of the end that is let go has no force.
#[test]
fn law_a_knot_that_is_cut_between_its_grips_comes_apart() {
    for cut in [
        CutSite::MaximumEnergyDensity,
        CutSite::At(0.4),
        CutSite::At(0.62),
    ] {
        let done = overhand(cut);
        let report = &done.record.report;
        println!(
            "at {}: {}, residual {:.1e}, parted {:?}, {:?}",
            done.at,
            report.stop,
            report.ledger_residual,
            done.parted,
            report.own.min_distance_over_contact
        );
        assert!(report.stop.is_success(), "{}", report.stop);
        assert!(report.ledger_residual < 2e-3, "{}", report.ledger_residual);
        assert!(done.removed > 0.0 && done.removed < 0.1 * done.start);
        assert!(done.parted.is_some());
        assert!(report.own.min_distance_over_contact.unwrap() > 0.75);
        let last = done.record.samples.last().unwrap();
        assert_eq!(last.state.n_components(), 2);
        assert!(last.grips[0].is_some() && last.grips[1].is_none());
    }
}

/// The site of largest density is inside of the fibre, and one at its end is refused.
#[test]
fn law_an_open_fibre_is_not_cut_at_its_ends() {
    let parameters = RodParameters {
        slenderness: 60.0,
        n_edges: 60,
        ..RodParameters::default()
    };
    let held = held(
        &parameters,
        &curves::overhand(60, 4.0),
        EndCondition::Pinned,
    );
    let found = held.cut_candidates(0.9);
    assert!(!found.is_empty() && found.iter().all(|c| (2..=58).contains(&c.vertex)));
    for at in [0.0, 0.02, 0.98] {
        let error = held.cut(CutSite::At(at)).unwrap_err().to_string();
        assert!(error.contains("at an end of the open rod"), "{error}");
    }
    assert!(held.cut(CutSite::At(2.0 / 60.0)).is_ok());
}
