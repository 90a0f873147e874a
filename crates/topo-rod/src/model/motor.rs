//! Twisting of a closed rod whose ends are held together but not fused: one end is turned against the other.

use super::RodModel;
use crate::{RodError, RodState};

/// A drive at the seam that turns the two ends against each other at a constant rate for some time.
///
/// The joint at the seam is twisted by the turn φ besides what the edges at its two sides turn, like any other joint by those alone:
///
/// ```math
/// \dot m_0 = w_0 - w_{-1} + \dot\varphi + \ldots, \qquad
/// Q = \frac{\alpha m_0}{4 l_0} + \frac{\eta}{2 l_0} \left[ (w_0 + \dot\varphi) - w_{-1}\, t_0 \cdot t_{-1} \right]
/// ```
///
/// and Q φ̇ is the power of the drive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motor {
    /// Vertex of the seam; the edge behind it has its number.
    vertex: usize,
    /// Edge before the seam.
    before: usize,
    /// 1/(2 l_0).
    half: f64,
    /// Of the twist energy: torque over twist.
    stiffness: f64,
    /// When it turns, in η/E_b.
    times: [f64; 2],
    /// How fast it then turns, in E_b/η.
    full: f64,
    /// How many of these times have passed.
    stage: usize,
    /// How fast it turns at present.
    rate: f64,
}

impl Motor {
    /// What it does from `time` on.
    fn is_at(&mut self, time: f64) {
        self.stage = self.times.iter().filter(|t| **t <= time).count();
        self.rate = if self.stage == 1 { self.full } else { 0.0 };
    }

    /// When it begins or stops next.
    pub(super) fn next_change(&self) -> Option<f64> {
        self.times.get(self.stage).copied()
    }

    /// Turn of the ends by `time`.
    pub(super) fn angle(&self, time: f64) -> f64 {
        let [start, end] = self.times;
        self.full * (time.min(end) - start).max(0.0)
    }

    /// What its turning adds to the torques that the edges at the seam must balance.
    pub(super) fn add_torque(&self, cosine: &[f64], torque: &mut [f64]) {
        torque[self.vertex] -= self.half * self.rate;
        torque[self.before] += self.half * self.rate * cosine[self.vertex];
    }

    /// Twists the joint at the seam over a time.
    pub(super) fn twist(&self, time: f64, state: &mut RodState) {
        state.add_twist(self.vertex, self.rate * time);
    }

    /// Twist viscosity of the joint at the seam over a step, besides that of the turns of its edges.
    pub(super) fn form(&self, turned: &[f64], cosine: impl Fn(usize) -> f64, dt: f64) -> f64 {
        let own = self.rate * dt;
        let edges = turned[self.vertex] - cosine(self.vertex) * turned[self.before];
        self.half * own * (own + 2.0 * edges)
    }

    /// Work over a step, with the mean of the twists before and after it.
    pub(super) fn work(
        &self,
        twists: [f64; 2],
        turned: &[f64],
        cosine: impl Fn(usize) -> f64,
        dt: f64,
    ) -> f64 {
        let own = self.rate * dt;
        let edges = turned[self.vertex] - cosine(self.vertex) * turned[self.before];
        let torque =
            self.stiffness * 0.5 * (twists[0] + twists[1]) + self.half * (own + edges) / dt;
        torque * own
    }

    pub(super) fn vertex(&self) -> usize {
        self.vertex
    }
}

impl RodModel {
    /// The model of a single closed rod that is twisted at its seam, its first vertex, by `angle` in radians at a constant rate between
    /// two times in η/E_b. A step does not cross these: see [`next_change`](Self::next_change). Call it before [`start`](Self::start).
    ///
    /// # Errors
    /// An open rod or several, or one without twist.
    ///
    /// # Validation
    /// `val_price_of_a_slow_twist`
    pub fn with_twisting(
        mut self,
        angle: f64,
        times: [f64; 2],
        state: &RodState,
    ) -> Result<Self, RodError> {
        let ([chain], Some(twist)) = (state.components(), self.twist) else {
            return Err(RodError::WrongTopology {
                operation: "twisting in time",
                needed: "a single twisted",
            });
        };
        if !chain.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "twisting in time",
                needed: "a closed",
            });
        }
        topo_core::positive("charge.twisting.over", times[1] - times[0])?;
        let l0 = chain.rest_length();
        let mut motor = Motor {
            vertex: chain.first(),
            before: chain.edge_before(chain.first()),
            half: 0.5 / l0,
            stiffness: twist.torque(1.0, l0),
            times,
            full: angle / (times[1] - times[0]),
            stage: 0,
            rate: 0.0,
        };
        motor.is_at(0.0);
        self.motor = Some(motor);
        self.is_driven = true;
        Ok(self)
    }

    /// Lets the drive do what it does from `time` on.
    pub(super) fn turn_motor(&mut self, time: f64) {
        if let Some(motor) = &mut self.motor {
            motor.is_at(time);
        }
    }

    /// Lets the drive do what it did just before `time`.
    pub(super) fn turn_motor_before(&mut self, time: f64) {
        self.turn_motor(time.next_down());
    }

    /// Turn of the ends at the seam by `time`, in radians.
    pub(crate) fn twisted_by(&self, time: f64) -> f64 {
        self.motor.map_or(0.0, |motor| motor.angle(time))
    }
}
