//! The second derivative of the energy at a state, applied to small changes of it.

mod lanczos;
mod start;
mod tridiagonal;

pub(crate) use lanczos::{Accuracy, LowestMode};

use std::ops::{Add, Mul, Sub};

use fearless_simd::{Simd, SimdBase, f64x8};

use crate::kernel::run::{Combination, Kernel};
use crate::tensor::{Tensor5, contract};
use crate::vector::dispatch;

/// The Hessian of the energy at a state: minus the derivative of the molecular field.
///
/// ```math
/// A P = -\frac{dH}{dQ} P = -L \nabla^2 P + A P + B\,(QP + PQ)_{\mathrm{tr}} + C\,[2 (Q:P)\, Q + (Q:Q)\, P]
/// ```
///
/// It is symmetric in the inner product of the gradient flow, the sum over cells of mass times P:P'. A small change along an
/// eigenvector decays at Γ times its eigenvalue, whose unit is L/ξ_N². The derivative is exact, not a difference of
/// fields: the elastic part is linear and the bulk part a cubic, so one pass is enough where differences need two.
///
/// # Validation
/// `hessian_is_the_derivative_of_the_molecular_field`
pub(crate) struct Hessian<'a> {
    /// The elastic part, zero on all surfaces.
    elastic: Kernel<f64>,
    /// The kernel at whose state the derivative is taken.
    kernel: &'a Kernel<f64>,
    /// The state, in the kernel's layout.
    q: &'a [f64],
}

impl<'a> Hessian<'a> {
    /// The Hessian at `q`, in the kernel's layout.
    pub(crate) fn new(kernel: &'a Kernel<f64>, q: &'a [f64]) -> Self {
        Self {
            elastic: kernel.elastic_part(),
            kernel,
            q,
        }
    }

    /// Writes A `p` to `out`, which must be zero where there is no field, and gives the inner product of `p` with it.
    pub(crate) fn apply(&self, p: &[f64], out: &mut [f64]) -> f64 {
        let what = Combination {
            on_q: 0.0,
            on_old: 0.0,
            on_field: -1.0,
            inputs: [],
            relaxing: false,
        };
        self.elastic.combine::<false, 0, false>(p, &what, out);
        self.elastic.add_second(p, -1.0, out);
        self.add_bulk(p, out)
    }

    /// Adds the bulk part to `out` and gives the inner product of `p` with the sum.
    fn add_bulk(&self, p: &[f64], out: &mut [f64]) -> f64 {
        let kernel = self.kernel;
        let m = kernel.material();
        let bulk = [m.a, m.b, m.c];
        let (q, p) = (kernel.components(self.q), kernel.components(p));
        let plane_size = self.plane_size();
        let sums = kernel.by_planes(out, &|k, mut out, _| {
            let first = k * plane_size;
            let mut sum = 0.0;
            for run in kernel.domain.runs_of(k) {
                let (from, to) = (run.start as usize, (run.start + run.length) as usize);
                let (q, p) = (q.map(|x| &x[from..to]), p.map(|x| &x[from..to]));
                let out = out.each_mut().map(|x| &mut x[from - first..to - first]);
                sum += dispatch!(kernel.level(), simd => add_to_run(simd, bulk, q, p, out));
            }
            for special in kernel.domain.special_of(k) {
                let cell = special.cell as usize;
                let (q, p) = (q.map(|x| x[cell]), p.map(|x| x[cell]));
                let share = special.volume / special.mass;
                let part = bulk_part(bulk, &q, &p);
                let all: Tensor5 = std::array::from_fn(|c| {
                    let to = &mut out[c][cell - first];
                    *to += share * part[c];
                    *to
                });
                sum += special.mass * contract(&p, &all);
            }
            [sum, 0.0, 0.0, 0.0]
        });
        sums[0]
    }

    /// old <- on_p `p` + on_out `out` + on_old old; gives the square of the norm of what results.
    pub(crate) fn combine(
        &self,
        (on_p, p): (f64, &[f64]),
        (on_out, out): (f64, &[f64]),
        on_old: f64,
        old: &mut [f64],
    ) -> f64 {
        let kernel = self.kernel;
        let factors = [on_p, on_out, on_old];
        let (p, out) = (kernel.components(p), kernel.components(out));
        let plane_size = self.plane_size();
        let sums = kernel.by_planes(old, &|k, mut old, _| {
            let first = k * plane_size;
            let mut sum = 0.0;
            for run in kernel.domain.runs_of(k) {
                let (from, to) = (run.start as usize, (run.start + run.length) as usize);
                let (p, out) = (p.map(|x| &x[from..to]), out.map(|x| &x[from..to]));
                let old = old.each_mut().map(|x| &mut x[from - first..to - first]);
                sum += dispatch!(kernel.level(), simd => combine_run(simd, factors, p, out, old));
            }
            for special in kernel.domain.special_of(k) {
                let cell = special.cell as usize;
                let (p, out) = (p.map(|x| x[cell]), out.map(|x| x[cell]));
                let mut new = old.each_ref().map(|x| x[cell - first]);
                sum += special.mass * combine_at(factors, &p, &out, &mut new);
                for c in 0..5 {
                    old[c][cell - first] = new[c];
                }
            }
            [sum, 0.0, 0.0, 0.0]
        });
        sums[0]
    }

    fn plane_size(&self) -> usize {
        let [nx, ny, _] = self.kernel.domain.grid.cells();
        nx * ny
    }
}

/// Operations on one number, or on eight side by side.
trait Field:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
}

impl<T> Field for T where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Mul<f64, Output = T>
{
}

/// The double contraction.
#[inline(always)]
fn product_of<T: Field>(a: &[T; 5], b: &[T; 5]) -> T {
    let off = a[1] * b[1] + a[2] * b[2] + a[4] * b[4];
    a[0] * b[0] + a[3] * b[3] + (a[0] + a[3]) * (b[0] + b[3]) + off * 2.0
}

/// The derivative of the bulk part along `p`, with its three constants.
#[inline(always)]
fn bulk_part<T: Field>([a, b, c]: [f64; 3], q: &[T; 5], p: &[T; 5]) -> [T; 5] {
    let (qq, qp) = (product_of(q, q), product_of(q, p));
    let third = qp * (2.0 / 3.0);
    // Twice the traceless part of QP made symmetric.
    let product = [
        (q[0] * p[0] + q[1] * p[1] + q[2] * p[2]) * 2.0 - third,
        q[1] * (p[0] + p[3]) + p[1] * (q[0] + q[3]) + q[2] * p[4] + p[2] * q[4],
        q[1] * p[4] + p[1] * q[4] - q[2] * p[3] - p[2] * q[3],
        (q[1] * p[1] + q[3] * p[3] + q[4] * p[4]) * 2.0 - third,
        q[1] * p[2] + p[1] * q[2] - q[4] * p[0] - p[4] * q[0],
    ];
    let (linear, cubic) = (qq * c, qp * (2.0 * c));
    let mut part = *p;
    for i in 0..5 {
        part[i] = p[i] * a + linear * p[i] + product[i] * b + cubic * q[i];
    }
    part
}

/// Numbers side by side; fixed, so that results do not depend on the machine.
const WIDTH: usize = 8;

// Loops, not closures: only what is surely inlined runs on the vector unit.
#[inline(always)]
fn add_to_run<S: Simd>(
    simd: S,
    bulk: [f64; 3],
    q: [&[f64]; 5],
    p: [&[f64]; 5],
    out: [&mut [f64]; 5],
) -> f64 {
    let n = q[0].len();
    let whole = n - n % WIDTH;
    let zero = f64x8::splat(simd, 0.0);
    let mut sums = zero;
    for start in (0..whole).step_by(WIDTH) {
        let (mut here, mut along) = ([zero; 5], [zero; 5]);
        for c in 0..5 {
            here[c] = f64x8::from_slice(simd, &q[c][start..start + WIDTH]);
            along[c] = f64x8::from_slice(simd, &p[c][start..start + WIDTH]);
        }
        let mut all = bulk_part(bulk, &here, &along);
        for c in 0..5 {
            let to = &mut out[c][start..start + WIDTH];
            all[c] += f64x8::from_slice(simd, to);
            all[c].store_slice(to);
        }
        sums += product_of(&along, &all);
    }
    let mut sum = sums.to_array().iter().sum();
    for i in whole..n {
        let (mut here, mut along) = ([0.0; 5], [0.0; 5]);
        for c in 0..5 {
            (here[c], along[c]) = (q[c][i], p[c][i]);
        }
        let mut all = bulk_part(bulk, &here, &along);
        for c in 0..5 {
            all[c] += out[c][i];
            out[c][i] = all[c];
        }
        sum += product_of(&along, &all);
    }
    sum
}

/// old <- on_p p + on_out out + on_old old in one cell or in several; gives the square of the norm of what results, summed as
/// [`contract`] does.
#[inline(always)]
fn combine_at<T: Field>(
    [on_p, on_out, on_old]: [f64; 3],
    p: &[T; 5],
    out: &[T; 5],
    old: &mut [T; 5],
) -> T {
    for c in 0..5 {
        old[c] = p[c] * on_p + out[c] * on_out + old[c] * on_old;
    }
    let [xx, xy, xz, yy, yz] = *old;
    (xx * xx + yy * yy + xy * xy + xz * xz + yz * yz) * 2.0 + xx * yy + yy * xx
}

#[inline(always)]
fn combine_run<S: Simd>(
    simd: S,
    factors: [f64; 3],
    p: [&[f64]; 5],
    out: [&[f64]; 5],
    old: [&mut [f64]; 5],
) -> f64 {
    let n = p[0].len();
    let whole = n - n % WIDTH;
    let zero = f64x8::splat(simd, 0.0);
    let mut sums = zero;
    for start in (0..whole).step_by(WIDTH) {
        let (mut along, mut image, mut new) = ([zero; 5], [zero; 5], [zero; 5]);
        for c in 0..5 {
            along[c] = f64x8::from_slice(simd, &p[c][start..start + WIDTH]);
            image[c] = f64x8::from_slice(simd, &out[c][start..start + WIDTH]);
            new[c] = f64x8::from_slice(simd, &old[c][start..start + WIDTH]);
        }
        sums += combine_at(factors, &along, &image, &mut new);
        for c in 0..5 {
            new[c].store_slice(&mut old[c][start..start + WIDTH]);
        }
    }
    let mut sums = sums.to_array();
    for i in whole..n {
        let (mut along, mut image, mut new) = ([0.0; 5], [0.0; 5], [0.0; 5]);
        for c in 0..5 {
            (along[c], image[c], new[c]) = (p[c][i], out[c][i], old[c][i]);
        }
        sums[0] += combine_at(factors, &along, &image, &mut new);
        for c in 0..5 {
            old[c][i] = new[c];
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests;
