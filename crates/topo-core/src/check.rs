//! Checks of single numbers, and the finite-difference check that every energy term must pass.

use serde::{Deserialize, Serialize};

/// A number outside its domain: which one, what it was, and what was expected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[error("{name} = {value} is not allowed: expected {expected}")]
pub struct InvalidValue {
    /// Name of the quantity, as in the user's input.
    pub name: String,
    /// The offending value.
    pub value: f64,
    /// What would have been accepted.
    pub expected: String,
}

impl InvalidValue {
    /// An error for `name = value` that says what was `expected` instead.
    pub fn new(name: impl Into<String>, value: f64, expected: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            value,
            expected: expected.into(),
        }
    }
}

/// Returns `value` if it is finite.
///
/// # Errors
/// [`InvalidValue`] when `value` is NaN or infinite.
pub fn finite(name: &str, value: f64) -> Result<f64, InvalidValue> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(InvalidValue::new(name, value, "a finite number"))
    }
}

/// Returns `value` if it is finite and above zero.
///
/// # Errors
/// [`InvalidValue`] when `value` is NaN, infinite, zero or negative.
pub fn positive(name: &str, value: f64) -> Result<f64, InvalidValue> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(InvalidValue::new(name, value, "a finite number above zero"))
    }
}

/// Returns `value` if it is finite and not negative.
///
/// # Errors
/// [`InvalidValue`] when `value` is NaN, infinite or negative.
pub fn non_negative(name: &str, value: f64) -> Result<f64, InvalidValue> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(InvalidValue::new(
            name,
            value,
            "a finite number, zero or above",
        ))
    }
}

/// Returns `value` if `low <= value <= high`.
///
/// # Errors
/// [`InvalidValue`] when `value` is NaN or outside the closed interval.
pub fn in_range(name: &str, value: f64, low: f64, high: f64) -> Result<f64, InvalidValue> {
    if value >= low && value <= high {
        Ok(value)
    } else {
        Err(InvalidValue::new(
            name,
            value,
            format!("{low} <= {name} <= {high}"),
        ))
    }
}

/// Gradient of `f` at `x` by central differences of fourth order: a verification tool, not a way to compute forces.
///
/// ```math
/// \partial_i f \approx \frac{8 [f(x + h e_i) - f(x - h e_i)] - [f(x + 2h e_i) - f(x - 2h e_i)]}{12 h}
/// ```
///
/// The truncation error is h^4 f'''''/30 and the rounding error about 1e-16 |f|/h, so that h near 1e-3 of the scale of `x`
/// resolves gradients of smooth functions to about 1e-11.
///
/// # Validation
/// `fourth_order_gradient_of_a_smooth_function`
pub fn finite_difference_gradient(mut f: impl FnMut(&[f64]) -> f64, x: &[f64], h: f64) -> Vec<f64> {
    let mut point = x.to_vec();
    let mut gradient = Vec::with_capacity(x.len());
    for i in 0..x.len() {
        let mut at = |offset: f64| {
            point[i] = x[i] + offset;
            let value = f(&point);
            point[i] = x[i];
            value
        };
        let near = at(h) - at(-h);
        let far = at(2.0 * h) - at(-2.0 * h);
        gradient.push((8.0 * near - far) / (12.0 * h));
    }
    gradient
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validators_name_culprit_and_remedy() {
        assert_eq!(positive("twist", 2.0), Ok(2.0));
        assert_eq!(in_range("ratio", 1.0, 0.0, 1.0), Ok(1.0));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(finite("x", bad).is_err());
            assert!(positive("x", bad).is_err());
            assert!(non_negative("x", bad).is_err());
            assert!(in_range("x", bad, -1.0, 1.0).is_err());
        }
        assert!(
            positive("x", 0.0).is_err()
                && non_negative("x", 0.0).is_ok()
                && non_negative("x", -1e-300).is_err()
        );
        let message = in_range("ratio", 3.0, 0.0, 1.0).unwrap_err().to_string();
        assert!(
            message.contains("ratio = 3") && message.contains("0 <= ratio <= 1"),
            "{message}"
        );
    }

    #[test]
    fn fourth_order_gradient_of_a_smooth_function() {
        let f = |x: &[f64]| (x[0] * x[1]).sin() + x[1].exp();
        let x = [0.7_f64, -0.4];
        let exact = [
            x[1] * (x[0] * x[1]).cos(),
            x[0] * (x[0] * x[1]).cos() + x[1].exp(),
        ];
        let error = |h: f64| {
            let g = finite_difference_gradient(f, &x, h);
            (g[0] - exact[0]).abs().max((g[1] - exact[1]).abs())
        };
        assert!(error(1e-3) < 1e-12, "{:e}", error(1e-3));
        let order = (error(0.2) / error(0.1)).log2();
        assert!(order > 3.8, "{order}");
    }
}
