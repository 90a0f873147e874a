//! Ties a trefoil, twists it, fuses the ends, lets it relax, cuts it and follows the discharge.
//!
//! ```text
//! cargo run --release -p topo-rod --example trefoil_discharge -- [twist] [edges] [tolerance]
//! ```

use std::time::Instant;

use nalgebra::Vector3;
use topo_core::{Polyline, RunHooks};
use topo_rod::{
    Accuracy, ChargeSettings, ChargedRod, CutSite, Discharge, DischargeSettings, Guards,
    RodBattery, RodParameters,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument =
        |k: usize, default: f64| std::env::args().nth(k).map_or(Ok(default), |a| a.parse());
    let (twist, n_edges, tolerance) = (
        argument(1, 0.0)?,
        argument(2, 100.0)? as usize,
        argument(3, 2e-3)?,
    );
    let curve = trefoil()?;
    println!("writhe of the start curve {:.3}", curve.writhe());
    let parameters = RodParameters {
        twist: Some(twist),
        n_edges,
        ..Default::default()
    };
    let accuracy = Accuracy {
        tolerance,
        ..Default::default()
    };
    let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve)?;
    let clock = Instant::now();
    let charged = battery.charge(&ChargeSettings::default(), &mut RunHooks::default())?;
    print_charge(&charged, clock)?;
    let clock = Instant::now();
    let run = charged
        .cut(CutSite::MaximumEnergyDensity)?
        .discharge(&DischargeSettings::default(), &mut RunHooks::default())?;
    print_discharge(&run, clock);
    Ok(())
}

/// A trefoil, not tight.
fn trefoil() -> Result<Polyline, topo_core::CurveError> {
    let at = |k: usize| {
        let u = std::f64::consts::TAU * k as f64 / 400.0;
        let r = 2.0 + (3.0 * u).cos();
        Vector3::new(
            r * (2.0 * u).cos(),
            r * (2.0 * u).sin(),
            -1.2 * (3.0 * u).sin(),
        )
    };
    Polyline::new((0..400).map(at).collect(), true)
}

fn print_charge(charged: &ChargedRod, clock: Instant) -> Result<(), &'static str> {
    let report = &charged.record().report;
    let last = charged.record().samples.last().ok_or("no sample")?;
    println!(
        "charged:    e/A = {:.4} (bend {:.4}, twist {:.4}), Wr {:.3}, Tw {:.3}, {} steps, {} refused, drift of Lk {:.1e}, {:?}, {:.2} s",
        last.elastic() * 50.0 / std::f64::consts::PI,
        last.stored[0] * 50.0 / std::f64::consts::PI,
        last.stored[1] * 50.0 / std::f64::consts::PI,
        last.writhe,
        last.total_twist,
        report.n_steps,
        report.rejections.total(),
        report.own.link_drift.unwrap_or(0.0),
        report.stop,
        clock.elapsed().as_secs_f64()
    );
    println!("  {:?}", report.own.work);
    println!("  {:?}", report.rejections);
    Ok(())
}

fn print_discharge(run: &Discharge, clock: Instant) {
    let report = &run.record.report;
    println!(
        "discharged: {} steps, {} refused, ledger residual {:.1e}, least distance {:?} d_c, {}, {:.2} s",
        report.n_steps,
        report.rejections.total(),
        report.ledger_residual,
        report.own.min_distance_over_contact,
        report.stop,
        clock.elapsed().as_secs_f64()
    );
    println!("  {:?}", report.own.work);
    println!("  {:?}", report.rejections);
    println!(
        "  parted {:?}, cut removed {:.4}",
        run.parted,
        run.removed / run.start
    );
    let curve = &run.record.curve;
    for share in [0.5, 0.9, 0.95, 0.99] {
        let below = |i: &usize| {
            (0..3).map(|p| curve.stored()[p][*i]).sum::<f64>() <= (1.0 - share) * run.start
        };
        if let Some(i) = (0..curve.len()).find(below) {
            println!(
                "  {:.0} % released at {:.3} T0",
                100.0 * share,
                curve.time()[i]
            );
        }
    }
}
