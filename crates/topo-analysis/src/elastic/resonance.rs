//! Results of a table of discharges: regimes, ensembles of nearly equal cuts, and slow knots.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::table::SweepRow;
use crate::statistics::{Spread, median};

/// Which part of the energy is larger after charging.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Regime {
    /// More bending than twist energy after charging.
    Bending,
    /// More twist than bending energy after charging.
    Twist,
}

/// Regime of a charged rod.
pub fn regime(row: &SweepRow) -> Regime {
    if row.twist_energy > row.bend {
        Regime::Twist
    } else {
        Regime::Bending
    }
}

/// Twist density |θ'h| at which twist and bending energy of a knot are equal, interpolated in the rows of one sign of twist.
///
/// `None` if they do not cross in the range of the rows.
pub fn crossover(rows: &[SweepRow], knot: &str, sign: f64) -> Option<f64> {
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|r| r.knot == knot && r.twist * sign >= 0.0)
        .map(|r| (r.twist.abs(), r.twist_energy - r.bend))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0 == b.0);
    points
        .windows(2)
        .find(|w| w[0].1 <= 0.0 && w[1].1 > 0.0)
        .map(|w| {
            let part = w[0].1 / (w[0].1 - w[1].1);
            w[0].0 + part * (w[1].0 - w[0].0)
        })
}

/// Discharge times of one knot and twist over its cuts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ensemble {
    /// Knot type.
    pub knot: String,
    /// Twist density θ'h.
    pub twist: f64,
    /// t50, t90, t95 and t99 over the cuts, in T_0.
    pub times: [Option<Spread>; 4],
}

/// Groups rows that differ in the cut only.
pub fn ensembles(rows: &[SweepRow]) -> Vec<Ensemble> {
    let mut groups: BTreeMap<(&str, i64), Vec<&SweepRow>> = BTreeMap::new();
    for row in rows {
        groups
            .entry((&row.knot, (row.twist * 1e6).round() as i64))
            .or_default()
            .push(row);
    }
    groups
        .into_values()
        .map(|rows| Ensemble {
            knot: rows[0].knot.clone(),
            twist: rows[0].twist,
            times: [0, 1, 2, 3].map(|k| Spread::of(rows.iter().filter_map(|r| r.times()[k]))),
        })
        .collect()
}

/// A knot that discharges more slowly than the median of all at the same twist.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Resonance {
    /// Knot type.
    pub knot: String,
    /// Twist density θ'h.
    pub twist: f64,
    /// Its mean t99 over the median of the means of all knots.
    pub ratio: f64,
    /// Whether it exceeds the factor in every other set of runs given as well.
    pub robust: bool,
}

/// Knots whose mean t99 exceeds `factor` times the median over the knots at the same twist, slowest first.
///
/// `others` are tables of the same knots under another reading or friction range: the reading mixes knot type with friction, so
/// only a knot that is slow in all of them is called robust.
pub fn resonances(rows: &[SweepRow], factor: f64, others: &[&[SweepRow]]) -> Vec<Resonance> {
    let slow = |rows: &[SweepRow]| -> Vec<Resonance> {
        let all = ensembles(rows);
        let mut found = Vec::new();
        for e in &all {
            let t99 = |e: &Ensemble| e.times[3].map(|s| s.mean);
            let middle = median(
                all.iter()
                    .filter(|o| (o.twist - e.twist).abs() < 1e-9)
                    .filter_map(t99),
            );
            if let (Some(time), Some(middle)) = (t99(e), middle)
                && time > factor * middle
            {
                found.push(Resonance {
                    knot: e.knot.clone(),
                    twist: e.twist,
                    ratio: time / middle,
                    robust: false,
                });
            }
        }
        found
    };
    let elsewhere: Vec<Vec<Resonance>> = others.iter().map(|rows| slow(rows)).collect();
    let mut found = slow(rows);
    for r in &mut found {
        let same = |o: &Resonance| o.knot == r.knot && (o.twist - r.twist).abs() < 1e-9;
        r.robust = !elsewhere.is_empty() && elsewhere.iter().all(|list| list.iter().any(same));
    }
    found.sort_by(|a, b| {
        b.ratio
            .total_cmp(&a.ratio)
            .then_with(|| a.knot.cmp(&b.knot))
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(knot: &str, twist: f64, cut: f64, t99: f64, bend: f64, twist_energy: f64) -> SweepRow {
        SweepRow {
            knot: knot.into(),
            twist,
            cut,
            t99: Some(t99),
            bend,
            twist_energy,
            ..Default::default()
        }
    }

    #[test]
    fn slow_knots_stand_out_and_robust_ones_do_so_everywhere() {
        let a = [
            row("3_1", 0.0, 0.1, 20.0, 1.0, 0.0),
            row("4_1", 0.0, 0.1, 7.0, 1.0, 0.0),
            row("5_1", 0.0, 0.1, 8.0, 1.0, 0.0),
            row("7_4", 0.0, 0.1, 12.0, 1.0, 0.0),
            row("7_4", 0.0, 0.6, 24.0, 1.0, 0.0),
        ];
        let b = [
            row("3_1", 0.0, 0.1, 20.0, 1.0, 0.0),
            row("4_1", 0.0, 0.1, 7.0, 1.0, 0.0),
            row("5_1", 0.0, 0.1, 8.0, 1.0, 0.0),
            row("7_4", 0.0, 0.1, 9.0, 1.0, 0.0),
        ];
        let found = resonances(&a, 1.4, &[&b]);
        assert_eq!(
            found
                .iter()
                .map(|r| (r.knot.as_str(), r.robust))
                .collect::<Vec<_>>(),
            [("3_1", true)]
        );
        let found = resonances(&a, 1.2, &[&b]);
        assert_eq!(
            found
                .iter()
                .map(|r| (r.knot.as_str(), r.robust))
                .collect::<Vec<_>>(),
            [("3_1", true), ("7_4", false)]
        );
        assert_eq!(
            ensembles(&a)
                .iter()
                .find(|e| e.knot == "7_4")
                .unwrap()
                .times[3]
                .unwrap()
                .mean,
            18.0
        );
    }

    #[test]
    fn regimes_cross_where_the_energies_are_equal() {
        let rows = [
            row("3_1", 0.0, 0.0, 1.0, 1.0, 0.0),
            row("3_1", 1.0, 0.0, 1.0, 1.0, 0.5),
            row("3_1", 2.0, 0.0, 1.0, 1.0, 2.5),
            row("3_1", -2.0, 0.0, 1.0, 1.0, 0.1),
        ];
        assert_eq!(regime(&rows[1]), Regime::Bending);
        assert_eq!(regime(&rows[2]), Regime::Twist);
        assert!((crossover(&rows, "3_1", 1.0).unwrap() - 1.25).abs() < 1e-12);
        assert_eq!(crossover(&rows, "3_1", -1.0), None);
    }
}
