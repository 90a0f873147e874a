//! The Alexander polynomial, exactly: minors of the Fox matrix at integers modulo a prime, interpolated.

use super::diagram::Diagram;
use super::field::{P, add, inverse, mul, sub};

/// Alexander polynomial of a diagram: symmetric coefficients, the first positive; none if they are not those of a knot.
///
/// One row per crossing of the Alexander quandle, `out = t in + (1 - t) over` (in and out exchanged at negative crossings), one
/// column per arc; any first minor is the polynomial up to sign and powers of t.
pub(super) fn polynomial(diagram: &Diagram) -> Option<Vec<i64>> {
    let n = diagram.n_crossings();
    if n < 3 {
        return Some(vec![1]);
    }
    let rows = wirtinger(diagram);
    let size = n - 1;
    let mut matrix = vec![0; size * size];
    let mut values = Vec::with_capacity(n);
    let mut scales = Vec::with_capacity(n);
    for k in 0..n {
        let t = k as u64 + 2;
        matrix.fill(0);
        for (i, row) in rows.iter().take(size).enumerate() {
            for (arc, coefficient) in [(row.over, sub(1, t)), (row.before, t), (row.after, P - 1)] {
                if arc < size {
                    let slot = &mut matrix[i * size + arc];
                    *slot = add(*slot, coefficient);
                }
            }
        }
        let (numerator, denominator) = minor(&mut matrix, size);
        values.push(numerator);
        scales.push(denominator);
    }
    divide_all(&mut values, &scales);
    normalise(&interpolate(values))
}

/// One relation: the arc above, and the two arcs below.
struct Relation {
    over: usize,
    before: usize,
    after: usize,
}

fn wirtinger(diagram: &Diagram) -> Vec<Relation> {
    let n = diagram.n_crossings();
    let mut over = vec![0; n];
    let mut below = vec![(0, 0); n];
    let mut arc = 0;
    for visit in &diagram.visits {
        let c = visit.crossing as usize;
        if visit.over {
            over[c] = arc;
        } else {
            let next = (arc + 1) % n;
            below[c] = (arc, next);
            arc = next;
        }
    }
    (0..n)
        .map(|c| {
            let (before, after) = if diagram.signs[c] > 0 {
                below[c]
            } else {
                (below[c].1, below[c].0)
            };
            Relation {
                over: over[c],
                before,
                after,
            }
        })
        .collect()
}

/// Determinant by elimination without division, as a quotient.
fn minor(matrix: &mut [u64], size: usize) -> (u64, u64) {
    let (mut numerator, mut denominator) = (1, 1);
    for k in 0..size {
        let Some(pivot_row) = (k..size).find(|&i| matrix[i * size + k] != 0) else {
            return (0, 1);
        };
        if pivot_row != k {
            for j in k..size {
                matrix.swap(pivot_row * size + j, k * size + j);
            }
            numerator = sub(0, numerator);
        }
        let pivot = matrix[k * size + k];
        numerator = mul(numerator, pivot);
        let (upper, lower) = matrix.split_at_mut((k + 1) * size);
        let pivot_row = &upper[k * size..];
        for row in lower.chunks_exact_mut(size) {
            let factor = row[k];
            if factor == 0 {
                continue;
            }
            denominator = mul(denominator, pivot);
            for j in k + 1..size {
                row[j] = sub(mul(row[j], pivot), mul(pivot_row[j], factor));
            }
        }
    }
    (numerator, denominator)
}

/// Divides each value by its scale with a single inversion.
fn divide_all(values: &mut [u64], scales: &[u64]) {
    let mut prefix = Vec::with_capacity(scales.len());
    let mut product = 1;
    for &s in scales {
        prefix.push(product);
        product = mul(product, s);
    }
    let mut inverse_of_rest = inverse(product);
    for k in (0..values.len()).rev() {
        values[k] = mul(values[k], mul(inverse_of_rest, prefix[k]));
        inverse_of_rest = mul(inverse_of_rest, scales[k]);
    }
}

/// Coefficients of the polynomial with the given values at t = 2, 3, ..., by Newton's divided differences.
fn interpolate(mut values: Vec<u64>) -> Vec<u64> {
    let n = values.len();
    let mut inverses = vec![1; n + 1];
    for k in 2..=n {
        inverses[k] = mul(P - P / k as u64, inverses[(P % k as u64) as usize]);
    }
    for level in 1..n {
        for k in (level..n).rev() {
            values[k] = mul(sub(values[k], values[k - 1]), inverses[level]);
        }
    }
    let mut coefficients = vec![0; n];
    for k in (0..n).rev() {
        let node = k as u64 + 2;
        for j in (0..n).rev() {
            let lower = if j > 0 {
                coefficients[j - 1]
            } else {
                values[k]
            };
            coefficients[j] = sub(lower, mul(coefficients[j], node));
        }
    }
    coefficients
}

fn normalise(coefficients: &[u64]) -> Option<Vec<i64>> {
    let first = coefficients.iter().position(|&c| c != 0)?;
    let last = coefficients.iter().rposition(|&c| c != 0)?;
    let mut signed: Vec<i64> = coefficients[first..=last]
        .iter()
        .map(|&c| {
            if c > P / 2 {
                c as i64 - P as i64
            } else {
                c as i64
            }
        })
        .collect();
    if signed[0] < 0 {
        signed.iter_mut().for_each(|c| *c = -*c);
    }
    let symmetric = signed.iter().eq(signed.iter().rev());
    let at_one = signed.iter().fold(0_i64, |sum, c| sum.wrapping_add(*c));
    (symmetric && at_one.abs() == 1).then_some(signed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_recovers_a_polynomial() {
        let truth = [7, P - 3, 0, 2];
        let values = (2..6)
            .map(|t| truth.iter().rev().fold(0, |sum, &c| add(mul(sum, t), c)))
            .collect();
        assert_eq!(interpolate(values), truth);
    }

    #[test]
    fn minor_of_a_small_matrix() {
        let mut m = vec![0, 2, 1, 3, 1, 4, 5, 0, 6];
        let (numerator, denominator) = minor(&mut m, 3);
        // 0(6 - 0) - 2(18 - 20) + 1(0 - 5) = -1
        assert_eq!(mul(numerator, inverse(denominator)), P - 1);
    }
}
