//! The defect ring around the particle: radius, height and the modes of its undulation.

use serde::{Deserialize, Serialize};

use crate::boundary::shares::norm;
use crate::tensor::{is_ordered_above, largest_eigenvalue};
use crate::{NematicState, Particle};

/// Number of azimuthal sectors in which the ring is looked for.
const N_SECTORS: usize = 128;
/// Highest mode of the height that is kept.
const N_MODES: usize = 40;

/// A ring of low order around the vertical axis of the particle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ring {
    /// Mean distance from the vertical axis, in ξ_N.
    pub radius: f64,
    /// Mean height above the particle's centre, in ξ_N.
    pub height: f64,
    /// Amplitudes of the modes m = 1, 2, ... of its height z(φ), in ξ_N.
    pub modes: Vec<f64>,
}

impl Ring {
    /// The strongest mode of its height.
    pub fn mode(&self) -> usize {
        let best = self.modes.iter().enumerate();
        best.max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0, |(m, _)| m + 1)
    }

    /// Amplitude of the strongest mode, in ξ_N.
    pub fn amplitude(&self) -> f64 {
        self.modes.iter().copied().fold(0.0, f64::max)
    }
}

/// The ring of a state: in each azimuthal sector the centre of the cells whose order is below `threshold`, weighted by how far below.
///
/// None without a particle, when sectors without such cells show that no closed ring surrounds it, or when such cells are
/// elsewhere: at the poles, at the edge of the cell, everywhere.
///
/// # Validation
/// `only_low_order_around_the_particle_is_a_ring`, `undulations_of_a_ring_have_their_amplitudes_modes_and_place`
pub fn ring(state: &NematicState, threshold: f64) -> Option<Ring> {
    let sectors = sectors(state, threshold)?;
    let n = N_SECTORS as f64;
    let radius = sectors.iter().map(|s| s[0]).sum::<f64>() / n;
    let heights: Vec<f64> = sectors.iter().map(|s| s[1]).collect();
    let height = heights.iter().sum::<f64>() / n;
    let mode = |m: usize| {
        let (mut a, mut b) = (0.0, 0.0);
        for (s, z) in heights.iter().enumerate() {
            let angle = std::f64::consts::TAU * m as f64 * (s as f64 + 0.5) / n;
            a += z * angle.cos();
            b += z * angle.sin();
        }
        2.0 * a.hypot(b) / n
    };
    Some(Ring {
        radius,
        height,
        modes: (1..=N_MODES).map(mode).collect(),
    })
}

/// The closed line of the ring, relative to the particle's centre (ξ_N): one point per sector of azimuth.
///
/// Where the core of a disclination touches the particle, [`defect_lines`](crate::defects::defect_lines) ends; this line
/// continues.
pub fn ring_line(state: &NematicState, threshold: f64) -> Option<Vec<[f64; 3]>> {
    let points = sectors(state, threshold)?.into_iter().enumerate();
    Some(points.map(|(s, centre)| place(s, centre)).collect())
}

/// Whether a point, relative to the particle's centre, is nearer to the particle than to the outer faces of the cell, periodic
/// ones included: what is beyond is not the particle's ring. False without a particle.
pub fn is_near_particle(state: &NematicState, point: [f64; 3]) -> bool {
    let Some(particle) = state.particle() else {
        return false;
    };
    let (extent, centre) = (state.grid().extent(), particle.centre());
    let to_face = |axis: usize| {
        let x = centre[axis] + point[axis];
        x.min(extent[axis] - x)
    };
    let nearest = (0..3).map(to_face).fold(f64::INFINITY, f64::min);
    norm(point) - particle.radius() < nearest
}

/// A cell of low order, seen from the axis.
struct LowCell {
    /// Distance from the axis and height.
    place: [f64; 2],
    weight: f64,
    /// The sectors that it covers, so that none is missed by chance.
    sectors: std::ops::RangeInclusive<i64>,
}

/// The fluid cells whose order is below `threshold`.
fn low_cells(state: &NematicState, particle: &Particle, threshold: f64) -> Vec<LowCell> {
    let grid = state.grid();
    let mut low = Vec::new();
    let [nx, ny, nz] = grid.cells();
    let (q, n) = (state.q_tensor(), grid.n_cells());
    // most cells are ordered: a plain loop along the row says so first
    let mut may_be_low = vec![false; nx];
    for k in 0..nz {
        for j in 0..ny {
            let first = grid.index([0, j, k]);
            let row: [&[f64]; 5] = std::array::from_fn(|c| &q[c * n + first..][..nx]);
            for (i, low) in may_be_low.iter_mut().enumerate() {
                *low = !is_ordered_above(&row.map(|c| c[i]), threshold);
            }
            let is_fluid = state.fluid_in_row(j, k);
            for i in (0..nx).filter(|i| may_be_low[*i] && is_fluid(*i)) {
                let tensor = row.map(|c| c[i]);
                let order = largest_eigenvalue(&tensor);
                if order >= threshold {
                    continue;
                }
                let d = particle.offset(grid, grid.centre([i, j, k]));
                let angle = d[1].atan2(d[0]).rem_euclid(std::f64::consts::TAU);
                let reach = d[0].hypot(d[1]).max(grid.spacing());
                let half = 0.6 * grid.spacing() / reach * N_SECTORS as f64 / std::f64::consts::TAU;
                let at = angle / std::f64::consts::TAU * N_SECTORS as f64;
                low.push(LowCell {
                    place: [reach, d[2]],
                    weight: threshold - order,
                    sectors: (at - half).floor() as i64..=(at + half).floor() as i64,
                });
            }
        }
    }
    low
}

fn wrapped(sector: i64) -> usize {
    sector.rem_euclid(N_SECTORS as i64) as usize
}

/// Distance from the axis and height of the ring in each sector; none where what is low in order is no ring of the particle.
fn sectors(state: &NematicState, threshold: f64) -> Option<Vec<[f64; 2]>> {
    let particle = state.particle()?;
    let low = low_cells(state, particle, threshold);
    let mut sums = vec![[0.0_f64; 3]; N_SECTORS];
    for cell in &low {
        for s in cell.sectors.clone() {
            let sum = &mut sums[wrapped(s)];
            sum[0] += cell.weight;
            sum[1] += cell.weight * cell.place[0];
            sum[2] += cell.weight * cell.place[1];
        }
    }
    let mean = |s: &[f64; 3]| (s[0] > 0.0).then(|| [s[1] / s[0], s[2] / s[0]]);
    let centres: Vec<[f64; 2]> = sums.iter().map(mean).collect::<Option<_>>()?;
    is_ring(state, &low, &centres).then_some(centres)
}

/// Whether the centres are those of a ring: near the particle, each with cells of low order around it (the middle of two caps has
/// none), and with none close to the axis (a cap covers it).
///
/// A quarter of the sectors may fail, where a strongly buckled ring overhangs.
fn is_ring(state: &NematicState, low: &[LowCell], centres: &[[f64; 2]]) -> bool {
    let mut nearest = vec![f64::INFINITY; N_SECTORS];
    let mut innermost = vec![f64::INFINITY; N_SECTORS];
    for cell in low {
        for s in cell.sectors.clone() {
            let s = wrapped(s);
            let [radius, height] = cell.place;
            let distance = (radius - centres[s][0]).hypot(height - centres[s][1]);
            nearest[s] = nearest[s].min(distance);
            innermost[s] = innermost[s].min(radius);
        }
    }
    let spacing = state.grid().spacing();
    let holds = |s: &usize| {
        nearest[*s] < 1.5 * spacing
            && innermost[*s] > 1.5 * spacing
            && is_near_particle(state, place(*s, centres[*s]))
    };
    4 * (0..N_SECTORS).filter(holds).count() >= 3 * N_SECTORS
}

/// The point of a sector at this distance from the axis and this height, relative to the particle's centre.
fn place(sector: usize, [radius, height]: [f64; 2]) -> [f64; 3] {
    let angle = std::f64::consts::TAU * (sector as f64 + 0.5) / N_SECTORS as f64;
    [radius * angle.cos(), radius * angle.sin(), height]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;
    use crate::{Faces, Grid};

    /// A particle of radius 6 in a box whose order is 0.1 where `is_low` of the place relative to its centre, else 0.5.
    fn found(is_low: impl Fn([f64; 3]) -> bool) -> Option<Ring> {
        let faces = [Faces::Wall, Faces::Wall, Faces::Wall];
        let grid = Grid::new([32, 32, 24], 1.0, faces).unwrap();
        let particle = Particle::central(&grid, 6.0).unwrap();
        let state = NematicState::from_fn(grid, Some(particle), |p| {
            let low = is_low(particle.offset(&grid, p));
            uniaxial(if low { 0.1 } else { 0.5 }, [0.0, 0.0, 1.0])
        });
        ring(&state.unwrap(), 0.35)
    }

    fn tube(radius: f64, height: f64) -> impl Fn([f64; 3]) -> bool {
        move |[x, y, z]| (x.hypot(y) - radius).hypot(z - height) < 1.5
    }

    #[test]
    fn only_low_order_around_the_particle_is_a_ring() {
        let near = found(tube(7.5, 0.0)).unwrap();
        assert!(
            (near.radius - 7.5).abs() < 0.3 && near.height.abs() < 0.1,
            "{near:?}"
        );
        let above = found(tube(6.2, 3.5)).unwrap();
        assert!((above.height - 3.5).abs() < 0.3, "{above:?}");
        let cap = |z: f64| move |p: [f64; 3]| p[0].hypot(p[1]).hypot(p[2] - z) < 3.0;
        assert_eq!(found(|p| cap(6.0)(p) || cap(-6.0)(p)), None, "two caps");
        assert_eq!(found(cap(6.0)), None, "one cap");
        assert_eq!(
            found(|[x, y, _]| x.abs().max(y.abs()) > 14.0),
            None,
            "sides"
        );
        let edge = |[x, y, z]: [f64; 3]| x.abs().max(y.abs()) > 13.0 && z.abs() > 9.0;
        assert_eq!(found(edge), None, "edges of both plates");
        let one_edge = move |p: [f64; 3]| edge(p) && p[2] > 0.0;
        assert_eq!(found(one_edge), None, "edge of one plate");
        assert_eq!(found(|_| true), None, "no order at all");
    }

    #[test]
    fn undulations_of_a_ring_have_their_amplitudes_modes_and_place() {
        // A tube around z = 1 + 0.9 cos(2φ + 0.4) + 0.4 sin(5φ) at 12 from the axis, its order rising from 0 in the middle; h = 0.5.
        let faces = [Faces::Wall, Faces::Wall, Faces::Wall];
        let grid = Grid::new([80, 80, 56], 0.5, faces).unwrap();
        let particle = Particle::central(&grid, 10.0).unwrap();
        let state = NematicState::from_fn(grid, Some(particle), |p| {
            let [x, y, z] = particle.offset(&grid, p);
            let azimuth = y.atan2(x);
            let height = 1.0 + 0.9 * (2.0 * azimuth + 0.4).cos() + 0.4 * (5.0 * azimuth).sin();
            let core = (x.hypot(y) - 12.0).hypot(z - height);
            uniaxial((0.2 * core).min(0.5), [0.0, 0.0, 1.0])
        });
        let state = state.unwrap();
        let line = ring_line(&state, 0.35).unwrap();
        assert_eq!(line.len(), 128);
        for (k, [x, y, z]) in line.into_iter().enumerate() {
            // One point in the middle of each sector.
            let azimuth = std::f64::consts::TAU * (k as f64 + 0.5) / 128.0;
            assert!((y.atan2(x).rem_euclid(std::f64::consts::TAU) - azimuth).abs() < 1e-9);
            let height = 1.0 + 0.9 * (2.0 * azimuth + 0.4).cos() + 0.4 * (5.0 * azimuth).sin();
            assert!((z - height).abs() < 0.15, "{azimuth}: {z} {height}");
        }
        let ring = ring(&state, 0.35).unwrap();
        assert_eq!(ring.mode(), 2);
        assert_eq!(ring.amplitude(), ring.modes[1]);
        assert!((ring.modes[1] - 0.9).abs() < 0.02, "{:?}", ring.modes);
        assert!((ring.modes[4] - 0.4).abs() < 0.02, "{:?}", ring.modes);
        for (k, mode) in ring.modes.iter().enumerate() {
            assert!(k == 1 || k == 4 || *mode < 0.03, "{k}: {mode}");
        }
        assert!((ring.height - 1.0).abs() < 0.02, "{}", ring.height);
        assert!((ring.radius - 12.0).abs() < 0.1, "{}", ring.radius);
    }

    #[test]
    fn a_ring_that_overhangs_is_kept() {
        let wavy = |[x, y, z]: [f64; 3]| {
            let height = 3.0 * (3.0 * y.atan2(x)).sin();
            (x.hypot(y) - 7.5).hypot(z - height) < 1.5
        };
        let ring = found(wavy).unwrap();
        assert_eq!(ring.mode(), 3);
        assert!((ring.amplitude() - 3.0).abs() < 0.4, "{}", ring.amplitude());
    }
}
