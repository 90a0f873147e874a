//! Tightening at one resolution: a sequence of quadratic programs.

use super::constraints::{Row, rebuild};
use super::qp::{self, Hessian};
use super::stop::Stop;
use crate::V;
use crate::curves::Curves;
use crate::rings::Rings;

/// How to tighten at one resolution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level {
    /// Proximal weight on displacements.
    pub damping: f64,
    /// Proximal weight on changes of curvature: without it vertices fold in a limit cycle.
    pub curvature_damping: f64,
    /// Tension along each axis; all 1 to tighten, others to squeeze the curve into another shape.
    pub weights: [f64; 3],
    /// Stops when the ropelength falls by less than this fraction over a window of steps.
    pub tolerance: f64,
    /// A curve whose vertices would still move further than this is not at rest.
    pub rest: f64,
    /// Stops once the ropelength is below this.
    pub enough: f64,
    /// Largest displacement of a vertex in the first step, and what it may always reach, in tube radii: struts are kept for all
    /// pairs of edges that come within twice as much of touching.
    pub reach: [f64; 2],
    /// Largest number of steps.
    pub max_steps: usize,
}

impl Level {
    /// Hessian of the tension of curves, and that with the proximal terms.
    fn hessians(&self, curves: &Curves, rings: &Rings) -> [Hessian; 2] {
        let stretch = stretch(curves, rings, self.weights);
        let damped = |(h, stencil): (f64, &[f64; 3])| {
            let bend = self.curvature_damping / h.powi(3);
            [
                stencil[0] + self.damping * h + 6.0 * bend,
                stencil[1] - 4.0 * bend,
                bend,
            ]
        };
        let edges = curves.edge_lengths().into_iter();
        let damped = Hessian {
            stencils: edges.zip(&stretch.stencils).map(damped).collect(),
            ..stretch.clone()
        };
        [stretch, damped]
    }
}

/// Hessian of the tension of curves with equal edges, with a factor for each axis.
pub(super) fn stretch(curves: &Curves, rings: &Rings, weights: [f64; 3]) -> Hessian {
    let stencil = |h: f64| [2.0 / h, -1.0 / h, 0.0];
    Hessian {
        rings: rings.clone(),
        stencils: curves.edge_lengths().into_iter().map(stencil).collect(),
        weights,
    }
}

/// Steps over which the fall of the ropelength is judged.
const WINDOW: usize = 6;
/// Largest displacement of a vertex in one step, in units of the thickness: two strands cannot pass each other below 1.
const LARGEST_STEP: f64 = 0.9;

/// Largest displacement of a vertex in one step, in units of the tube radius.
const LONGEST_STEP: f64 = 0.5;
/// The reach for starts that may be far from tight.
pub(crate) const LOOSE_REACH: [f64; 2] = [LONGEST_STEP, 0.03];
/// The reach for starts that are nearly tight: fewer struts.
pub(crate) const NEAR_REACH: [f64; 2] = [0.1, 0.01];

/// What tightening at one resolution came to.
#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    /// Last curves.
    pub last: Curves,
    /// Shortest curves met, in units in which the tube radius was about 1.
    pub curves: Curves,
    /// Their length over their thickness.
    pub ropelength: f64,
    /// Matrix factorisations made.
    pub n_factorisations: usize,
    /// Whether the ropelength came to rest before the steps ran out.
    pub converged: bool,
}

/// Shortens closed curves at thickness 1, with their numbers of vertices and their type kept, by a sequence of quadratic programs
/// in the displacements y:
///
/// ```math
/// \min_y \frac{N}{2 L_0} \sum_i |e_i + \Delta y_i|^2 + \frac{\mu h}{2} |y|^2 + \frac{\mu_2}{2 h^3} |D^2 y|^2,
/// \qquad A y \ge b
/// ```
///
/// The first sum is over the edges of all curves, N and L_0 being those of each; y is every displacement. When it is interrupted, it
/// returns the shortest curves so far.
pub(crate) fn tighten_level(start: &Curves, level: &Level, stop: &Stop) -> Option<Outcome> {
    let rings = start.rings();
    let n = rings.n();
    let tau = start.thickness().tau;
    let mut curve = start.scaled(1.0 / tau).ok()?;
    let mut best = curve.clone();
    let mut best_ropelength = curve.length();
    let mut history = vec![best_ropelength];
    let (mut pairs, mut rows): (Vec<(u32, u32)>, Vec<Row>) = (Vec::new(), Vec::new());
    let mut gradient = vec![0.0; 3 * n];
    let [mut delta, least_delta] = level.reach;
    let mut tau: f64 = 1.0;
    let (mut n_steps, mut n_factorisations, mut converged) = (0, 0, false);
    while n_steps < level.max_steps && !stop.asks() {
        delta = delta.min(LARGEST_STEP * tau);
        let length = curve.length();
        rebuild(&curve.vertices(), &rings, delta, &mut pairs, &mut rows);
        let [stretch, hessian] = level.hessians(&curve, &rings);
        stretch.multiply(&curve.coordinates(), &mut gradient);
        let gap = 1e-2 * level.tolerance * length;
        let solution = qp::solve(&hessian, &gradient, &rows, gap)?;
        n_factorisations += solution.n_iterations;
        n_steps += 1;
        let largest = largest_displacement(&solution.y);
        let alpha = if largest > delta {
            delta / largest
        } else {
            1.0
        };
        curve = moved(&curve, alpha, &solution.y)?;
        tau = curve.thickness().tau;
        let ropelength = curve.length() / tau;
        tracing::trace!(
            n_steps,
            n_rows = rows.len(),
            largest,
            delta,
            ropelength,
            n_iterations = solution.n_iterations,
            "step"
        );
        if ropelength < best_ropelength {
            best_ropelength = ropelength;
            best = curve.clone();
        }
        if best_ropelength < level.enough {
            break;
        }
        history.push(best_ropelength);
        delta = (1.5 * largest.min(delta)).clamp(least_delta, LONGEST_STEP);
        if history.len() > WINDOW {
            let before = history[history.len() - 1 - WINDOW];
            if before - best_ropelength < level.tolerance * best_ropelength && largest < level.rest
            {
                converged = true;
                break;
            }
        }
    }
    Some(Outcome {
        last: curve,
        curves: best,
        ropelength: best_ropelength,
        n_factorisations,
        converged,
    })
}

fn largest_displacement(y: &[f64]) -> f64 {
    y.chunks_exact(3)
        .map(|y| y[0].hypot(y[1]).hypot(y[2]))
        .fold(0.0, f64::max)
}

/// The curves moved by `alpha` times the displacements.
fn moved(curve: &Curves, alpha: f64, y: &[f64]) -> Option<Curves> {
    let vertices = curve.vertices().into_iter().zip(y.chunks_exact(3));
    curve.with_vertices(vertices.map(|(x, y)| x + alpha * V::new(y[0], y[1], y[2])))
}
