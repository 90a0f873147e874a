//! The Hessian against differences of the molecular field, its lowest mode against a dense solver.

use super::*;
use crate::kernel::run::Threads;
use crate::kernel::tests::{CASES, kernel_with, rough};

#[test]
fn hessian_is_the_derivative_of_the_molecular_field() {
    for (second, (cells, walled, ball)) in [false, true]
        .into_iter()
        .flat_map(|s| CASES.map(|c| (s, c)))
    {
        let kernel = kernel_with::<f64>(second, cells, walled, ball, Threads::One);
        let n = kernel.array_length();
        let q: Vec<f64> = rough(kernel.stride);
        let mut change: Vec<f64> = rough(kernel.stride);
        change.rotate_left(11);
        let masses = kernel.domain.masses();
        for (cell, mass) in masses.iter().enumerate() {
            if *mass == 0.0 {
                (0..5).for_each(|c| change[c * kernel.stride + cell] = 0.0);
            }
        }
        // a cubic: central differences at two steps give its derivative to rounding
        let difference = |step: f64| -> Vec<f64> {
            let at = |sign: f64| {
                let moved: Vec<f64> = (q.iter().zip(&change))
                    .map(|(q, p)| q + sign * step * p)
                    .collect();
                let mut h = vec![0.0; n];
                kernel.molecular_field(&moved, &mut h);
                h
            };
            let (up, down) = (at(1.0), at(-1.0));
            (up.iter().zip(&down))
                .map(|(u, d)| (d - u) / (2.0 * step))
                .collect()
        };
        let (near, far) = (difference(0.1), difference(0.2));
        let hessian = Hessian::new(&kernel, &q);
        let mut found = vec![0.0; n];
        let along = hessian.apply(&change, &mut found);
        let mut exact = 0.0;
        for (cell, mass) in masses.iter().enumerate().filter(|(_, m)| **m > 0.0) {
            let at =
                |x: &[f64]| -> Tensor5 { std::array::from_fn(|c| x[c * kernel.stride + cell]) };
            let (near, far, found) = (at(&near), at(&far), at(&found));
            for c in 0..5 {
                let wanted = (4.0 * near[c] - far[c]) / 3.0;
                assert!(
                    (found[c] - wanted).abs() < 1e-11 * (1.0 + wanted.abs()),
                    "{cells:?} {cell} {c}: {} {wanted}",
                    found[c]
                );
            }
            exact += mass * contract(&at_cell(&change, kernel.stride, cell), &found);
        }
        assert!(
            (along - exact).abs() < 1e-10 * exact.abs(),
            "{along} {exact}"
        );
    }
}

fn at_cell(x: &[f64], stride: usize, cell: usize) -> Tensor5 {
    std::array::from_fn(|c| x[c * stride + cell])
}

#[test]
fn hessian_is_symmetric_and_the_same_for_any_number_of_threads() {
    for (cells, walled, ball) in CASES {
        let kernel = kernel_with::<f64>(true, cells, walled, ball, Threads::One);
        let all = kernel_with::<f64>(true, cells, walled, ball, Threads::All);
        let (n, stride) = (kernel.array_length(), kernel.stride);
        let q: Vec<f64> = rough(stride);
        let masses = kernel.domain.masses();
        let change = |shift: usize| {
            let mut p: Vec<f64> = rough(stride);
            p.rotate_left(shift);
            for cell in (0..masses.len()).filter(|cell| masses[*cell] == 0.0) {
                (0..5).for_each(|c| p[c * stride + cell] = 0.0);
            }
            p
        };
        let (a, b) = (change(3), change(17));
        let product = |kernel: &Kernel<f64>, p: &[f64]| {
            let mut out = vec![0.0; n];
            let along = Hessian::new(kernel, &q).apply(p, &mut out);
            (along, out)
        };
        let inner = |x: &[f64], y: &[f64]| -> f64 {
            let of = |cell: usize| {
                masses[cell] * contract(&at_cell(x, stride, cell), &at_cell(y, stride, cell))
            };
            (0..masses.len()).map(of).sum()
        };
        let (_, on_a) = product(&kernel, &a);
        let (_, on_b) = product(&kernel, &b);
        let [ab, ba] = [inner(&b, &on_a), inner(&a, &on_b)];
        assert!(
            (ab - ba).abs() < 1e-11 * ab.abs().max(inner(&a, &a)),
            "{ab} {ba}"
        );
        for n_threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads);
            let pool = pool.build().unwrap();
            let shared = pool.install(|| product(&all, &a));
            assert_eq!(product(&kernel, &a), shared, "{cells:?} {n_threads}");
        }
    }
}
