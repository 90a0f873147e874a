//! Discharge times: when which share of the stored energy was released.

use serde::{Deserialize, Serialize};
use topo_core::DischargeCurve;

/// A time with the error of interpolating it between two steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interpolated {
    /// The time, in the unit of the curve.
    pub value: f64,
    /// Difference of the exponential and the linear interpolation between the two steps around it, in the unit of the curve.
    pub error: f64,
}

/// Times at which given shares of an energy were released; `None` where the curve ends before.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DischargeTimes {
    shares: Vec<f64>,
    times: Vec<Option<Interpolated>>,
}

/// Shares that tables list for the elastic battery.
pub const ELASTIC_SHARES: [f64; 4] = [0.5, 0.9, 0.95, 0.99];

/// The same for the nematic battery.
pub const NEMATIC_SHARES: [f64; 4] = [0.5, 0.9, 0.99, 0.999];

impl DischargeTimes {
    /// First times at which the sum of `parts` of a curve has fallen by each share of `start`.
    ///
    /// Between two steps the energy is taken to decay exponentially, as free relaxation does.
    ///
    /// # Validation
    /// `times_of_an_exponential_are_exact`, `first_crossing_counts`.
    pub fn of(curve: &DischargeCurve, parts: &[&str], start: f64, shares: &[f64]) -> Self {
        Self::between(curve, parts, [start, 0.0], shares)
    }

    /// As [`of`](Self::of), with shares of the energy between `start` and that of a final state, `end`; none where nothing is
    /// stored between them.
    pub fn between(
        curve: &DischargeCurve,
        parts: &[&str],
        [start, end]: [f64; 2],
        shares: &[f64],
    ) -> Self {
        let columns: Vec<&[f64]> = parts.iter().filter_map(|p| curve.series(p)).collect();
        let energy = |i: usize| columns.iter().map(|c| c[i]).sum::<f64>() - end;
        let start = start - end;
        let time = curve.time();
        let times = shares
            .iter()
            .map(|share| {
                if start <= 0.0 {
                    return None;
                }
                let goal = (1.0 - share) * start;
                let i = (0..time.len()).find(|&i| energy(i) <= goal)?;
                if i == 0 {
                    return Some(Interpolated {
                        value: time[0],
                        error: 0.0,
                    });
                }
                let (before, after, dt) = (energy(i - 1), energy(i), time[i] - time[i - 1]);
                let linear = (before - goal) / (before - after);
                let decaying = after > 0.0 && goal > 0.0;
                let part = if decaying {
                    (before / goal).ln() / (before / after).ln()
                } else {
                    linear
                };
                Some(Interpolated {
                    value: time[i - 1] + part * dt,
                    error: (part - linear).abs() * dt,
                })
            })
            .collect();
        Self {
            shares: shares.to_vec(),
            times,
        }
    }

    /// Time at which `share` was released, if that share was requested and reached.
    pub fn at(&self, share: f64) -> Option<Interpolated> {
        let k = self.shares.iter().position(|s| (s - share).abs() < 1e-12)?;
        self.times[k]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(f64, f64)]) -> DischargeCurve {
        let mut curve = DischargeCurve::new(["bend", "contact"], Vec::<String>::new());
        for &(t, e) in points {
            curve.push(t, &[e, 7.0], &[]).unwrap();
        }
        curve
    }

    #[test]
    fn times_of_an_exponential_are_exact() {
        let points: Vec<_> = (0..40)
            .map(|k| (0.3 * k as f64, 2.0 * (-0.3 * k as f64 / 1.7).exp()))
            .collect();
        let times = DischargeTimes::of(&curve(&points), &["bend"], 2.0, &ELASTIC_SHARES);
        for share in ELASTIC_SHARES {
            let exact = -1.7 * f64::ln(1.0 - share);
            let found = times.at(share).unwrap();
            assert!((found.value - exact).abs() < 1e-12);
            assert!(found.error < 0.02);
        }
    }

    #[test]
    fn shares_count_down_to_the_final_state() {
        let points: Vec<_> = (0..60)
            .map(|k| (0.3 * k as f64, -38.0 + 2.0 * (-0.3 * k as f64 / 1.7).exp()))
            .collect();
        let between =
            |ends| DischargeTimes::between(&curve(&points), &["bend"], ends, &ELASTIC_SHARES);
        let times = between([-36.0, -38.0]);
        for share in ELASTIC_SHARES {
            let exact = -1.7 * f64::ln(1.0 - share);
            assert!((times.at(share).unwrap().value - exact).abs() < 1e-9);
        }
        // Nothing is stored where the final state is the present one, or lies above it.
        for end in [-36.0, -20.0] {
            assert_eq!(between([-36.0, end]).at(0.5), None);
        }
    }

    #[test]
    fn first_crossing_counts() {
        let times = DischargeTimes::of(
            &curve(&[(0.0, 1.0), (1.0, 0.4), (2.0, 0.6), (3.0, 0.1)]),
            &["bend"],
            1.0,
            &[0.5, 0.95],
        );
        assert!(times.at(0.5).unwrap().value < 1.0);
        assert_eq!(times.at(0.95), None);
        assert_eq!(times.at(0.7), None);
    }
}
