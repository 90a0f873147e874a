//! The fused kernel: Laplacian, bulk field and update of a stretch of cells in one pass.

pub(crate) mod combine;
mod elementwise;
mod prefetch;
pub(crate) mod run;
pub(crate) mod second;

use crate::Material;
use crate::kernel::prefetch::prefetch;
use crate::real::{Lanes, Real};

/// Widest vector, in numbers.
const WIDEST: usize = 16;

/// Coefficients of the molecular field of a cell with six whole links to its neighbours Q_n; E is the field term.
///
/// ```math
/// H = \frac{L}{h^2} \sum_{6} (Q_n - Q) - A Q - B\,(Q^2)_{\mathrm{tr}} - C\,(Q:Q)\,Q + E
/// ```
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficients<T> {
    /// L/h².
    link: T,
    /// -A - 6 L/h².
    linear: T,
    /// -B.
    quadratic: T,
    /// -C.
    cubic: T,
    /// Uniform field E.
    field: [T; 5],
}

impl<T: Real> Coefficients<T> {
    pub(crate) fn new(material: &Material, spacing: f64, field: &[f64; 5]) -> Self {
        let link = material.elastic_constant / (spacing * spacing);
        Self {
            link: T::of(link),
            linear: T::of(-material.a - 6.0 * link),
            quadratic: T::of(-material.b),
            cubic: T::of(-material.c),
            field: field.map(T::of),
        }
    }
}

/// A stretch of cells along x and its neighbours.
pub(crate) struct Stretch<'a, T> {
    /// Components of the whole field, or of a copy of the stretch and its neighbours; of equal length.
    pub field: [&'a [T]; 5],
    /// First cell and number of cells.
    pub start: usize,
    pub length: usize,
    /// The first neighbour at -y, +y, -z, +z.
    pub sides: [usize; 4],
    /// Neighbour of the first cell at -x and of the last at +x.
    pub ends: [[T; 5]; 2],
}

/// What is done with the molecular field of a few cells.
pub(crate) trait Update<L: Lanes> {
    /// Remembers what is to be read in place at cells `at..at + N`, which will be treated last, although some of them are
    /// written before.
    fn keep(&mut self, token: L::Token, at: usize);

    /// Treats cells `at..at + N` with tensor `q` and molecular field `h`; `weight` is 0 for cells treated before, else 1.
    fn cells(
        &mut self,
        token: L::Token,
        at: usize,
        q: &[L; 5],
        h: &[L; 5],
        weight: L,
        is_last: bool,
    );
}

/// One value a component; closures passed here must be inlined, or they are compiled for the baseline instruction set.
#[inline(always)]
pub(crate) fn five<L>(f: impl Fn(usize) -> L) -> [L; 5] {
    [f(0), f(1), f(2), f(3), f(4)]
}

/// Passes over a stretch of at least N cells; a last incomplete vector overlaps the one before.
#[inline(always)]
pub(crate) fn pass<L: Lanes, U: Update<L>>(
    token: L::Token,
    stretch: &Stretch<'_, L::Scalar>,
    k: &Coefficients<L::Scalar>,
    update: &mut U,
) {
    let (start, n, n_cells) = (stretch.start, stretch.length, stretch.field[0].len());
    // Equal lengths, known to the compiler, share their checks below.
    let q0 = &stretch.field[0][..n_cells];
    let q1 = &stretch.field[1][..n_cells];
    let q2 = &stretch.field[2][..n_cells];
    let q3 = &stretch.field[3][..n_cells];
    let q4 = &stretch.field[4][..n_cells];
    let centre = [q0, q1, q2, q3, q4];
    // Copies of the loop's own: through the reference they are read again at each vector.
    let (sides, ends) = (stretch.sides, stretch.ends);
    let (zero, one, two) = (
        L::splat(token, L::Scalar::of(0.0)),
        L::splat(token, L::Scalar::of(1.0)),
        L::splat(token, L::Scalar::of(2.0)),
    );
    let third = L::splat(token, L::Scalar::of(-1.0 / 3.0));
    let (link, linear, quadratic, cubic) = (
        L::splat(token, k.link),
        L::splat(token, k.linear),
        L::splat(token, k.quadratic),
        L::splat(token, k.cubic),
    );
    let field = five(
        #[inline(always)]
        |c| L::splat(token, k.field[c]),
    );
    let overlaps = !n.is_multiple_of(L::N);
    let last = n - L::N;
    if overlaps {
        update.keep(token, last);
    }
    let mut at = 0;
    loop {
        let q: [L; 5] = five(
            #[inline(always)]
            |c| L::load(token, &centre[c][start + at..start + at + L::N]),
        );
        for component in centre {
            // Not the row at -y: it was the row itself a moment ago.
            for row in &sides[1..] {
                prefetch::<_, 512>(component, row + at);
            }
        }
        let [xx, xy, xz, yy, yz] = q;
        let squares = [xx * xx, xy * xy, xz * xz, yy * yy, yz * yz];
        let half = xx.mul_add(
            yy,
            (squares[0] + squares[3]) + (squares[1] + squares[2]) + squares[4],
        );
        let trace = half * two;
        let traceless = trace * third;
        let linear = cubic.mul_add(trace, linear);
        // Traceless part of Q².
        let square = [
            (squares[0] + squares[1]) + (squares[2] + traceless),
            xy.mul_add(xx + yy, xz * yz),
            xy.mul_add(yz, zero - xz * yy),
            (squares[1] + squares[3]) + (squares[4] + traceless),
            xy.mul_add(xz, zero - yz * xx),
        ];
        let h: [L; 5] = five(
            #[inline(always)]
            |c| {
                let left = if at == 0 {
                    shifted_in::<L>(token, ends[0][c], &centre[c][start..])
                } else {
                    L::load(token, &centre[c][start + at - 1..start + at - 1 + L::N])
                };
                let right = if at == last {
                    shifted_out::<L>(token, &centre[c][start + at..], ends[1][c])
                } else {
                    L::load(token, &centre[c][start + at + 1..start + at + 1 + L::N])
                };
                let below = load_at::<L>(token, centre[c], sides[0] + at);
                let above = load_at::<L>(token, centre[c], sides[1] + at);
                let back = load_at::<L>(token, centre[c], sides[2] + at);
                let front = load_at::<L>(token, centre[c], sides[3] + at);
                let sum = (left + right) + (below + above) + (back + front);
                let bulk = linear.mul_add(q[c], quadratic.mul_add(square[c], field[c]));
                link.mul_add(sum, bulk)
            },
        );
        let is_last = at == last && overlaps;
        let weight = if is_last { unseen::<L>(token, n) } else { one };
        update.cells(token, at, &q, &h, weight, is_last);
        if at == last {
            break;
        }
        at = (at + L::N).min(last);
    }
}

#[inline(always)]
fn load_at<L: Lanes>(token: L::Token, field: &[L::Scalar], at: usize) -> L {
    L::load(token, &field[at..at + L::N])
}

/// `first` followed by the first N - 1 of `rest`.
#[inline(always)]
fn shifted_in<L: Lanes>(token: L::Token, first: L::Scalar, rest: &[L::Scalar]) -> L {
    let mut lanes = [first; WIDEST];
    lanes[1..L::N].copy_from_slice(&rest[..L::N - 1]);
    L::load(token, &lanes)
}

/// The second to the N-th of `rest`, followed by `last`.
#[inline(always)]
fn shifted_out<L: Lanes>(token: L::Token, rest: &[L::Scalar], last: L::Scalar) -> L {
    let mut lanes = [last; WIDEST];
    lanes[..L::N - 1].copy_from_slice(&rest[1..L::N]);
    L::load(token, &lanes)
}

/// 0 for the lanes of the last vector of `n` cells that the vector before has covered.
#[inline(always)]
fn unseen<L: Lanes>(token: L::Token, n: usize) -> L {
    let n_covered = L::N - n % L::N;
    let mut lanes = [L::Scalar::of(1.0); WIDEST];
    // Lane by lane: filled as a slice it is a call, for which all vectors in use are put aside.
    for (i, lane) in lanes[..L::N].iter_mut().enumerate() {
        *lane = L::Scalar::of(f64::from(u8::from(i >= n_covered)));
    }
    L::load(token, &lanes)
}

#[cfg(test)]
pub(crate) mod tests;
