//! Evidence that a curve is a tight knot, from the curve alone.

use serde::{Deserialize, Serialize};
use topo_core::Polyline;

use super::constraints::{Guard, rebuild};
use super::qp::{self, Hessian};
use crate::{Invariants, KnotError, thickness_brute_force, windowed_half_distance};

/// Contacts within this fraction of the tube radius may carry force.
const CONTACT: f64 = 5e-3;

/// What was checked on a tight curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Smallest radius of curvature, in tube radii.
    pub thickness_minrad: f64,
    /// Half the smallest doubly critical self-distance, from all pairs of edges, in tube radii.
    pub thickness_dcsd: f64,
    /// Half the smallest distance between points at least π apart along the curve, in tube radii.
    pub thickness_windowed: f64,
    /// Writhe of the polygon.
    pub writhe: f64,
    /// Average crossing number of the polygon.
    pub average_crossing_number: f64,
    /// Pairs of edges in contact.
    pub n_struts: usize,
    /// Vertices as sharp as a tube allows.
    pub n_kinks: usize,
    /// Part of the tension that contacts cannot balance, |K x - A^T l| / |K x| over l >= 0.
    pub residual: f64,
    /// Alexander polynomial, determinant and signature.
    pub invariants: Invariants,
    /// Whether the length came to rest at the finest level.
    pub converged: bool,
}

impl Certificate {
    /// Thickness, the smaller of the two bounds.
    pub fn tau(&self) -> f64 {
        self.thickness_minrad.min(self.thickness_dcsd)
    }

    /// Examines a closed curve of thickness about 1; `converged` is what its maker says of its length.
    ///
    /// # Errors
    /// Those of [`Invariants::of`].
    ///
    /// # Validation
    /// `all_knots_are_tight`.
    pub fn of(curve: &Polyline, converged: bool) -> Result<Self, KnotError> {
        let exact = thickness_brute_force(curve);
        let (mut pairs, mut rows) = (Vec::new(), Vec::new());
        rebuild(curve.vertices(), CONTACT, &mut pairs, &mut rows);
        rows.retain(|row| row.bound > -2.0 * CONTACT);
        let count = |guard| rows.iter().filter(|row| row.guard == guard).count();
        let (n_struts, n_kinks) = (count(Guard::Strut), count(Guard::Kink));
        let h = curve.length() / curve.n_edges() as f64;
        let flat: Vec<f64> = curve
            .vertices()
            .iter()
            .flat_map(|x| [x.x, x.y, x.z])
            .collect();
        let mut tension = vec![0.0; flat.len()];
        Hessian {
            stencil: [2.0 / h, -1.0 / h, 0.0],
            weights: [1.0; 3],
        }
        .multiply(&flat, &mut tension);
        rows.iter_mut().for_each(|row| row.bound = 0.0);
        let size: f64 = tension.iter().map(|t| t * t).sum();
        // The displacement that shortens fastest without loosening a contact is the unbalanced part of the tension.
        let residual = qp::solve(
            Hessian {
                stencil: [1.0, 0.0, 0.0],
                weights: [1.0; 3],
            },
            &tension,
            &rows,
            1e-6 * size,
        )
        .filter(|s| s.converged)
        .map_or(1.0, |s| {
            (s.y.iter().map(|y| y * y).sum::<f64>() / size).sqrt()
        });
        Ok(Self {
            thickness_minrad: exact.min_rad,
            thickness_dcsd: 0.5 * exact.dcsd,
            thickness_windowed: windowed_half_distance(curve, 1.0),
            writhe: curve.writhe(),
            average_crossing_number: curve.average_crossing_number(),
            n_struts,
            n_kinks,
            residual,
            invariants: Invariants::of(curve.vertices())?,
            converged,
        })
    }
}
