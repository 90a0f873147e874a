//! Invariants of links, and whether two have the same whatever the order and the orientations of their components.

use serde::{Deserialize, Serialize};

use crate::curves::Curves;
use crate::invariant::{Diagram, least_crossing_of, polynomial_text, usable_vertices};
use crate::{Invariants, KnotError, V};

/// Directions tried for the projection with the fewest crossings.
const N_PROJECTIONS: usize = 30;

/// A polynomial in half powers of t, such as the Jones polynomial of a link.
///
/// ```math
/// V(t) = \sum_k c_k\, t^{\mathrm{twice\_lowest} / 2 + k}
/// ```
///
/// # Validation
/// `jones_polynomials_of_links_as_published`
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkJones {
    /// Twice the power of the first coefficient.
    pub twice_lowest: i32,
    /// Coefficients, the first and the last not zero.
    pub coefficients: Vec<i64>,
}

impl LinkJones {
    /// The polynomial of the mirror image, V(1/t).
    pub fn mirror(&self) -> Self {
        Self {
            twice_lowest: -(self.twice_lowest + 2 * (self.coefficients.len() as i32 - 1)),
            coefficients: self.coefficients.iter().rev().copied().collect(),
        }
    }

    /// The polynomial as text, as `-t^(1/2) - t^(5/2)`.
    pub fn text(&self) -> String {
        polynomial_text(&self.coefficients, |k| self.twice_lowest + 2 * k)
    }

    fn times_power(&self, twice: i32) -> Self {
        Self {
            twice_lowest: self.twice_lowest + twice,
            coefficients: self.coefficients.clone(),
        }
    }
}

/// Invariants of a link of several components.
///
/// The polynomial is the Jones polynomial up to the power of t that depends on the orientations: with λ the sum of all linking
/// numbers,
///
/// ```math
/// f(t) = t^{-3 \lambda / 2}\, V(t) = (-A^3)^{-w}\, \langle D \rangle, \qquad t = A^{-4}
/// ```
///
/// where the writhe w counts the crossings of components with themselves alone. Reversing a component leaves f as it is.
///
/// # Validation
/// `reversed_components_and_another_order_change_nothing`, `jones_polynomials_of_links_as_published`
///
/// # References
/// [kauffman1987]
///
/// [kauffman1987]: https://doi.org/10.1016/0040-9383(87)90009-7
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinkInvariants {
    /// Invariants of each component by itself.
    pub components: Vec<Invariants>,
    /// Linking numbers of the pairs of components: 0 and 1, 0 and 2, 1 and 2, 0 and 3, and so on.
    pub linking: Vec<i32>,
    /// The polynomial f; `None` if the diagram is too wide for it.
    pub jones: Option<LinkJones>,
}

impl LinkInvariants {
    /// Invariants of closed polygons, from the projection with the fewest crossings.
    ///
    /// # Errors
    /// As [`Invariants::of`], and [`KnotError::Degenerate`] for polygons that meet.
    pub fn of(components: &[&[V]]) -> Result<Self, KnotError> {
        let all: Vec<V> = components.iter().flat_map(|x| x.iter().copied()).collect();
        let rings = crate::rings::Rings::of(components.iter().map(|x| x.len()));
        let all = usable_vertices(&all, true)?;
        let diagram = least_crossing_of(&all, &rings, N_PROJECTIONS, 0)?;
        let own = rings.ranges().map(|range| Invariants::of(&all[range]));
        Ok(Self::of_diagram(&diagram, own.collect::<Result<_, _>>()?))
    }

    pub(crate) fn of_curves(curves: &Curves) -> Result<Self, KnotError> {
        let parts: Vec<&[V]> = curves.parts().iter().map(|part| part.vertices()).collect();
        Self::of(&parts)
    }

    /// Invariants of a diagram whose components are known by themselves.
    pub(crate) fn of_diagram(diagram: &Diagram, components: Vec<Invariants>) -> Self {
        let jones = Invariants::bracket_of(diagram).filter(|(lowest, _)| lowest % 2 == 0);
        let jones = jones.map(|(four_times_lowest, coefficients)| LinkJones {
            twice_lowest: four_times_lowest / 2,
            coefficients,
        });
        let n = components.len();
        let mut linking = vec![0; n * n.saturating_sub(1) / 2];
        for ([a, b], sign) in diagram.crossing_rings().into_iter().zip(&diagram.signs) {
            if a != b {
                linking[pair(a, b)] += i32::from(*sign);
            }
        }
        linking.iter_mut().for_each(|l| *l /= 2);
        Self {
            components,
            linking,
            jones,
        }
    }

    /// Number of components.
    pub fn n_components(&self) -> usize {
        self.components.len()
    }

    /// Linking number of two components.
    pub fn linking_number(&self, a: usize, b: usize) -> i32 {
        match a == b {
            true => 0,
            false => self.linking[pair(a, b)],
        }
    }

    /// The Jones polynomial V of the link with the orientations that the coordinates give.
    pub fn oriented_jones(&self) -> Option<LinkJones> {
        let whole: i32 = self.linking.iter().sum();
        self.jones.as_ref().map(|f| f.times_power(3 * whole))
    }

    /// The invariants of the mirror image.
    pub fn mirror(&self) -> Self {
        Self {
            components: self.components.iter().map(Invariants::mirror).collect(),
            linking: self.linking.iter().map(|l| -l).collect(),
            jones: self.jones.as_ref().map(LinkJones::mirror),
        }
    }

    /// Whether the two are equal for some order and orientation of the components.
    ///
    /// # Validation
    /// `reversed_components_and_another_order_change_nothing`
    pub fn fits(&self, other: &Self) -> bool {
        let agree = match (&self.jones, &other.jones) {
            (Some(a), Some(b)) => a == b,
            _ => true,
        };
        let n = self.n_components();
        agree && n == other.n_components() && self.matches_from(other, &mut Vec::with_capacity(n))
    }

    /// Whether the places that the first components have in `other`, with their signs, can be completed.
    fn matches_from(&self, other: &Self, placed: &mut Vec<(usize, i32)>) -> bool {
        let k = placed.len();
        if k == self.n_components() {
            return true;
        }
        for place in 0..self.n_components() {
            let is_taken = placed.iter().any(|(taken, _)| *taken == place);
            if is_taken || self.components[k] != other.components[place] {
                continue;
            }
            for sign in [1, -1] {
                let fits = placed.iter().enumerate().all(|(j, (at, turn))| {
                    self.linking_number(j, k) == sign * turn * other.linking_number(*at, place)
                });
                if fits {
                    placed.push((place, sign));
                    if self.matches_from(other, placed) {
                        return true;
                    }
                    placed.pop();
                }
            }
        }
        false
    }

    /// The linking numbers and the polynomial as text.
    pub(crate) fn text(&self) -> String {
        let jones = self.jones.as_ref().map(LinkJones::text);
        let alexander = self.components.iter().map(Invariants::alexander_text);
        format!(
            "components of Alexander polynomials {}, linking numbers {:?}, polynomial {}",
            alexander.collect::<Vec<_>>().join(", "),
            self.linking,
            jones.as_deref().unwrap_or("not computed")
        )
    }
}

/// Place of the pair of two different components in a list of all pairs.
pub(crate) fn pair(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high - 1) / 2 + low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::braid_closure;

    fn of_word(word: &[i32]) -> LinkInvariants {
        let parts = braid_closure(word).expect("a link");
        LinkInvariants::of_curves(&parts.into()).expect("a link")
    }

    /// Positive Hopf link, its mirror image, Whitehead link, Borromean rings and T(2,4), as LinkInfo lists them.
    #[test]
    fn jones_polynomials_of_links_as_published() {
        for (word, linking, twice_lowest, coefficients) in [
            (&[1, 1][..], vec![1], 1, vec![-1, 0, -1]),
            (&[-1, -1], vec![-1], -5, vec![-1, 0, -1]),
            (&[1; 4], vec![2], 3, vec![-1, 0, -1, 1, -1]),
            (&[-1, 2, -1, 2, -1], vec![0], -7, vec![1, -2, 1, -2, 1, -1]),
            (
                &[1, -2, 1, -2, 1, -2],
                vec![0, 0, 0],
                -6,
                vec![-1, 3, -2, 4, -2, 3, -1],
            ),
        ] {
            let found = of_word(word);
            assert_eq!(found.linking, linking, "{word:?}");
            let expected = LinkJones {
                twice_lowest,
                coefficients,
            };
            assert_eq!(found.oriented_jones(), Some(expected), "{word:?}");
        }
        let hopf = of_word(&[1, 1]).oriented_jones().expect("few crossings");
        assert_eq!(hopf.text(), "-t^(1/2) - t^(5/2)");
        assert_eq!(hopf.mirror().text(), "-t^(-5/2) - t^(-1/2)");
    }

    #[test]
    fn reversed_components_and_another_order_change_nothing() {
        // Three rings in a row; the second of the word is the middle one.
        let mut parts = braid_closure(&[1, 1, 2, 2]).expect("a link");
        let chain = LinkInvariants::of_curves(&parts.clone().into()).expect("a link");
        assert_eq!(chain.linking, [1, 0, 1]);
        parts.swap(0, 1);
        let mut back = parts[0].clone().into_vertices();
        back.reverse();
        parts[0] = topo_core::Polyline::new(back, true).expect("a ring");
        let other = LinkInvariants::of_curves(&parts.into()).expect("a link");
        assert_eq!(other.linking, [-1, -1, 0]);
        assert_eq!(other.jones, chain.jones);
        assert!(chain.fits(&other) && other.fits(&chain));
        // The signs of a closed row of three tell the hand, those of an open row do not.
        let torus = of_word(&[1, 2, 1, 2, 1, 2]);
        assert!(chain.fits(&chain.mirror()) && !torus.fits(&torus.mirror()));
        let wrong = LinkInvariants {
            jones: chain.jones.clone(),
            ..torus.clone()
        };
        assert!(!wrong.fits(&chain) && !torus.fits(&chain));
    }
}
