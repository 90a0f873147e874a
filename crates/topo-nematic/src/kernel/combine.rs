//! Linear combinations of field, old values and other arrays, written by the kernel in the same pass.

use crate::kernel::prefetch::prefetch;
use crate::kernel::{Update, five};
use crate::real::Lanes;

/// Factors of out <- on_q Q + on_old out + on_field H + sum of on_inputs X.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Factors<T> {
    pub on_q: T,
    pub on_old: T,
    pub on_field: T,
    pub on_inputs: [T; 2],
}

/// The combination over one stretch; `OLD` reads `out`, `INPUTS` other arrays are read, `SUMS` makes sums of H and the first of them.
pub(crate) struct Combine<'a, L: Lanes, const OLD: bool, const INPUTS: usize, const SUMS: bool> {
    pub factors: Factors<L>,
    /// Components of the plane that is written, and the place of the first cell in it.
    pub out: [&'a mut [L::Scalar]; 5],
    pub out_start: usize,
    /// Components of whole arrays, and the place of the first cell in them.
    pub start: usize,
    pub inputs: [[&'a [L::Scalar]; 5]; INPUTS],
    pub kept: [L; 5],
    /// Sums of H:H, H:X and X:X over lanes.
    pub sums: [L; 3],
}

impl<L: Lanes, const OLD: bool, const INPUTS: usize, const SUMS: bool> Update<L>
    for Combine<'_, L, OLD, INPUTS, SUMS>
{
    #[inline(always)]
    fn keep(&mut self, token: L::Token, at: usize) {
        let to = self.out_start + at;
        if OLD {
            self.kept = five(
                #[inline(always)]
                |c| L::load(token, &self.out[c][to..to + L::N]),
            );
        }
    }

    #[inline(always)]
    fn cells(
        &mut self,
        token: L::Token,
        at: usize,
        q: &[L; 5],
        h: &[L; 5],
        weight: L,
        is_last: bool,
    ) {
        let (to, from) = (self.out_start + at, self.start + at);
        let f = &self.factors;
        for c in 0..5 {
            prefetch::<_, 1024>(self.out[c], to);
            for input in &self.inputs {
                prefetch::<_, 1024>(input[c], from);
            }
            let mut sum = f.on_field * h[c];
            sum = f.on_q.mul_add(q[c], sum);
            if OLD {
                let old = if is_last {
                    self.kept[c]
                } else {
                    L::load(token, &self.out[c][to..to + L::N])
                };
                sum = f.on_old.mul_add(old, sum);
            }
            if !SUMS {
                for k in 0..INPUTS {
                    let x = L::load(token, &self.inputs[k][c][from..from + L::N]);
                    sum = f.on_inputs[k].mul_add(x, sum);
                }
            }
            sum.store(&mut self.out[c][to..to + L::N]);
        }
        if SUMS {
            let h = five(
                #[inline(always)]
                |c| h[c] * weight,
            );
            let x = five(
                #[inline(always)]
                |c| L::load(token, &self.inputs[0][c][from..from + L::N]) * weight,
            );
            self.sums[0] = self.sums[0] + contract_lanes(&h, &h);
            self.sums[1] = self.sums[1] + contract_lanes(&h, &x);
            self.sums[2] = self.sums[2] + contract_lanes(&x, &x);
        }
    }
}

/// The double contraction.
#[inline(always)]
fn contract_lanes<L: Lanes>(a: &[L; 5], b: &[L; 5]) -> L {
    let trace_a = a[0] + a[3];
    let trace_b = b[0] + b[3];
    // a:b = xx xx' + yy yy' + (xx + yy)(xx' + yy') + 2 (off-diagonal products).
    let off = a[1].mul_add(b[1], a[2].mul_add(b[2], a[4] * b[4]));
    a[0].mul_add(
        b[0],
        a[3].mul_add(b[3], trace_a.mul_add(trace_b, off + off)),
    )
}
