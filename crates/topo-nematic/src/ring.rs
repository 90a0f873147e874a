//! The defect ring around the particle: radius, height and the modes of its undulation.

use serde::{Deserialize, Serialize};

use crate::NematicState;
use crate::tensor::{is_ordered_above, largest_eigenvalue};

/// Number of azimuthal sectors in which the ring is looked for.
const N_SECTORS: usize = 128;
/// Highest mode of the height that is kept.
const N_MODES: usize = 40;

/// A ring of low order around the vertical axis of the particle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ring {
    /// Mean distance from the vertical axis, in xi_N.
    pub radius: f64,
    /// Mean height above the particle's centre, in xi_N.
    pub height: f64,
    /// Amplitudes of the modes m = 1, 2, ... of its height z(φ), in xi_N.
    pub modes: Vec<f64>,
}

impl Ring {
    /// The strongest mode of its height.
    pub fn mode(&self) -> usize {
        let best = self.modes.iter().enumerate();
        best.max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0, |(m, _)| m + 1)
    }

    /// Amplitude of the strongest mode, in xi_N.
    pub fn amplitude(&self) -> f64 {
        self.modes.iter().copied().fold(0.0, f64::max)
    }
}

/// The ring of a state: in each azimuthal sector the centre of the cells whose order is below `threshold`, weighted by how far below.
///
/// None without a particle, or when sectors without such cells show that no closed ring surrounds it.
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

/// The closed line of the ring, relative to the particle's centre (xi_N): one point a sector of azimuth.
///
/// Where the core of a disclination lies against the particle, [`defect_lines`](crate::defect_lines) ends there; this line goes on.
pub fn ring_line(state: &NematicState, threshold: f64) -> Option<Vec<[f64; 3]>> {
    let points = sectors(state, threshold)?.into_iter().enumerate();
    let place = |(s, [radius, height]): (usize, [f64; 2])| {
        let angle = std::f64::consts::TAU * (s as f64 + 0.5) / N_SECTORS as f64;
        [radius * angle.cos(), radius * angle.sin(), height]
    };
    Some(points.map(place).collect())
}

/// Distance from the axis and height of the ring in each sector.
fn sectors(state: &NematicState, threshold: f64) -> Option<Vec<[f64; 2]>> {
    let (grid, particle) = (state.grid(), state.particle()?);
    let [nx, ny, nz] = grid.cells();
    let mut sectors = vec![[0.0_f64; 3]; N_SECTORS];
    for k in 0..nz {
        for j in 0..ny {
            let is_fluid = state.fluid_in_row(j, k);
            for i in (0..nx).filter(|i| is_fluid(*i)) {
                let tensor = state.tensor(grid.index([i, j, k]));
                if is_ordered_above(&tensor, threshold) {
                    continue;
                }
                let order = largest_eigenvalue(&tensor);
                if order >= threshold {
                    continue;
                }
                let d = particle.offset(grid, grid.centre([i, j, k]));
                let weight = threshold - order;
                // Each cell counts in the sectors it covers, so that none is missed by chance.
                let angle = d[1].atan2(d[0]).rem_euclid(std::f64::consts::TAU);
                let reach = d[0].hypot(d[1]).max(grid.spacing());
                let half = 0.6 * grid.spacing() / reach * N_SECTORS as f64 / std::f64::consts::TAU;
                let at = angle / std::f64::consts::TAU * N_SECTORS as f64;
                let (first, last) = ((at - half).floor() as i64, (at + half).floor() as i64);
                for s in first..=last {
                    let sector = &mut sectors[s.rem_euclid(N_SECTORS as i64) as usize];
                    sector[0] += weight;
                    sector[1] += weight * reach;
                    sector[2] += weight * d[2];
                }
            }
        }
    }
    let mean = |s: &[f64; 3]| (s[0] > 0.0).then(|| [s[1] / s[0], s[2] / s[0]]);
    sectors.iter().map(mean).collect()
}
