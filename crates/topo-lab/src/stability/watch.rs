//! What no run may do.

use topo_core::DischargeCurve;

/// Largest rise of the energy in one accepted step, relative.
const STEP_RISE: f64 = 1e-4;
/// Largest sum of all rises over a run, relative to its first energy.
const SUM_OF_RISES: f64 = 1e-3;

/// Counts what is wrong with the energies of a run that nothing drives: values that are not finite, and rises; energies below
/// `floor` are nothing.
pub(super) fn violations(curve: &DischargeCurve, floor: f64) -> u32 {
    let n = curve.len();
    let finite = curve
        .stored()
        .iter()
        .chain(curve.dissipated())
        .flatten()
        .chain(curve.time())
        .all(|x| x.is_finite());
    let energy: Vec<f64> = (0..n).map(|i| curve.stored_total(i)).collect();
    let mut sum = 0.0;
    let mut n_rises = 0;
    for pair in energy.windows(2) {
        let rise = pair[1] - pair[0];
        if rise > 0.0 {
            sum += rise;
            if rise > STEP_RISE * pair[0].abs() + floor {
                n_rises += 1;
            }
        }
    }
    let start = energy.first().map_or(0.0, |e| e.abs());
    u32::from(!finite) + n_rises + u32::from(sum > SUM_OF_RISES * start + floor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(energies: &[f64]) -> DischargeCurve {
        let mut curve = DischargeCurve::new(["stored"], ["lost"]);
        for (i, e) in energies.iter().enumerate() {
            curve.push(i as f64, &[*e], &[energies[0] - e]).unwrap();
        }
        curve
    }

    #[test]
    fn rises_are_counted() {
        assert_eq!(violations(&curve(&[1.0, 0.5, 0.2]), 1e-9), 0);
        assert_eq!(violations(&curve(&[1.0, 0.5, 0.500_04]), 1e-9), 0);
        assert_eq!(violations(&curve(&[1.0, 0.5, 0.500_1]), 1e-9), 1);
        // one rise too large, and too much in all
        assert_eq!(violations(&curve(&[1.0, 0.5, 0.502]), 1e-9), 2);
    }
}
