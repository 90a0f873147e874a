//! The Jones polynomial, exactly: Kauffman's bracket summed crossing by crossing along a front that stays narrow.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::diagram::Diagram;

/// Most crossings of a diagram: below it no coefficient of the bracket can overflow.
const MOST_CROSSINGS: usize = 60;
/// Limit of the ways in which the front may be joined; wider diagrams would take too long.
const MOST_STATES: usize = 3000;

/// A Laurent polynomial with integer coefficients in t, such as the Jones polynomial of a knot.
///
/// ```math
/// V(t) = \sum_k c_k\, t^{\mathrm{lowest} + k}
/// ```
///
/// # Validation
/// `jones_polynomials_of_the_table`, `jones_tells_what_the_signature_cannot`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Jones {
    /// Power of the first coefficient.
    pub lowest: i32,
    /// Coefficients, the first and the last not zero.
    pub coefficients: Vec<i64>,
}

impl Jones {
    /// Polynomial of the unknot.
    pub fn one() -> Self {
        Self {
            lowest: 0,
            coefficients: vec![1],
        }
    }

    /// The polynomial of the mirror image, V(1/t).
    pub fn mirror(&self) -> Self {
        Self {
            lowest: -(self.lowest + self.coefficients.len() as i32 - 1),
            coefficients: self.coefficients.iter().rev().copied().collect(),
        }
    }

    /// The polynomial of the sum of two knots, the product; `None` if a coefficient is beyond 64 bits.
    pub fn product(&self, other: &Self) -> Option<Self> {
        let mut coefficients = vec![0_i64; self.coefficients.len() + other.coefficients.len() - 1];
        for (i, a) in self.coefficients.iter().enumerate() {
            for (j, b) in other.coefficients.iter().enumerate() {
                coefficients[i + j] = coefficients[i + j].checked_add(a.checked_mul(*b)?)?;
            }
        }
        Some(Self {
            lowest: self.lowest + other.lowest,
            coefficients,
        })
    }

    /// The polynomial as text, as `t + t^3 - t^4`.
    pub fn text(&self) -> String {
        text(&self.coefficients, |k| 2 * (self.lowest + k))
    }

    /// Whether V(1) = 1, V'(1) = 0 and |V(-1)| is the determinant, as for every knot.
    pub(crate) fn fits_a_knot(&self, determinant: u64) -> bool {
        let (mut at_one, mut slope, mut at_minus_one) = (0_i128, 0_i128, 0_i128);
        for (k, c) in self.coefficients.iter().enumerate() {
            let (c, power) = (i128::from(*c), i128::from(self.lowest) + k as i128);
            at_one += c;
            slope += c * power;
            at_minus_one += if k % 2 == 0 { c } else { -c };
        }
        at_one == 1 && slope == 0 && at_minus_one.unsigned_abs() == u128::from(determinant)
    }
}

/// A polynomial in t as text, given twice the power of each coefficient: powers of links may be halves.
pub(crate) fn text(coefficients: &[i64], twice_power: impl Fn(i32) -> i32) -> String {
    let mut text = String::new();
    for (k, c) in coefficients.iter().enumerate() {
        let twice = twice_power(k as i32);
        let sign = match (*c < 0, text.is_empty()) {
            (_, _) if *c == 0 => continue,
            (true, true) => "-",
            (true, false) => " - ",
            (false, true) => "",
            (false, false) => " + ",
        };
        text += sign;
        let size = c.unsigned_abs();
        if size != 1 || twice == 0 {
            text += &size.to_string();
        }
        match twice {
            0 => {}
            2 => text += "t",
            _ if twice % 2 == 0 => text += &format!("t^{}", twice / 2),
            _ => text += &format!("t^({twice}/2)"),
        }
    }
    text
}

/// Jones polynomial of a diagram of a knot, from Kauffman's bracket and the writhe w; `None` when it has too many crossings or
/// is too wide.
///
/// ```math
/// V(t) = (-A^3)^{-w} \langle D \rangle,\quad t = A^{-4}, \qquad
/// \langle \times \rangle = A \langle \asymp \rangle + A^{-1} \langle )( \rangle,\quad
/// \langle D \sqcup \bigcirc \rangle = -(A^2 + A^{-2}) \langle D \rangle
/// ```
///
/// # References
/// [kauffman1987]
///
/// [kauffman1987]: https://doi.org/10.1016/0040-9383(87)90009-7
pub(super) fn jones(diagram: &Diagram) -> Option<Jones> {
    let n = diagram.n_crossings();
    if n > MOST_CROSSINGS {
        return None;
    }
    if n == 0 {
        return Some(Jones::one());
    }
    let writhe: i32 = diagram.signs.iter().map(|s| i32::from(*s)).sum();
    bracket(diagram)?.into_jones(writhe)
}

/// Kauffman's bracket of a diagram of at least one curve, that of a circle being 1; `None` as for [`jones`].
pub(super) fn bracket(diagram: &Diagram) -> Option<Power> {
    let n = diagram.n_crossings();
    if n > MOST_CROSSINGS {
        return None;
    }
    let ends = edges_around_crossings(diagram);
    let mut front = Front::default();
    front.states.insert(Vec::new(), Power::one());
    let mut left: Vec<usize> = (0..n).collect();
    while !left.is_empty() {
        let (place, _) = left
            .iter()
            .enumerate()
            .max_by_key(|(place, c)| (front.n_known(&ends[**c]), usize::MAX - place))?;
        front.add(&ends[left.remove(place)]);
        if front.states.len() > MOST_STATES {
            return None;
        }
    }
    let n_circles = diagram.rings.ranges().filter(|r| r.is_empty()).count();
    let mut bracket = Power::default();
    bracket.add(&front.states.remove(&Vec::new())?, 0, n_circles);
    bracket.without_one_loop()
}

/// The edges that meet each crossing, counterclockwise from the one on which the upper strand leaves.
fn edges_around_crossings(diagram: &Diagram) -> Vec<[u16; 4]> {
    let mut ends = vec![[0; 4]; diagram.n_crossings()];
    let before = diagram.rings.before();
    for (k, visit) in diagram.visits.iter().enumerate() {
        // Edge k leaves visit k.
        let (out, into) = (k as u16, before[k] as u16);
        let c = visit.crossing as usize;
        if visit.over {
            (ends[c][0], ends[c][2]) = (out, into);
        } else if diagram.signs[c] > 0 {
            (ends[c][1], ends[c][3]) = (out, into);
        } else {
            (ends[c][1], ends[c][3]) = (into, out);
        }
    }
    ends
}

/// All ways in which the crossings so far can be smoothed, grouped by how they join the edges that stick out.
#[derive(Default)]
struct Front {
    /// Pairs of joined edges, each pair and the list of pairs in ascending order.
    states: BTreeMap<Vec<[u16; 2]>, Power>,
}

impl Front {
    /// Number of the edges that already stick out.
    fn n_known(&self, edges: &[u16; 4]) -> usize {
        let Some((pairs, _)) = self.states.first_key_value() else {
            return 0;
        };
        let known = |e: &&u16| pairs.iter().any(|p| p.contains(e));
        edges.iter().filter(known).count()
    }

    fn add(&mut self, e: &[u16; 4]) {
        let mut next: BTreeMap<Vec<[u16; 2]>, Power> = BTreeMap::new();
        for (pairs, power) in &self.states {
            // Turning the upper strand counterclockwise sweeps the corners 0-1 and 2-3, which the first smoothing opens.
            for (arcs, shift) in [
                ([[e[1], e[2]], [e[3], e[0]]], 1),
                ([[e[0], e[1]], [e[2], e[3]]], -1),
            ] {
                let mut pairs = pairs.clone();
                let n_loops = arcs.iter().filter(|arc| join(&mut pairs, **arc)).count();
                pairs.sort_unstable();
                let slot = next.entry(pairs).or_default();
                slot.add(power, shift, n_loops);
            }
        }
        self.states = next;
    }
}

/// Joins two edges; true if that closes a loop.
fn join(pairs: &mut Vec<[u16; 2]>, [a, b]: [u16; 2]) -> bool {
    let mut far_end = |e: u16| match pairs.iter().position(|p| p.contains(&e)) {
        Some(k) => {
            let [p, q] = pairs.swap_remove(k);
            (if p == e { q } else { p }, true)
        }
        None => (e, false),
    };
    let (x, known) = far_end(a);
    if a == b || (known && x == b) {
        return true;
    }
    let (y, _) = far_end(b);
    pairs.push([x.min(y), x.max(y)]);
    false
}

/// A Laurent polynomial in A whose powers all have one parity: `coefficients[k]` is that of A^(lowest + 2 k).
#[derive(Clone, Debug, Default)]
pub(super) struct Power {
    pub lowest: i32,
    pub coefficients: Vec<i128>,
}

impl Power {
    fn one() -> Self {
        Self {
            lowest: 0,
            coefficients: vec![1],
        }
    }

    /// Adds `other` times A^shift (-A^2 - A^-2)^n_loops.
    fn add(&mut self, other: &Self, shift: i32, n_loops: usize) {
        let mut scaled = other.clone();
        scaled.lowest += shift;
        for _ in 0..n_loops {
            // From c A^p to -c A^(p-2) - c A^(p+2).
            let n = scaled.coefficients.len();
            let mut product = vec![0; n + 2];
            for (k, c) in scaled.coefficients.iter().enumerate() {
                product[k] -= c;
                product[k + 2] -= c;
            }
            scaled.coefficients = product;
            scaled.lowest -= 2;
        }
        if self.coefficients.is_empty() {
            *self = scaled;
            return;
        }
        let low = self.lowest.min(scaled.lowest);
        let top = |p: &Self| p.lowest + 2 * p.coefficients.len() as i32;
        let n = ((top(self).max(top(&scaled)) - low) / 2) as usize;
        let mut sum = vec![0; n];
        for p in [&*self, &scaled] {
            let first = ((p.lowest - low) / 2) as usize;
            for (k, c) in p.coefficients.iter().enumerate() {
                sum[first + k] += c;
            }
        }
        (self.lowest, self.coefficients) = (low, sum);
    }

    /// The quotient by -A^2 - A^-2, if there is no rest.
    fn without_one_loop(mut self) -> Option<Self> {
        let n = self.coefficients.len().checked_sub(2)?;
        let mut quotient = vec![0; n];
        for k in 0..n {
            quotient[k] = -self.coefficients[k];
            self.coefficients[k + 2] += quotient[k];
            self.coefficients[k] = 0;
        }
        self.coefficients.iter().all(|c| *c == 0).then_some(Self {
            lowest: self.lowest + 2,
            coefficients: quotient,
        })
    }

    /// (-A^3)^-writhe times the bracket, in powers of t = A^-4.
    fn into_jones(self, writhe: i32) -> Option<Jones> {
        let (four_times_lowest, coefficients) = self.in_powers_of_t(writhe)?;
        (four_times_lowest % 4 == 0).then_some(Jones {
            lowest: four_times_lowest / 4,
            coefficients,
        })
    }

    /// The same for links, with four times the lowest power, which need not be whole, and the coefficients.
    pub fn in_powers_of_t(self, writhe: i32) -> Option<(i32, Vec<i64>)> {
        let sign = if writhe % 2 == 0 { 1 } else { -1 };
        let first = self.coefficients.iter().position(|c| *c != 0)?;
        let last = self.coefficients.iter().rposition(|c| *c != 0)?;
        let lowest = self.lowest + 2 * first as i32 - 3 * writhe;
        let highest = lowest + 2 * (last - first) as i32;
        let kept = &self.coefficients[first..=last];
        let stray = |(k, c): (usize, &i128)| k % 2 == 1 && *c != 0;
        if kept.iter().enumerate().any(stray) {
            return None;
        }
        let in_t = kept.iter().step_by(2).rev();
        let coefficients = in_t.map(|c| i64::try_from(sign * c).ok());
        Some((-highest, coefficients.collect::<Option<_>>()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::invariant::{least_crossing, one_view};
    use crate::{KnotTable, closed_braid};

    fn of_word(word: &[i32], n_directions: usize, simplify: bool) -> (Option<Jones>, usize) {
        let curve = closed_braid(word).expect("a knot");
        let diagram = if simplify {
            least_crossing(curve.vertices(), n_directions, 3).expect("general")
        } else {
            one_view(curve.vertices(), 3)
        };
        (jones(&diagram), diagram.n_crossings())
    }

    #[test]
    fn right_handed_trefoil() {
        let expected = Jones {
            lowest: 1,
            coefficients: vec![1, 0, 1, -1],
        };
        let (found, _) = of_word(&[1, 1, 1], 8, true);
        assert_eq!(found.as_ref(), Some(&expected));
        assert_eq!(expected.text(), "t + t^3 - t^4");
        let (mirror, _) = of_word(&[-1, -1, -1], 8, true);
        assert_eq!(mirror, Some(expected.mirror()));
        assert_eq!(expected.mirror().text(), "-t^-4 + t^-3 + t^-1");
    }

    #[test]
    fn every_diagram_of_a_knot_gives_the_same() {
        for knot in KnotTable::builtin().iter() {
            let (few, _) = of_word(&knot.braid, 30, true);
            let (many, _) = of_word(&knot.braid, 1, false);
            let few = few.expect("narrow");
            assert!(few.fits_a_knot(knot.invariants.determinant), "{few:?}");
            assert_eq!(Some(few), many, "{}", knot.name);
        }
    }

    #[test]
    fn wide_and_long_diagrams_are_given_up() {
        // The torus knot T(13, 14) as a braid: as many open strands as there are, and 168 crossings.
        let row: Vec<i32> = (1..13).collect();
        let (found, n) = of_word(&row.repeat(14), 2, true);
        assert!(n > MOST_CROSSINGS && found.is_none());
        // Within the crossings, a weave of eight strands.
        let row = [1, -2, 3, -4, 5, -6, 7];
        let (found, n) = of_word(&row.repeat(7), 30, true);
        assert!(n <= MOST_CROSSINGS);
        if let Some(found) = found {
            assert_eq!(found.coefficients.iter().sum::<i64>(), 1);
        }
    }
}
