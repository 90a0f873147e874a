//! How fast the last of the energy decays.

use topo_core::DischargeCurve;

/// The rate is fitted while the energy falls by this factor to its last value.
const WINDOW: f64 = 2.0;

/// Rate −d ln(F − F_final)/dt at the end of a curve, in the inverse unit of its times, with F_final = `end`, by least squares
/// over the steps in which F − F_final halved last; `None` with fewer than three steps.
///
/// A tilt of the director by the slowest mode between plates a distance L_z apart decays so that F ∝ exp(−2 π² Γ L t/L_z²).
///
/// # Validation
/// `the_rate_of_an_exponential_is_found`
pub fn late_rate(curve: &DischargeCurve, end: f64) -> Option<f64> {
    let last = curve
        .len()
        .checked_sub(1)
        .map(|i| curve.stored_total(i) - end)?;
    let points: Vec<(f64, f64)> = curve
        .time()
        .iter()
        .enumerate()
        .map(|(i, t)| (*t, curve.stored_total(i) - end))
        .filter(|(_, f)| *f > 0.0 && *f <= WINDOW * last)
        .map(|(t, f)| (t, f.ln()))
        .collect();
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| points.iter().map(part).sum::<f64>() / n;
    let (t0, y0) = (mean(|p| p.0), mean(|p| p.1));
    let (ty, tt) = points.iter().fold((0.0, 0.0), |(ty, tt), (t, y)| {
        (ty + (t - t0) * (y - y0), tt + (t - t0).powi(2))
    });
    (tt > 0.0).then(|| -ty / tt)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_an_exponential_is_found() {
        let mut curve = DischargeCurve::new(["elastic", "bulk"], Vec::<String>::new());
        for k in 0..200 {
            let t = 0.1 * f64::from(k);
            // a fast mode holds most of the energy
            let f = 100.0 * (-9.0 * t).exp() + 0.3 * (-0.7 * t).exp();
            curve.push(t, &[0.25 * f, 0.75 * f], &[]).unwrap();
        }
        let rate = late_rate(&curve, 0.0).unwrap();
        assert!((rate - 0.7).abs() < 1e-9, "{rate}");
        let empty = DischargeCurve::new(["elastic"], Vec::<String>::new());
        assert_eq!(late_rate(&empty, 0.0), None);
    }
}
