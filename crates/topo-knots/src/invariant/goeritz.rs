//! Determinant and signature from the Goeritz matrix of a checkerboard colouring, with Gordon and Litherland's correction.

use super::diagram::Diagram;

/// Determinant and signature of a diagram from its Goeritz matrix G, with the correction η(c) of crossings of type II; none if
/// its code is not that of a planar diagram.
///
/// ```math
/// \sigma(K) = \mathrm{sign}\,G - \sum_{\text{type II}} \eta(c), \qquad \det K = |\det G|
/// ```
///
/// # References
/// [gordon1978]
///
/// [gordon1978]: https://doi.org/10.1007/BF01609479
pub(super) fn determinant_and_signature(diagram: &Diagram) -> Option<(u64, i32)> {
    if diagram.n_crossings() < 3 {
        return Some((1, 0));
    }
    let faces = Faces::trace(diagram);
    if faces.n_white[0] + faces.n_white[1] != diagram.n_crossings() + 2 {
        return None;
    }
    let white = usize::from(faces.n_white[1] < faces.n_white[0]);
    from_colouring(diagram, &faces, white)
}

fn from_colouring(diagram: &Diagram, faces: &Faces, white: usize) -> Option<(u64, i32)> {
    let n = diagram.n_crossings();
    let size = faces.n_white[white] - 1;
    let mut matrix = vec![0.0; size * size];
    let mut correction = 0;
    for c in 0..n {
        // Corners of equal parity have one colour; corner 0 is swept by the upper strand turning counterclockwise.
        let odd = (faces.colour_of_corner_0[c] + white) % 2;
        let eta = if odd == 1 { 1 } else { -1 };
        let coherent_is_black = (diagram.signs[c] > 0) == (odd == 1);
        if coherent_is_black {
            correction += eta;
        }
        let (f, g) = (faces.name[4 * c + odd], faces.name[4 * c + odd + 2]);
        if f != g {
            let mut put = |i: usize, j: usize, value: i32| {
                if i < size && j < size {
                    matrix[i * size + j] += f64::from(value);
                }
            };
            put(f, g, -eta);
            put(g, f, -eta);
            put(f, f, eta);
            put(g, g, eta);
        }
    }
    let (determinant, signature) = inertia(&mut matrix, size);
    let rounded = determinant.round();
    if (determinant - rounded).abs() > 0.25 || rounded > 1e15 {
        return None;
    }
    Some((rounded as u64, signature - correction))
}

/// Faces of the diagram: which one each corner of each crossing lies in, and their checkerboard colour.
///
/// The half-edges of a crossing are numbered counterclockwise from the outgoing upper one; corner k lies between k and k + 1.
struct Faces {
    /// Index of the face among those of its colour, for corner 4 c + k.
    name: Vec<usize>,
    colour_of_corner_0: Vec<usize>,
    n_white: [usize; 2],
}

impl Faces {
    fn trace(diagram: &Diagram) -> Self {
        let n = diagram.n_crossings();
        let n_visits = diagram.visits.len();
        let twin = diagram.twins();
        let mut colour = vec![0; n];
        for k in 0..n_visits.saturating_sub(1) {
            let (here, there) = (diagram.visits[k], diagram.visits[k + 1]);
            let (a, b) = (here.crossing as usize, there.crossing as usize);
            // The face left of an edge is corner `out` of its start and corner `into - 1` of its end.
            colour[b] = (colour[a] + diagram.slot(here, true) + diagram.slot(there, false) + 1) % 2;
        }
        let mut name = vec![usize::MAX; 4 * n];
        let mut n_white = [0, 0];
        for start in 0..4 * n {
            if name[start] != usize::MAX {
                continue;
            }
            let shade = (colour[start / 4] + start) % 2;
            let mut corner = start;
            while name[corner] == usize::MAX {
                name[corner] = n_white[shade];
                let arrival = twin[corner];
                corner = 4 * (arrival / 4) + (arrival + 3) % 4;
            }
            n_white[shade] += 1;
        }
        Self {
            name,
            colour_of_corner_0: colour,
            n_white,
        }
    }
}

/// |det| and signature of a symmetric matrix by elimination with Bunch and Parlett's pivots.
fn inertia(m: &mut [f64], n: usize) -> (f64, i32) {
    let (mut determinant, mut signature) = (1.0, 0);
    let mut k = 0;
    while k < n {
        let (mut diagonal, mut p) = (-1.0, k);
        let (mut off, mut q) = (0.0, (k, k));
        for i in k..n {
            if m[i * n + i].abs() > diagonal {
                (diagonal, p) = (m[i * n + i].abs(), i);
            }
            for j in i + 1..n {
                if m[i * n + j].abs() > off {
                    (off, q) = (m[i * n + j].abs(), (i, j));
                }
            }
        }
        if diagonal.max(off) < 1e-9 {
            return (0.0, signature);
        }
        if diagonal >= 0.64 * off {
            swap(m, n, k, p);
            let pivot = m[k * n + k];
            determinant *= pivot.abs();
            signature += if pivot > 0.0 { 1 } else { -1 };
            for i in k + 1..n {
                let factor = m[i * n + k] / pivot;
                if factor != 0.0 {
                    for j in k + 1..n {
                        m[i * n + j] -= factor * m[k * n + j];
                    }
                }
            }
            k += 1;
        } else {
            swap(m, n, k, q.0);
            swap(m, n, k + 1, q.1);
            let (a, b, d) = (m[k * n + k], m[k * n + k + 1], m[(k + 1) * n + k + 1]);
            // |a|, |d| < 0.64 |b|: one eigenvalue of each sign.
            let det = a * d - b * b;
            determinant *= det.abs();
            for i in k + 2..n {
                let (x, y) = (m[i * n + k], m[i * n + k + 1]);
                let (f, g) = ((d * x - b * y) / det, (a * y - b * x) / det);
                for j in k + 2..n {
                    m[i * n + j] -= f * m[k * n + j] + g * m[(k + 1) * n + j];
                }
            }
            k += 2;
        }
    }
    (determinant, signature)
}

fn swap(m: &mut [f64], n: usize, a: usize, b: usize) {
    if a != b {
        for j in 0..n {
            m.swap(a * n + j, b * n + j);
        }
        for i in 0..n {
            m.swap(i * n + a, i * n + b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, closed_braid};

    #[test]
    fn both_colourings_agree() {
        for knot in KnotTable::builtin().iter() {
            let curve = closed_braid(&knot.braid).expect("a knot");
            let diagram = crate::invariant::one_view(curve.vertices(), 5);
            if diagram.n_crossings() < 3 {
                continue;
            }
            let faces = Faces::trace(&diagram);
            let expected = Some((knot.invariants.determinant, knot.invariants.signature));
            for white in 0..2 {
                assert_eq!(
                    from_colouring(&diagram, &faces, white),
                    expected,
                    "{}",
                    knot.name
                );
            }
        }
    }

    #[test]
    fn inertia_of_matrices_that_need_both_pivots() {
        let mut hyperbolic = [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -0.5];
        assert_eq!(inertia(&mut hyperbolic, 3), (0.5, -1));
        // Coxeter matrix of A4: determinant 5, positive.
        let mut m = [0.0; 16];
        for i in 0..4 {
            m[5 * i] = 2.0;
            if i < 3 {
                m[5 * i + 1] = -1.0;
                m[5 * i + 4] = -1.0;
            }
        }
        let (determinant, signature) = inertia(&mut m, 4);
        assert!((determinant - 5.0).abs() < 1e-12);
        assert_eq!(signature, 4);
    }
}
