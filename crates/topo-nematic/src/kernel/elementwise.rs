//! Passes that need no neighbours.

use fearless_simd::Simd;
use rayon::prelude::*;

use crate::kernel::run::{Kernel, Threads};
use crate::real::Real;
use crate::tensor::contract;
use crate::vector::dispatch;

/// Numbers a task treats.
const CHUNK: usize = 1 << 14;

impl<T: Real> Kernel<T> {
    /// Calls `f` with each number of `a` and `b` and that of `c`.
    pub(crate) fn for_each3(
        &self,
        a: &mut [T],
        b: &mut [T],
        c: &[T],
        f: impl Fn(&mut T, &mut T, T) + Copy + Send + Sync,
    ) {
        let work = |((a, b), c): ((&mut [T], &mut [T]), &[T])| {
            dispatch!(self.level(), simd => each3(simd, a, b, c, f));
        };
        match self.threads {
            Threads::One => a
                .chunks_mut(CHUNK)
                .zip(b.chunks_mut(CHUNK))
                .zip(c.chunks(CHUNK))
                .for_each(work),
            Threads::All => a
                .par_chunks_mut(CHUNK)
                .zip(b.par_chunks_mut(CHUNK))
                .zip(c.par_chunks(CHUNK))
                .for_each(work),
        }
    }

    /// Calls `work` with each chunk of `a`, and its number.
    fn by_chunks(&self, a: &mut [T], work: &(dyn Fn(usize, &mut [T]) + Sync)) {
        match self.threads {
            Threads::One => a
                .chunks_mut(CHUNK)
                .enumerate()
                .for_each(|(k, a)| work(k, a)),
            Threads::All => a
                .par_chunks_mut(CHUNK)
                .enumerate()
                .for_each(|(k, a)| work(k, a)),
        }
    }

    /// What `work` gives for each of `n` numbers.
    fn by_numbers(&self, n: usize, work: &(dyn Fn(usize) -> f64 + Sync)) -> Vec<f64> {
        match self.threads {
            Threads::One => (0..n).map(work).collect(),
            Threads::All => (0..n).into_par_iter().map(work).collect(),
        }
    }

    /// a <- sum of factors times arrays, `a` itself with the factor `on_a`.
    pub(crate) fn linear<const N: usize>(&self, a: &mut [T], on_a: f64, others: [(f64, &[T]); N]) {
        let on_a = T::of(on_a);
        let others = others.map(|(f, x)| (T::of(f), x));
        self.by_chunks(a, &|chunk, a| {
            let (from, to) = (chunk * CHUNK, chunk * CHUNK + a.len());
            let others = others.map(|(f, x)| (f, &x[from..to]));
            dispatch!(self.level(), simd => linear(simd, a, on_a, others));
        });
    }

    /// Largest Frobenius norm of a tensor of `a`.
    pub(crate) fn largest(&self, a: &[T]) -> f64 {
        let components = self.components(a);
        let square = |cell: usize| {
            let tensor = components.map(|x| x[cell].into());
            contract(&tensor, &tensor)
        };
        let cells = 0..self.domain.grid.n_cells();
        cells.map(square).fold(0.0, f64::max).sqrt()
    }

    /// Root mean square over the field of the tensor sum of factors times arrays.
    pub(crate) fn rms<const N: usize>(&self, arrays: [(f64, &[T]); N]) -> f64 {
        let n = self.domain.grid.n_cells();
        let row = |chunk: usize| {
            let (from, to) = (chunk * CHUNK, (chunk * CHUNK + CHUNK).min(n));
            dispatch!(self.level(), simd => squares(simd, arrays, self.stride, from, to))
        };
        let sums = self.by_numbers(n.div_ceil(CHUNK), &row);
        (sums.iter().sum::<f64>() / self.domain.n_active.max(1) as f64).sqrt()
    }
}

#[inline(always)]
fn each3<S: Simd, T: Real>(
    _simd: S,
    a: &mut [T],
    b: &mut [T],
    c: &[T],
    f: impl Fn(&mut T, &mut T, T),
) {
    for ((x, y), z) in a.iter_mut().zip(b).zip(c) {
        f(x, y, *z);
    }
}

#[inline(always)]
fn linear<S: Simd, T: Real, const N: usize>(
    _simd: S,
    a: &mut [T],
    on_a: T,
    others: [(T, &[T]); N],
) {
    let n = a.len();
    for i in 0..n {
        let mut sum = on_a * a[i];
        for (f, x) in others {
            sum += f * x[i];
        }
        a[i] = sum;
    }
}

#[inline(always)]
fn squares<S: Simd, T: Real, const N: usize>(
    _simd: S,
    arrays: [(f64, &[T]); N],
    stride: usize,
    from: usize,
    to: usize,
) -> f64 {
    let mut sums = [0.0; 4];
    for cell in from..to {
        let mut error = [0.0; 5];
        for (c, e) in error.iter_mut().enumerate() {
            for (f, x) in arrays {
                let x: f64 = x[c * stride + cell].into();
                *e += f * x;
            }
        }
        sums[cell % 4] += contract(&error, &error);
    }
    sums.iter().sum()
}
