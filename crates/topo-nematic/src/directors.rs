//! Orders and directors of many cells, in wide vectors.

use std::ops::Range;

use fearless_simd::{Level, Select, Simd, SimdBase, SimdFloat, SimdMask};

use crate::NematicState;
use crate::kernel::five;
use crate::tensor::{NEWTON_STEPS, order_and_director};
use crate::vector::dispatch;

/// Orders and directors of a stretch of cells, to the bit those of [`order_and_director`]; the room is used again.
pub(crate) struct Directors {
    pub order: Vec<f64>,
    pub director: [Vec<f64>; 3],
    level: Level,
}

impl Default for Directors {
    fn default() -> Self {
        Self {
            order: Vec::new(),
            director: [const { Vec::new() }; 3],
            level: Level::new(),
        }
    }
}

impl Directors {
    /// Those of every cell.
    pub fn of(state: &NematicState) -> Self {
        let mut directors = Self::default();
        directors.find(state, 0..state.grid().n_cells());
        directors
    }

    /// Finds those of `cells` (indices of the grid).
    pub(crate) fn find(&mut self, state: &NematicState, cells: Range<usize>) {
        let (q, n) = (state.q_tensor(), state.grid().n_cells());
        self.find_of(std::array::from_fn(|c| {
            &q[c * n + cells.start..c * n + cells.end]
        }));
    }

    fn find_of(&mut self, q: [&[f64]; 5]) {
        let n = q[0].len();
        self.order.resize(n, 0.0);
        self.director.iter_mut().for_each(|d| d.resize(n, 0.0));
        dispatch!(self.level, simd => self.wide(simd, q));
    }

    #[inline(always)]
    fn wide<S: Simd>(&mut self, simd: S, q: [&[f64]; 5]) {
        let (n, len) = (S::f64s::LEN, q[0].len());
        let whole = len - len % n;
        for at in (0..whole).step_by(n) {
            let tensors = five(
                #[inline(always)]
                |c| S::f64s::from_slice(simd, &q[c][at..at + n]),
            );
            let (order, director, found) = common(simd, tensors);
            order.store_slice(&mut self.order[at..at + n]);
            for (to, d) in self.director.iter_mut().zip(director) {
                d.store_slice(&mut to[at..at + n]);
            }
            for i in (at..at + n).filter(|i| found >> (i - at) & 1 == 0) {
                self.single(q, i);
            }
        }
        (whole..len).for_each(|i| self.single(q, i));
    }

    fn single(&mut self, q: [&[f64]; 5], i: usize) {
        let (order, director) = order_and_director(&q.map(|c| c[i]));
        self.order[i] = order;
        for (to, d) in self.director.iter_mut().zip(director) {
            to[i] = d;
        }
    }
}

/// Order and director of several tensors; bit l of the mask says that lane l took the common path of [`order_and_director`].
#[inline(always)]
fn common<S: Simd>(simd: S, q: [S::f64s; 5]) -> (S::f64s, [S::f64s; 3], u64) {
    let number = |x: f64| S::f64s::splat(simd, x);
    let [xx, xy, xz, yy, yz] = q;
    let zero = number(0.0);
    let zz = -xx - yy;
    let products = xx * xx + yy * yy + xy * xy + xz * xz + yz * yz;
    let square = (number(2.0) * products + xx * yy + yy * xx) / number(6.0);
    let determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    // Newton's method, each lane until it has settled.
    let mut root = number(2.0) * square.sqrt();
    let mut running = square.simd_gt(zero);
    let mut settled = number(1.0).simd_lt(zero);
    for _ in 0..NEWTON_STEPS {
        let slope = number(3.0) * (root * root - square);
        running &= slope.simd_ge(square);
        let step = (root * (root * root - number(3.0) * square) - determinant) / slope;
        root = running.select(root - step, root);
        let now = running & step.abs().simd_lt(number(1e-9) * root);
        settled |= now;
        running &= !now;
        if running.to_bitmask() == 0 {
            break;
        }
    }
    let (a, b, c) = (xx - root, yy - root, zz - root);
    let products = [
        [xy * yz - xz * b, xz * xy - a * yz, a * b - xy * xy],
        [b * c - yz * yz, yz * xz - xy * c, xy * yz - b * xz],
        [yz * xz - c * xy, c * a - xz * xz, xz * xy - yz * a],
    ];
    let norm = |p: &[S::f64s; 3]| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    let (mut best, mut longest) = (products[0], norm(&products[0]));
    for product in &products[1..] {
        let next = norm(product);
        let longer = next.simd_ge(longest);
        longest = longer.select(next, longest);
        for (x, y) in best.iter_mut().zip(product) {
            *x = longer.select(*y, *x);
        }
    }
    let scale = norm(&[xx, xy, xz]) + norm(&[xy, yy, yz]) + norm(&[xz, yz, zz]);
    let length = longest.sqrt();
    settled &= length.simd_gt(number(1e-13) * scale) & scale.simd_gt(zero);
    let n = best.map(
        #[inline(always)]
        |x| x / length,
    );
    let down = n[2].simd_lt(zero);
    let n = n.map(
        #[inline(always)]
        |x| down.select(-x, x),
    );
    (root, n, settled.to_bitmask())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::{Tensor5, uniaxial};

    #[test]
    fn wide_vectors_give_the_bits_of_single_cells() {
        let mut noise = crate::noise::noise(7);
        let mut next = || 0.5 * noise.next().unwrap();
        for n in [1, 7, 8, 19, 200] {
            let cells: Vec<Tensor5> = (0..n)
                .map(|k| match k % 7 {
                    0 => [0.0; 5],
                    1 => uniaxial(-0.3, [0.6, 0.0, 0.8]),
                    2 => uniaxial(0.5, [0.0, 1.0, 0.0]),
                    3 => [f64::NAN, 0.0, 0.1, f64::INFINITY, 0.0],
                    4 => std::array::from_fn(|_| 1e-9 * next()),
                    5 => uniaxial(0.5, [next(), next(), next()]),
                    _ => std::array::from_fn(|_| next()),
                })
                .collect();
            let components: [Vec<f64>; 5] =
                std::array::from_fn(|c| cells.iter().map(|q| q[c]).collect());
            let mut found = Directors::default();
            found.find_of(std::array::from_fn(|c| &components[c][..]));
            for (i, q) in cells.iter().enumerate() {
                let (order, d) = order_and_director(q);
                assert_eq!(found.order[i].to_bits(), order.to_bits(), "{q:?}");
                for c in 0..3 {
                    assert_eq!(found.director[c][i].to_bits(), d[c].to_bits(), "{q:?}");
                }
            }
        }
    }
}
