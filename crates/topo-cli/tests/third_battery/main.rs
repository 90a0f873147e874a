//! A battery from outside the workspace's crates: a few files that fill in the traits of topo-lab, and the ordinary commands run,
//! share out, resume, compare, export and draw its scenes.

mod battery;
mod commands;
mod experiment;
mod fibre;
mod program;
mod rows;
mod shown;

use fibre::{discharge, share_left, time_of};
use topo_analysis::DischargeTimes;
use topo_core::{Interrupt, StopReason};

/// A fibre that is let go loses its energy as its Fourier series says, to second order in the edges; the books balance.
#[test]
fn val_a_fibre_let_go_at_one_end_untwists_as_its_series() {
    // all of the energy is there at the start, and the slowest mode is alone at the end
    assert!((share_left(0.0) - 1.0).abs() < 1e-4);
    let late = share_left(2.1) / share_left(2.0);
    assert!((late.ln() + 0.05 * std::f64::consts::PI.powi(2)).abs() < 1e-9);
    let (length, turn) = (20.0, 3.0);
    let errors = |n_edges: usize| {
        let run = discharge([length, turn], n_edges, 1e-8, 0.999, &Interrupt::new()).unwrap();
        assert!(matches!(run.stop, StopReason::Condition(_)), "{}", run.stop);
        let energy = run.curve.stored_total(0);
        assert!((energy / (turn * turn / (2.0 * length)) - 1.0).abs() < 1e-12);
        assert!(
            run.ledger_residual.abs() < 1e-5,
            "{:e}",
            run.ledger_residual
        );
        let shares = [0.5, 0.9, 0.99];
        let times = DischargeTimes::of(&run.curve, &[fibre::TWIST], energy, &shares);
        shares.map(|share| {
            let time = times.at(share).unwrap().value / (length * length);
            time / time_of(share) - 1.0
        })
    };
    let (coarse, fine) = (errors(50), errors(100));
    println!("50 edges: {coarse:?}, 100 edges: {fine:?}");
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(fine.abs() < 2e-4, "off by {fine:e}");
        let order = (coarse / fine).log2();
        assert!((1.9..2.1).contains(&order), "order {order}");
    }
}
