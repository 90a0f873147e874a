//! A straight fibre, clamped at one end and twisted by the other, that untwists against the drag on its surface once it is let go.
//!
//! ```math
//! \zeta \theta_t = C \theta_{ss}, \quad \theta(0) = 0, \quad \theta_s(L) = 0, \quad E = \frac{C}{2} \int \theta_s^2 \, ds
//! ```
//!
//! Lengths are in radii h, energies in C/h, times in ζ h²/C.

use topo_core::{
    DischargeCurve, Interrupt, Ledger, LinearlyImplicit, Model, Rejection, RosenbrockW, Sample,
    Schedule, Scheduled, Simulation, StepControl, StopReason,
};

/// The terms and channels of its energy account.
pub const TWIST: &str = "twist";
const DRAG: &str = "drag";

/// Angles of the vertices beyond the clamped one, in radians.
type Angles = Vec<f64>;

/// The fibre as a model of topo-core.
struct Fibre {
    edge: f64,
    /// Of W, from the last `prepare`.
    off_diagonal: Vec<f64>,
    pivots: Vec<f64>,
    rates: [Vec<f64>; 2],
    turn: f64,
    ledger: Ledger,
}

impl Fibre {
    fn new(length: f64, turn: f64, angles: &Angles) -> Self {
        let n = angles.len();
        let mut fibre = Self {
            edge: length / n as f64,
            off_diagonal: vec![0.0; n],
            pivots: vec![1.0; n],
            rates: [vec![0.0; n], vec![0.0; n]],
            turn,
            ledger: Ledger::new(&[TWIST], &[DRAG]),
        };
        let energy = fibre.energy(angles);
        fibre.ledger.set_stored(&[energy]);
        fibre
    }

    fn energy(&self, angles: &Angles) -> f64 {
        let before = [0.0].into_iter().chain(angles.iter().copied());
        let squares = angles.iter().zip(before).map(|(b, a)| (b - a).powi(2));
        0.5 * squares.sum::<f64>() / self.edge
    }

    /// Length that drags a vertex: half an edge at the free end.
    fn dragged(&self, vertex: usize, n: usize) -> f64 {
        if vertex + 1 == n {
            0.5 * self.edge
        } else {
            self.edge
        }
    }

    fn rate_at(&self, angles: &Angles, rate: &mut [f64]) {
        let n = angles.len();
        for i in 0..n {
            let before = if i == 0 { 0.0 } else { angles[i - 1] };
            let after = angles.get(i + 1).copied().unwrap_or(angles[i]);
            let torque = (before - 2.0 * angles[i] + after) / self.edge;
            rate[i] = torque / self.dragged(i, n);
        }
    }

    /// Power that goes into the drag at these rates.
    fn power(&self, rates: impl Iterator<Item = f64>, n: usize) -> f64 {
        rates
            .enumerate()
            .map(|(i, v)| self.dragged(i, n) * v * v)
            .sum()
    }
}

impl Model for Fibre {
    type State = Angles;

    fn n_dof(&self) -> usize {
        self.pivots.len()
    }

    fn rate(&mut self, angles: &Angles, rate: &mut [f64]) -> Result<(), Rejection> {
        self.rate_at(angles, rate);
        Ok(())
    }

    fn advance(&self, from: &Angles, step: &[f64], to: &mut Angles) -> Result<(), Rejection> {
        for ((to, from), step) in to.iter_mut().zip(from).zip(step) {
            *to = from + step;
        }
        Ok(())
    }

    /// The largest error of an angle, over the turn.
    fn error_norm(&self, error: &[f64]) -> f64 {
        topo_core::max_norm(error) / self.turn.abs()
    }

    /// What drag took is Simpson's sum of the power over the step: the books balance to the order of the step alone.
    fn accepted(&mut self, from: &Angles, to: &Angles, step: &[f64], dt: f64) {
        let n = step.len();
        let [mut before, mut after] = std::mem::take(&mut self.rates);
        self.rate_at(from, &mut before);
        self.rate_at(to, &mut after);
        let ends = self.power(before.iter().copied(), n) + self.power(after.iter().copied(), n);
        let middle = self.power(step.iter().map(|d| d / dt), n);
        self.rates = [before, after];
        self.ledger.dissipate(0, dt / 6.0 * (ends + 4.0 * middle));
        let energy = self.energy(to);
        self.ledger.set_stored(&[energy]);
    }

    fn ledger(&self) -> Option<&Ledger> {
        Some(&self.ledger)
    }
}

impl LinearlyImplicit for Fibre {
    /// Gauss's elimination of the tridiagonal W, row by row.
    fn prepare(&mut self, _: &Angles, g_dt: f64) -> Result<(), Rejection> {
        let n = self.pivots.len();
        for i in 0..n {
            let c = g_dt / (self.edge * self.dragged(i, n));
            let n_edges = if i + 1 == n { 1.0 } else { 2.0 };
            self.off_diagonal[i] = -c;
            self.pivots[i] = 1.0 + n_edges * c;
            if i > 0 {
                let coupling = self.off_diagonal[i] * self.off_diagonal[i - 1];
                self.pivots[i] -= coupling / self.pivots[i - 1];
            }
        }
        Ok(())
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection> {
        for i in 1..rhs.len() {
            rhs[i] -= self.off_diagonal[i] / self.pivots[i - 1] * rhs[i - 1];
        }
        for i in (0..rhs.len()).rev() {
            let after = rhs.get(i + 1).map_or(0.0, |x| self.off_diagonal[i] * x);
            rhs[i] = (rhs[i] - after) / self.pivots[i];
        }
        Ok(())
    }
}

/// A fibre that was let go and followed.
pub struct Discharge {
    pub curve: DischargeCurve,
    /// Angles at its end, of the vertices beyond the clamped one.
    pub angles: Vec<f64>,
    pub stop: StopReason,
    pub ledger_residual: f64,
    pub n_steps: u64,
}

/// Twists a fibre of `n_edges` by `turn` and follows it from its release until a share of its energy has gone.
pub fn discharge(
    [length, turn]: [f64; 2],
    n_edges: usize,
    tolerance: f64,
    until_released: f64,
    interrupt: &Interrupt,
) -> Result<Discharge, topo_core::InvalidValue> {
    let angles: Angles = (1..=n_edges)
        .map(|i| turn * i as f64 / n_edges as f64)
        .collect();
    let fibre = Fibre::new(length, turn, &angles);
    let start = fibre.energy(&angles);
    let time = length * length;
    let control = StepControl::new(tolerance, 1e-7 * time)?.with_max_trials(1_000_000);
    let mut run = Simulation::new(fibre, angles, RosenbrockW::ros34pw2(), control)
        .with_interrupt(interrupt.clone());
    let mut curve = DischargeCurve::new([TWIST], [DRAG]);
    let mut record = |sample: &Sample<'_, Angles>| {
        // refuses only what the loop never offers: times that do not grow
        let _ = curve.push(
            sample.time,
            sample.ledger.stored(),
            &[sample.ledger.dissipated(0)],
        );
    };
    let mut observers = [Scheduled::new(Schedule::always(), &mut record)];
    let stop = run.run(100.0 * time, &mut observers, &mut |sample| {
        let left = sample.ledger.stored_total() / start;
        (left <= 1.0 - until_released).then(|| "released".to_owned())
    });
    let ledger_residual = run.model().ledger.relative_residual();
    let n_steps = run.n_steps();
    let angles = run.state().clone();
    Ok(Discharge {
        curve,
        angles,
        stop,
        ledger_residual,
        n_steps,
    })
}

/// Share of its energy that the fibre still has at `time`, in units of ζ L²/C.
///
/// ```math
/// \frac{E}{E_0} = \sum_k \frac{2}{\lambda_k^2} e^{-2 \lambda_k^2 t}, \quad \lambda_k = (k + 1/2) \pi
/// ```
pub fn share_left(time: f64) -> f64 {
    let term = |k: u32| {
        let square = ((f64::from(k) + 0.5) * std::f64::consts::PI).powi(2);
        2.0 / square * (-2.0 * square * time).exp()
    };
    (0..4000).rev().map(term).sum()
}

/// Time at which a share has gone, in the same units.
pub fn time_of(released: f64) -> f64 {
    let (mut early, mut late) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (early + late);
        if share_left(middle) > 1.0 - released {
            early = middle;
        } else {
            late = middle;
        }
    }
    early
}
