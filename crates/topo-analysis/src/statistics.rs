//! Means, ranges and medians of small ensembles.

use serde::{Deserialize, Serialize};

/// Mean and range of an ensemble, such as the discharge times over near-tied cuts.
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
    }
}
