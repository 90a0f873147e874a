//! Claims 10 to 14.

use super::*;

/// Untwisted knots, 10 T_0 each by default; t90 is a third of it.
fn untwisted(change: impl Fn(&mut Cut)) -> Vec<Cut> {
    rows(&[0.0], |r| {
        (r.t99, r.t90) = (Some(10.0), Some(3.0));
        change(r);
    })
}

/// The untwisted knots with the given t99 over the median.
fn factors(list: &[(&str, f64)]) -> Vec<Cut> {
    untwisted(|r| {
        if let Some((_, factor)) = list.iter().find(|k| k.0 == r.knot) {
            r.t99 = Some(10.0 * factor);
        }
    })
}

/// Adds near ties: a second cut of 7_4 with `t99`.
fn with_tie(mut rows: Vec<Cut>, t99: f64) -> Vec<Cut> {
    let mut tie = rows.iter().find(|r| r.knot == "7_4").unwrap().clone();
    (tie.cut, tie.t99) = (0.5, Some(t99));
    rows.push(tie);
    rows
}

#[test]
fn claim_10_is_judged_by_the_cut_at_the_largest_density() {
    let both = factors(&[("3_1", 1.6), ("7_4", 2.2)]);
    assert_eq!(verdict(10, &tables(both.clone())), Confirmed);
    let one = factors(&[("3_1", 1.6), ("7_4", 1.0)]);
    assert_eq!(verdict(10, &tables(one)), Partly);
    assert_eq!(verdict(10, &tables(factors(&[]))), NotConfirmed);
    // fast instead of slow
    let fast = factors(&[("3_1", 0.5), ("7_4", 0.5)]);
    assert_eq!(verdict(10, &tables(fast)), NotConfirmed);
    // slow up to 90 % only
    let early = untwisted(|r| {
        if ["3_1", "7_4"].contains(&r.knot.as_str()) {
            r.t90 = Some(6.0);
        }
    });
    assert_eq!(verdict(10, &tables(early)), Partly);
    // a near tie that is fast speaks in the other reading: (22 + 6)/2 = 14
    let tied = tables(with_tie(both, 6.0));
    assert_eq!((verdict(10, &tied), other(10, &tied)), (Confirmed, Partly));
    let once = finding(10, &tables(factors(&[])));
    assert!(once.other_reading.is_none());
}

/// Cuts of the untwisted knots by criterion, with the given t99 over the median.
fn cut_by(by: &str, list: &[(&str, f64)]) -> Vec<Cut> {
    let mut rows = factors(list);
    for row in &mut rows {
        row.cut_by = by.to_owned();
    }
    rows
}

#[test]
fn claim_10_looks_at_every_reading_of_maximum_stress() {
    let pair: &[(&str, f64)] = &[("3_1", 1.6), ("7_4", 2.2)];
    let judged = |curvature: &[(&str, f64)], others: &[(&str, f64)]| {
        let mut made = tables(factors(pair));
        let rows = [
            cut_by("energy;von-mises", others),
            cut_by("curvature", curvature),
            cut_by("tension", pair),
        ];
        made.criteria = ByCriterion::of(&Sweep::of_rows(rows.concat()).unwrap());
        made
    };
    let agreeing = judged(pair, pair);
    assert_eq!(agreeing.criteria.len(), 4);
    assert_eq!(verdict(10, &agreeing), Confirmed);
    let apart = judged(&[("7_1", 1.7)], pair);
    assert_eq!(verdict(10, &apart), Partly);
    let said = finding(10, &apart).found;
    assert!(
        said.contains("largest curvature: 3₁ 1 and 7₄ 1 times, slow: 7₁ 1.7"),
        "{said}"
    );
    assert!(said.contains("von Mises stress: 3₁ 1.6"), "{said}");
    // slow by none of the readings
    let mut none = judged(&[], &[]);
    none.elastic = Sweep::of_rows(factors(&[]));
    none.criteria
        .retain(|c| c.criterion != topo_rod::Criterion::Tension);
    assert_eq!(verdict(10, &none), NotConfirmed);
    // and to claim 11 each reading is one choice more
    let choice = || side("so", factors(pair));
    let mut made = judged(pair, pair);
    made.choices.push(choice());
    assert_eq!(verdict(11, &made), Confirmed);
    let mut made = judged(&[], pair);
    made.choices.push(choice());
    assert_eq!(verdict(11, &made), Partly);
    let said = finding(11, &made).found;
    assert!(
        said.contains("not under cut at the largest curvature"),
        "{said}"
    );
}

#[test]
fn claim_11_needs_a_knot_that_is_slow_under_every_choice() {
    let slow = || factors(&[("7_4", 2.2), ("7_1", 1.7)]);
    let under = |default: Vec<Cut>, choices: &[&[(&str, f64)]]| {
        let mut made = tables(default);
        made.choices = choices.iter().map(|c| side("so", factors(c))).collect();
        made
    };
    let made = under(slow(), &[&[("7_4", 1.8)], &[("7_4", 2.0), ("7_1", 3.0)]]);
    assert_eq!(verdict(11, &made), Confirmed);
    // slow under each choice, but no knot under all
    let made = under(slow(), &[&[("7_4", 1.8)], &[("7_1", 3.0)]]);
    assert_eq!(verdict(11, &made), Partly);
    let made = under(factors(&[]), &[&[("7_4", 1.8)], &[("7_4", 1.8)]]);
    assert_eq!(verdict(11, &made), NotConfirmed);
    assert!(CLAIMS[10].finding(11, &tables(slow())).is_none());
    // the mean over near ties is reported beside it
    let tied = with_tie(factors(&[("7_4", 2.2)]), 6.0);
    let made = under(tied, &[&[("7_4", 1.8)]]);
    assert_eq!(
        (verdict(11, &made), other(11, &made)),
        (Confirmed, NotConfirmed)
    );
    // warnings of another choice count too
    let mut made = under(slow(), &[&[("7_4", 1.8)]]);
    made.choices[0].sweep.cases[0].cuts[0].warnings = "stopped".into();
    assert_eq!(verdict(11, &made), Partly);
}

/// The published sweep with t99 given by knot and twist; t90 is a third of it.
fn timed(t99: impl Fn(&str, f64) -> f64) -> Tables {
    published(|r| {
        let t = t99(&r.knot, r.twist);
        (r.t99, r.t90) = (Some(t), Some(t / 3.0));
    })
}

#[test]
fn claim_12_needs_slow_states_at_low_twist() {
    let slow = |where_to: fn(f64) -> bool| {
        timed(move |knot, twist| {
            if knot == "7_1" && where_to(twist) {
                30.0
            } else {
                10.0
            }
        })
    };
    assert_eq!(verdict(12, &slow(|t| t.abs() <= 1.0)), Confirmed);
    // nine states, of which seven are weakly twisted
    assert_eq!(verdict(12, &slow(|t| (-1.5..=0.5).contains(&t))), Partly);
    assert_eq!(verdict(12, &slow(|t| t.abs() > 1.0)), NotConfirmed);
    assert_eq!(verdict(12, &slow(|_| false)), NotConfirmed);
}

#[test]
fn claim_13_needs_every_strongly_twisted_state_to_be_fast() {
    let fast = |slow_one: fn(&str, f64) -> bool| {
        timed(move |knot, twist| match twist.abs() {
            t if t < 1.5 => 15.0,
            _ if slow_one(knot, twist) => 20.0,
            _ => 4.0,
        })
    };
    assert_eq!(verdict(13, &fast(|_, _| false)), Confirmed);
    // 5 of 84
    assert_eq!(verdict(13, &fast(|k, t| k == "7_1" && t != 2.0)), Partly);
    assert_eq!(verdict(13, &fast(|k, _| k.starts_with('7'))), NotConfirmed);
    // slow at high twist, fast without
    let inverted = timed(|_, twist| if twist.abs() < 1.5 { 4.0 } else { 15.0 });
    assert_eq!(verdict(13, &inverted), NotConfirmed);
}

#[test]
fn claim_14_needs_either_hand_to_wash_the_knots_out() {
    // mean 12 and deviation 4 without twist; by twist the mean is 3
    let spread = |right: f64, left: f64, zero: f64| {
        timed(move |knot, twist| {
            let place = KNOTS.iter().position(|k| *k == knot).unwrap();
            let side = if place % 2 == 0 { 1.0 } else { -1.0 };
            match twist {
                0.0 => 12.0 + zero * side,
                t if t > 0.0 => 3.0 + right * side,
                _ => 3.0 + left * side,
            }
        })
    };
    assert_eq!(verdict(14, &spread(0.3, 0.3, 4.0)), Confirmed);
    assert_eq!(verdict(14, &spread(0.3, 2.0, 4.0)), Partly);
    assert_eq!(verdict(14, &spread(2.0, 2.0, 4.0)), NotConfirmed);
    assert_eq!(verdict(14, &spread(2.0, 2.0, 0.3)), NotConfirmed);
    // every time shorter, by one factor: the knots matter as before
    assert_eq!(verdict(14, &spread(1.0, 1.0, 4.0)), NotConfirmed);
    // t99 is reported beside t90
    let mut made = spread(0.3, 0.3, 4.0);
    for case in &mut made.elastic.as_mut().unwrap().cases {
        case.cuts[0].t99 = Some(if case.first().knot == "7_1" {
            18.0
        } else {
            3.0
        });
    }
    assert_eq!(
        (verdict(14, &made), other(14, &made)),
        (Confirmed, NotConfirmed)
    );
}
