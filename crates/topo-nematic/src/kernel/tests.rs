//! The kernel against its energy, against other threads and against single precision.

use super::run::{Combination, Kernel, Threads};
use crate::anchoring::{Anchoring, SurfacePattern};
use crate::boundary::{AnchoredSurface, Boundary, FreeParticle, FreeSurface};
use crate::domain::{Domain, Wall, Walls};
use crate::real::Real;
use crate::tensor::{Tensor5, contract, uniaxial};
use crate::{Faces, Grid, Material, Particle};

/// A reproducible field without any symmetry.
pub(crate) fn rough<T: Real>(n: usize) -> Vec<T> {
    crate::noise::noise(12345)
        .take(5 * n)
        .map(|x| T::of(0.3 * x))
        .collect()
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Ball {
    None,
    Cut(Boundary),
    Free(FreeSurface),
}

/// A kernel with walls along the axes marked: strong, weak, with values that differ from face to face.
pub(crate) fn kernel_with<T: Real>(
    second: bool,
    cells: [usize; 3],
    walled: [bool; 3],
    ball: Ball,
    threads: Threads,
) -> Kernel<T> {
    let faces = walled.map(|w| if w { Faces::Wall } else { Faces::Periodic });
    let grid = Grid::new(cells, 0.8, faces).unwrap();
    let material = Material {
        second_elastic_constant: (second && (ball == Ball::None || walled[0])).then_some(0.6),
        ..Default::default()
    };
    let mut walls: Walls = Default::default();
    for axis in 0..3 {
        let area = grid.n_cells() / cells[axis];
        for (up, conductance) in [(0, 2.0), (1, 0.7)] {
            if walled[axis] {
                let values = (0..area)
                    .map(|f| uniaxial(0.5, [0.6 * (f as f64).sin(), 0.8, 0.1 * axis as f64]))
                    .collect();
                walls[axis][up] = Some(Wall {
                    conductance,
                    values,
                });
            }
        }
    }
    let particle = Particle::central(&grid, 2.9);
    let pattern = SurfacePattern::Winding(3);
    let domain = match ball {
        Ball::None => Domain::new(grid, walls, |_| crate::domain::Kind::Regular),
        Ball::Cut(boundary) => {
            let particle = particle.unwrap();
            let surface = AnchoredSurface {
                grid: &grid,
                particle: &particle,
                pattern: &pattern,
                anchoring: Anchoring::Weak(3.0),
                boundary,
                material: &material,
            };
            Domain::new(grid, walls, |ijk| surface.kind(ijk))
        }
        Ball::Free(surface) => {
            let particle = particle.unwrap();
            let free = FreeParticle::new(&grid, &particle, surface);
            Domain::new(grid, walls, |ijk| free.kind(ijk))
        }
    };
    Kernel::new(
        domain,
        &material,
        [0.01, -0.02, 0.03, 0.005, 0.015],
        threads,
    )
}

fn kernel<T: Real>(
    cells: [usize; 3],
    walled: [bool; 3],
    ball: Ball,
    threads: Threads,
) -> Kernel<T> {
    kernel_with(false, cells, walled, ball, threads)
}

fn field_of<T: Real>(kernel: &Kernel<T>, q: &[T]) -> Vec<T> {
    let mut h = vec![T::of(0.0); q.len()];
    kernel.molecular_field(q, &mut h);
    h
}

pub(crate) const CASES: [([usize; 3], [bool; 3], Ball); 6] = [
    (
        [13, 12, 14],
        [false, false, true],
        Ball::Cut(Boundary::CutLink),
    ),
    (
        [16, 12, 14],
        [true, true, true],
        Ball::Cut(Boundary::NodeMask),
    ),
    ([14, 14, 14], [false; 3], Ball::Free(FreeSurface::CutCell)),
    (
        [18, 13, 14],
        [true, false, false],
        Ball::Free(FreeSurface::Staircase),
    ),
    ([5, 4, 6], [false, true, false], Ball::None),
    ([4, 7, 5], [true; 3], Ball::None),
];

#[test]
fn molecular_field_is_the_gradient_of_the_energy() {
    for (second, (cells, walled, ball)) in [false, true]
        .into_iter()
        .flat_map(|s| CASES.map(|c| (s, c)))
    {
        let kernel = kernel_with::<f64>(second, cells, walled, ball, Threads::One);
        let n = kernel.stride;
        let q: Vec<f64> = rough(n);
        let h = field_of(&kernel, &q);
        let mut direction: Vec<f64> = rough(n);
        direction.rotate_left(7);
        let mass = kernel.domain.masses();
        let at = |x: &[f64], cell: usize| -> Tensor5 { std::array::from_fn(|c| x[c * n + cell]) };
        let slope: f64 = (0..mass.len())
            .map(|cell| {
                -0.8_f64.powi(3) * mass[cell] * contract(&at(&h, cell), &at(&direction, cell))
            })
            .sum();
        let energy = |x: &[f64]| {
            let moved: Vec<f64> = q
                .iter()
                .zip(&direction)
                .map(|(q, d)| q + x[0] * d)
                .collect();
            kernel.energy(&moved).total()
        };
        let numeric = topo_core::finite_difference_gradient(energy, &[0.0], 1e-3)[0];
        let error = (slope / numeric - 1.0).abs();
        assert!(error < 1e-9, "{cells:?} {slope} {numeric}");
    }
}

#[test]
fn threads_give_the_same_bits() {
    for (cells, walled, ball) in CASES {
        let one = kernel::<f64>(cells, walled, ball, Threads::One);
        let all = kernel::<f64>(cells, walled, ball, Threads::All);
        let q: Vec<f64> = rough(one.stride);
        let pass = |kernel: &Kernel<f64>| {
            let mut out = q.clone();
            out.rotate_left(3);
            let what = Combination {
                on_q: 0.3,
                on_old: -0.2,
                on_field: 1.1,
                inputs: [(0.7, &q[..]), (-0.4, &q[..])],
                relaxing: false,
            };
            kernel.combine::<true, 2, false>(&q, &what, &mut out);
            let dots = Combination {
                inputs: [(0.0, &out[..])],
                relaxing: true,
                on_q: 0.0,
                on_old: 0.0,
                on_field: 1.0,
            };
            let mut h = q.clone();
            let sums = kernel.combine::<false, 1, true>(&q, &dots, &mut h);
            (out, h, sums, kernel.energy(&q))
        };
        let alone = pass(&one);
        for n_threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n_threads)
                .build()
                .unwrap();
            assert_eq!(alone, pool.install(|| pass(&all)));
        }
    }
}

#[test]
fn combinations_are_what_their_factors_say_in_place_and_at_ragged_ends() {
    for (cells, walled, ball) in CASES {
        let kernel = kernel::<f64>(cells, walled, ball, Threads::One);
        let n = kernel.stride;
        let q: Vec<f64> = rough(n);
        let h = field_of(&kernel, &q);
        let (mut old, mut x) = (q.clone(), q.clone());
        old.rotate_left(11);
        x.rotate_left(23);
        let mut out = old.clone();
        let what = Combination {
            on_q: 0.3,
            on_old: -0.2,
            on_field: 1.1,
            inputs: [(0.7, &x[..]), (-0.4, &q[..])],
            relaxing: false,
        };
        kernel.combine::<true, 2, false>(&q, &what, &mut out);
        let active: Vec<bool> = kernel.domain.masses().iter().map(|m| *m > 0.0).collect();
        for i in 0..5 * n {
            let wanted = if active.get(i % n) == Some(&true) {
                (0.3 - 0.4) * q[i] - 0.2 * old[i] + 1.1 * h[i] + 0.7 * x[i]
            } else {
                old[i]
            };
            assert!(
                (out[i] - wanted).abs() < 1e-12,
                "{cells:?} {i} {} {wanted}",
                out[i]
            );
        }
        let mut again = q.clone();
        let dots = Combination {
            on_q: 0.0,
            on_old: 0.0,
            on_field: 1.0,
            inputs: [(0.0, &x[..])],
            relaxing: false,
        };
        let sums = kernel.combine::<false, 1, true>(&q, &dots, &mut again);
        let at = |x: &[f64], cell: usize| -> Tensor5 { std::array::from_fn(|c| x[c * n + cell]) };
        let sum = |a: &[f64], b: &[f64]| -> f64 {
            (0..active.len())
                .filter(|c| active[*c])
                .map(|c| contract(&at(a, c), &at(b, c)))
                .sum()
        };
        for (found, wanted) in sums.iter().zip([sum(&h, &h), sum(&h, &x), sum(&x, &x)]) {
            assert!(
                (found - wanted).abs() < 1e-10 * wanted.abs().max(1.0),
                "{found} {wanted}"
            );
        }
    }
}

#[test]
fn single_precision_agrees_to_its_rounding() {
    for (cells, walled, ball) in CASES {
        let double = kernel::<f64>(cells, walled, ball, Threads::One);
        let single = kernel::<f32>(cells, walled, ball, Threads::One);
        let n = double.domain.grid.n_cells();
        let q: Vec<f32> = rough(single.stride);
        let (mut flat, mut wide) = (vec![0.0; 5 * n], vec![0.0; double.array_length()]);
        single.gather(&q, &mut flat);
        double.spread(&flat, &mut wide);
        let (mut a, mut b) = (flat.clone(), flat);
        double.gather(&field_of(&double, &wide), &mut a);
        single.gather(&field_of(&single, &q), &mut b);
        let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (x, y) in a.iter().zip(&b) {
            assert!((x - y).abs() < 1e-6 * largest, "{x} {y}");
        }
        let (a, b) = (double.energy(&wide).total(), single.energy(&q).total());
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    }
}
