//! Defect lines: where the director turns by half a turn around a square of cells.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::directors::Directors;
use crate::tensor::{Tensor5, matrix};
use crate::{Faces, Grid, NematicState};

/// What a plane across a defect line shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CrossSection {
    /// The director turns with the way around the line.
    PlusHalf,
    /// It turns against it.
    MinusHalf,
    /// It turns about an axis across the line.
    Twisted,
}

/// A disclination line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DefectLine {
    /// Points along it (ξ_N), continued through periodic faces rather than cut there.
    pub points: Vec<[f64; 3]>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// Cosine of the angle between the axis about which the director turns and the tangent, at each point: 1, -1, 0 for the three
    /// cross-sections.
    pub cosine: Vec<f64>,
    /// Length (ξ_N).
    pub length: f64,
}

impl DefectLine {
    /// Cross-section at a point.
    ///
    /// # Panics
    /// When there is no such point.
    pub fn cross_section(&self, point: usize) -> CrossSection {
        match self.cosine[point] {
            c if c > 0.5 => CrossSection::PlusHalf,
            c if c < -0.5 => CrossSection::MinusHalf,
            _ => CrossSection::Twisted,
        }
    }
}

/// A square of four cell centres: its lowest cell and the axis it is normal to.
type Square = (usize, usize);

/// Defect lines of a state, longest first.
///
/// A line pierces a square of cells when the director, followed around it, comes back reversed. A cube of cells has an even
/// number of such squares, so lines end only at walls and at the particle. Points are moved to the centre of low order nearby.
/// The cross-section follows from a tensor: its trace over its norm is the cosine of the angle β between the axis of rotation
/// and the tangent.
///
/// ```math
/// D_{\gamma i} = \varepsilon_{\gamma\mu\nu}\, \varepsilon_{i l k}\, \partial_l Q_{\mu\alpha}\, \partial_k Q_{\nu\alpha}, \qquad \cos\beta = \operatorname{tr} D/|D|
/// ```
///
/// # Validation
/// `straight_lines_have_their_cross_sections`
///
/// # References
/// [schimming2022]
///
/// [schimming2022]: https://doi.org/10.1039/D1SM01584B
pub fn defect_lines(state: &NematicState) -> Vec<DefectLine> {
    let tracer = Tracer::new(state);
    let squares = tracer.pierced_squares();
    // Cubes, and the pierced squares on them.
    let mut cubes: HashMap<usize, Vec<Square>> = HashMap::new();
    for square in &squares {
        for cube in tracer.cubes_of(*square).into_iter().flatten() {
            cubes.entry(cube).or_default().push(*square);
        }
    }
    let mut used: HashMap<Square, bool> = squares.iter().map(|s| (*s, false)).collect();
    // Open lines first, from their ends, so that none is cut in two.
    let is_end = |s: &Square| tracer.cubes_of(*s).iter().any(Option::is_none);
    let (ends, others): (Vec<Square>, Vec<Square>) = squares.iter().partition(|s| is_end(s));
    let mut lines = Vec::new();
    for first in ends.iter().chain(&others) {
        if used[first] {
            continue;
        }
        used.insert(*first, true);
        let mut chain = vec![*first];
        let mut here = *first;
        let mut came_from = None;
        let closed = loop {
            let cubes_here = tracer.cubes_of(here);
            let forward = cubes_here
                .into_iter()
                .flatten()
                .find(|cube| Some(*cube) != came_from);
            let Some(cube) = forward else { break false };
            let next = cubes[&cube].iter().find(|s| !used[*s]).copied();
            match next {
                Some(square) => {
                    used.insert(square, true);
                    chain.push(square);
                    here = square;
                    came_from = Some(cube);
                }
                None => break cubes[&cube].contains(first) && chain.len() > 2,
            }
        };
        lines.push(tracer.line(&chain, closed));
    }
    lines.sort_by(|a, b| b.length.total_cmp(&a.length));
    lines
}

struct Tracer<'a> {
    state: &'a NematicState,
    grid: &'a Grid,
    director: [Vec<f64>; 3],
    order: Vec<f64>,
    fluid: Vec<bool>,
    largest: f64,
}

impl<'a> Tracer<'a> {
    fn new(state: &'a NematicState) -> Self {
        let grid = state.grid();
        let [nx, ny, nz] = grid.cells();
        let n = grid.n_cells();
        let Directors {
            order, director, ..
        } = Directors::of(state);
        let mut fluid = Vec::with_capacity(n);
        for k in 0..nz {
            for j in 0..ny {
                fluid.extend((0..nx).map(state.fluid_in_row(j, k)));
            }
        }
        let largest = order.iter().copied().fold(0.0, f64::max);
        Self {
            state,
            grid,
            director,
            order,
            fluid,
            largest,
        }
    }

    /// The cell `steps` away along `axis`; none beyond a wall.
    fn step(&self, cell: usize, axis: usize, steps: isize) -> Option<usize> {
        let [nx, ny, _] = self.grid.cells();
        let (stride, n) = ([1, nx, nx * ny][axis], self.grid.cells()[axis]);
        let at = (cell / stride % n) as isize;
        let to = at + steps;
        let inside = (0..n as isize).contains(&to);
        let to = match self.grid.faces()[axis] {
            _ if inside => to,
            Faces::Periodic => to.rem_euclid(n as isize),
            Faces::Wall => return None,
        };
        Some(cell.wrapping_add_signed((to - at) * stride as isize))
    }

    /// The four cells around a square, if all are fluid.
    fn corners(&self, (cell, axis): Square) -> Option<[usize; 4]> {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let first = self.step(cell, a, 1)?;
        let corners = [cell, first, self.step(first, b, 1)?, self.step(cell, b, 1)?];
        corners.iter().all(|c| self.fluid[*c]).then_some(corners)
    }

    /// In ascending order.
    fn pierced_squares(&self) -> Vec<Square> {
        let mut squares = Vec::new();
        for cell in 0..self.grid.n_cells() {
            // Far from defects the director turns little from cell to cell.
            if self.order[cell] > 0.95 * self.largest || !self.fluid[cell] {
                continue;
            }
            for axis in 0..3 {
                let around = self.corners((cell, axis));
                if around.is_some_and(|corners| self.is_reversed(&corners)) {
                    squares.push((cell, axis));
                }
            }
        }
        squares
    }

    fn is_reversed(&self, corners: &[usize; 4]) -> bool {
        let mut reversals = 0;
        for side in 0..4 {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            let along: f64 = self.director.iter().map(|d| d[a] * d[b]).sum();
            reversals += u32::from(along < 0.0);
        }
        reversals % 2 == 1
    }

    /// The cubes of eight fluid cells on both sides of a square, by their lowest cell.
    fn cubes_of(&self, (cell, axis): Square) -> [Option<usize>; 2] {
        let above = Some(cell).filter(|c| self.is_fluid_cube(*c));
        let below = self.step(cell, axis, -1).filter(|c| self.is_fluid_cube(*c));
        [below, above]
    }

    fn is_fluid_cube(&self, cell: usize) -> bool {
        let Some(next) = self.step(cell, 2, 1) else {
            return false;
        };
        self.corners((cell, 2)).is_some() && self.corners((next, 2)).is_some()
    }

    fn line(&self, chain: &[Square], closed: bool) -> DefectLine {
        let extent = self.grid.extent();
        let mut points: Vec<[f64; 3]> = Vec::with_capacity(chain.len());
        let mut cosine = Vec::with_capacity(chain.len());
        let follow = |from: [f64; 3], to: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|x| match self.grid.faces()[x] {
                Faces::Wall => to[x],
                Faces::Periodic => to[x] - extent[x] * ((to[x] - from[x]) / extent[x]).round(),
            })
        };
        for square in chain {
            let mut point = self.centre_of_low_order(*square);
            if let Some(last) = points.last() {
                point = follow(*last, point);
            }
            points.push(point);
            cosine.push(self.cosine(*square));
        }
        let (points, cosine) = (smoothed(&points, closed), smoothed_numbers(&cosine, closed));
        let mut length: f64 = points.windows(2).map(|p| distance(p[0], p[1])).sum();
        if let (true, Some(first), Some(last)) = (closed, points.first(), points.last()) {
            length += distance(*last, follow(*last, *first));
        }
        DefectLine {
            points,
            closed,
            cosine,
            length,
        }
    }

    /// Mean of the cells near a square, weighted by how much order they lack.
    fn centre_of_low_order(&self, square: Square) -> [f64; 3] {
        let (cell, axis) = square;
        let [nx, ny, _] = self.grid.cells();
        let h = self.grid.spacing();
        let origin = self
            .grid
            .centre([cell % nx, cell / nx % ny, cell / (nx * ny)]);
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mut sum, mut weights) = ([0.0; 2], 0.0);
        for da in -1..=2_isize {
            for db in -1..=2_isize {
                let near = (self.step(cell, a, da)).and_then(|c| self.step(c, b, db));
                let Some(near) = near.filter(|c| self.fluid[*c]) else {
                    continue;
                };
                let weight = (self.largest - self.order[near]).max(0.0).powi(3);
                weights += weight;
                sum[0] += weight * da as f64;
                sum[1] += weight * db as f64;
            }
        }
        let middle = if weights > 0.0 {
            sum.map(|s| (s / weights).clamp(-0.5, 1.5))
        } else {
            [0.5; 2]
        };
        let mut point = origin;
        point[a] += h * middle[0];
        point[b] += h * middle[1];
        point
    }

    /// tr D/|D| with D summed over the corners of a square.
    fn cosine(&self, square: Square) -> f64 {
        let mut d = nalgebra::Matrix3::<f64>::zeros();
        for cell in self.corners(square).into_iter().flatten() {
            let slopes: [nalgebra::Matrix3<f64>; 3] =
                std::array::from_fn(|axis| matrix(&self.slope(cell, axis)));
            for i in 0..3 {
                let (l, k) = ((i + 1) % 3, (i + 2) % 3);
                // Both orders of (l, k) give the same.
                let product = slopes[l] * slopes[k].transpose();
                for g in 0..3 {
                    let (m, n) = ((g + 1) % 3, (g + 2) % 3);
                    d[(g, i)] += 2.0 * (product[(m, n)] - product[(n, m)]);
                }
            }
        }
        let size = d.norm();
        if size > 0.0 { d.trace() / size } else { 0.0 }
    }

    /// Difference of the tensors at both sides of a cell, one-sided at walls and at the particle.
    fn slope(&self, cell: usize, axis: usize) -> Tensor5 {
        let fluid = |steps| {
            self.step(cell, axis, steps)
                .filter(|c| self.fluid[*c])
                .unwrap_or(cell)
        };
        let (up, down) = (fluid(1), fluid(-1));
        let scale = if up != cell && down != cell { 0.5 } else { 1.0 };
        let (up, down) = (self.state.tensor(up), self.state.tensor(down));
        std::array::from_fn(|c| scale * (up[c] - down[c]))
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    crate::boundary::shares::norm(std::array::from_fn(|x| a[x] - b[x]))
}

/// Two passes of a (1, 2, 1)/4 filter, ends kept.
fn smoothed(points: &[[f64; 3]], closed: bool) -> Vec<[f64; 3]> {
    let mut columns: [Vec<f64>; 3] = Default::default();
    // A closed line that goes through a periodic face does not come back to its first point: filter it as open.
    let gap = match (points.first(), points.last()) {
        (Some(a), Some(b)) => distance(*a, *b),
        _ => 0.0,
    };
    let mean =
        points.windows(2).map(|p| distance(p[0], p[1])).sum::<f64>() / points.len().max(1) as f64;
    for (x, column) in columns.iter_mut().enumerate() {
        let values: Vec<f64> = points.iter().map(|p| p[x]).collect();
        *column = smoothed_numbers(&values, closed && gap < 5.0 * mean);
    }
    (0..points.len())
        .map(|i| [columns[0][i], columns[1][i], columns[2][i]])
        .collect()
}

fn smoothed_numbers(values: &[f64], closed: bool) -> Vec<f64> {
    let n = values.len();
    let mut old = values.to_vec();
    for _ in 0..2 {
        let new = (0..n)
            .map(|i| {
                if n < 3 || (!closed && (i == 0 || i + 1 == n)) {
                    return old[i];
                }
                0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n]
            })
            .collect();
        old = new;
    }
    old
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;

    /// A straight line along z in the middle of a periodic-looking box; the director turns by half a turn about `axis`.
    fn state(turn: f64, axis: [f64; 3]) -> NematicState {
        let grid = Grid::new(
            [16, 16, 8],
            1.0,
            [Faces::Wall, Faces::Wall, Faces::Periodic],
        )
        .unwrap();
        let axis = nalgebra::Vector3::from(axis).normalize();
        let start = if axis.z.abs() < 0.5 {
            nalgebra::Vector3::z()
        } else {
            nalgebra::Vector3::x()
        };
        let e1 = (start - axis * axis.dot(&start)).normalize();
        let e2 = axis.cross(&e1);
        NematicState::from_fn(grid, None, |[x, y, _]| {
            let (dx, dy) = (x - 8.2, y - 7.9);
            let angle = turn * dy.atan2(dx);
            let n = e1 * angle.cos() + e2 * angle.sin();
            let order = 0.5 * (dx.hypot(dy) / 2.0).tanh();
            uniaxial(order, [n.x, n.y, n.z])
        })
        .unwrap()
    }

    #[test]
    fn straight_lines_have_their_cross_sections() {
        let cases = [
            (0.5, [0.0, 0.0, 1.0], CrossSection::PlusHalf),
            (-0.5, [0.0, 0.0, 1.0], CrossSection::MinusHalf),
            (0.5, [1.0, 0.0, 0.0], CrossSection::Twisted),
            (0.5, [0.0, 1.0, 0.0], CrossSection::Twisted),
        ];
        for (turn, axis, wanted) in cases {
            let lines = defect_lines(&state(turn, axis));
            assert_eq!(lines.len(), 1, "{wanted:?}: {}", lines.len());
            let line = &lines[0];
            assert!(line.closed, "through the periodic faces");
            assert!((line.length - 8.0).abs() < 1e-9, "{}", line.length);
            for (i, p) in line.points.iter().enumerate() {
                assert!(
                    (p[0] - 8.2).abs() < 0.25 && (p[1] - 7.9).abs() < 0.25,
                    "{p:?}"
                );
                assert_eq!(line.cross_section(i), wanted, "{}", line.cosine[i]);
            }
        }
    }

    /// An arch in the plane y = 8: its feet stand on the upper wall, +1/2 on one side and -1/2 on the other, and meet at z = 4.
    fn arch() -> NematicState {
        let grid = Grid::new([24, 16, 18], 1.0, [Faces::Wall; 3]).unwrap();
        NematicState::from_fn(grid, None, |[x, y, z]| {
            let half = 1.7 * (z - 4.0).max(0.0).sqrt();
            let angle = |foot: f64| (y - 8.1).atan2(x - foot);
            let turn = 0.5 * (angle(12.2 - half) - angle(12.2 + half));
            let nearest = (x - 12.2).abs() - half;
            let core = nearest.hypot(y - 8.1) + (4.0 - z).max(0.0);
            uniaxial(0.5 * (core / 2.0).tanh(), [turn.cos(), turn.sin(), 0.0])
        })
        .unwrap()
    }

    #[test]
    fn an_arch_is_one_open_line_of_both_kinds() {
        // The lowest pierced squares are those of its crown: a line begun there would be cut in two.
        let lines = defect_lines(&arch());
        assert_eq!(lines.len(), 1);
        let line = &lines[0];
        assert!(!line.closed);
        let (first, last) = (0, line.points.len() - 1);
        let feet = [line.points[first], line.points[last]];
        assert!(feet.iter().all(|p| p[2] > 16.5), "{feet:?}");
        let apart = (feet[0][0] - feet[1][0]).abs();
        assert!((apart - 2.0 * 1.7 * 13.0_f64.sqrt()).abs() < 1.0, "{apart}");
        let kinds = [first, last].map(|i| line.cross_section(i));
        let both = [CrossSection::PlusHalf, CrossSection::MinusHalf];
        assert!(kinds == both || kinds == [both[1], both[0]], "{kinds:?}");
        let lowest = |i: &usize| line.points[*i][2];
        let crown = (first..=last).min_by(|a, b| lowest(a).total_cmp(&lowest(b)));
        let crown = crown.unwrap();
        assert_eq!(line.cross_section(crown), CrossSection::Twisted);
        assert!((lowest(&crown) - 4.0).abs() < 1.0, "{}", lowest(&crown));
    }

    #[test]
    fn smoothing_is_binomial_and_leaves_ends_and_straight_lines() {
        let peak = |at: usize| -> Vec<f64> { (0..7).map(|i| f64::from(i == at)).collect() };
        // Two passes of 1 2 1 are 1 4 6 4 1, around the seam as well.
        let weights = [6.0, 4.0, 1.0, 0.0, 0.0, 1.0, 4.0].map(|w| w / 16.0);
        assert_eq!(smoothed_numbers(&peak(0), true), weights);
        let mut turned = weights;
        turned.rotate_right(5);
        assert_eq!(smoothed_numbers(&peak(5), true), turned);
        let line: Vec<f64> = (0..9).map(|i| 0.5 * f64::from(i) - 1.0).collect();
        assert_eq!(smoothed_numbers(&line, false), line);
        assert_eq!(smoothed_numbers(&[3.0, 7.0], true), [3.0, 7.0]);
    }

    #[test]
    fn a_uniform_field_has_no_lines() {
        let grid = Grid::new([8; 3], 1.0, [Faces::Periodic; 3]).unwrap();
        let uniform =
            NematicState::from_fn(grid, None, |_| uniaxial(0.5, [1.0, 0.0, 0.0])).unwrap();
        assert!(defect_lines(&uniform).is_empty());
        let isotropic = NematicState::from_fn(grid, None, |_| [0.0; 5]).unwrap();
        assert!(defect_lines(&isotropic).is_empty());
    }
}
