//! The whole field of a colloid at one time: order, director, tensor, velocity.

use super::about::About;
use super::npz::Archive;
use super::vtk::{self, Array, Lattice};
use crate::error::ViewError;
use std::path::Path;
use topo_lab::FieldSnapshot;
use topo_nematic::tensor::{matrix, order_and_director};

/// What follows from a field: zero inside the particle.
pub struct Derived {
    lattice: Lattice,
    order: Vec<f32>,
    director: Vec<f32>,
    /// All nine components, row by row.
    tensor: Vec<f32>,
    fluid: Vec<u8>,
    /// Point by point; none without flow.
    velocity: Option<Vec<f32>>,
}

impl Derived {
    /// Derives it.
    pub fn of(field: &FieldSnapshot) -> Self {
        let n = field.fluid.len();
        let mut derived = Self {
            lattice: Lattice {
                n_points: field.cells,
                origin: field.origin,
                spacing: field.spacing,
            },
            order: Vec::with_capacity(n),
            director: Vec::with_capacity(3 * n),
            tensor: Vec::with_capacity(9 * n),
            fluid: field.fluid.iter().map(|f| u8::from(*f)).collect(),
            velocity: field.velocity.as_ref().map(|u| {
                (0..n)
                    .flat_map(|i| [u[i], u[n + i], u[2 * n + i]])
                    .collect()
            }),
        };
        for i in 0..n {
            if field.fluid[i] {
                let q = field.tensor(i);
                let (order, d) = order_and_director(&q);
                derived.order.push(order as f32);
                derived.director.extend(d.map(|x| x as f32));
                derived.tensor.extend(matrix(&q).iter().map(|x| *x as f32));
            } else {
                derived.order.push(0.0);
                derived.director.extend([0.0; 3]);
                derived.tensor.extend([0.0; 9]);
            }
        }
        derived
    }

    /// Writes it as `.vti`.
    pub fn write_vtk(&self, about: &About, path: &Path) -> Result<(), ViewError> {
        let mut arrays = vec![
            Array::single("order", 1, &self.order),
            Array::single("director", 3, &self.director),
            Array::single("Q", 9, &self.tensor),
            Array::bytes("fluid", &self.fluid),
        ];
        let velocity = self.velocity.as_ref();
        arrays.extend(velocity.map(|u| Array::single("velocity", 3, u)));
        vtk::image(path, about, &self.lattice, &arrays)
    }

    /// Writes it as `.npz`.
    pub fn write_npz(
        &self,
        about: &About,
        field: &FieldSnapshot,
        path: &Path,
    ) -> Result<(), ViewError> {
        let [nx, ny, nz] = field.cells;
        let mut archive = Archive::new(about)?;
        archive.add("time", &[], vec![field.time.unwrap_or(f64::NAN)])?;
        archive.add("origin", &[3], field.origin.to_vec())?;
        archive.add("spacing", &[], vec![field.spacing])?;
        archive.add("order", &[nz, ny, nx], self.order.clone())?;
        archive.add("director", &[nz, ny, nx, 3], self.director.clone())?;
        archive.add("Q", &[nz, ny, nx, 3, 3], self.tensor.clone())?;
        archive.add("fluid", &[nz, ny, nx], self.fluid.clone())?;
        if let Some(u) = &self.velocity {
            archive.add("velocity", &[nz, ny, nx, 3], u.clone())?;
        }
        archive.write(path)
    }

    /// What nemaktis reads: `n`, `Q` over the equilibrium order as xx, yy, zz, xy, xz, yz, and `domain_mask`, positive in the
    /// nematic and negative in the particle; lengths in micrometres.
    pub fn write_nemaktis(
        &self,
        about: &About,
        order: f64,
        unit: f64,
        path: &Path,
    ) -> Result<(), ViewError> {
        let n = self.fluid.len();
        let (mut director, mut q) = (self.director.clone(), Vec::with_capacity(6 * n));
        for (i, m) in self.tensor.chunks_exact(9).enumerate() {
            let scale = (1.0 / order) as f32;
            if self.fluid[i] > 0 {
                q.extend([m[0], m[4], m[8], m[1], m[2], m[5]].map(|x| scale * x));
            } else {
                // not used, but a director has to be there
                director[3 * i + 2] = 1.0;
                q.extend([-0.5, -0.5, 1.0, 0.0, 0.0, 0.0]);
            }
        }
        let mask = self.fluid.iter().map(|f| if *f > 0 { 1.0 } else { -1.0 });
        let mask: Vec<f32> = mask.collect();
        let lattice = Lattice {
            origin: self.lattice.origin.map(|x| x * unit),
            spacing: self.lattice.spacing * unit,
            ..self.lattice
        };
        let arrays = [
            Array::single("n", 3, &director),
            Array::single("Q", 6, &q),
            Array::single("domain_mask", 1, &mask),
        ];
        // the parameters stay in the units of the case
        let about = about
            .clone()
            .with("units.points", "micrometre")
            .with("micrometres_per_xi_N", unit);
        vtk::image(path, &about, &lattice, &arrays)
    }
}
