//! Which coordinates allow exact arithmetic, and how others are scaled.

use std::borrow::Cow;

use crate::{KnotError, V};

/// Sizes of an axis that need no scaling: third powers of coordinates and their last digits are far from overflow and underflow.
const TAME: std::ops::Range<f64> = 1e-30..1e30;
/// Binary place of the last digit of a product of three coordinates up to which it is exact.
const LAST_PLACE: i32 = -1060;
/// Binary place of the last digit of any coordinate above 1e-40, and of the eye.
const EYE_PLACE: i32 = -260;

/// Refuses curves with too few or non-finite vertices; curves of extreme size are scaled by powers of two, closed ones each
/// axis by itself: that keeps the type, and no digit is lost.
///
/// # Errors
/// [`KnotError::TooFewVertices`], [`KnotError::NotFinite`], and [`KnotError::Spread`] for digits too small for exact
/// arithmetic.
pub(crate) fn usable_vertices(vertices: &[V], closed: bool) -> Result<Cow<'_, [V]>, KnotError> {
    let least = if closed { 3 } else { 2 };
    if vertices.len() < least {
        return Err(KnotError::TooFewVertices {
            n_vertices: vertices.len(),
        });
    }
    let mut size = V::zeros();
    for (vertex, x) in vertices.iter().enumerate() {
        if !x.iter().all(|c| c.is_finite()) {
            return Err(KnotError::NotFinite { vertex });
        }
        size = size.zip_map(x, |s, c: f64| s.max(c.abs()));
    }
    if !closed {
        size = V::repeat(size.amax());
    }
    let is_tame = |s: f64| s == 0.0 || TAME.contains(&s);
    let place = size.map(|s| if is_tame(s) { 0 } else { -exponent(s) });
    refuse_spread(vertices, place)?;
    if place == nalgebra::Vector3::zeros() {
        return Ok(Cow::Borrowed(vertices));
    }
    // In two steps: 2^1074 itself is beyond the largest number.
    let first = place.map(|p| f64::from(p / 2).exp2());
    let second = place.map(|p| f64::from(p - p / 2).exp2());
    let scaled = |x: &V| x.component_mul(&first).component_mul(&second);
    Ok(Cow::Owned(vertices.iter().map(scaled).collect()))
}

/// Refuses curves with digits so far apart that a product of three coordinates, one of each axis, is not exact.
///
/// `place` is by how many binary places each axis will be scaled.
fn refuse_spread(vertices: &[V], place: nalgebra::Vector3<i32>) -> Result<(), KnotError> {
    // The last place on each axis and its vertex; the eye of a view has its own places.
    let mut last = [(EYE_PLACE, 0); 3];
    for (vertex, x) in vertices.iter().enumerate() {
        for k in 0..3 {
            // Far from the limit, nearly always, the size of a number already shows that its digits are.
            if x[k] != 0.0 && (x[k].abs() < 1e-40 || place[k] != 0) {
                last[k] = last[k].min((last_place(x[k]) + place[k], vertex));
            }
        }
    }
    let sum: i32 = last.iter().map(|(place, _)| place).sum();
    match last.iter().min() {
        Some((_, vertex)) if sum < LAST_PLACE => Err(KnotError::Spread { vertex: *vertex }),
        _ => Ok(()),
    }
}

/// The binary place of the first digit, about.
fn exponent(x: f64) -> i32 {
    x.abs().log2().floor() as i32
}

/// The binary place of the last digit that is not 0.
fn last_place(x: f64) -> i32 {
    let bits = x.to_bits();
    let (power, digits) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
    if power == 0 {
        digits.trailing_zeros() as i32 - 1074
    } else {
        (digits | 1 << 52).trailing_zeros() as i32 + power - 1075
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A coordinate of 1e-94, as a spline may give it, is accepted; three of 1e-120 are not.
    #[test]
    fn digits_too_far_apart_are_refused() {
        let triangle = |tiny: V| [V::x(), V::y(), V::z(), tiny];
        assert!(usable_vertices(&triangle(V::new(1e-94, 0.5, 1e-94)), true).is_ok());
        assert!(matches!(
            usable_vertices(&triangle(V::repeat(1e-120)), true),
            Err(KnotError::Spread { vertex: 3 })
        ));
        assert!(usable_vertices(&triangle(V::repeat(0.5_f64.powi(300))), true).is_ok());
    }

    #[test]
    fn bad_coordinates_are_refused() {
        assert!(matches!(
            usable_vertices(&[V::zeros(); 2], true),
            Err(KnotError::TooFewVertices { n_vertices: 2 })
        ));
        let nan = [V::zeros(), V::x(), V::new(0.0, f64::NAN, 0.0)];
        assert!(matches!(
            usable_vertices(&nan, true),
            Err(KnotError::NotFinite { vertex: 2 })
        ));
    }
}
