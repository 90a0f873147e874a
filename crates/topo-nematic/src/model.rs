//! The model: which cells take part with which links, made from parameters.

use crate::anchoring::{Anchoring, Plate, SurfacePattern};
use crate::boundary::{AnchoredSurface, FreeParticle, FreeSurface};
use crate::domain::{Domain, Kind, Wall, Walls};
use crate::kernel::run::{Kernel, Threads};
use crate::parameters::{NematicParameters, Sides};
use crate::real::Real;
use crate::tensor::{Tensor5, uniaxial};
use crate::{Faces, Grid, Particle};

/// Tensors on an outer face, cell by cell.
pub(crate) type FaceValues = [[Option<Vec<Tensor5>>; 2]; 3];

/// What the particle's surface does at present.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Surface {
    /// It prefers a pattern.
    Anchored(SurfacePattern, Anchoring),
    /// It prefers nothing.
    Free(FreeSurface),
}

/// The walls of `grid`; values given for a face replace its plate.
pub(crate) fn walls(parameters: &NematicParameters, grid: &Grid, values: &FaceValues) -> Walls {
    let material = &parameters.material;
    let wall = |axis: usize, up: usize, plate: &Plate| {
        if grid.faces()[axis] == Faces::Periodic {
            return None;
        }
        if let Some(values) = &values[axis][up] {
            return Some(Wall {
                conductance: 2.0,
                values: values.clone(),
            });
        }
        let (conductance, _) =
            plate
                .anchoring
                .conductance(2.0, 1.0, grid.spacing() / material.elastic_constant);
        Some(Wall {
            conductance,
            values: vec![uniaxial(material.order(), plate.director_along(axis))],
        })
    };
    let sides = match parameters.sides {
        Sides::Periodic => Plate::default(),
        Sides::Walled(plate) => plate,
    };
    std::array::from_fn(|axis| {
        let plate = if axis == 2 {
            &parameters.plates
        } else {
            &sides
        };
        std::array::from_fn(|up| wall(axis, up, plate))
    })
}

/// The kernel of `grid` with a particle whose surface is as `surface` says.
pub(crate) fn kernel<T: Real>(
    parameters: &NematicParameters,
    grid: &Grid,
    particle: Option<&Particle>,
    surface: &Surface,
    values: &FaceValues,
    threads: Threads,
) -> Kernel<T> {
    let walls = walls(parameters, grid, values);
    let domain = match (particle, surface) {
        (None, _) => Domain::new(*grid, walls, |_| Kind::Regular),
        (Some(particle), Surface::Anchored(pattern, anchoring)) => {
            let surface = AnchoredSurface {
                grid,
                particle,
                pattern,
                anchoring: *anchoring,
                boundary: parameters.boundary,
                material: &parameters.material,
            };
            Domain::new(*grid, walls, |ijk| surface.kind(ijk))
        }
        (Some(particle), Surface::Free(surface)) => {
            let free = FreeParticle::new(grid, particle, *surface);
            Domain::new(*grid, walls, |ijk| free.kind(ijk))
        }
    };
    let field = parameters
        .field
        .map_or([0.0; 5], |field| field.molecular_field());
    Kernel::new(domain, &parameters.material, field, threads)
}
