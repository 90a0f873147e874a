//! The particle on the grid: cut links or masked nodes while it anchors, cut cells or a staircase while it is free.

pub(crate) mod shares;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::anchoring::{Anchoring, SurfacePattern};
use crate::domain::{Kind, STEPS, SpecialCell, neighbour};
use crate::{Grid, Material, Particle};
use shares::{face_share, norm, volume_share};

/// Shortest link to the surface, in spacings: shorter ones would only be stiffer, not more accurate.
pub(crate) const SHORTEST_LINK: f64 = 0.2;
/// Least fluid share of a cell that is kept.
const LEAST_VOLUME: f64 = 0.05;

/// How anchoring on the particle is put on the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Boundary {
    /// Links end where they meet the surface, symmetrically, so that the field is the gradient of an energy.
    #[default]
    CutLink,
    /// Nodes inside have the surface's tensor: cruder, as in most earlier work.
    NodeMask,
}

impl Boundary {
    /// The name used in tables and scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::CutLink => "cut-link",
            Self::NodeMask => "node-mask",
        }
    }
}

/// How a free particle is put on the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FreeSurface {
    /// Cells count by the share of their volume, links by the share of their face, outside the sphere.
    #[default]
    CutCell,
    /// Cells whose centre is outside, with whole links among each other.
    Staircase,
}

impl FreeSurface {
    /// The name used in tables and scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::CutCell => "cut-cell",
            Self::Staircase => "staircase",
        }
    }
}

/// A cell without links, whole.
fn bare() -> SpecialCell {
    SpecialCell {
        cell: 0,
        neighbours: [0; 6],
        weights: [0.0; 6],
        sink: 0.0,
        source: [0.0; 5],
        offset: 0.0,
        anchored: 0.0,
        volume: 1.0,
        mass: 1.0,
    }
}

/// An anchoring particle: where its surface is, what it prefers, how strongly.
pub(crate) struct AnchoredSurface<'a> {
    pub grid: &'a Grid,
    pub particle: &'a Particle,
    pub pattern: &'a SurfacePattern,
    pub anchoring: Anchoring,
    pub boundary: Boundary,
    pub material: &'a Material,
}

impl AnchoredSurface<'_> {
    /// What cell (i, j, k) is.
    ///
    /// A link of whole length h to the surface at distance θ h has conductance 1/θ; its end represents the area h² |ν_axis|, so
    /// that all ends together cover the surface.
    pub(crate) fn kind(&self, ijk: [usize; 3]) -> Kind {
        let (grid, particle) = (self.grid, self.particle);
        let h = grid.spacing();
        let offset = particle.offset(grid, grid.centre(ijk));
        let r = norm(offset);
        if r > particle.radius() + 1.01 * h {
            return Kind::Regular;
        }
        if r < particle.radius() {
            return Kind::Inactive;
        }
        let mut cell = bare();
        let mut is_cut = false;
        for (link, (axis, up)) in STEPS.into_iter().enumerate() {
            let Some(other) = neighbour(grid, ijk, link) else {
                continue;
            };
            if !particle.contains_cell(grid, other) {
                cell.weights[link] = 1.0;
                continue;
            }
            is_cut = true;
            let share = match self.boundary {
                Boundary::CutLink => crossing(offset, axis, up, h, particle.radius()),
                Boundary::NodeMask => 1.0,
            };
            let mut end = offset;
            end[axis] += if up { share * h } else { -share * h };
            let normal = (end[axis] / norm(end)).abs();
            let (conductance, anchored) = self.anchoring.conductance(
                1.0 / share.max(SHORTEST_LINK),
                normal,
                h / self.material.elastic_constant,
            );
            let q = self.pattern.q_tensor(self.material.order(), end);
            let before = cell.sink * cell.anchored;
            cell.link_to(conductance, &q);
            if cell.sink > 0.0 {
                cell.anchored = (before + conductance * anchored) / cell.sink;
            }
        }
        if is_cut {
            Kind::Special(Box::new(cell))
        } else {
            Kind::Regular
        }
    }
}

/// Share of the link from `offset` (outside, from the centre) along ±`axis` that lies before the surface of the sphere.
pub(crate) fn crossing(offset: [f64; 3], axis: usize, up: bool, h: f64, radius: f64) -> f64 {
    let x = offset[axis].abs();
    let across = norm(offset).powi(2) - x * x;
    let surface = (radius * radius - across).max(0.0).sqrt();
    // The neighbour lies inside, so the step is towards the middle plane.
    let towards = (offset[axis] > 0.0) != up;
    let distance = if towards { x - surface } else { -x - surface };
    (distance / h).clamp(0.0, 1.0)
}

/// A free particle.
pub(crate) struct FreeParticle<'a> {
    grid: &'a Grid,
    particle: &'a Particle,
    surface: FreeSurface,
    /// Fluid share of each cell.
    volume: Vec<f64>,
}

impl<'a> FreeParticle<'a> {
    pub(crate) fn new(grid: &'a Grid, particle: &'a Particle, surface: FreeSurface) -> Self {
        let [nx, ny, nz] = grid.cells();
        let (h, radius) = (grid.spacing(), particle.radius());
        let mut volume = Vec::with_capacity(grid.n_cells());
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let offset = particle.offset(grid, grid.centre([i, j, k]));
                    volume.push(match surface {
                        FreeSurface::CutCell => volume_share(offset, h, radius),
                        FreeSurface::Staircase if norm(offset) < radius => 0.0,
                        FreeSurface::Staircase => 1.0,
                    });
                }
            }
        }
        Self {
            grid,
            particle,
            surface,
            volume,
        }
    }

    /// What cell (i, j, k) is.
    pub(crate) fn kind(&self, ijk: [usize; 3]) -> Kind {
        let (grid, h) = (self.grid, self.grid.spacing());
        let volume = self.volume[grid.index(ijk)];
        if volume < LEAST_VOLUME {
            return Kind::Inactive;
        }
        let offset = self.particle.offset(grid, grid.centre(ijk));
        if norm(offset) > self.particle.radius() + 2.0 * h {
            return Kind::Regular;
        }
        let mut cell = bare();
        for (link, (axis, up)) in STEPS.into_iter().enumerate() {
            let Some(other) = neighbour(grid, ijk, link) else {
                continue;
            };
            let there = self.volume[grid.index(other)];
            cell.weights[link] = match self.surface {
                _ if there < LEAST_VOLUME => 0.0,
                FreeSurface::Staircase => 1.0,
                FreeSurface::CutCell => {
                    let mut face = offset;
                    face[axis] += if up { 0.5 * h } else { -0.5 * h };
                    face_share(face, axis, h, self.particle.radius())
                }
            };
        }
        if volume == 1.0 && cell.weights.iter().all(|w| *w == 1.0) {
            return Kind::Regular;
        }
        cell.volume = volume;
        // A small cell with open faces would be stiffer than any other: it gets as much inertia as its faces ask for.
        cell.mass = volume.max(cell.weights.iter().sum::<f64>() / 6.0);
        Kind::Special(Box::new(cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Faces;
    use crate::domain::Domain;

    #[test]
    fn links_end_on_the_surface_and_their_ends_make_up_its_area() {
        let grid = Grid::new([32; 3], 1.0, [Faces::Periodic; 3]).unwrap();
        let particle = Particle::central(&grid, 9.3).unwrap();
        let material = Material::default();
        let pattern = SurfacePattern::Homeotropic;
        // With a weak hold the conductance of an end is its area times W h/L.
        let surface = AnchoredSurface {
            grid: &grid,
            particle: &particle,
            pattern: &pattern,
            anchoring: Anchoring::Weak(1e-9),
            boundary: Boundary::CutLink,
            material: &material,
        };
        let domain = Domain::new(grid, Default::default(), |ijk| surface.kind(ijk));
        let area: f64 = domain.special.iter().map(|s| s.sink / 1e-9).sum();
        let exact = 4.0 * std::f64::consts::PI * 9.3_f64.powi(2);
        assert!((area / exact - 1.0).abs() < 0.01, "{area} {exact}");
        for s in &domain.special {
            assert!((s.anchored - 1.0).abs() < 1e-8);
        }
        let inside = particle.mask(&grid).iter().filter(|m| **m).count();
        assert_eq!(domain.n_active + inside, grid.n_cells());
    }

    #[test]
    fn a_link_meets_the_surface_where_it_should() {
        let h = 0.5;
        let offset = [3.2, 0.3, -0.4];
        let share = crossing(offset, 0, false, h, 3.0);
        let end = [3.2 - share * h, 0.3, -0.4];
        assert!((norm(end) - 3.0).abs() < 1e-12, "{share}");
        let share = crossing([-3.2, 0.3, -0.4], 0, true, h, 3.0);
        assert!((norm([-3.2 + share * h, 0.3, -0.4]) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn cut_cells_have_the_volume_of_the_fluid_and_symmetric_faces() {
        let grid = Grid::new([24; 3], 1.0, [Faces::Periodic; 3]).unwrap();
        let particle = Particle::central(&grid, 7.4).unwrap();
        let free = FreeParticle::new(&grid, &particle, FreeSurface::CutCell);
        let fluid: f64 = free.volume.iter().sum();
        let exact = 24.0_f64.powi(3) - 4.0 / 3.0 * std::f64::consts::PI * 7.4_f64.powi(3);
        assert!((fluid - exact).abs() < 0.5, "{fluid} {exact}");
        let domain = Domain::new(grid, Default::default(), |ijk| free.kind(ijk));
        let weight = |from: usize, link: usize| {
            let special = domain.special.iter().find(|s| s.cell as usize == from);
            special.map_or(1.0, |s| s.weights[link])
        };
        for s in &domain.special {
            for link in 0..6 {
                let there = s.neighbours[link] as usize;
                let back = weight(there, link ^ 1);
                let seen = s.weights[link];
                let active = free.volume[there] >= LEAST_VOLUME;
                assert!(!active || (seen - back).abs() < 1e-9, "{seen} {back}");
                assert!(active || seen == 0.0);
            }
            assert!(s.mass >= s.volume && s.total_weight() <= 6.0 * s.mass + 1e-12);
        }
        // No cell is stiffer than a whole one, of six links.
        assert!(
            (domain.stiffest() - 12.0).abs() < 1e-9,
            "{}",
            domain.stiffest()
        );
    }
}
