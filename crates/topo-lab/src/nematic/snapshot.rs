//! What is kept of the field at a few times: defect lines, and the vertical plane through the particle's centre.

use serde::{Deserialize, Serialize};
use topo_nematic::NematicState;
use topo_nematic::defects::defect_lines;
use topo_nematic::flow::FlowCoupling;
use topo_nematic::ring::{is_near_particle, ring_line};
use topo_nematic::tensor::order_and_director;

use topo_analysis::{LinePoint, SlicePoint};

/// Degree of order whose isosurface encloses the defect ring.
pub(super) const RING_ORDER: f64 = 0.35;
/// Shares of the energy after the switch at which the field is looked at.
const SHARES: [f64; 12] = [
    1.0, 0.98, 0.9, 0.75, 0.5, 0.25, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0005,
];
/// Most points of a slice along x.
const SLICE_POINTS: usize = 100;

/// Lines and slices kept so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Snapshots {
    /// How many of the shares have been passed.
    n_passed: usize,
    /// At how many times the field was looked at.
    pub n_kept: usize,
    /// Points of the defect lines.
    pub lines: Vec<LinePoint>,
    /// Points of the ring.
    pub ring: Vec<LinePoint>,
    /// Points of the slices.
    pub slices: Vec<SlicePoint>,
}

impl Snapshots {
    /// Looks at a state with `share` of the energy left; says whether it was kept.
    pub fn see(
        &mut self,
        time: f64,
        share: f64,
        state: &NematicState,
        flow: Option<&FlowCoupling>,
    ) -> bool {
        let n_passed = SHARES.iter().filter(|s| share <= **s).count();
        if n_passed <= self.n_passed {
            return false;
        }
        self.n_passed = n_passed;
        self.keep(Some(time), state, flow);
        true
    }

    /// Keeps a state; `None` is the time of the charged one.
    pub fn keep(&mut self, time: Option<f64>, state: &NematicState, flow: Option<&FlowCoupling>) {
        self.n_kept += 1;
        let centre = centre(state);
        let first = self.lines.len();
        for (k, line) in defect_lines(state).into_iter().enumerate() {
            for (p, cosine) in line.points.iter().zip(&line.cosine) {
                let angle = cosine.clamp(-1.0, 1.0).acos().to_degrees();
                self.lines.push(LinePoint {
                    time,
                    line: k,
                    closed: line.closed,
                    x: p[0] - centre[0],
                    y: p[1] - centre[1],
                    z: p[2] - centre[2],
                    angle: angle.is_finite().then_some(angle),
                });
            }
        }
        let whole = {
            let line = self.lines[first..].iter().filter(|p| p.line == 0);
            let points: Vec<LinePoint> = line.cloned().collect();
            let near = |p: &LinePoint| is_near_particle(state, [p.x, p.y, p.z]);
            (goes_around(&points) && points.iter().all(near)).then_some(points)
        };
        match whole {
            Some(points) => self.ring.extend(points),
            None => self.keep_sectors(time, state, first),
        }
        self.keep_slice(time, state, flow, centre);
    }

    /// The ring by sectors of azimuth, where the defect line has gaps; angles come from the pieces of line nearby.
    fn keep_sectors(&mut self, time: Option<f64>, state: &NematicState, first: usize) {
        for [x, y, z] in ring_line(state, RING_ORDER).unwrap_or_default() {
            let far = |p: &&LinePoint| (p.x - x).hypot(p.y - y).hypot(p.z - z);
            let nearest = self.lines[first..]
                .iter()
                .min_by(|a, b| far(a).total_cmp(&far(b)))
                .filter(|p| far(p) < 3.0 * state.grid().spacing());
            self.ring.push(LinePoint {
                time,
                line: 0,
                closed: true,
                x,
                y,
                z,
                angle: nearest.and_then(|p| p.angle),
            });
        }
    }

    fn keep_slice(
        &mut self,
        time: Option<f64>,
        state: &NematicState,
        flow: Option<&FlowCoupling>,
        centre: [f64; 3],
    ) {
        let (grid, h) = (state.grid(), state.grid().spacing());
        let [nx, ny, nz] = grid.cells();
        let stride = nx.div_ceil(SLICE_POINTS);
        let j = ((centre[1] / h) as usize).min(ny - 1);
        let moving = flow.map(|f| (f.centred_velocity(), f.vorticity()));
        let n = grid.n_cells();
        // the same number of rows and columns on both sides of the centre
        let first = |n: usize| (n / 2) % stride;
        for k in (first(nz)..nz).step_by(stride) {
            for i in (first(nx)..nx).step_by(stride) {
                let cell = grid.index([i, j, k]);
                let point = grid.centre([i, j, k]);
                let (order, d) = order_and_director(&state.tensor(cell));
                let fluid = state.is_fluid([i, j, k]);
                let of = |field: &[f64], axis: usize| fluid.then(|| field[axis * n + cell]);
                self.slices.push(SlicePoint {
                    time,
                    x: point[0] - centre[0],
                    z: point[2] - centre[2],
                    order: if fluid { order } else { 0.0 },
                    nx: d[0],
                    ny: d[1],
                    nz: d[2],
                    ux: moving.as_ref().and_then(|(u, _)| of(u, 0)),
                    uz: moving.as_ref().and_then(|(u, _)| of(u, 2)),
                    vorticity: moving.as_ref().and_then(|(_, w)| of(w, 1)),
                });
            }
        }
    }
}

/// Whether a line closes after one turn around the vertical axis.
fn goes_around(points: &[LinePoint]) -> bool {
    let Some(last) = points.last().filter(|p| p.closed) else {
        return false;
    };
    let mut before = last.y.atan2(last.x);
    let mut turned = 0.0;
    for p in points {
        let angle = p.y.atan2(p.x);
        let step = (angle - before + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU);
        turned += step - std::f64::consts::PI;
        before = angle;
    }
    (turned.abs() - std::f64::consts::TAU).abs() < 1e-6
}

/// Centre of the particle, or of the cell without one.
pub(super) fn centre(state: &NematicState) -> [f64; 3] {
    match state.particle() {
        Some(particle) => particle.centre(),
        None => state.grid().extent().map(|edge| 0.5 * edge),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_nematic::tensor::uniaxial;
    use topo_nematic::{Faces, Grid};

    #[test]
    fn only_a_closed_line_around_the_axis_is_a_ring() {
        let line = |x: f64, closed: bool| -> Vec<LinePoint> {
            let place = |i: i32| f64::from(i) / 40.0 * std::f64::consts::TAU;
            let point = |i: i32| LinePoint {
                closed,
                x: x + place(i).cos(),
                y: -place(i).sin(),
                ..LinePoint::default()
            };
            (0..40).map(point).collect()
        };
        assert!(goes_around(&line(0.3, true)));
        assert!(!goes_around(&line(0.3, false)));
        assert!(!goes_around(&line(1.7, true)));
        assert!(!goes_around(&[]));
    }

    #[test]
    fn each_share_is_kept_once_and_slices_are_thinned() {
        let faces = [Faces::Periodic, Faces::Periodic, Faces::Wall];
        let grid = Grid::new([240, 4, 8], 0.5, faces).unwrap();
        let state = NematicState::from_fn(grid, None, |_| uniaxial(0.5, [0.0, 0.6, 0.8])).unwrap();
        let mut kept = Snapshots::default();
        assert!(kept.see(1.0, 0.8, &state, None));
        assert!(!kept.see(2.0, 0.78, &state, None));
        assert!(kept.see(3.0, 0.02, &state, None));
        assert!(kept.lines.is_empty());
        let one: Vec<_> = kept.slices.iter().filter(|p| p.time == Some(1.0)).collect();
        assert_eq!(one.len(), 80 * 3);
        for p in one {
            assert!((p.order - 0.5).abs() < 1e-12 && p.ux.is_none());
            assert!((p.ny.abs() - 0.6).abs() < 1e-9 && (p.nz.abs() - 0.8).abs() < 1e-9);
        }
        let mut xs: Vec<f64> = kept.slices.iter().map(|p| p.x).collect();
        xs.sort_by(f64::total_cmp);
        assert!(xs[0] < -57.0 && xs[xs.len() - 1] > 57.0);
    }
}
