//! What takes up the work of an opening rod: a spring and a dashpot side by side.

use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{in_range, non_negative};

use crate::energy::{Force, Stiffness};
use crate::relaxation::excess;
use crate::{Chain, EndCondition, Ends, RodError, RodState};

/// What a load acts between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LoadPlace {
    /// The two ends of the open rod.
    #[default]
    Ends,
    /// The first end and a fixed anchor, the last end being held.
    First,
    /// The last end and a fixed anchor, the first end being held.
    Last,
}

/// A load: a spring and a dashpot side by side on one line, of the length r.
///
/// ```math
/// F = k\,(r - r_0) + c\,\dot r, \qquad r = |x_1 - x_0|
/// ```
///
/// F draws its two ends together, per area of the rod's cross-section. A dashpot has no direction while its ends are in one place,
/// as the tips of a rod that has just been cut: within a tenth of h it resists their relative motion in all directions alike,
/// and farther apart along the line only. Of the same length is the part of a spring with a rest length where its push has not
/// its full strength yet.
///
/// The anchor of a load at one end is where that end is when the load is attached, or that and `rest_length` along `direction`.
///
/// # Validation
/// `val_clamped_rod_unbends_against_a_spring`, `val_cut_circle_works_on_a_dashpot`, `law_what_is_released_is_work_and_heat`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EndLoad {
    /// Between the two ends, or between one end and an anchor.
    #[schemars(example = LoadPlace::Last)]
    pub between: LoadPlace,
    /// Stiffness k of the spring, per area.
    #[schemars(range(min = 0, max = 1e9), extend("x-unit" = "E_b/h"), example = 0.01)]
    pub spring: f64,
    /// Length r_0 at which the spring is at rest.
    #[schemars(range(min = 0, max = 1e9), extend("x-unit" = "h"), example = 10.0)]
    pub rest_length: f64,
    /// Resistance c of the dashpot, per area.
    #[schemars(range(min = 0, max = 1e12), extend("x-unit" = "η/h"), example = 0.5)]
    pub dashpot: f64,
    /// From the end to the anchor of a load at one end that has a rest length.
    #[schemars(extend("x-unit" = "1", "x-default" = "none", "examples" = [[1.0, 0.0, 0.0]]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
}

/// Length within which a line has no direction yet, in h.
const UNDIRECTED: f64 = 0.1;

impl EndLoad {
    /// Checks every number, and that something holds the rod against a load at one end.
    ///
    /// # Errors
    /// Names what is wrong and what would be right.
    pub fn checked(self, ends: &Ends) -> Result<Self, RodError> {
        for (name, value, most) in [
            ("discharge.load.spring", self.spring, 1e9),
            ("discharge.load.rest_length", self.rest_length, 1e9),
            ("discharge.load.dashpot", self.dashpot, 1e12),
        ] {
            non_negative(name, value)?;
            in_range(name, value, 0.0, most)?;
        }
        let wrong = |key, reason| Err(RodError::Load { key, reason });
        if self.spring == 0.0 && self.dashpot == 0.0 {
            return wrong(
                "discharge.load",
                "a load without `spring` and `dashpot` does nothing: give one of them, or leave the table out",
            );
        }
        let away = self.direction.map(Vector3::from);
        if away.is_some_and(|d| !(d.norm() > 0.0 && d.norm().is_finite())) {
            return wrong(
                "discharge.load.direction",
                "a direction is three finite numbers that are not all zero",
            );
        }
        let Some([own, other]) = self.end() else {
            if away.is_some() {
                return wrong(
                    "discharge.load.direction",
                    "a load between the ends has the direction of their line: leave it out, or write between = \"last\"",
                );
            }
            return Ok(self);
        };
        if ends.conditions[other] == EndCondition::Free {
            return wrong(
                "discharge.load.between",
                "the other end is free, so nothing would hold the rod against the load (its viscosity is internal: a rod with a free end carries no net force): pin or clamp it in `discharge.ends`, or write between = \"ends\"",
            );
        }
        if ends.conditions[own] != EndCondition::Free {
            return wrong(
                "discharge.load.between",
                "that end is held, so it would not move the load: free it in `discharge.ends`, or load the other one",
            );
        }
        if away.is_some() != (self.rest_length > 0.0) {
            return wrong(
                "discharge.load.direction",
                "the anchor of a load at one end is `rest_length` away along `direction`: give both or neither",
            );
        }
        Ok(self)
    }

    /// The loaded end and the other one, of a load at one end.
    fn end(&self) -> Option<[usize; 2]> {
        match self.between {
            LoadPlace::Ends => None,
            LoadPlace::First => Some([0, 1]),
            LoadPlace::Last => Some([1, 0]),
        }
    }
}

/// A load attached to a rod.
#[derive(Debug)]
pub(crate) struct Load {
    settings: EndLoad,
    line: LoadLine,
    anchor: Vector3<f64>,
    n_vertices: usize,
    /// At the state evaluated last.
    pub(crate) here: Pull,
    /// At the state accepted last.
    pub(crate) accepted: Pull,
}

/// The vertices that a load acts on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LoadLine {
    /// None: the anchor.
    pub(crate) from: Option<usize>,
    pub(crate) to: usize,
}

impl LoadLine {
    /// Relative motion of its two ends in a component-major vector.
    pub(crate) fn relative(&self, u: &[f64], n: usize) -> Vector3<f64> {
        self.relative_of(|i| Vector3::new(u[i], u[n + i], u[2 * n + i]))
    }

    /// Relative motion of its two ends.
    pub(crate) fn relative_of(&self, at: impl Fn(usize) -> Vector3<f64>) -> Vector3<f64> {
        self.from
            .map_or_else(|| at(self.to), |from| at(self.to) - at(from))
    }
}

/// A load at a state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pull {
    /// From its first end to the other one, in h.
    line: Vector3<f64>,
    /// Of the spring, per area.
    pub(crate) energy: f64,
    /// On the vertex `to`, in E_b.
    pub(crate) force: Vector3<f64>,
    /// Resistance to relative motion, in η/h.
    pub(crate) damping: Matrix3<f64>,
}

impl Load {
    /// The load attached to an open component at `state`.
    pub(crate) fn attached(settings: EndLoad, chain: &Chain, state: &RodState) -> Self {
        let ends = [chain.first(), chain.last()];
        let (line, anchor) = match settings.end() {
            None => (
                LoadLine {
                    from: Some(ends[0]),
                    to: ends[1],
                },
                Vector3::zeros(),
            ),
            Some([own, _]) => {
                let to = ends[own];
                let away = settings.direction.map_or_else(Vector3::zeros, |d| {
                    Vector3::from(d).normalize() * settings.rest_length
                });
                (LoadLine { from: None, to }, state.vertices()[to] + away)
            }
        };
        let mut load = Self {
            here: Pull::slack(),
            accepted: Pull::slack(),
            settings,
            line,
            anchor,
            n_vertices: state.n_vertices(),
        };
        load.here = load.at(state);
        load.accepted = load.here;
        load
    }

    pub(crate) fn line(&self) -> LoadLine {
        self.line
    }

    fn at(&self, state: &RodState) -> Pull {
        let EndLoad {
            spring,
            rest_length,
            ..
        } = self.settings;
        let x = state.vertices();
        let d = self.line.relative_of(|i| x[i])
            - self.line.from.map_or(self.anchor, |_| Vector3::zeros());
        let square = d.norm_squared() + UNDIRECTED * UNDIRECTED;
        let (energy, force) = if rest_length == 0.0 {
            (0.5 * spring * d.norm_squared(), d * -spring)
        } else {
            let stretched = square.sqrt() - Self::rest(rest_length);
            (
                0.5 * spring * stretched * stretched,
                d * (-spring * stretched / square.sqrt()),
            )
        };
        Pull {
            line: d,
            energy,
            force,
            damping: self.damping_along(d),
        }
    }

    /// Resistance of the dashpot to relative motion where its line is `d`: c along it, and across it c q², q = ε²/(|d|² + ε²).
    fn damping_along(&self, d: Vector3<f64>) -> Matrix3<f64> {
        let square = d.norm_squared() + UNDIRECTED * UNDIRECTED;
        let share = UNDIRECTED * UNDIRECTED / square;
        let along = d * d.transpose() * ((1.0 + share) / square);
        (along + Matrix3::from_diagonal_element(share * share)) * self.settings.dashpot
    }

    /// That over the last step, along the mean of the lines before and after it: across that line a step that turns it as a whole moves
    /// its ends, not along it.
    fn mean_damping(&self) -> Matrix3<f64> {
        self.damping_along((self.accepted.line + self.here.line) * 0.5)
    }

    /// Regularised length of a spring at rest.
    fn rest(rest_length: f64) -> f64 {
        rest_length.hypot(UNDIRECTED)
    }

    /// Evaluates it at `state` and adds its force.
    pub(crate) fn add_force(&mut self, state: &RodState, force: &mut Force) {
        self.here = self.at(state);
        force.vertex[self.line.to] += self.here.force;
        if let Some(from) = self.line.from {
            force.vertex[from] -= self.here.force;
        }
    }

    /// Makes the state evaluated last the accepted one; of a state that a checkpoint remembers, evaluates it.
    pub(crate) fn accept(&mut self) {
        self.accepted = self.here;
    }

    /// As [`accept`](Self::accept) at a state that was not evaluated.
    pub(crate) fn accept_at(&mut self, state: &RodState) {
        self.here = self.at(state);
        self.accept();
    }

    /// Adds the stiffness of the spring and, over the time `s`, the resistance of the dashpot.
    pub(crate) fn add_stiffness(&self, s: f64, stiffness: &mut Stiffness) {
        let EndLoad {
            spring,
            rest_length,
            ..
        } = self.settings;
        let d = self.here.line;
        let own = if rest_length == 0.0 {
            Matrix3::from_diagonal_element(spring)
        } else {
            let square = d.norm_squared() + UNDIRECTED * UNDIRECTED;
            let along = d * d.transpose() / square;
            let tight = (1.0 - Self::rest(rest_length) / square.sqrt()).max(0.0);
            (along + (Matrix3::identity() - along) * tight) * spring
        };
        let block = own + self.here.damping / s;
        match self.line.from {
            None => stiffness.diagonal[self.line.to] += block,
            Some(from) => stiffness.add_further(from as u32, self.line.to as u32, block),
        }
        stiffness.further.sort_by_key(|p| (p.0, p.1));
    }

    /// Relative motion of its two ends in a component-major vector.
    pub(crate) fn relative(&self, u: &[f64]) -> Vector3<f64> {
        self.line.relative(u, self.n_vertices)
    }

    /// What of a change of rate over the last step, from `before` to `after`, is due to the turning of its line alone: nothing moves
    /// along the line of ends that go round each other, though their velocities turn.
    pub(crate) fn turning(&self, before: &[f64], after: &[f64]) -> Vector3<f64> {
        let unit = |d: Vector3<f64>| d / d.norm().hypot(UNDIRECTED);
        let mean = unit((self.accepted.line + self.here.line) * 0.5);
        let [then, now] = [(before, &self.accepted), (after, &self.here)]
            .map(|(rate, pull)| self.relative(rate).dot(&(mean - unit(pull.line))));
        mean * (now - then)
    }

    /// Work on it over the last step: what its spring has taken up and its dashpot dissipates, given the change a of the relative
    /// rate of its ends and W⁻¹ a.
    pub(crate) fn work(
        &self,
        step: &[f64],
        dt: f64,
        [a, smoothed]: [Vector3<f64>; 2],
        g: Option<f64>,
    ) -> f64 {
        let damping = self.mean_damping();
        let form = |u: Vector3<f64>, v: Vector3<f64>| u.dot(&(damping * v));
        let moved = self.relative(step);
        let slow = form(moved, moved);
        let heat = slow * (1.0 + excess(slow, g, a, smoothed, form)) / dt;
        heat + self.here.energy - self.accepted.energy
    }

    /// What its dashpot resists a held vertex `i` with at the relative velocity of `velocity`; 0 for other vertices.
    pub(crate) fn resistance(
        &self,
        i: usize,
        velocity: impl Fn(usize) -> Vector3<f64>,
    ) -> Vector3<f64> {
        let side = if i == self.line.to {
            1.0
        } else if Some(i) == self.line.from {
            -1.0
        } else {
            return Vector3::zeros();
        };
        self.mean_damping() * self.line.relative_of(velocity) * side
    }
}

impl Pull {
    fn slack() -> Self {
        Self {
            line: Vector3::zeros(),
            energy: 0.0,
            force: Vector3::zeros(),
            damping: Matrix3::zeros(),
        }
    }
}

/// The velocity with a dashpot between two vertices, by that without it.
///
/// ```math
/// (A + T D T^T)^{-1} = A^{-1} - Y (1 + D\,T^T Y)^{-1} D\,T^T A^{-1}, \qquad Y = A^{-1} T
/// ```
///
/// A resists the three directions alike, so Y is one column and TᵀY a number; D, a 3 × 3 matrix, couples them.
#[derive(Debug)]
pub(crate) struct LoadCorrection {
    line: LoadLine,
    column: Vec<f64>,
    pub(crate) damping: Matrix3<f64>,
}

impl LoadCorrection {
    pub(crate) fn new(line: LoadLine) -> Self {
        Self {
            line,
            column: Vec::new(),
            damping: Matrix3::zeros(),
        }
    }

    pub(crate) fn n_bytes(&self) -> usize {
        size_of::<f64>() * self.column.capacity()
    }

    /// The right-hand side of Y, of vertices that are free.
    pub(crate) fn unit(&mut self, fixed: &[bool]) -> &mut [f64] {
        self.column.clear();
        self.column.resize(fixed.len(), 0.0);
        let LoadLine { from, to } = self.line;
        for (i, side) in from.map(|i| (i, -1.0)).into_iter().chain([(to, 1.0)]) {
            if !fixed[i] {
                self.column[i] = side;
            }
        }
        &mut self.column
    }

    /// Turns velocities without the dashpot into those with it.
    pub(crate) fn correct(&self, v: &mut [f64]) {
        let y = |i: usize| self.column[i];
        let own = y(self.line.to) - self.line.from.map_or(0.0, y);
        let relative = self.damping * self.line.relative(v, self.column.len());
        let system = Matrix3::identity() + self.damping * own;
        let Some(push) = system.lu().solve(&relative) else {
            return;
        };
        let n = self.column.len();
        for (i, y) in self.column.iter().enumerate() {
            for k in 0..3 {
                v[k * n + i] -= y * push[k];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends that go round each other do not move along their line, though their velocities turn into it.
    #[test]
    fn the_turning_of_a_line_is_no_motion_along_it() {
        let line = (0..=8).map(|k| Vector3::new(0.5 * f64::from(k), 0.0, 0.0));
        let line = topo_core::Polyline::new(line.collect(), false).unwrap();
        let before = RodState::new(&line, 4.0, 0.0).unwrap();
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.1);
        let after = before.with_vertices(before.vertices().iter().map(|x| turn * x).collect());
        let settings = EndLoad {
            dashpot: 10.0,
            ..EndLoad::default()
        };
        let mut load = Load::attached(settings, &before.components()[0], &before);
        load.here = load.at(&after);
        let rate = |state: &RodState| -> Vec<f64> {
            let spin = |k: usize| move |x: &Vector3<f64>| Vector3::z().cross(x)[k];
            (0..3)
                .flat_map(|k| state.vertices().iter().map(spin(k)))
                .collect()
        };
        let rates = [rate(&before), rate(&after)];
        let change = load.relative(&rates[1]) - load.relative(&rates[0]);
        let left = change - load.turning(&rates[0], &rates[1]);
        let along = (load.accepted.line + load.here.line).normalize();
        assert!(change.dot(&along).abs() > 0.3, "{}", change.dot(&along));
        assert!(left.dot(&along).abs() < 0.01 * change.dot(&along).abs());
        assert!(
            (left - along * left.dot(&along) - (change - along * change.dot(&along))).norm()
                < 1e-12
        );
    }
}
