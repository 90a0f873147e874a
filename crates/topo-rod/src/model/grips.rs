//! What holds and draws the ends: in time, and with which force.

use nalgebra::Vector3;

use super::{RodModel, marked};
use crate::ends::{GripSchedule, GripSegment, PlacedEnds};
use crate::{EndCondition, Ends, Grip, Layout, RodError, RodState};

/// Force of a grip on an end of the rod and its torque about the tangent, per area, in E_b and E_b h.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct GripForce {
    /// On the end, in E_b.
    pub force: [f64; 3],
    /// About its tangent, in E_b h.
    pub torque: f64,
}

/// Pairs of vertices that rub, each with its coefficient.
type Couplings = Vec<(u32, u32, f64)>;

impl RodModel {
    /// The model of a single open rod whose ends are held, moved and loaded in time, instead of ends that are the same at all times.
    /// Displacements and times count from the start. Call it before [`start`](Self::start).
    ///
    /// The times of the grips are in units of `unit`, in η/E_b. A step does not cross a time at which a course has a corner, so that
    /// between them motions are uniform: [`next_change`](Self::next_change) says when to call [`change_grips`](Self::change_grips).
    ///
    /// # Errors
    /// A contradiction, courses out of order, a closed rod or several.
    ///
    /// # Validation
    /// `law_work_of_ends_in_time`
    pub fn with_grips(
        mut self,
        grips: &[Grip; 2],
        unit: f64,
        state: &RodState,
    ) -> Result<Self, RodError> {
        let [chain] = state.components() else {
            return Err(RodError::WrongTopology {
                operation: "a grip in time",
                needed: "a single",
            });
        };
        if chain.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "a grip",
                needed: "an open",
            });
        }
        let schedule = GripSchedule::new(grips, unit, self.twist.is_some())?;
        let segment = schedule.segment(0.0);
        self.ends = vec![PlacedEnds {
            chain: *chain,
            ends: Ends::default(),
        }];
        self.driven = Some(Box::new((schedule, segment)));
        self.take_up(segment, state);
        Ok(self)
    }

    /// Time in η/E_b of the next corner in the course of a grip, or at which twisting begins or ends.
    pub fn next_change(&self) -> Option<f64> {
        let driven = self.driven.as_ref();
        let corner = driven.and_then(|driven| driven.0.next_break(&driven.1));
        corner.or_else(|| self.motor.as_ref()?.next_change())
    }

    /// Takes up what the grips do from `time` on, in η/E_b, and sets the clock of the state.
    pub fn change_grips(&mut self, time: f64, state: &mut RodState) {
        if self.has_clock() {
            state.set_clock(time);
            self.turn_motor(time);
            self.accepted.rate_stamp = None;
            self.forget();
        }
        if let Some(driven) = &self.driven {
            let segment = driven.0.segment(time);
            self.take_up(segment, state);
        }
    }

    /// Takes up what the grips did just before `time`, in η/E_b, for a run that goes on from there.
    pub(crate) fn resume_grips(&mut self, time: f64, state: &RodState) {
        self.turn_motor_before(time);
        if let Some(driven) = &self.driven {
            let segment = driven.0.segment_before(time);
            self.take_up(segment, state);
        }
    }

    fn take_up(&mut self, segment: GripSegment, state: &RodState) {
        let Some(driven) = &mut self.driven else {
            return;
        };
        driven.1 = segment;
        let before = self.ends[0].ends.conditions;
        self.ends[0].ends = driven.1.ends;
        self.is_driven = true;
        self.held_vertices = self.ends[0].held_vertices();
        self.held_edges = match self.twist {
            Some(_) => self.ends[0].held_edges(),
            None => Vec::new(),
        };
        if before != self.ends[0].ends.conditions {
            let fixed = marked(self.n_vertices, self.held_vertices.iter().map(|h| h.0));
            let turning = self.held_edges.iter().map(|h| h.0);
            let fixed_edges = marked(self.n_edges, turning.chain(state.unused_edges()));
            self.centreline.hold(&fixed);
            self.newton.hold(&fixed);
            if let Some(rotation) = &mut self.rotation {
                rotation.hold(&fixed_edges);
            }
            if let Some(newton) = &mut self.newton_twist {
                newton.hold(&fixed_edges);
            }
        }
        self.accepted.rate_stamp = None;
        self.forget();
    }

    /// What ends do at a time.
    pub(super) fn ends_at(&self, placed: &PlacedEnds, time: f64) -> Ends {
        match &self.driven {
            Some(driven) => driven.1.ends_at(time),
            None => placed.ends,
        }
    }

    /// What viscosity and friction resist vertex `i` with, in motions over the time `dt`.
    pub(super) fn resistance(
        &self,
        layout: &Layout,
        i: usize,
        moved: impl Fn(usize) -> Vector3<f64>,
        couplings: &[(&Couplings, f64)],
        dt: f64,
    ) -> Vector3<f64> {
        let (mut resistance, chain) = (Vector3::zeros(), layout.chain_of(i));
        let viscous = 1.0 / (chain.rest_length() * dt);
        for j in [i.checked_sub(1), Some(i)]
            .into_iter()
            .flatten()
            .filter(|j| chain.edges().contains(j))
        {
            let other = if j == i { i + 1 } else { i - 1 };
            resistance += (moved(i) - moved(other)) * viscous;
        }
        for (couplings, share) in couplings {
            for &(a, b, c) in couplings
                .iter()
                .filter(|c| c.0 as usize == i || c.1 as usize == i)
            {
                let other = if a as usize == i { b } else { a } as usize;
                resistance += (moved(i) - moved(other)) * (share * c / dt);
            }
        }
        resistance
    }

    /// What twist viscosity resists edge `j` with, in turns over the time `dt`.
    pub(super) fn resistance_to_turns(
        &self,
        layout: &Layout,
        j: usize,
        turned: impl Fn(usize) -> f64,
        cosine: impl Fn(usize) -> f64,
        dt: f64,
    ) -> f64 {
        let chain = layout.chain_of(j);
        let half = 0.5 / (chain.rest_length() * dt);
        let mut resistance = 0.0;
        for i in [j, j + 1]
            .into_iter()
            .filter(|i| chain.interior().contains(i))
        {
            let other = if i == j { j - 1 } else { j + 1 };
            resistance += half * (turned(j) - cosine(i) * turned(other));
        }
        resistance
    }

    /// Whether any end is held or loaded.
    pub fn has_grips(&self) -> bool {
        !self.ends.is_empty()
    }

    /// What holds or draws the first end and the last, each of the first component that has it held or drawn, at the state accepted last:
    /// none of an end that nothing holds or draws, and of all before the first step.
    ///
    /// # Validation
    /// `law_grips_hold_what_the_rod_draws`
    pub fn grip_forces(&self, state: &RodState) -> [Option<GripForce>; 2] {
        let known =
            self.accepted.rate_stamp == Some(state.stamp()) && self.at.stamp == Some(state.stamp());
        if !known {
            return [None; 2];
        }
        [0, 1].map(|end| {
            self.ends
                .iter()
                .find_map(|placed| self.grip_force(state, placed, end))
        })
    }

    fn grip_force(&self, state: &RodState, placed: &PlacedEnds, end: usize) -> Option<GripForce> {
        let ends = self.ends_at(placed, state.clock());
        let motion = ends.motions[end];
        match ends.conditions[end] {
            EndCondition::Free => {
                let loaded = motion.force != [0.0; 3] || motion.torque != 0.0;
                loaded.then_some(GripForce {
                    force: motion.force,
                    torque: motion.torque,
                })
            }
            held => Some(self.reaction(state, placed, end, held, motion.torque)),
        }
    }

    fn reaction(
        &self,
        state: &RodState,
        placed: &PlacedEnds,
        end: usize,
        held: EndCondition,
        torque: f64,
    ) -> GripForce {
        let (n, v) = (self.n_vertices, &self.accepted.rate);
        let velocity = |i: usize| Vector3::new(v[i], v[n + i], v[2 * n + i]);
        let vertex = placed.vertices()[end];
        let next = if end == 0 { vertex + 1 } else { vertex - 1 };
        let held_here = if held == EndCondition::Clamped { 2 } else { 1 };
        let mut force = Vector3::zeros();
        for &i in &[vertex, next][..held_here] {
            force += self.resistance(state, i, velocity, &[(&self.at.couplings, 1.0)], 1.0);
            if let Some(load) = &self.load {
                force += load.resistance(i, velocity);
            }
            force -= self.at.force.vertex[i];
        }
        let edge = placed.edges()[end];
        let torque = if held == EndCondition::Clamped && self.twist.is_some() {
            let turned = |j: usize| v[3 * n + j];
            let cosine = |i: usize| self.at.geometry.cosine[i];
            self.resistance_to_turns(state, edge, turned, cosine, 1.0) - self.at.force.torque[edge]
        } else {
            torque
        };
        GripForce {
            force: force.into(),
            torque,
        }
    }
}
