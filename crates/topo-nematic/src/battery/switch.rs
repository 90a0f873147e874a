//! The release: the anchoring is switched.

use std::sync::OnceLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::NematicBattery;
use super::charge::ChargedNematic;
use super::record::FinalState;
use crate::anchoring::{Anchoring, SurfacePattern};
use crate::boundary::FreeSurface;
use crate::boundary::shares::norm;
use crate::domain::{STEPS, SpecialCell, neighbour};
use crate::kernel::run::{Kernel, Threads};
use crate::model::Surface;
use crate::real::Real;
use crate::{NematicError, NematicParameters, NematicState, Particle};

/// What the surface does after the switch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SwitchTarget {
    /// It prefers nothing: the director may take any orientation.
    Free(FreeSurface),
    /// It keeps its pattern: the nematic stays as it is.
    Keep,
    /// It prefers another pattern.
    Pattern {
        /// The pattern.
        pattern: SurfacePattern,
        /// How strongly.
        anchoring: Anchoring,
    },
}

impl Default for SwitchTarget {
    fn default() -> Self {
        Self::Free(FreeSurface::CutCell)
    }
}

/// How the anchoring is switched.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SwitchSettings {
    /// What the surface is switched to.
    #[schemars(example = SwitchTarget::Keep)]
    pub to: SwitchTarget,
    /// Duration of the switch, in τ_N; at once when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "τ_N", "x-default" = "at once", "exclusiveMinimum" = 0), example = 1.0)]
    pub ramp: Option<f64>,
}

impl SwitchSettings {
    /// Checks the settings for a battery with or without a particle.
    ///
    /// # Errors
    /// A broken pattern or ramp; a switch where there is no particle.
    pub fn check(&self, has_particle: bool) -> Result<(), NematicError> {
        if let Some(ramp) = self.ramp {
            topo_core::positive("switch.ramp", ramp)?;
        }
        if !has_particle && self.to != SwitchTarget::Keep {
            return Err(NematicError::NoParticle {
                operation: "a switch of the anchoring",
            });
        }
        if let SwitchTarget::Pattern { pattern, anchoring } = &self.to {
            pattern.check("switch.to.pattern.pattern")?;
            anchoring.checked("switch.to.pattern.anchoring.weak")?;
        }
        Ok(())
    }
}

/// A battery whose anchoring has just been switched, with the energy that the switch removed.
#[derive(Debug, Clone)]
pub struct SwitchedNematic {
    pub(crate) charged: ChargedNematic,
    pub(crate) settings: SwitchSettings,
    pub(crate) state: NematicState,
    start: f64,
    pub(super) final_state: OnceLock<FinalState>,
}

impl ChargedNematic {
    /// Switches the anchoring.
    ///
    /// A free surface keeps the values that the pattern had given it, as start values of the cells that the sphere cuts; their
    /// slope inside is chosen so that the energy does not jump, as far as that is possible.
    ///
    /// # Errors
    /// A broken pattern or ramp; a battery without a particle.
    pub fn switch(&self, settings: &SwitchSettings) -> Result<SwitchedNematic, NematicError> {
        settings.check(self.battery.particle.is_some())?;
        let settings = settings.clone();
        let mut state = self.state.clone();
        let start = if settings.ramp.is_some() {
            self.energy().total()
        } else {
            let kernel = self
                .battery
                .kernel::<f64>(&self.surface_after(&settings), Threads::One);
            extend_into_cut_cells(
                &self.battery,
                self.battery.parameters().anchoring,
                &kernel,
                self.energy().total(),
                &mut state,
            )
            .energy
        };
        Ok(SwitchedNematic {
            charged: self.clone(),
            settings,
            state,
            start,
            final_state: OnceLock::new(),
        })
    }
}

impl ChargedNematic {
    /// What the surface does once it is switched.
    pub(crate) fn surface_after(&self, settings: &SwitchSettings) -> Surface {
        match &settings.to {
            SwitchTarget::Free(surface) => Surface::Free(*surface),
            SwitchTarget::Keep => self.battery.charged_surface(),
            SwitchTarget::Pattern { pattern, anchoring } => {
                Surface::Anchored(pattern.clone(), *anchoring)
            }
        }
    }

    /// The end of a ramp, on the links of the anchored surface.
    pub(crate) fn surface_at_end_of_ramp(&self, settings: &SwitchSettings) -> Surface {
        match self.surface_after(settings) {
            Surface::Free(_) => {
                Surface::Anchored(self.battery.parameters().pattern.clone(), Anchoring::Free)
            }
            anchored => anchored,
        }
    }
}

/// Sets the links of `kernel` to the surface to a mixture of those of two others, `share` of the second.
pub(crate) fn blend<T: Real>(
    kernel: &mut Kernel<T>,
    from: &[SpecialCell],
    to: &[SpecialCell],
    share: f64,
) {
    for ((cell, a), b) in kernel.domain.special.iter_mut().zip(from).zip(to) {
        let mix = |a: f64, b: f64| (1.0 - share) * a + share * b;
        cell.sink = mix(a.sink, b.sink);
        cell.source = std::array::from_fn(|c| mix(a.source[c], b.source[c]));
        cell.offset = mix(a.offset, b.offset);
        if cell.sink > 0.0 {
            cell.anchored = mix(a.sink * a.anchored, b.sink * b.anchored) / cell.sink;
        }
    }
}

impl SwitchedNematic {
    /// What was switched.
    pub fn charged(&self) -> &ChargedNematic {
        &self.charged
    }

    /// The tensor field just after the switch.
    pub fn state(&self) -> &NematicState {
        &self.state
    }

    /// Energy just after the switch, in L ξ_N.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Energy that the switch itself removed, in L ξ_N; negative if it added energy.
    pub fn removed(&self) -> f64 {
        self.charged.energy().total() - self.start
    }
}

/// A cell inside the sphere that takes part when it is free: its value on the surface, and the slope from there inwards.
struct Extension {
    cell: usize,
    on_surface: [f64; 5],
    inwards: [f64; 5],
}

/// Steepest extension tried, as a multiple of the linear one.
const STEEPEST: f64 = 3.0;

/// A field that was continued into the sphere.
pub(crate) struct Extended {
    /// Its energy, in L ξ_N.
    pub energy: f64,
    /// Slope from the surface inwards, in multiples of that outside: near 1 where apertures and volumes are right.
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "what the tests of the switch look at")
    )]
    pub steepness: f64,
}

/// Gives values to the cells inside the sphere that `kernel` holds active, so that the energy is `goal` if possible.
///
/// `anchoring` is what has held the surface so far.
///
/// # Validation
/// `the_field_goes_on_into_the_sphere_about_as_steeply_as_outside`
pub(crate) fn extend_into_cut_cells(
    battery: &NematicBattery,
    anchoring: Anchoring,
    kernel: &Kernel<f64>,
    goal: f64,
    state: &mut NematicState,
) -> Extended {
    let extensions = extensions(battery, anchoring, kernel, state);
    let n = state.grid().n_cells();
    let mut q = vec![0.0; kernel.array_length()];
    kernel.spread(state.q_tensor(), &mut q);
    let stride = kernel.stride;
    let mut energy = |steepness: f64| {
        for e in &extensions {
            for c in 0..5 {
                q[c * stride + e.cell] = e.on_surface[c] + steepness * e.inwards[c];
            }
        }
        kernel.energy(&q).total()
    };
    let mut steepness = 0.0;
    let mut start = energy(steepness);
    if !extensions.is_empty() && start < goal {
        // The energy is a convex function of the steepness but for its bulk part: bisect between flat and too steep.
        let (mut low, mut high) = (0.0, STEEPEST);
        start = energy(high);
        steepness = high;
        if start > goal {
            for _ in 0..60 {
                steepness = 0.5 * (low + high);
                start = energy(steepness);
                if (start / goal - 1.0).abs() < 1e-12 {
                    break;
                }
                if start < goal {
                    low = steepness;
                } else {
                    high = steepness;
                }
            }
        }
    }
    let q = state.q_mut();
    for e in &extensions {
        for c in 0..5 {
            q[c * n + e.cell] = e.on_surface[c] + steepness * e.inwards[c];
        }
    }
    Extended {
        energy: start,
        steepness,
    }
}

/// Values and slopes of the cells inside the sphere, from the links that cut its surface.
fn extensions(
    battery: &NematicBattery,
    anchoring: Anchoring,
    kernel: &Kernel<f64>,
    state: &NematicState,
) -> Vec<Extension> {
    let grid = &battery.grid;
    let Some(particle) = &battery.particle else {
        return Vec::new();
    };
    let [nx, ny, _] = grid.cells();
    let cells = kernel.domain.special.iter().map(|s| s.cell as usize);
    cells
        .map(|cell| (cell, [cell % nx, cell / nx % ny, cell / (nx * ny)]))
        .filter(|(_, ijk)| particle.contains_cell(grid, *ijk))
        .map(|(cell, ijk)| extension(battery.parameters(), particle, anchoring, state, cell, ijk))
        .collect()
}

/// Value and slope of one cell inside the sphere: means over its links that cut the surface.
fn extension(
    parameters: &NematicParameters,
    particle: &Particle,
    anchoring: Anchoring,
    state: &NematicState,
    cell: usize,
    ijk: [usize; 3],
) -> Extension {
    let grid = state.grid();
    let (h, order) = (grid.spacing(), parameters.material.order());
    let (mut on_surface, mut inwards, mut weights) = ([0.0; 5], [0.0; 5], 0.0);
    for (link, (axis, up)) in STEPS.into_iter().enumerate() {
        let Some(outer) = neighbour(grid, ijk, link).filter(|n| state.is_fluid(*n)) else {
            continue;
        };
        let outside = particle.offset(grid, grid.centre(outer));
        let share = crate::boundary::crossing(outside, axis, !up, h, particle.radius());
        let mut end = outside;
        end[axis] += if up { -share * h } else { share * h };
        let there = state.tensor(grid.index(outer));
        let link_share = share.max(crate::boundary::SHORTEST_LINK);
        // With weak anchoring the surface is between what it prefers and what it touches.
        let (held, _) = anchoring.conductance(
            1.0 / link_share,
            (end[axis] / norm(end)).abs(),
            h / parameters.material.elastic_constant,
        );
        let held = held * link_share;
        let wanted = parameters.pattern.q_tensor(order, end);
        for c in 0..5 {
            let surface = there[c] + held * (wanted[c] - there[c]);
            on_surface[c] += link_share * surface;
            // link_share cancels in the weighted slope.
            inwards[c] += (1.0 - share) * (surface - there[c]);
        }
        weights += link_share;
    }
    if weights > 0.0 {
        on_surface = on_surface.map(|x| x / weights);
        inwards = inwards.map(|x| x / weights);
    } else {
        let offset = particle.offset(grid, grid.centre(ijk));
        on_surface = match anchoring {
            Anchoring::Free => state.tensor(cell),
            _ => parameters.pattern.q_tensor(order, offset),
        };
    }
    Extension {
        cell,
        on_surface,
        inwards,
    }
}

#[cfg(test)]
mod tests;
