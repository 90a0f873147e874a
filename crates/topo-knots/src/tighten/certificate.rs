//! Evidence that curves are a tight knot or link, from the curves alone.

use serde::{Deserialize, Serialize};
use topo_core::{Polyline, distance_between, windowed_half_distance};

use super::constraints::{Guard, rebuild};
use super::level::stretch;
use super::qp::{self, Hessian};
use crate::curves::Curves;
use crate::{Invariants, KnotError};

/// Contacts within this fraction of the tube radius may carry force.
const CONTACT: f64 = 5e-3;

/// What was checked on a tight curve, or on the curves of a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate<I = Invariants> {
    /// Smallest radius of curvature, in tube radii.
    pub thickness_minrad: f64,
    /// Half the smallest doubly critical self-distance or distance between components, from all pairs of edges, in tube radii.
    pub thickness_dcsd: f64,
    /// Half the smallest distance between points at least π apart along a curve or of different components, in tube radii.
    pub thickness_windowed: f64,
    /// Writhe of the polygon; of a link the sum of those of its components, which does not depend on their orientations.
    pub writhe: f64,
    /// Average crossing number of the polygon; of a link the sum of those of its components.
    pub average_crossing_number: f64,
    /// Pairs of edges in contact.
    pub n_struts: usize,
    /// Vertices as sharp as a tube allows.
    pub n_kinks: usize,
    /// Part of the tension that contacts cannot balance, |K x - A^T l| / |K x| over l >= 0.
    pub residual: f64,
    /// Of a knot: Alexander polynomial, determinant and signature.
    pub invariants: I,
    /// Whether the length came to rest at the finest level.
    pub converged: bool,
}

impl<I> Certificate<I> {
    /// Thickness, the smaller of the two bounds.
    pub fn tau(&self) -> f64 {
        self.thickness_minrad.min(self.thickness_dcsd)
    }

    /// The evidence of curves of thickness about 1, whose invariants are known.
    pub(super) fn examine(curves: &Curves, converged: bool, invariants: I) -> Self {
        let exact = curves.thickness_brute_force();
        let rings = curves.rings();
        let (mut pairs, mut rows) = (Vec::new(), Vec::new());
        rebuild(&curves.vertices(), &rings, CONTACT, &mut pairs, &mut rows);
        rows.retain(|row| row.bound > -2.0 * CONTACT);
        let count = |guard| rows.iter().filter(|row| row.guard == guard).count();
        let (n_struts, n_kinks) = (count(Guard::Strut), count(Guard::Kink));
        let mut tension = vec![0.0; 3 * rings.n()];
        stretch(curves, &rings, [1.0; 3]).multiply(&curves.coordinates(), &mut tension);
        rows.iter_mut().for_each(|row| row.bound = 0.0);
        let size: f64 = tension.iter().map(|t| t * t).sum();
        // The displacement that shortens fastest without loosening a contact is the unbalanced part of the tension.
        let identity = Hessian {
            stencils: vec![[1.0, 0.0, 0.0]; rings.n_rings()],
            rings,
            weights: [1.0; 3],
        };
        let residual = qp::solve(&identity, &tension, &rows, 1e-6 * size)
            .filter(|s| s.converged)
            .map_or(1.0, |s| {
                (s.y.iter().map(|y| y * y).sum::<f64>() / size).sqrt()
            });
        let parts = curves.parts();
        Self {
            thickness_minrad: exact.min_rad,
            thickness_dcsd: 0.5 * exact.dcsd,
            thickness_windowed: windowed(parts),
            writhe: curves.writhe(),
            average_crossing_number: parts.iter().map(Polyline::average_crossing_number).sum(),
            n_struts,
            n_kinks,
            residual,
            invariants,
            converged,
        }
    }
}

impl Certificate {
    /// Examines a closed curve of thickness about 1; `converged` is what its maker says of its length.
    ///
    /// # Errors
    /// Those of [`Invariants::of`].
    ///
    /// # Validation
    /// `all_knots_are_tight`.
    pub fn of(curve: &Polyline, converged: bool) -> Result<Self, KnotError> {
        let invariants = Invariants::of(curve.vertices())?;
        Ok(Self::examine(&curve.clone().into(), converged, invariants))
    }
}

fn windowed(parts: &[Polyline]) -> f64 {
    let mut least = f64::INFINITY;
    for (k, part) in parts.iter().enumerate() {
        least = least.min(windowed_half_distance(part, 1.0));
        for other in &parts[k + 1..] {
            least = least.min(0.5 * distance_between(part, other));
        }
    }
    least
}
