//! Claims 1 to 8.

use super::*;
use std::f64::consts::TAU;

const AMPHICHIRAL: [&str; 2] = ["4_1", "6_3"];

#[test]
fn claim_1_needs_every_state_its_type_and_its_linking_number() {
    assert_eq!(verdict(1, &published(|_| {})), Confirmed);
    let fewer = tables(rows(&[-2.0, 0.0, 2.0], |_| {}));
    assert_eq!(verdict(1, &fewer), Partly);
    // what happens to one state and to all
    let changes: [fn(&mut Cut); 4] = [
        |r| r.link_drift = Some(1e-9),
        |r| r.link_drift = None,
        |r| r.warnings = "the charged rod is tied as 0_1".into(),
        |r| r.warnings = "charge stopped: step too small".into(),
    ];
    for change in changes {
        let one = published(|r| {
            if r.knot == "5_2" && r.twist == 1.0 {
                change(r);
            }
        });
        assert_eq!(verdict(1, &one), Partly);
        assert_eq!(verdict(1, &published(change)), NotConfirmed);
    }
}

#[test]
fn claim_2_needs_energies_that_differ_between_the_hands() {
    let hand =
        |difference: f64| published(move |r| r.energy = 1.0 + 0.5 * difference * r.twist.signum());
    for (difference, expected) in [
        (0.03, Confirmed),
        (-0.03, Confirmed),
        (0.004, NotConfirmed),
        (0.0, NotConfirmed),
    ] {
        assert_eq!(verdict(2, &hand(difference)), expected, "{difference}");
    }
}

#[test]
fn claim_3_needs_one_image_alone_to_store_the_same() {
    // energy of the other image as a function of the twist
    let image = |other: fn(f64) -> Option<f64>| {
        published(move |r| {
            if r.knot == "4_1" {
                r.energy_other_image = other(r.twist.abs());
            }
        })
    };
    assert_eq!(verdict(3, &image(|_| Some(1.001))), Confirmed);
    let at_low_twist = |t| Some(if t < 1.0 { 1.02 } else { 1.0 });
    assert_eq!(verdict(3, &image(at_low_twist)), Partly);
    assert_eq!(verdict(3, &image(|_| Some(1.02))), NotConfirmed);
    // equal by construction is no proof
    let found = finding(3, &image(|_| None));
    assert_eq!(found.verdict, NotJudged);
    assert!(found.found.contains("by construction"));
    let kept = published(|r| r.energy = 1.0 + 0.02 * f64::from(r.twist > 0.0));
    assert_eq!(verdict(3, &kept), NotConfirmed);
}

#[test]
fn claim_4_needs_chiral_knots_above_amphichiral_ones() {
    let made = |chiral: f64, indifferent: &'static [&str], image: Option<f64>| {
        published(move |r| {
            if AMPHICHIRAL.contains(&r.knot.as_str()) {
                r.energy_other_image = image.map(|d| 1.0 + d);
            } else if !indifferent.contains(&r.knot.as_str()) {
                r.energy = 1.0 + 0.5 * chiral * r.twist.signum();
            }
        })
    };
    assert_eq!(verdict(4, &made(0.012, &[], Some(0.002))), Confirmed);
    assert_eq!(verdict(4, &made(0.012, &["5_1"], Some(0.002))), Partly);
    assert_eq!(verdict(4, &made(0.004, &[], Some(0.002))), NotConfirmed);
    assert_eq!(verdict(4, &made(0.002, &[], Some(0.012))), NotConfirmed);
    // a difference that is seen at one twist only
    let at_one = published(|r| {
        r.energy_other_image = AMPHICHIRAL.contains(&r.knot.as_str()).then_some(1.002);
        if r.energy_other_image.is_none() && r.twist == 0.25 {
            r.energy = 1.03;
        }
    });
    assert_eq!(
        (verdict(4, &at_one), other(4, &at_one)),
        (NotConfirmed, Confirmed)
    );
    // nothing is known of one image alone
    assert_eq!(verdict(4, &made(0.012, &[], None)), NotJudged);
}

#[test]
fn claim_5_needs_profiles_that_differ() {
    let dir = tempfile::tempdir().unwrap();
    let mut made = published(|_| {});
    made.results = dir.path().to_owned();
    for (peak, expected) in [(1.5, Confirmed), (1.25, NotConfirmed)] {
        // largest over mean density at +2 and −2: the mean of four is (3 + peak)/4
        for (twist, peak) in [("2", peak), ("-2", 1.2)] {
            let text = format!(
                "s,x,y,z,energy_density\n0,0,0,0,1\n1,1,0,0,{peak}\n2,1,1,0,1\n3,0,1,0,1\n"
            );
            let path = dir.path().join(format!("elastic/3_1_{twist}/charged.csv"));
            crate::data::write(&path, text.as_bytes()).unwrap();
        }
        assert_eq!(verdict(5, &made), expected);
    }
}

#[test]
fn claim_6_needs_most_states_of_either_hand_to_lose_twist() {
    // turns supplied: θ'h · 50/2π
    let left = |share: fn(&Cut) -> f64| {
        published(move |r| r.total_twist = share(r) * r.twist * 50.0 / TAU)
    };
    // typically, not always
    let typical = |r: &Cut| if r.twist.abs() < 0.8 { 1.01 } else { 0.98 };
    assert_eq!(verdict(6, &left(typical)), Confirmed);
    let one_hand = |r: &Cut| if r.twist > 0.0 { 0.98 } else { 1.02 };
    assert_eq!(verdict(6, &left(one_hand)), Partly);
    assert_eq!(verdict(6, &left(|_| 1.02)), NotConfirmed);
}

#[test]
fn claim_7_needs_energies_of_the_knots_to_come_together() {
    let knot = |r: &Cut| KNOTS.iter().position(|k| *k == r.knot).unwrap() as f64 / 13.0;
    let span = |low: f64, high: f64| {
        published(move |r| {
            let span = if r.twist == 0.0 { low } else { high };
            r.energy = 1.0 + (span - 1.0) * knot(r);
        })
    };
    assert_eq!(verdict(7, &span(4.4, 1.2)), Confirmed);
    assert_eq!(verdict(7, &span(4.4, 3.0)), Partly);
    assert_eq!(verdict(7, &span(1.2, 4.4)), NotConfirmed);
}

#[test]
fn claim_8_needs_the_takeover_at_about_one() {
    // twist energy grows as the square of the twist
    let at = |takeover: f64| {
        published(move |r| {
            r.bend = 0.2;
            r.twist_energy = 0.2 * (r.twist / takeover).powi(2);
        })
    };
    assert_eq!(verdict(8, &at(1.0)), Confirmed);
    let found = finding(8, &at(0.6));
    assert_eq!(found.verdict, Partly);
    assert!(
        found.found.contains("instead of about 1"),
        "{}",
        found.found
    );
    assert_eq!(verdict(8, &at(1.5)), Partly);
    assert_eq!(verdict(8, &at(3.0)), NotConfirmed);
}
