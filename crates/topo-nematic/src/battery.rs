//! The nematic battery: charge (patterned anchoring, relax) → release (switch the anchoring) → discharge.

pub(crate) mod charge;
pub(crate) mod charge_settings;
mod charging;
pub(crate) mod discharge;
pub(crate) mod final_state;
pub(crate) mod hooks;
pub(crate) mod minimum;
pub(crate) mod protocol;
pub mod record;
pub(crate) mod switch;

use crate::kernel::run::{Kernel, Threads};
use crate::memory::{MemoryEstimate, estimate};
use crate::model::{FaceValues, Surface, kernel};
use crate::real::Real;
use crate::tensor::{Tensor5, uniaxial};
use crate::{
    Faces, Grid, NematicAccuracy, NematicError, NematicParameters, NematicState, Particle,
};

/// A colloid between plates, ready to be charged.
#[derive(Debug, Clone)]
pub struct NematicBattery {
    parameters: NematicParameters,
    accuracy: NematicAccuracy,
    grid: Grid,
    particle: Option<Particle>,
    values: FaceValues,
    warnings: Vec<String>,
}

impl NematicBattery {
    /// A battery of these parameters.
    ///
    /// # Errors
    /// A parameter out of range, a particle that does not fit, or a grid that needs more memory than allowed.
    pub fn new(
        parameters: &NematicParameters,
        accuracy: &NematicAccuracy,
    ) -> Result<Self, NematicError> {
        let parameters = parameters.clone().checked()?;
        let accuracy = accuracy.checked()?;
        let grid = parameters.grid(parameters.spacing)?;
        let needed = estimate(&grid, accuracy.precision).total();
        if let Some(limit) = accuracy.memory_limit.filter(|limit| needed > *limit) {
            return Err(NematicError::TooMuchMemory {
                cells: grid.cells(),
                needed,
                limit,
            });
        }
        let particle = if parameters.particle {
            Some(Particle::central(&grid, parameters.radius)?)
        } else {
            None
        };
        Ok(Self {
            warnings: parameters.warnings(&grid),
            parameters,
            accuracy,
            grid,
            particle,
            values: FaceValues::default(),
        })
    }

    /// The battery with tensors given on an outer face by a function of position, instead of what its plate prefers.
    ///
    /// `axis` is 0, 1, 2 for x, y, z; `upper` says which of its two faces.
    ///
    /// # Errors
    /// [`NematicError::PeriodicFace`] when the face is periodic, [`NematicError::NotFinite`] when a value is not finite.
    pub fn with_face(
        mut self,
        axis: usize,
        upper: bool,
        f: impl Fn([f64; 3]) -> Tensor5,
    ) -> Result<Self, NematicError> {
        let axis = axis.min(2);
        if self.grid.faces()[axis] == Faces::Periodic {
            return Err(NematicError::PeriodicFace { axis });
        }
        let (cells, extent) = (self.grid.cells(), self.grid.extent());
        let (fast, slow) = match axis {
            0 => (1, 2),
            1 => (0, 2),
            _ => (0, 1),
        };
        let mut values = Vec::with_capacity(cells[fast] * cells[slow]);
        for b in 0..cells[slow] {
            for a in 0..cells[fast] {
                let mut ijk = [0; 3];
                ijk[fast] = a;
                ijk[slow] = b;
                let mut point = self.grid.centre(ijk);
                point[axis] = if upper { extent[axis] } else { 0.0 };
                let value = f(point);
                if value.iter().any(|x| !x.is_finite()) {
                    return Err(NematicError::NotFinite {
                        what: "the tensor on a face",
                        cell: values.len(),
                    });
                }
                values.push(value);
            }
        }
        self.values[axis][usize::from(upper)] = Some(values);
        Ok(self)
    }

    /// Its parameters.
    pub fn parameters(&self) -> &NematicParameters {
        &self.parameters
    }

    /// The accuracy settings.
    pub fn accuracy(&self) -> &NematicAccuracy {
        &self.accuracy
    }

    /// Its grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Its particle, if there is one.
    pub fn particle(&self) -> Option<&Particle> {
        self.particle.as_ref()
    }

    /// What is unusual about it, although valid.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Estimate of the memory that its runs need, without flow.
    pub fn memory(&self) -> MemoryEstimate {
        estimate(&self.grid, self.accuracy.precision)
    }

    /// Diffusion time R²/(Γ L), in τ_N.
    pub fn diffusion_time(&self) -> f64 {
        let m = &self.parameters.material;
        self.parameters.radius.powi(2) / (m.rotational_mobility * m.elastic_constant)
    }

    /// The state before charging: uniform, along z, tilted by `seed` cos(π z/L_z) towards `azimuth`, both in radians.
    ///
    /// Without a seed the symmetric saddle above the buckling transition is kept to rounding.
    ///
    /// # Errors
    /// Never for finite arguments.
    pub fn start(&self, seed: f64, azimuth: f64) -> Result<NematicState, NematicError> {
        self.start_on(self.grid, self.particle, seed, azimuth)
    }

    pub(crate) fn start_on(
        &self,
        grid: Grid,
        particle: Option<Particle>,
        seed: f64,
        azimuth: f64,
    ) -> Result<NematicState, NematicError> {
        let (order, height) = (self.parameters.material.order(), grid.extent()[2]);
        NematicState::from_fn(grid, particle, |[_, _, z]| {
            let tilt = seed * (std::f64::consts::PI * (z / height - 0.5)).cos();
            let director = [
                tilt.sin() * azimuth.cos(),
                tilt.sin() * azimuth.sin(),
                tilt.cos(),
            ];
            uniaxial(order, director)
        })
    }

    /// The kernel with the surface as charged.
    pub(crate) fn charged_surface(&self) -> Surface {
        Surface::Anchored(self.parameters.pattern.clone(), self.parameters.anchoring)
    }

    pub(crate) fn kernel<T: Real>(&self, surface: &Surface, threads: Threads) -> Kernel<T> {
        kernel(
            &self.parameters,
            &self.grid,
            self.particle.as_ref(),
            surface,
            &self.values,
            threads,
        )
    }
}
