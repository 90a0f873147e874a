//! Sums and maxima over planes whose order does not depend on the number of threads.

use std::ops::Range;

/// Sum of `term` over `planes` along a tree whose shape is fixed: the same to the bit for any number of threads.
pub(crate) fn sum_over(planes: Range<usize>, term: &(impl Fn(usize) -> f64 + Sync)) -> f64 {
    fold_over(planes, 0.0, term, &|a, b| a + b)
}

/// Largest `term` over `planes`; NaN if any is.
pub(crate) fn max_over(planes: Range<usize>, term: &(impl Fn(usize) -> f64 + Sync)) -> f64 {
    fold_over(planes, 0.0, term, &larger)
}

/// The larger of two numbers; NaN if one is, so that it is not lost.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn fold_over(
    planes: Range<usize>,
    empty: f64,
    term: &(impl Fn(usize) -> f64 + Sync),
    combine: &(impl Fn(f64, f64) -> f64 + Sync),
) -> f64 {
    match planes.len() {
        0 => empty,
        1 => term(planes.start),
        n => {
            let middle = planes.start + n / 2;
            let (low, high) = rayon::join(
                || fold_over(planes.start..middle, empty, term, combine),
                || fold_over(middle..planes.end, empty, term, combine),
            );
            combine(low, high)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_the_same_for_any_number_of_threads() {
        let term = |k: usize| 1.0 / (k as f64 + 0.1).powi(3);
        let with = |n| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            pool.unwrap().install(|| sum_over(0..1013, &term))
        };
        assert_eq!(with(1).to_bits(), with(3).to_bits());
        assert_eq!(sum_over(0..0, &term), 0.0);
        assert_eq!(max_over(0..9, &|k| (k % 5) as f64), 4.0);
        for at in 0..7 {
            assert!(max_over(0..7, &|k| if k == at { f64::NAN } else { 1.0 }).is_nan());
        }
    }
}
