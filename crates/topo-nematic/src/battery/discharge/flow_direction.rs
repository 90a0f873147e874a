//! Whether the flow of a discharge still has its first direction.

use serde::{Deserialize, Serialize};

use crate::NematicState;
use crate::stokes::MacField;

/// The first velocity of a discharge that was sampled, in units of its largest component, in every cell; zero outside the
/// fluid.
///
/// A direction needs no more than single precision.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct FlowDirection {
    first: Vec<[f32; 3]>,
}

impl FlowDirection {
    /// Correlation of a velocity with the first one, over the cells of the fluid: 1 along it, -1 against it.
    ///
    /// ```math
    /// c(t) = \frac{\langle u(t) \cdot u(t_1) \rangle}{\|u(t)\|\, \|u(t_1)\|}
    /// ```
    ///
    /// t_1 is the first time at which the fluid moves; `None` while it does not.
    ///
    /// # Validation
    /// `a_reversed_flow_is_against_the_first`, `val_flow_of_two_waves_turns_as_their_rates_say`
    pub fn correlation(&mut self, velocity: &MacField, state: &NematicState) -> Option<f64> {
        if self.first.is_empty() {
            let largest = velocity.max_abs();
            if !(largest.is_finite() && largest > 0.0) {
                return None;
            }
            self.first = vec![[0.0; 3]; state.grid().n_cells()];
            let first = &mut self.first;
            in_fluid(velocity, state, |cell, u| {
                first[cell] = u.map(|x| (x / largest) as f32);
            });
        }
        let (mut product, mut square, mut square_of_first) = (0.0, 0.0, 0.0);
        in_fluid(velocity, state, |cell, u| {
            for (x, first) in u.into_iter().zip(self.first[cell]) {
                let first = f64::from(first);
                product += x * first;
                square += x * x;
                square_of_first += first * first;
            }
        });
        let sizes = (square * square_of_first).sqrt();
        (sizes > 0.0).then(|| (product / sizes).clamp(-1.0, 1.0))
    }

    /// Whether it is one of a grid of so many cells.
    pub fn fits(&self, n_cells: usize) -> bool {
        let is_sound = |u: &[f32; 3]| u.iter().all(|x| x.is_finite());
        self.first.is_empty() || (self.first.len() == n_cells && self.first.iter().all(is_sound))
    }

    /// Bytes held.
    pub fn n_bytes(&self) -> usize {
        size_of_val(self.first.as_slice())
    }
}

/// Shows the velocity at the centre of every cell of the fluid.
fn in_fluid(velocity: &MacField, state: &NematicState, mut see: impl FnMut(usize, [f64; 3])) {
    let grid = state.grid();
    let [nx, ny, nz] = grid.cells();
    for (j, k) in (0..nz).flat_map(|k| (0..ny).map(move |j| (j, k))) {
        let is_fluid = state.fluid_in_row(j, k);
        for i in (0..nx).filter(|i| is_fluid(*i)) {
            see(grid.index([i, j, k]), velocity.at_centre([i, j, k]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;
    use crate::{Faces, Grid, Particle};

    fn still(with_particle: bool) -> NematicState {
        let faces = [Faces::Periodic, Faces::Periodic, Faces::Wall];
        let grid = Grid::new([12, 10, 8], 1.0, faces).unwrap();
        let particle = with_particle.then(|| Particle::central(&grid, 2.0).unwrap());
        NematicState::from_fn(grid, particle, |_| uniaxial(0.5, [0.0, 0.0, 1.0])).unwrap()
    }

    /// `along` x and `across` y, uniform but for what lies in the particle.
    fn uniform(state: &NematicState, along: f64, across: f64, inside: f64) -> MacField {
        let grid = state.grid();
        let [nx, ny, nz] = grid.cells();
        let mut velocity = MacField::zeros(grid);
        for (i, j, k) in
            (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| (i, j, k))))
        {
            let cell = grid.index([i, j, k]);
            // a face belongs to the fluid if one of its cells does
            let before = [(i + nx - 1) % nx, j, k];
            let fluid = state.is_fluid([i, j, k]) || state.is_fluid(before);
            velocity.component_mut(0)[cell] = if fluid { along } else { inside };
            velocity.component_mut(1)[cell] = across;
        }
        velocity
    }

    #[test]
    fn a_reversed_flow_is_against_the_first() {
        for with_particle in [false, true] {
            let state = still(with_particle);
            let mut direction = FlowDirection::default();
            let mut see = |along, across, inside| {
                direction.correlation(&uniform(&state, along, across, inside), &state)
            };
            // a fluid at rest has no direction and is no first one
            assert_eq!(see(0.0, 0.0, 0.0), None);
            let near = |c: Option<f64>, truth: f64| (c.unwrap() - truth).abs() < 1e-12;
            // weaker, against it, across, at 60 degrees to it; what the particle holds does not count
            assert!(near(see(3e-3, 0.0, 5.0), 1.0));
            assert!(near(see(2e-9, 0.0, -8.0), 1.0));
            assert!(near(see(-4.0, 0.0, 1e3), -1.0));
            assert!(near(see(0.0, 1e-4, 7.0), 0.0));
            assert!(near(see(0.5, 0.75_f64.sqrt(), 0.0), 0.5));
            assert_eq!(see(0.0, 0.0, 0.0), None);
            let n = state.grid().n_cells();
            assert!(direction.fits(n) && !direction.fits(n + 1));
            assert_eq!(direction.n_bytes(), 12 * n);
        }
    }
}
