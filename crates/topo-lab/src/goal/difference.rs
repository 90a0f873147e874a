//! What the difference of two runs, fine and coarse, tells of the finer one.

/// Order of the error in the resolution. In colloids it holds; in rods (near ties of contacts, places of cuts among the
/// vertices) a difference becomes an error of about the right size.
const ORDER: f64 = 2.0;

/// Grids nearer to each other tell nothing: small cells may have hardly another one.
const LEAST_RATIO: f64 = 1.05;

/// Relative error of a discharge that one on a grid coarser by `ratio` tells: the largest of what each of its `times`, fine and
/// coarse, says, as two runs may agree in one time by chance; none where one is lacking.
///
/// # Validation
/// `errors_of_second_order_are_found`
pub(crate) fn difference_error(times: &[(Option<f64>, Option<f64>)], ratio: f64) -> Option<f64> {
    let of = |&(fine, coarse): &(Option<f64>, Option<f64>)| {
        let (fine, coarse) = fine.zip(coarse).filter(|_| ratio > LEAST_RATIO)?;
        Some((coarse / fine - 1.0).abs() / gain(ratio))
    };
    let all: Option<Vec<f64>> = times.iter().map(of).collect();
    all?.into_iter().reduce(f64::max)
}

/// What a time `fine` and one on a grid coarser by `ratio` tend to on finer grids.
///
/// # Validation
/// `errors_of_second_order_are_found`
pub(crate) fn extrapolated(fine: f64, coarse: f64, ratio: f64) -> f64 {
    fine + (fine - coarse) / gain(ratio)
}

/// Difference of two times, in errors of the finer one.
fn gain(ratio: f64) -> f64 {
    ratio.powf(ORDER) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_second_order_are_found() {
        let time = |h: f64| 8.0 - 0.3 * h * h;
        let (fine, coarse) = (time(0.5), time(0.75));
        assert!((extrapolated(fine, coarse, 1.5) - 8.0).abs() < 1e-12);
        let error = difference_error(&[(Some(fine), Some(coarse))], 1.5).unwrap();
        assert!((error - 0.075 / fine).abs() < 1e-12);
        // what differs most counts
        for other in [0.99, 1.01] {
            let two = [(Some(2.0), Some(2.0 * other)), (Some(fine), Some(coarse))];
            let error = difference_error(&two, 1.5).unwrap();
            let both = [0.01, coarse / fine - 1.0].map(|d| d.abs() / 1.25);
            assert!((error - f64::max(both[0], both[1])).abs() < 1e-12);
        }
        // without a second run, or with one on the same grid, there is no estimate
        for (a, b, ratio) in [
            (Some(3.0), None, 1.5),
            (None, Some(3.0), 1.5),
            (Some(3.0), Some(3.1), 1.0),
        ] {
            assert_eq!(
                difference_error(&[(a, b), (Some(1.0), Some(1.0))], ratio),
                None
            );
        }
    }
}
