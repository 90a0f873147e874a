//! Means, ranges and medians of small ensembles.

use serde::{Deserialize, Serialize};

/// Mean and range of an ensemble, such as the discharge times over nearly equal cuts; in the unit of its members.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
    /// Number of members.
    pub n: usize,
}

impl Spread {
    /// Spread of the finite numbers given; `None` if there is none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut spread = Self {
            mean: 0.0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            n: 0,
        };
        for v in values.into_iter().filter(|v| v.is_finite()) {
            spread.mean += v;
            spread.min = spread.min.min(v);
            spread.max = spread.max.max(v);
            spread.n += 1;
        }
        spread.mean /= spread.n as f64;
        (spread.n > 0).then_some(spread)
    }
}

/// Quantile of the finite numbers given, interpolated between neighbours; `None` if there is none.
pub fn quantile(values: impl IntoIterator<Item = f64>, q: f64) -> Option<f64> {
    let mut sorted: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    let at = q.clamp(0.0, 1.0) * last as f64;
    let (i, rest) = (at.floor() as usize, at.fract());
    Some(sorted[i] + rest * (sorted[(i + 1).min(last)] - sorted[i]))
}

/// Median of the finite numbers given; `None` if there is none.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    quantile(values, 0.5)
}

/// Standard deviation of a sample, sqrt(Σ (x − mean)²/(n − 1)), of the finite numbers given; `None` of fewer than two.
pub fn standard_deviation(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (values.len() > 1).then(|| (squares / (n - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_and_median_of_known_numbers() {
        let s = Spread::of([3.0, 1.0, f64::NAN, 5.0]).unwrap();
        assert_eq!((s.mean, s.min, s.max, s.n), (3.0, 1.0, 5.0, 3));
        assert_eq!(Spread::of([]), None);
        assert_eq!(median([4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(quantile([1.0, 2.0, 3.0, 4.0, 5.0], 0.9), Some(4.6));
        assert_eq!(median([f64::NAN]), None);
        // mean 5, squares 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16
        let sd = standard_deviation([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert!((sd - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
        assert_eq!(standard_deviation([1.0, f64::NAN]), None);
    }
}
