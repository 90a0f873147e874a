//! Results of a sweep over q: where the ring buckles, and which q discharges fastest at the end.

use serde::{Deserialize, Serialize};

use super::table::NematicRow;

/// Smallest q with a buckled ring, of rows that differ only in q.
pub fn buckling(rows: &[NematicRow]) -> Option<u32> {
    rows.iter().filter(|r| r.is_buckled()).map(|r| r.q).min()
}

/// The q that is discharged fastest by a measure of time, with its rate; `None` if no row has that time.
pub fn resonance_peak(
    rows: &[NematicRow],
    time: impl Fn(&NematicRow) -> Option<f64>,
) -> Option<(u32, f64)> {
    rows.iter()
        .filter_map(|r| Some((r.q, 1.0 / time(r).filter(|t| *t > 0.0)?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The resonance in a sweep over q.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NematicResonance {
    /// Smallest q with a buckled ring.
    pub q_c: Option<u32>,
    /// Whether the free energy grows with q all the way.
    pub energy_is_monotonic: bool,
    /// Whether the 50 % rate grows with q all the way.
    pub half_rate_is_monotonic: bool,
    /// The q with the largest 99 % rate, and that rate.
    pub peak_99: Option<(u32, f64)>,
    /// The q with the largest 99.9 % rate, and that rate.
    pub peak_999: Option<(u32, f64)>,
    /// The largest 99.9 % rate over that at q_c.
    pub collapse: Option<f64>,
}

/// The result of rows that differ only in q.
pub fn nematic_resonance(rows: &[NematicRow]) -> NematicResonance {
    let mut rows: Vec<NematicRow> = rows.to_vec();
    rows.sort_by_key(|r| r.q);
    let q_c = buckling(&rows);
    let grows = |value: &dyn Fn(&NematicRow) -> Option<f64>| {
        let values: Vec<f64> = rows.iter().filter_map(value).collect();
        values.len() == rows.len() && values.windows(2).all(|w| w[1] > w[0])
    };
    let rate = |t: Option<f64>| t.filter(|t| *t > 0.0).map(|t| 1.0 / t);
    let peak_999 = resonance_peak(&rows, |r| r.t999);
    let at_onset = rows
        .iter()
        .find(|r| Some(r.q) == q_c)
        .and_then(|r| rate(r.t999));
    NematicResonance {
        q_c,
        energy_is_monotonic: grows(&|r| Some(r.f_charged)),
        half_rate_is_monotonic: grows(&|r| rate(r.t50)),
        peak_99: resonance_peak(&rows, |r| r.t99),
        peak_999,
        collapse: peak_999
            .zip(at_onset)
            .map(|((_, peak), onset)| peak / onset),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(q: u32, f: f64, order: f64, t50: f64, t999: f64) -> NematicRow {
        NematicRow {
            q,
            f_charged: f,
            order_parameter: order,
            t50: Some(t50),
            t99: Some(0.5 * t999),
            t999: Some(t999),
            ..Default::default()
        }
    }

    #[test]
    fn a_peak_below_the_buckling_is_found() {
        let mut rows = vec![
            row(1, 700.0, 1e-7, 15.0, 430.0),
            row(2, 800.0, 1e-7, 11.0, 260.0),
            row(3, 900.0, 1e-7, 7.0, 60.0),
            row(4, 1000.0, 0.2, 5.0, 600.0),
        ];
        let found = nematic_resonance(&rows);
        assert_eq!(found.q_c, Some(4));
        assert!(found.energy_is_monotonic && found.half_rate_is_monotonic);
        assert_eq!(found.peak_999.unwrap().0, 3);
        assert!((found.collapse.unwrap() - 10.0).abs() < 1e-12);
        rows[3].t50 = None;
        assert!(!nematic_resonance(&rows).half_rate_is_monotonic);
        assert_eq!(nematic_resonance(&rows[..3]).q_c, None);
    }
}
