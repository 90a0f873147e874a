//! Closed curves together: the one of a knot, or the components of a link.

use topo_core::{CurveError, Polyline, Thickness, thickness_of_all, thickness_of_all_brute_force};

use crate::rings::Rings;
use crate::{KnotError, V};

/// Fewest vertices of a component.
const LEAST_VERTICES: usize = 8;

/// Closed curves that are tightened, moved and examined together; at least one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Curves {
    parts: Vec<Polyline>,
}

impl From<Polyline> for Curves {
    fn from(curve: Polyline) -> Self {
        Self { parts: vec![curve] }
    }
}

impl From<Vec<Polyline>> for Curves {
    fn from(parts: Vec<Polyline>) -> Self {
        Self { parts }
    }
}

impl Curves {
    /// The components.
    pub fn parts(&self) -> &[Polyline] {
        &self.parts
    }

    /// The components, by value.
    pub fn into_parts(self) -> Vec<Polyline> {
        self.parts
    }

    /// The first component: the curve of a knot.
    pub fn into_first(mut self) -> Polyline {
        self.parts.swap_remove(0)
    }

    /// Where the components lie in [`vertices`](Self::vertices).
    pub fn rings(&self) -> Rings {
        Rings::of(self.parts.iter().map(Polyline::n_vertices))
    }

    /// Vertices of all components, one after the other.
    pub fn vertices(&self) -> Vec<V> {
        let vertices = self.parts.iter().flat_map(Polyline::vertices);
        vertices.copied().collect()
    }

    /// The coordinates of all vertices.
    pub fn coordinates(&self) -> Vec<f64> {
        let vertices = self.parts.iter().flat_map(Polyline::vertices);
        vertices.flat_map(|x| [x.x, x.y, x.z]).collect()
    }

    /// Number of vertices of all components, also that of edges.
    pub fn n_vertices(&self) -> usize {
        self.parts.iter().map(Polyline::n_vertices).sum()
    }

    /// Sum of the lengths.
    pub fn length(&self) -> f64 {
        self.parts.iter().map(Polyline::length).sum()
    }

    /// Mean length of the edges of each component.
    pub fn edge_lengths(&self) -> Vec<f64> {
        let mean = |part: &Polyline| part.length() / part.n_edges() as f64;
        self.parts.iter().map(mean).collect()
    }

    /// Thickness of the union.
    pub fn thickness(&self) -> Thickness {
        thickness_of_all(&self.parts)
    }

    /// The same from every pair of edges.
    pub fn thickness_brute_force(&self) -> Thickness {
        thickness_of_all_brute_force(&self.parts)
    }

    /// Total length over thickness.
    pub fn ropelength(&self) -> f64 {
        self.length() / self.thickness().tau
    }

    /// Sum of the writhes of the components: the part of the writhe that does not depend on how they are oriented.
    pub fn writhe(&self) -> f64 {
        self.parts.iter().map(Polyline::writhe).sum()
    }

    fn each(
        &self,
        change: impl Fn(&Polyline) -> Result<Polyline, CurveError>,
    ) -> Result<Self, KnotError> {
        let parts = self.parts.iter().map(change).collect::<Result<_, _>>()?;
        Ok(Self { parts })
    }

    /// All multiplied by `factor`.
    pub fn scaled(&self, factor: f64) -> Result<Self, KnotError> {
        self.each(|part| part.scaled(factor))
    }

    /// Each after `n_passes` of the binomial filter.
    pub fn smoothed(&self, n_passes: usize) -> Result<Self, KnotError> {
        self.each(|part| part.smoothed(n_passes))
    }

    /// Each with equal edges, `n` in all, shared out in proportion to the lengths.
    pub fn resampled(&self, n: usize) -> Result<Self, KnotError> {
        if let [only] = &self.parts[..] {
            return Ok(only.resampled(n)?.into());
        }
        let whole = self.length();
        self.each(|part| {
            let share = n as f64 * part.length() / whole;
            part.resampled((share.round() as usize).max(LEAST_VERTICES))
        })
    }

    /// The curves with new vertices, as many as before.
    pub fn with_vertices(&self, vertices: impl IntoIterator<Item = V>) -> Option<Self> {
        let mut vertices = vertices.into_iter();
        let moved = |part: &Polyline| {
            let own = vertices.by_ref().take(part.n_vertices()).collect();
            Polyline::new(own, true).ok()
        };
        let parts = self.parts.iter().map(moved).collect::<Option<_>>()?;
        Some(Self { parts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_get_vertices_by_their_length() {
        let ring = |n: usize, r: f64| {
            let at = |k: usize| {
                let (s, c) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
                V::new(r * c, r * s, 0.0)
            };
            Polyline::new((0..n).map(at).collect(), true).expect("a ring")
        };
        let curves = Curves::from(vec![ring(60, 1.0), ring(60, 3.0)]);
        let fine = curves.resampled(200).expect("resampled");
        let sizes: Vec<usize> = fine.parts().iter().map(Polyline::n_vertices).collect();
        assert_eq!(sizes, [50, 150]);
        assert_eq!(fine.rings().range(1), 50..200);
        let again = fine.with_vertices(fine.vertices()).expect("the same");
        assert_eq!(again, fine);
        assert_eq!(fine.coordinates().len(), 600);
    }
}
