//! Charges a colloid with n_q anchoring, switches the anchoring off and follows the discharge.
//!
//! ```text
//! cargo run --release -p topo-nematic --example nematic_discharge -- [charge] [radius] [spacing] [seed] [flow: 1] [staircase: 1]
//! ```

use std::time::Instant;

use topo_core::Interrupt;
use topo_core::Progress;
use topo_nematic::{
    ChargeSettings, ChargedNematic, Discharge, DischargeSettings, FlowParameters, FreeSurface,
    NematicAccuracy, NematicBattery, NematicError, NematicParameters, RunHooks, SurfacePattern,
    SwitchSettings, SwitchTarget,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument =
        |k: usize, default: f64| std::env::args().nth(k).map_or(Ok(default), |a| a.parse());
    let (charge, radius, spacing, seed, flow, staircase) = (
        argument(1, 3.0)? as i32,
        argument(2, 10.0)?,
        argument(3, 1.5)?,
        argument(4, 0.05)?,
        argument(5, 0.0)? > 0.0,
        argument(6, 0.0)? > 0.0,
    );
    let parameters = NematicParameters {
        radius,
        spacing,
        pattern: SurfacePattern::Winding(charge),
        ..Default::default()
    };
    let battery = NematicBattery::new(&parameters, &NematicAccuracy::default())?;
    for warning in battery.warnings() {
        println!("warning: {warning}");
    }
    println!("cells {:?}", battery.grid().cells());
    let charged = charge_from(&battery, seed)?;
    if let Some(ring) = charged.ring(0.35) {
        println!(
            "ring:       radius {:.3} R, height mode {} of amplitude {:.3} xi_N",
            ring.radius / radius,
            ring.mode(),
            ring.amplitude()
        );
    }
    let clock = Instant::now();
    let switched = charged.switch(&SwitchSettings {
        to: SwitchTarget::Free(if staircase {
            FreeSurface::Staircase
        } else {
            FreeSurface::CutCell
        }),
        ramp: None,
    })?;
    println!(
        "switched:   F = {:.2}, removed {:.2e}",
        switched.start(),
        switched.removed()
    );
    let settings = DischargeSettings {
        flow: flow.then(FlowParameters::default),
        ..Default::default()
    };
    let run = switched.discharge(&settings, &mut RunHooks::new(&Interrupt::new()))?;
    print_run(&run, clock);
    print_times(&run, battery.diffusion_time());
    Ok(())
}

/// Charges from the uniform field tilted by `seed` and prints how it went.
fn charge_from(battery: &NematicBattery, seed: f64) -> Result<ChargedNematic, NematicError> {
    let interrupt = Interrupt::new();
    let settings = ChargeSettings {
        seeds: vec![seed],
        ..Default::default()
    };
    let clock = Instant::now();
    let mut show = |p: &Progress| {
        if std::env::var_os("TOPO_VERBOSE").is_some() {
            println!("  {p}");
        }
    };
    let mut hooks = RunHooks::new(&interrupt).with_progress(&mut show);
    let charged = battery.charge(&settings, &mut hooks)?;
    let report = charged.report();
    println!(
        "charged:    F = {:.2} (elastic {:.2}, bulk {:.2}), tilt {:.5} at {:.0} deg, {} steps, rms H {:.1e}, {}, {:.2} s",
        report.energy.total(),
        report.energy.elastic,
        report.energy.bulk,
        report.order.magnitude(),
        report.order.azimuth().to_degrees(),
        report.n_steps,
        report.rms_field,
        report.stop,
        clock.elapsed().as_secs_f64()
    );
    Ok(charged)
}

/// How the discharge went.
fn print_run(run: &Discharge, clock: Instant) {
    let report = &run.record.report;
    println!(
        "discharged: {} steps, {} refused, {} evaluations, ledger residual {:.1e}, {}, {:.2} s",
        report.n_steps,
        report.rejections.total(),
        report.counters.n_rate_evaluations,
        report.ledger_residual,
        report.stop,
        clock.elapsed().as_secs_f64()
    );
    if let Some(flow) = report.own.flow {
        println!(
            "flow:       {} updates, {:?}, largest speed {:.2e}",
            flow.counters.n_updates, flow.counters, flow.max_speed
        );
    }
    println!("bytes:      {:?}", report.own.bytes);
}

/// Times at which shares of the energy are released, in the diffusion time.
fn print_times(run: &Discharge, unit: f64) {
    let curve = &run.record.curve;
    for share in [0.5, 0.9, 0.99, 0.999] {
        let left = (1.0 - share) * run.start;
        if let Some(i) = (1..curve.len()).find(|i| curve.stored_total(*i) <= left) {
            // Between steps the energy decays about exponentially.
            let (e0, e1) = (curve.stored_total(i - 1), curve.stored_total(i));
            let (t0, t1) = (curve.time()[i - 1], curve.time()[i]);
            let time = t0 + (t1 - t0) * (e0 / left).ln() / (e0 / e1).ln();
            println!(
                "  {:5.1} % released at {:.4} R^2/(Gamma L)",
                100.0 * share,
                time / unit
            );
        }
    }
}
