//! Whether a charged state is a minimum of its energy.

use serde::{Deserialize, Serialize};
use topo_core::MinimumState;

use crate::Particle;
use crate::hessian::{Accuracy, Hessian, LowestMode};
use crate::kernel::run::Kernel;

/// How the check of a charged state ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MinimumReport {
    /// Lowest eigenvalue of the Hessian of the energy in the inner product of the gradient flow, in L/ξ_N²: a small change along
    /// its mode decays at Γ times this.
    pub lowest_eigenvalue: f64,
    /// Norm of the residual A v − λ v of its mode v, in L/ξ_N².
    pub residual: f64,
    /// What the eigenvalue means for the state.
    pub state: MinimumState,
    /// Kicks along unstable modes, each followed by a relaxation.
    pub n_kicks: u32,
    /// Products with the Hessian over all checks, each as expensive as a step of the relaxation.
    pub n_products: u64,
}

/// Above this, in units of λ₀, a state is a minimum.
const MINIMUM: f64 = 1e-2;
/// Below minus this, it is a saddle. The eigenvalue is found to this accuracy.
const SADDLE: f64 = 1e-3;
/// Tilt of the director, in radians, that changes a tensor as much as a kick does where it changes it most.
const KICK: f64 = 0.05;

fn state_of(eigenvalue: f64, unit: f64) -> MinimumState {
    if eigenvalue > MINIMUM * unit {
        MinimumState::Minimum
    } else if eigenvalue < -SADDLE * unit {
        MinimumState::Saddle
    } else {
        MinimumState::Marginal
    }
}

/// A state that was checked.
pub(super) struct Check<'a> {
    hessian: Hessian<'a>,
    kernel: &'a Kernel<f64>,
    particle: Option<&'a Particle>,
    q: &'a [f64],
    lowest: LowestMode,
    pub state: MinimumState,
}

impl<'a> Check<'a> {
    /// Looks for the lowest mode of the state `q`, or for any unstable one if it `can_kick`; `None` when `stop` said so or none was
    /// found.
    pub fn new(
        kernel: &'a Kernel<f64>,
        particle: Option<&'a Particle>,
        q: &'a [f64],
        can_kick: bool,
        n_products: &mut u64,
        stop: impl FnMut() -> bool,
    ) -> Option<Self> {
        let unit = kernel.plate_mode();
        let wanted = Accuracy {
            near_zero: SADDLE * unit,
            unit,
            any_saddle: can_kick,
        };
        let hessian = Hessian::new(kernel, q);
        let lowest = hessian.lowest(particle, wanted, n_products, stop)?;
        let state = state_of(lowest.eigenvalue, unit);
        Some(Self {
            hessian,
            kernel,
            particle,
            q,
            lowest,
            state,
        })
    }

    pub fn report(&self, n_kicks: u32, n_products: u64) -> MinimumReport {
        MinimumReport {
            lowest_eigenvalue: self.lowest.eigenvalue,
            residual: self.lowest.residual,
            state: self.state,
            n_kicks,
            n_products,
        }
    }

    /// The state kicked along its lowest mode, to the side of lower energy; both being the same to 1e-9, to that on which the mode
    /// has a part of the search's start.
    pub fn kicked(&self, n_products: &mut u64) -> Option<Vec<f64>> {
        let mut mode = self.hessian.mode(self.particle, &self.lowest, n_products)?;
        let kernel = self.kernel;
        let order = kernel.material().order();
        let turned = 1.5 * order * std::f64::consts::SQRT_2;
        let size = KICK * turned / kernel.largest(&mode);
        let energy = |sign: f64| {
            let mut q = self.q.to_vec();
            kernel.linear(&mut q, 1.0, [(sign * size, &mode[..])]);
            kernel.energy(&q).total()
        };
        let [plus, minus] = [energy(1.0), energy(-1.0)];
        let sign = if minus < plus - 1e-9 * plus.abs() {
            -1.0
        } else {
            1.0
        };
        kernel.linear(&mut mode, sign * size, [(1.0, self.q)]);
        mode.iter().all(|x| x.is_finite()).then_some(mode)
    }
}

impl Kernel<f64> {
    /// Decay of the director's slowest mode between strong plates, over Γ: L π²/L_z².
    fn plate_mode(&self) -> f64 {
        let height = self.domain.grid.extent()[2];
        self.material().elastic_constant * (std::f64::consts::PI / height).powi(2)
    }
}
