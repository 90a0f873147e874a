//! Twisting of closed rods whose ends are held together but not fused: one end is turned against the other.

use std::ops::Range;

use super::RodModel;
use crate::ends::TimeCourse;
use crate::energy::{At, CurvedBend};
use crate::{Chain, RodError, RodState};

/// What turns the ends at a seam against each other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Drive {
    /// A turn at a constant rate, as far as the twist density, in radians per h, takes it.
    Turn,
    /// A torque, in that which a straight rod of the twist density carries; times in η/E_b.
    Torque(TimeCourse),
}

/// Drives at the seams, the first vertices of closed rods, that turn the two ends of each against each other for some time.
///
/// The joint at a seam is twisted by the turn φ besides what the edges at its two sides turn, like any other joint by those alone:
///
/// ```math
/// \dot m_0 = w_0 - w_{-1} + \dot\varphi + \ldots, \qquad
/// Q = \frac{\alpha m_0}{4 l_0} + \frac{\eta}{2 l_0} \left[ (w_0 + \dot\varphi) - w_{-1}\, t_0 \cdot t_{-1} \right]
/// ```
///
/// and Q φ̇ is the power of the drive. Either φ̇ is given or Q; then φ̇ is one more unknown of the equations of the turns.
#[derive(Debug, Clone)]
pub(super) struct Motor {
    seams: Vec<Seam>,
    drive: Drive,
    /// When it begins and stops, in η/E_b.
    times: [f64; 2],
    /// These, and the corners of the course of a torque between them, ascending.
    breaks: Vec<f64>,
    /// Since when it does what it does.
    since: f64,
}

/// The joint of two ends.
#[derive(Debug, Clone, Copy)]
struct Seam {
    /// Its vertex; the edge behind it has its number.
    vertex: usize,
    /// Edge before it.
    before: usize,
    /// 1/(2 l_0).
    half: f64,
    /// Of the twist energy: torque over twist.
    stiffness: f64,
    /// How fast it turns, in E_b/η, or torque per area, in E_b h.
    full: f64,
}

impl Seam {
    /// How much more the ends turn against each other by the `turned` of the edges, as twist viscosity sees it.
    fn of_edges(&self, turned: &[f64], cosine: f64) -> f64 {
        turned[self.vertex] - cosine * turned[self.before]
    }
}

impl Motor {
    /// Whether it turns the ends at present.
    fn is_on(&self) -> bool {
        let [start, end] = self.times;
        (start..end).contains(&self.since)
    }

    /// Whether it turns them by a torque at present.
    fn is_torque_on(&self) -> bool {
        self.is_on() && matches!(self.drive, Drive::Torque(_))
    }

    /// When it does something else next.
    pub(super) fn next_change(&self) -> Option<f64> {
        self.breaks.iter().copied().find(|t| *t > self.since)
    }

    /// The torque at seam `k` at `time`, per area, in E_b h; none where the turn is given.
    fn torque(&self, k: usize, time: f64) -> Option<f64> {
        match &self.drive {
            Drive::Torque(course) if self.is_on() => {
                Some(self.seams[k].full * course.at(time - self.times[0]))
            }
            _ => None,
        }
    }

    /// Elastic torque that each joint carries against the turn of its ends: that of its twist, and of a natural curvature that turns
    /// with them.
    pub(super) fn torques<'a>(&'a self, at: At<'a>) -> impl Iterator<Item = f64> + 'a {
        let bends = at.state.rest().is_some();
        self.seams.iter().enumerate().map(move |(c, seam)| {
            let bend = if bends {
                CurvedBend::torque_behind(at, c, seam.vertex)
            } else {
                0.0
            };
            seam.stiffness * at.state.excess_twist(seam.vertex) - bend
        })
    }

    /// The right side of the equations of the turns: what a given turn adds to the torques that the edges must balance, or what of
    /// a given torque the joint leaves to be balanced, of which it carries `joints`. `drives` becomes the rates of the turns, or these
    /// torques.
    pub(super) fn balance(
        &self,
        time: f64,
        joints: &[f64],
        cosine: &[f64],
        torque: &mut [f64],
        drives: &mut [f64],
    ) {
        for (k, (seam, drive)) in self.seams.iter().zip(drives).enumerate() {
            *drive = match self.torque(k, time) {
                Some(given) => given - joints[k],
                None if self.is_on() => {
                    torque[seam.vertex] -= seam.half * seam.full;
                    torque[seam.before] += seam.half * seam.full * cosine[seam.vertex];
                    seam.full
                }
                None => 0.0,
            };
        }
    }

    /// Twists the joints by the turns of the drives.
    pub(super) fn twist(&self, drives: &[f64], state: &mut RodState) {
        for (k, (seam, turn)) in self.seams.iter().zip(drives).enumerate() {
            state.turn_seam(k, seam.vertex, *turn);
        }
    }

    /// What the turns of the drives add to the form of twist viscosity, of two motions of `n_edges` edges and the drives behind them.
    pub(super) fn form(
        &self,
        n_edges: usize,
        cosine: impl Fn(usize) -> f64,
        u: &[f64],
        w: &[f64],
    ) -> f64 {
        let of = |(k, seam): (usize, &Seam)| {
            let (own, other) = (u[n_edges + k], w[n_edges + k]);
            let c = cosine(seam.vertex);
            seam.half * (own * other + own * seam.of_edges(w, c) + other * seam.of_edges(u, c))
        };
        self.seams.iter().enumerate().map(of).sum()
    }

    /// Work over a step of the edges and the drives behind them: that of a given torque at its middle, `time`, or with the mean
    /// of the torques `joints` that the joints carry before and after it.
    pub(super) fn work(
        &self,
        time: f64,
        joints: [&[f64]; 2],
        turned: &[f64],
        n_edges: usize,
        cosine: impl Fn(usize) -> f64,
        dt: f64,
    ) -> f64 {
        let of = |(k, seam): (usize, &Seam)| {
            let own = turned[n_edges + k];
            let torque = self.torque(k, time).unwrap_or_else(|| {
                let edges = seam.of_edges(turned, cosine(seam.vertex));
                0.5 * (joints[0][k] + joints[1][k]) + seam.half * (own + edges) / dt
            });
            torque * own
        };
        self.seams.iter().enumerate().map(of).sum()
    }
}

impl RodModel {
    /// The model of closed rods whose ends are turned against each other at their seams between two times in η/E_b: at a constant rate
    /// until they have the twist density, in radians per h, or by a torque, however far it turns them. A step crosses neither these
    /// times nor a corner of the torque: see [`next_change`](Self::next_change). Call it before [`start`](Self::start).
    ///
    /// # Errors
    /// An open rod, one without twist, or a course out of order.
    ///
    /// # Validation
    /// `val_price_of_a_slow_twist`, `val_a_torque_turns_the_ends_of_a_ring`
    pub(crate) fn with_twisting(
        mut self,
        density: f64,
        drive: Drive,
        times: [f64; 2],
        state: &RodState,
    ) -> Result<Self, RodError> {
        let wrong = |needed| RodError::WrongTopology {
            operation: "twisting in time",
            needed,
        };
        let twist = self.twist.ok_or_else(|| wrong("a twisted"))?;
        if !state.components().iter().all(Chain::is_closed) {
            return Err(wrong("a closed"));
        }
        topo_core::positive("charge.twisting.over", times[1] - times[0])?;
        let mut breaks = times.to_vec();
        if let Drive::Torque(course) = &drive {
            course.checked("charge.twisting.torque", false)?;
            let corners = course.times().map(|t| times[0] + t);
            breaks.extend(corners.filter(|t| *t < times[1]));
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let seam = |chain: &Chain| {
            let l0 = chain.rest_length();
            Seam {
                vertex: chain.first(),
                before: chain.edge_before(chain.first()),
                half: 0.5 / l0,
                stiffness: twist.torque(1.0, l0),
                full: match drive {
                    Drive::Turn => density * chain.length() / (times[1] - times[0]),
                    Drive::Torque(_) => twist.torque(density * l0, l0),
                },
            }
        };
        self.motor = Some(Box::new(Motor {
            seams: state.components().iter().map(seam).collect(),
            drive,
            times,
            breaks,
            since: 0.0,
        }));
        self.is_driven = true;
        Ok(self)
    }

    /// Places of the turns of drives among the degrees of freedom.
    pub(super) fn drives(&self) -> Range<usize> {
        let first = 3 * self.n_vertices + self.n_turns();
        let n = self.motor.as_ref().map_or(0, |motor| motor.seams.len());
        first..first + n
    }

    /// Lets the drives do what they do from `time` on.
    pub(super) fn turn_motor(&mut self, time: f64) {
        let Some(motor) = &mut self.motor else { return };
        let was_torque_on = motor.is_torque_on();
        motor.since = time;
        if was_torque_on == motor.is_torque_on() {
            return;
        }
        let seams: Vec<usize> = match motor.is_torque_on() {
            true => motor.seams.iter().map(|seam| seam.vertex).collect(),
            false => Vec::new(),
        };
        if let Some(rotation) = &mut self.rotation {
            rotation.loosen(&seams);
        }
        if let Some(newton) = &mut self.newton_twist {
            newton.loosen(&seams);
        }
    }

    /// Lets the drives do what they did just before `time`.
    pub(super) fn turn_motor_before(&mut self, time: f64) {
        let of = |motor: &Motor| {
            let passed = motor.breaks.iter().filter(|t| **t < time);
            passed.copied().fold(0.0, f64::max)
        };
        if let Some(since) = self.motor.as_deref().map(of) {
            self.turn_motor(since);
        }
    }
}
