//! Kauffman's polynomial in two variables, at one point of a finite field: two knots for which it differs are different.
//!
//! ```math
//! F(a, z) = a^{-w} \Lambda(D), \qquad \Lambda_\times + \Lambda_{\bar\times} = z (\Lambda_\asymp + \Lambda_{)(}), \qquad
//! \Lambda(\text{positive curl}) = a \Lambda, \qquad \Lambda(\bigcirc) = 1
//! ```
//!
//! Polynomials of the size met here that differ as such have equal values at a point chosen without regard to them with a chance
//! below 1e-16.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use super::diagram::Diagram;
use super::field::{add, inverse, mul, of, power, sub};
use crate::name::KnotName;

/// Most diagrams looked at on the way; more would take longer than a second.
const MOST_DIAGRAMS: usize = 400_000;
/// Most crossings of a diagram.
const MOST_CROSSINGS: usize = 30;

/// Where the polynomial is evaluated.
#[derive(Debug, Clone, Copy)]
struct Point {
    a: u64,
    a_inverse: u64,
    z: u64,
    /// Factor of a further circle, (a + 1/a) / z - 1.
    circle: u64,
}

impl Point {
    fn new(a: u64, z: u64) -> Self {
        let a_inverse = inverse(a);
        Self {
            a,
            a_inverse,
            z,
            circle: sub(mul(add(a, a_inverse), inverse(z)), 1),
        }
    }
}

/// Digits of π and of e.
static POINT: LazyLock<Point> =
    LazyLock::new(|| Point::new(314_159_265_358_979_323, 271_828_182_845_904_523));

/// Value of the polynomial of a knot, or of a link with the writhe w of its components alone, so that their orientations do not
/// matter; `None` if its diagram would take too long.
///
/// # Validation
/// `kauffman_polynomials_as_published`, `at_a_line_of_points_it_is_the_jones_polynomial`.
///
/// # References
/// [kauffman1990]
///
/// [kauffman1990]: https://doi.org/10.1090/S0002-9947-1990-0958895-7
pub(crate) fn kauffman(diagram: &Diagram) -> Option<u64> {
    at(diagram, &POINT)
}

fn at(diagram: &Diagram, point: &Point) -> Option<u64> {
    if diagram.n_crossings() > MOST_CROSSINGS {
        return None;
    }
    let link = Link {
        twin: diagram.twins().iter().map(|h| *h as u8).collect(),
        n_circles: diagram.rings.ranges().filter(|r| r.is_empty()).count(),
    };
    let mut left = MOST_DIAGRAMS;
    let writhe = diagram.own_writhe();
    Some(mul(power(point.a, -writhe), link.value(point, &mut left)?))
}

static TEXT: &str = include_str!("../../data/kauffman.csv");

/// Values of the knots whose polynomial is published in `data/kauffman.csv`, and of their mirror images.
static KNOWN: LazyLock<BTreeMap<&'static str, [u64; 2]>> = LazyLock::new(|| {
    let mut known = BTreeMap::new();
    for (name, z, lowest, coefficients) in TEXT.lines().skip(1).filter_map(row) {
        let values = known.entry(name).or_insert([0; 2]);
        for (value, a) in values.iter_mut().zip([POINT.a, POINT.a_inverse]) {
            for (k, c) in coefficients.iter().enumerate() {
                let term = mul(power(POINT.z, z), power(a, lowest + k as i32));
                *value = add(*value, mul(of(*c), term));
            }
        }
    }
    known
});

/// A line `name,z_power,a_lowest,coefficients`.
fn row(line: &'static str) -> Option<(&'static str, i32, i32, Vec<i64>)> {
    let mut cells = line.split(',');
    let name = cells.next()?;
    let z = cells.next()?.parse().ok()?;
    let lowest = cells.next()?.parse().ok()?;
    Some((name, z, lowest, numbers(cells.next()?)?))
}

/// Value of the polynomial of a knot or sum, the product; `None` if that of a factor is not in the table of those that need it.
pub(crate) fn kauffman_of_name(name: &KnotName) -> Option<u64> {
    name.factors().iter().try_fold(1, |product, factor| {
        let [plain, mirror] = KNOWN.get(factor.knot.as_str())?;
        Some(mul(product, if factor.mirrored { *mirror } else { *plain }))
    })
}

/// A diagram without orientation, and circles apart from it.
///
/// The half-edges of crossing c are 4 c to 4 c + 3, counterclockwise, the even ones above; each has its twin at the other end of its edge.
#[derive(Clone)]
struct Link {
    twin: Vec<u8>,
    n_circles: usize,
}

/// What a walk along all components finds.
struct Walk {
    /// Crossings first met from below.
    from_below: Vec<usize>,
    n_components: usize,
    /// Sum of the signs of the crossings of each component with itself.
    writhe: i32,
}

impl Link {
    fn n_crossings(&self) -> usize {
        self.twin.len() / 4
    }

    /// Value of Λ, by undoing crossings until every component lies above the next and descends.
    fn value(mut self, point: &Point, left: &mut usize) -> Option<u64> {
        *left = left.checked_sub(1)?;
        let mut factor = 1;
        while let Some(curl) = self.cancel(point) {
            factor = mul(factor, curl);
        }
        if self.n_crossings() == 0 {
            return Some(mul(factor, power(point.circle, self.n_circles as i32 - 1)));
        }
        let walks = (0..self.twin.len()).map(|start| self.walk(start));
        let walk = walks.min_by_key(|walk| walk.from_below.len())?;
        let Some(&c) = walk.from_below.first() else {
            let n_circles = (walk.n_components + self.n_circles) as i32;
            let curls = power(point.a, walk.writhe);
            return Some(mul(factor, mul(curls, power(point.circle, n_circles - 1))));
        };
        let mut smoothed = 0;
        for first in [0, 1] {
            let mut link = self.clone();
            link.smooth(c, first);
            smoothed = add(smoothed, link.value(point, left)?);
        }
        self.switch(c);
        let switched = self.value(point, left)?;
        Some(mul(factor, sub(mul(point.z, smoothed), switched)))
    }

    /// Walks along all components, the first from a half-edge on.
    fn walk(&self, start: usize) -> Walk {
        let n = self.n_crossings();
        // The half-edge by which each crossing was left the first time, and in which component.
        let mut first: Vec<Option<(usize, usize)>> = vec![None; n];
        let mut seen = vec![false; 4 * n];
        let mut found = Walk {
            from_below: Vec::new(),
            n_components: 0,
            writhe: 0,
        };
        for begin in (start..4 * n).chain(0..start) {
            if seen[begin] {
                continue;
            }
            let mut out = begin;
            while !seen[out] {
                let into = usize::from(self.twin[out]);
                (seen[out], seen[into]) = (true, true);
                let c = into / 4;
                out = 4 * c + (into + 2) % 4;
                match first[c] {
                    None => {
                        first[c] = Some((out, found.n_components));
                        if into % 2 == 1 {
                            found.from_below.push(c);
                        }
                    }
                    Some((other, component)) if component == found.n_components => {
                        let (over, under) = if out % 2 == 0 {
                            (out, other)
                        } else {
                            (other, out)
                        };
                        found.writhe += if (under + 4 - over) % 4 == 1 { 1 } else { -1 };
                    }
                    Some(_) => {}
                }
            }
            found.n_components += 1;
        }
        found
    }

    /// Exchanges what is above and below at a crossing.
    fn switch(&mut self, c: usize) {
        let moved = |h: u8| match usize::from(h) / 4 == c {
            true => (4 * c + (usize::from(h) + 1) % 4) as u8,
            false => h,
        };
        let ends = [0, 1, 2, 3].map(|k| moved(self.twin[4 * c + k]));
        for (k, end) in ends.into_iter().enumerate() {
            let here = 4 * c + (k + 1) % 4;
            self.twin[here] = end;
            self.twin[usize::from(end)] = here as u8;
        }
    }

    /// Takes a crossing out, joining its half-edges `first` and the next, and the two others.
    fn smooth(&mut self, c: usize, first: usize) {
        self.join(4 * c + first, 4 * c + first + 1);
        self.join(4 * c + first + 2, 4 * c + (first + 3) % 4);
        self.remove(c);
    }

    /// Joins what two half-edges lead to.
    fn join(&mut self, p: usize, q: usize) {
        let (x, y) = (usize::from(self.twin[p]), usize::from(self.twin[q]));
        if x == q {
            self.n_circles += 1;
        } else {
            (self.twin[x], self.twin[y]) = (y as u8, x as u8);
        }
    }

    /// Drops a crossing to which nothing leads any more; the last one takes its number.
    fn remove(&mut self, c: usize) {
        let last = self.n_crossings() - 1;
        for k in 0..4 {
            let end = usize::from(self.twin[4 * last + k]);
            if c != last {
                let end = if end / 4 == last {
                    4 * c + end % 4
                } else {
                    end
                };
                self.twin[4 * c + k] = end as u8;
                self.twin[end] = (4 * c + k) as u8;
            }
        }
        self.twin.truncate(4 * last);
    }

    /// Undoes a curl, or slides a strand off another; the factor of that, none if there is nothing to undo.
    fn cancel(&mut self, point: &Point) -> Option<u64> {
        for h in 0..self.twin.len() {
            let (c, k) = (h / 4, h % 4);
            let next = 4 * c + (k + 1) % 4;
            if usize::from(self.twin[h]) == next {
                self.join(4 * c + (k + 2) % 4, 4 * c + (k + 3) % 4);
                self.remove(c);
                return Some(if k % 2 == 0 { point.a_inverse } else { point.a });
            }
            // A bigon: the edge from h, and back along the edge beside it, one strand above at both crossings.
            let far = usize::from(self.twin[h]);
            let beside = 4 * (far / 4) + (far + 3) % 4;
            if far / 4 != c && usize::from(self.twin[next]) == beside && far % 2 == h % 2 {
                let d = far / 4;
                self.join(4 * c + (k + 2) % 4, 4 * d + (far + 2) % 4);
                self.join(4 * c + (k + 3) % 4, 4 * d + (beside + 2) % 4);
                self.remove(c.max(d));
                self.remove(c.min(d));
                return Some(1);
            }
        }
        None
    }
}

/// The integers of a cell.
pub(crate) fn numbers<T: std::str::FromStr>(cell: &str) -> Option<Vec<T>> {
    cell.split(' ').map(|number| number.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::invariant::{Invariants, one_view};
    use crate::{KnotTable, closed_braid};

    fn of_word(word: &[i32], seed: u64) -> Diagram {
        one_view(closed_braid(word).expect("a knot").vertices(), seed)
    }

    /// As the diagram has it, without any simplification before.
    #[test]
    fn kauffman_polynomials_as_published() {
        let table = KnotTable::builtin();
        assert_eq!(KNOWN.len(), 15);
        for name in KNOWN.keys() {
            for knot in [(*name).to_owned(), format!("m{name}")] {
                let entry = table.get(&knot).expect("known");
                let mut diagram = of_word(&entry.braid, 1);
                diagram.simplify();
                let own = kauffman_of_name(&KnotName::parse(&knot));
                assert_eq!(kauffman(&diagram), own, "{knot}");
            }
        }
        // F(3_1) = -(2 a^-2 + a^-4) + (a^-3 + a^-5) z + (a^-2 + a^-4) z^2
        let (a, z) = (POINT.a, POINT.z);
        let [a2, a3, a4, a5] = [2, 3, 4, 5].map(|k| power(a, -k));
        let constant = sub(0, add(add(a2, a2), a4));
        let trefoil = add(
            add(constant, mul(z, add(a3, a5))),
            mul(mul(z, z), add(a2, a4)),
        );
        assert_eq!(kauffman(&of_word(&[1, 1, 1], 0)), Some(trefoil));
    }

    #[test]
    fn every_view_gives_the_same_and_sums_multiply() {
        let word = [1, 1, 1, 2, -3, 2, -3];
        let parts = [&[1, 1, 1][..], &[1, -2, 1, -2]].map(|w| kauffman(&of_word(w, 0)));
        let product = parts[0].zip(parts[1]).map(|(a, b)| mul(a, b));
        for seed in 0..12 {
            let mut diagram = of_word(&word, seed);
            diagram.cancel();
            assert_eq!(kauffman(&diagram), product, "{seed}");
        }
    }

    /// V(t) = F(-t^(-3/4), t^(1/4) + t^(-1/4))
    #[test]
    fn at_a_line_of_points_it_is_the_jones_polynomial() {
        let root = 123_456_789;
        let a = sub(0, power(root, -3));
        let point = Point::new(a, add(root, inverse(root)));
        for knot in KnotTable::builtin().iter() {
            let mut diagram = of_word(&knot.braid, 2);
            diagram.cancel();
            let jones = Invariants::jones_of(&diagram).expect("narrow");
            let terms = jones.coefficients.iter().enumerate();
            let at_t = terms.fold(0, |sum, (k, c)| {
                add(sum, mul(of(*c), power(root, 4 * (jones.lowest + k as i32))))
            });
            assert_eq!(at(&diagram, &point), Some(at_t), "{}", knot.name);
        }
    }
}
