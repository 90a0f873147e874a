//! Published numbers: material, load and the four readings of L/h. The paper is `patil2020discharging`.

use super::*;
use crate::{ChargeSettings, DischargeSettings, Guards};

/// Length over radius of the tight 3_1, 4_1, 7_1 and 7_7 (`ashton2011`).
const ROPELENGTHS: [f64; 4] = [32.74, 42.09, 61.41, 65.69];

#[test]
fn val_defaults_are_the_published_ones() {
    let rod = RodParameters::default();
    // captions of its figures: α⁻¹ = 1.3, γ = 5, L/h = 50
    assert!((1.0 / rod.twist_ratio - 1.3).abs() < 1e-15);
    assert_eq!((rod.stretch_ratio, rod.slenderness), (5.0, 50.0));
    // its text: η_f/η = 0.1 instead of the η_f = η of its forerunner, within 2h
    let friction = rod.friction.unwrap();
    assert_eq!(friction.ratio, 0.1);
    assert_eq!(friction.range, FrictionRange::Reading);
    // the independent program of the table of energies and times: k_c = 20, N = 200, tolerance 2e-3 h, reading `shrunk`
    assert_eq!(rod.contact.unwrap().stiffness, 20.0);
    assert_eq!((rod.n_edges, rod.reading), (200, Reading::Shrunk));
    assert_eq!(rod.twist, Some(0.0));
    assert_eq!(Accuracy::default().tolerance, 2e-3);
    // and its limits of a step: h/4, a rise of the energy by 1e-4, a link that drifts by a hundredth of a turn
    let guards = Guards::default();
    assert_eq!((guards.displacement, guards.energy_rise), (0.25, 1e-4));
    assert_eq!(guards.link_drift, 0.01);
    // discharges are followed until 99.9 % is released; 1 to 5 T_0 reach the charged plateau
    assert_eq!(DischargeSettings::default().until_released, 0.999);
    assert!((1.0..=5.0).contains(&ChargeSettings::default().duration));
}

/// L, d_c, friction range and length of the start curve, by hand.
#[test]
fn val_the_four_readings_of_the_slenderness() {
    for rope in ROPELENGTHS {
        let tube = |reading| {
            let rod = RodParameters {
                reading,
                ..Default::default()
            };
            let t = rod.tube(rope).unwrap();
            [
                t.length,
                t.contact_diameter,
                t.friction_range,
                t.start_length,
            ]
        };
        // strands never touch wider than the tube is, also where there is rope to spare (3_1, 4_1)
        let shrunk = if rope < 50.0 { 2.0 } else { 100.0 / rope };
        assert_eq!(tube(Reading::Shrunk), [50.0, shrunk, 2.0, 50.0]);
        // the true tube: what is too long for it starts stretched
        let stretched = if rope < 50.0 { 50.0 } else { rope };
        assert_eq!(tube(Reading::Hard), [50.0, 2.0, 2.0, stretched]);
        // every knot tight
        let tight = 100.0 / rope;
        assert_eq!(tube(Reading::Tight), [50.0, tight, tight, 50.0]);
        assert_eq!(tube(Reading::OwnLength), [rope, 2.0, 2.0, rope]);
    }
    // the readings differ where they should: 7_1 and 7_7 stretched by 23 and 31 %, range over diameter up to 1.31
    let rod = RodParameters::default();
    assert!((2.0 / rod.tube(65.69).unwrap().contact_diameter - 1.3138).abs() < 1e-12);
}

#[test]
fn val_friction_reaches_as_asked() {
    let range = |reading, range| {
        let rod = RodParameters {
            reading,
            friction: Some(FrictionParameters {
                range,
                ..Default::default()
            }),
            ..Default::default()
        };
        rod.tube(62.5).unwrap().friction_range
    };
    // d_c = 2 · 50/62.5 = 1.6 where it shrinks
    for reading in [Reading::Shrunk, Reading::Tight] {
        assert_eq!(range(reading, FrictionRange::Contact), 1.6);
        assert_eq!(range(reading, FrictionRange::TimesContact(1.25)), 2.0);
    }
    for reading in [Reading::Hard, Reading::OwnLength] {
        assert_eq!(range(reading, FrictionRange::Contact), 2.0);
        assert_eq!(range(reading, FrictionRange::TimesContact(1.25)), 2.5);
    }
    assert_eq!(range(Reading::Shrunk, FrictionRange::Reading), 2.0);
    assert_eq!(range(Reading::Tight, FrictionRange::Reading), 1.6);
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let rod = RodParameters::default;
    type Change = fn(&mut RodParameters, f64);
    let changes: [(&str, Change); 6] = [
        ("slenderness", |p, x| p.slenderness = x),
        ("twist_ratio", |p, x| p.twist_ratio = x),
        ("stretch_ratio", |p, x| p.stretch_ratio = x),
        ("contact.stiffness", |p, x| {
            p.contact = Some(ContactParameters { stiffness: x });
        }),
        ("friction.ratio", |p, x| {
            p.friction.as_mut().unwrap().ratio = x;
        }),
        ("friction.range.times-contact", |p, x| {
            p.friction.as_mut().unwrap().range = FrictionRange::TimesContact(x);
        }),
    ];
    for (name, change) in changes {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let mut parameters = rod();
            change(&mut parameters, bad);
            let error = parameters.checked().unwrap_err().to_string();
            assert!(error.contains(name), "{name} = {bad}: {error}");
        }
    }
    let with = |twist, n_edges| RodParameters {
        twist,
        n_edges,
        ..rod()
    };
    assert!(with(Some(f64::NAN), 200).checked().is_err());
    assert!(with(None, 7).checked().is_err() && with(None, 8).checked().is_ok());
    for rope in [5.9, f64::NAN, 2e6] {
        assert!(rod().tube(rope).is_err());
    }
    assert!(rod().tube(2.0 * std::f64::consts::PI).is_ok());
    for accuracy in [
        Accuracy {
            tolerance: 0.0,
            ..Default::default()
        },
        Accuracy {
            gamma: 0.2,
            ..Default::default()
        },
        Accuracy {
            skin: 0.0,
            ..Default::default()
        },
        Accuracy {
            max_steps: 0,
            ..Default::default()
        },
    ] {
        assert!(accuracy.checked().is_err());
    }
    assert!(Accuracy::default().checked().is_ok());
}
