//! Free energy by part.

use fearless_simd::Simd;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::domain::SpecialCell;
use crate::kernel::run::{Kernel, Place, Threads};
use crate::real::Real;
use crate::tensor::{Tensor5, contract};
use crate::vector::dispatch;

/// Free energy by part, all in L ξ_N; the bulk part counts from the uniform equilibrium.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyParts {
    /// Distortion: L/2 (∂Q)² and the second elastic term.
    pub elastic: f64,
    /// Order: the terms in A, B and C.
    pub bulk: f64,
    /// Weak anchoring.
    pub surface: f64,
    /// External field.
    pub field: f64,
}

impl EnergyParts {
    /// Names of the parts, as tables use them.
    pub const NAMES: [&'static str; 4] = ["elastic", "bulk", "surface", "field"];

    /// All parts together.
    pub fn total(&self) -> f64 {
        self.elastic + self.bulk + self.surface + self.field
    }

    /// In the order of the names.
    pub fn as_array(&self) -> [f64; 4] {
        [self.elastic, self.bulk, self.surface, self.field]
    }
}

impl<T: Real> Kernel<T> {
    /// Free energy of `q`.
    ///
    /// ```math
    /// F = h^3 \sum_{\text{cells}} \varphi\, f(Q) + \frac{L h}{2} \sum_{\text{links}} w\, |Q_a - Q_b|^2
    /// ```
    ///
    /// φ is the fluid share of a cell and w the weight of a link. Links count half with each of their two cells; sums are made
    /// plane by plane, so that the result does not depend on the number of threads.
    pub(crate) fn energy(&self, q: &[T]) -> EnergyParts {
        let nz = self.domain.grid.cells()[2];
        let plane = |k: usize| dispatch!(self.level(), simd => self.plane_energy(simd, k, q));
        let planes: Vec<[f64; 4]> = match self.threads {
            Threads::One => (0..nz).map(plane).collect(),
            Threads::All => (0..nz).into_par_iter().map(plane).collect(),
        };
        let mut sum = [0.0; 4];
        for p in planes {
            sum.iter_mut().zip(p).for_each(|(s, x)| *s += x);
        }
        let h = self.domain.grid.spacing();
        let link = 0.5 * self.material().elastic_constant * h;
        EnergyParts {
            elastic: link * sum[0] + self.second_energy(q),
            bulk: h * h * h * sum[1],
            surface: link * sum[2],
            field: h * h * h * sum[3],
        }
    }

    /// Sums over a plane: squares of differences, bulk density, squares of anchored differences, field density.
    #[inline(always)]
    fn plane_energy<S: Simd>(&self, _simd: S, k: usize, q: &[T]) -> [f64; 4] {
        let grid = &self.domain.grid;
        let [nx, ny, _] = grid.cells();
        let n = self.stride;
        let m = self.material();
        let reference = m.reference_density();
        // The trace of Q³ is three times the determinant.
        let (half_a, b, quarter_c) = (0.5 * m.a, m.b, 0.25 * m.c);
        let mut sums = [0.0; 4];
        let mut ghosts = vec![T::of(0.0); 20 * nx];
        let has_field = self.field().iter().any(|e| *e != 0.0);
        for run in self.domain.runs_of(k) {
            let (start, length) = (run.start as usize, run.length as usize);
            let j = start / nx % ny;
            self.write_ghosts(q, start, length, [j, k], &mut ghosts);
            let sides = self.side_rows(q, start, length, [j, k], &ghosts);
            let place = Place {
                start,
                length,
                local: start,
            };
            let ends = self.ends(q, &place, [j, k]);
            let centre = self.components(q).map(|s| &s[start..start + length]);
            // A link to a wall of conductance c shows as a step of c times the difference, and is not shared.
            let share = |conductance: Option<f64>| match conductance {
                None => 0.5,
                Some(c) if c > 0.0 => 1.0 / c,
                Some(_) => 0.0,
            };
            let beyond = self
                .beyond([j, k])
                .map(|wall| share(wall.map(|w| w.conductance)));
            let [left, right] = self.end_walls(start, length).map(share);
            let mut bulk = [0.0_f64; WIDTH];
            let density = |xx: T, xy: T, xz: T, yy: T, yz: T| {
                let (xx, xy, xz): (f64, f64, f64) = (xx.into(), xy.into(), xz.into());
                let (yy, yz): (f64, f64) = (yy.into(), yz.into());
                let zz = -xx - yy;
                let t = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
                let determinant =
                    xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
                t * (half_a + quarter_c * t) + b * determinant - reference
            };
            let [
                (xx, xx_end),
                (xy, xy_end),
                (xz, xz_end),
                (yy, yy_end),
                (yz, yz_end),
            ] = centre.map(<[T]>::as_chunks::<WIDTH>);
            for ((((xx, xy), xz), yy), yz) in xx.iter().zip(xy).zip(xz).zip(yy).zip(yz) {
                for lane in 0..WIDTH {
                    bulk[lane] += density(xx[lane], xy[lane], xz[lane], yy[lane], yz[lane]);
                }
            }
            let rest: f64 = (0..xx_end.len())
                .map(|i| density(xx_end[i], xy_end[i], xz_end[i], yy_end[i], yz_end[i]))
                .sum();
            let bulk: f64 = bulk.iter().sum::<f64>() + rest;
            sums[1] += bulk;
            if has_field {
                for i in 0..length {
                    let here: Tensor5 = centre.map(|s| s[i].into());
                    sums[3] -= contract(self.field(), &here);
                }
            }
            for (side, weight) in sides.iter().zip(beyond) {
                sums[0] += weight * squares(&centre, side);
            }
            if length > 1 {
                let inner = squares(&centre.map(|s| &s[1..]), &centre.map(|s| &s[..length - 1]));
                sums[0] += inner;
            }
            for (cell, end, weight) in [(0, 0, left), (length - 1, 1, right)] {
                let here: Tensor5 = centre.map(|s| s[cell].into());
                let there: Tensor5 = ends[end].map(Into::into);
                sums[0] += weight * square_of_difference(&here, &there);
            }
        }
        for special in self.domain.special_of(k) {
            let part = self.special_energy(q, n, special);
            sums.iter_mut().zip(part).for_each(|(s, x)| *s += x);
        }
        sums
    }

    fn special_energy(&self, q: &[T], n: usize, special: &SpecialCell) -> [f64; 4] {
        let value = |cell: usize| -> Tensor5 { std::array::from_fn(|c| q[c * n + cell].into()) };
        let here = value(special.cell as usize);
        let links: f64 = (special.weights.iter().zip(special.neighbours))
            .map(|(w, other)| 0.5 * w * square_of_difference(&here, &value(other as usize)))
            .sum();
        let fixed = special.sink * contract(&here, &here) - 2.0 * contract(&here, &special.source)
            + special.offset;
        [
            links + (1.0 - special.anchored) * fixed,
            special.volume * self.material().bulk_density(&here),
            special.anchored * fixed,
            -special.volume * contract(self.field(), &here),
        ]
    }
}

fn square_of_difference(a: &Tensor5, b: &Tensor5) -> f64 {
    let d: Tensor5 = std::array::from_fn(|c| a[c] - b[c]);
    contract(&d, &d)
}

/// Sums side by side, so that additions need not wait for each other.
const WIDTH: usize = 8;

/// Sum of squares of differences, in the metric of the tensors.
#[inline(always)]
fn squares<T: Real>(a: &[&[T]; 5], b: &[&[T]; 5]) -> f64 {
    let n = a[0].len();
    // fixed lengths let the compiler use wide vectors
    let [
        (xx, xx_end),
        (xy, xy_end),
        (xz, xz_end),
        (yy, yy_end),
        (yz, yz_end),
    ] = a.map(|s| s[..n].as_chunks::<WIDTH>());
    let [
        (xx2, xx2_end),
        (xy2, xy2_end),
        (xz2, xz2_end),
        (yy2, yy2_end),
        (yz2, yz2_end),
    ] = b.map(|s| s[..n].as_chunks::<WIDTH>());
    let mut sums = [0.0_f64; WIDTH];
    let first = xx.iter().zip(xy).zip(xz).zip(yy).zip(yz);
    let second = xx2.iter().zip(xy2).zip(xz2).zip(yy2).zip(yz2);
    for (((((xx, xy), xz), yy), yz), ((((xx2, xy2), xz2), yy2), yz2)) in first.zip(second) {
        for lane in 0..WIDTH {
            let dxx: f64 = (xx[lane] - xx2[lane]).into();
            let dyy: f64 = (yy[lane] - yy2[lane]).into();
            let dxy: f64 = (xy[lane] - xy2[lane]).into();
            let dxz: f64 = (xz[lane] - xz2[lane]).into();
            let dyz: f64 = (yz[lane] - yz2[lane]).into();
            let dzz = dxx + dyy;
            sums[lane] +=
                dxx * dxx + dyy * dyy + dzz * dzz + 2.0 * (dxy * dxy + dxz * dxz + dyz * dyz);
        }
    }
    for at in 0..xx_end.len() {
        let d: Tensor5 = [
            (xx_end[at] - xx2_end[at]).into(),
            (xy_end[at] - xy2_end[at]).into(),
            (xz_end[at] - xz2_end[at]).into(),
            (yy_end[at] - yy2_end[at]).into(),
            (yz_end[at] - yz2_end[at]).into(),
        ];
        sums[0] += contract(&d, &d);
    }
    sums.iter().sum()
}
