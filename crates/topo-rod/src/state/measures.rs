//! What is measured on a state: twist, writhe, linking numbers, distances of ends, and its centrelines.

use nalgebra::Vector3;
use topo_core::Polyline;

use super::RodState;
use crate::{Chain, RodError};

impl RodState {
    fn vertices_of(&self, chain: &Chain) -> &[Vector3<f64>] {
        &self.vertices[chain.vertices()]
    }

    /// Total twist Tw = Σ m_i / 2π, in turns; of several components, the sum.
    pub fn total_twist(&self) -> f64 {
        self.twists.iter().sum::<f64>() / std::f64::consts::TAU
    }

    /// Total twist of component `c`, in turns.
    ///
    /// # Errors
    /// There is no such component.
    pub fn total_twist_of(&self, c: usize) -> Result<f64, RodError> {
        let twists = &self.twists[self.chain(c)?.vertices()];
        Ok(twists.iter().sum::<f64>() / std::f64::consts::TAU)
    }

    /// Writhe of the centreline by the exact polygon formula; of several components, the sum of what each has with itself.
    pub fn writhe(&self) -> f64 {
        let own = |chain| topo_core::writhe(self.vertices_of(chain), chain.is_closed());
        self.components().iter().map(own).sum()
    }

    /// Writhe of component `c` with itself.
    ///
    /// # Errors
    /// There is no such component.
    pub fn writhe_of(&self, c: usize) -> Result<f64, RodError> {
        let chain = self.chain(c)?;
        Ok(topo_core::writhe(
            self.vertices_of(chain),
            chain.is_closed(),
        ))
    }

    /// Gauss integral of components `a` and `b` by the exact polygon formula: their linking number if both are closed.
    ///
    /// # Errors
    /// There is no such component, or it is one and the same.
    ///
    /// # Validation
    /// `law_linking_numbers_are_kept_through_a_charge`
    pub fn linking(&self, a: usize, b: usize) -> Result<f64, RodError> {
        if a == b {
            let n_components = self.n_components();
            return Err(RodError::Component { c: b, n_components });
        }
        let [a, b] = [self.chain(a)?, self.chain(b)?];
        let [x, y] = [self.vertices_of(a), self.vertices_of(b)];
        Ok(topo_core::linking((x, a.is_closed()), (y, b.is_closed())))
    }

    /// The centreline of a single component as a curve.
    ///
    /// # Errors
    /// Several components, coincident vertices or numbers that are not finite.
    pub fn centreline(&self) -> Result<Polyline, RodError> {
        let [chain] = self.components() else {
            return Err(RodError::WrongTopology {
                operation: "the centreline",
                needed: "a single",
            });
        };
        Ok(Polyline::new(self.vertices.clone(), chain.is_closed())?)
    }

    /// The vertices of each component, in h.
    pub fn component_vertices(&self) -> impl Iterator<Item = &[Vector3<f64>]> {
        let chains = self.components().iter();
        chains.map(|chain| self.vertices_of(chain))
    }

    /// The centreline of each component.
    ///
    /// # Errors
    /// Coincident vertices or numbers that are not finite.
    pub fn centrelines(&self) -> Result<Vec<Polyline>, RodError> {
        let of = |chain: &Chain| {
            let vertices = self.vertices_of(chain).to_vec();
            Ok(Polyline::new(vertices, chain.is_closed())?)
        };
        self.components().iter().map(of).collect()
    }

    /// Distance between the two ends, in h (0 while closed); of several open components, the largest.
    pub fn end_to_end(&self) -> f64 {
        let open = self.components().iter().filter(|chain| !chain.is_closed());
        open.map(|c| (self.vertices[c.last()] - self.vertices[c.first()]).norm())
            .fold(0.0, f64::max)
    }

    /// Mean of a density over windows of width π h along each component.
    pub fn smoothed(&self, density: &[f64]) -> Vec<f64> {
        let of = |chain: &Chain| {
            let own = &density[chain.vertices()];
            crate::smoothed_density(own, chain.rest_length(), chain.is_closed())
        };
        self.components().iter().flat_map(of).collect()
    }
}
