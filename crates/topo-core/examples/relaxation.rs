//! A stiff relaxation by two integrators, and the writhe of a trefoil.
//!
//! A chain of beads joined by springs contracts in a viscous bath (a heat equation on beads). ROS2-W factorises a sparse matrix
//! each step and takes few steps; RKC2 needs no matrix but many evaluations of the rate. Both meet the same tolerance.

use topo_core::{
    DischargeCurve, Ledger, LinearlyImplicit, Model, Polyline, Rejection, Rkc2, RosenbrockW,
    Sample, Schedule, Scheduled, Simulation, SpectralBound, StepControl, Stepper,
};
use topo_sparse::SparseCholesky;

/// Beads on a line, neighbours joined by springs, each bead dragged by the bath: u' = -k K u.
struct Chain {
    stiffness: f64,
    matrix: SparseCholesky,
    diagonal: Vec<usize>,
    off_diagonal: Vec<usize>,
    ledger: Ledger,
}

impl Chain {
    fn new(
        n_beads: usize,
        stiffness: f64,
        start: &[f64],
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let pattern: Vec<(u32, u32)> = (1..n_beads as u32).map(|i| (i - 1, i)).collect();
        let matrix = SparseCholesky::new(n_beads, &pattern)?;
        let slots =
            |row: usize, column: usize| matrix.slot(row, column).ok_or("entry outside the pattern");
        let diagonal = (0..n_beads)
            .map(|i| slots(i, i))
            .collect::<Result<_, _>>()?;
        let off_diagonal = (1..n_beads)
            .map(|i| slots(i - 1, i))
            .collect::<Result<_, _>>()?;
        let mut chain = Self {
            stiffness,
            matrix,
            diagonal,
            off_diagonal,
            ledger: Ledger::new(&["springs"], &["drag"]),
        };
        let energy = chain.energy(start);
        chain.ledger.set_stored(&[energy]);
        Ok(chain)
    }

    fn energy(&self, u: &[f64]) -> f64 {
        0.5 * self.stiffness * u.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>()
    }
}

impl Model for Chain {
    type State = Vec<f64>;

    fn n_dof(&self) -> usize {
        self.diagonal.len()
    }

    fn rate(&mut self, u: &Vec<f64>, rate: &mut [f64]) -> Result<(), Rejection> {
        rate.fill(0.0);
        for i in 1..u.len() {
            let pull = self.stiffness * (u[i] - u[i - 1]);
            rate[i - 1] += pull;
            rate[i] -= pull;
        }
        Ok(())
    }

    fn advance(&self, from: &Vec<f64>, step: &[f64], to: &mut Vec<f64>) -> Result<(), Rejection> {
        for ((to, from), step) in to.iter_mut().zip(from).zip(step) {
            *to = from + step;
        }
        Ok(())
    }

    fn accepted(&mut self, _: &Vec<f64>, to: &Vec<f64>, step: &[f64], dt: f64) {
        let lost: f64 = step.iter().map(|d| d * d).sum::<f64>() / dt;
        self.ledger.dissipate(0, lost);
        let energy = self.energy(to);
        self.ledger.set_stored(&[energy]);
    }

    fn ledger(&self) -> Option<&Ledger> {
        Some(&self.ledger)
    }
}

impl LinearlyImplicit for Chain {
    fn prepare(&mut self, _: &Vec<f64>, g_dt: f64) -> Result<(), Rejection> {
        let (n, coupling) = (self.diagonal.len(), g_dt * self.stiffness);
        let values = self.matrix.values_mut();
        for (i, slot) in self.diagonal.iter().enumerate() {
            let n_springs = if i == 0 || i + 1 == n { 1.0 } else { 2.0 };
            values[*slot] = 1.0 + coupling * n_springs;
        }
        for slot in &self.off_diagonal {
            values[*slot] = -coupling;
        }
        self.matrix.factor().map_err(|_| Rejection::Factorisation {
            what: "drag and springs",
        })
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection> {
        self.matrix.solve_in_place(rhs, 1);
        Ok(())
    }
}

impl SpectralBound for Chain {
    fn spectral_radius(&mut self, _: &Vec<f64>) -> Result<f64, Rejection> {
        Ok(4.0 * self.stiffness)
    }
}

fn relax<S: Stepper<Chain>>(name: &str, stepper: S) -> Result<(), Box<dyn std::error::Error>> {
    let n = 200;
    // A long wave that relaxes slowly, and a zigzag that is over at once.
    let start: Vec<f64> = (0..n)
        .map(|i| (std::f64::consts::PI * (i as f64 + 0.5) / n as f64).cos() + 0.1 * (i % 2) as f64)
        .collect();
    let chain = Chain::new(n, 1e4, &start)?;
    let mut run = Simulation::new(chain, start, stepper, StepControl::new(1e-4, 1e-6)?);

    let mut curve = DischargeCurve::new(["springs"], ["drag"]);
    let mut record = |sample: &Sample<'_, Vec<f64>>| {
        // Refuses only what the loop never offers: times that do not grow.
        let _ = curve.push(
            sample.time,
            sample.ledger.stored(),
            &[sample.ledger.dissipated(0)],
        );
    };
    let mut observers = [Scheduled::new(
        Schedule::log_spaced(1e-5, 4.0)?,
        &mut record,
    )];
    let reason = run.run(1.0, &mut observers, &mut |_| None);

    let counters = run.counters();
    println!(
        "{name}: {reason} after {} steps, {} refused",
        run.n_steps(),
        run.rejections().total()
    );
    println!(
        "  {} rates, {} factorisations",
        counters.n_rate_evaluations, counters.n_factorisations
    );
    println!(
        "  energy {:.4} -> {:.4}, ledger residual {:.1e}",
        curve.stored_total(0),
        run.sample().ledger.stored_total(),
        run.sample().ledger.relative_residual()
    );
    println!("  {} samples dense in log t", curve.len());
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    relax("ROS34PW2", RosenbrockW::default())?;
    relax("RKC2", Rkc2::default())?;

    let trefoil = |i: u32| {
        let t = std::f64::consts::TAU * f64::from(i) / 1000.0;
        let r = 2.0 + (3.0 * t).cos();
        nalgebra::Vector3::new(r * (2.0 * t).cos(), r * (2.0 * t).sin(), -(3.0 * t).sin())
    };
    let curve = Polyline::new((0..1000).map(trefoil).collect(), true)?.resampled(200)?;
    println!(
        "trefoil on a torus: length {:.4}, writhe {:+.6}, average crossing number {:.4}",
        curve.length(),
        curve.writhe(),
        curve.average_crossing_number()
    );
    Ok(())
}
