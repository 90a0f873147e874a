//! Terms of a colloid: flow, second elastic constant, external field, second precision.

use topo_core::{CpuClock, Interrupt};
use topo_nematic::record::PhaseReport;
use topo_nematic::{
    ChargeSettings, DischargeSettings, ExternalField, FlowParameters, Material, NematicAccuracy,
    NematicBattery, NematicParameters, Precision, Protocol, RunHooks, SurfacePattern,
};

use super::term::{Taken, Term};
use crate::{LabError, Preset};

/// A colloid with all that can be left out.
#[derive(Debug, Clone)]
struct Colloid {
    parameters: NematicParameters,
    accuracy: NematicAccuracy,
    discharge: DischargeSettings,
}

/// A colloid without further terms.
fn plain(radius: f64) -> Colloid {
    Colloid {
        parameters: NematicParameters {
            radius,
            spacing: 1.5,
            pattern: SurfacePattern::Winding(3),
            ..NematicParameters::default()
        },
        accuracy: NematicAccuracy::default(),
        discharge: DischargeSettings {
            until_released: 0.99,
            ..DischargeSettings::default()
        },
    }
}

pub(super) fn terms(preset: Preset) -> Vec<Term> {
    let radius = if preset == Preset::Draft { 7.5 } else { 15.0 };
    let plain = plain(radius);
    let shape = format!("R = {radius}, h = 1.5, q = 3");
    let mut terms = Vec::new();
    let mut add = |name: &'static str,
                   value: &str,
                   change: fn(&mut Colloid),
                   own: fn(&PhaseReport) -> (u64, u64)| {
        let mut with = plain.clone();
        change(&mut with);
        let scenes = [plain.clone(), with];
        terms.push(Term {
            system: "nematic",
            name,
            quantity: format!("{value}; {shape}"),
            run: Box::new(move |with, interrupt| run(&scenes[usize::from(with)], own, interrupt)),
        });
    };
    add(
        "flow",
        "every step",
        |c| c.discharge.flow = Some(FlowParameters::default()),
        |r| {
            let n_updates = r.own.flow.map_or(0, |f| f.counters.n_updates);
            (r.own.bytes.flow, n_updates)
        },
    );
    add(
        "second elastic constant",
        "L_2 = 0.3 L",
        |c| {
            c.parameters.material = Material {
                second_elastic_constant: Some(0.3),
                ..c.parameters.material
            };
        },
        |r| (r.own.bytes.second, r.own.n_second_passes),
    );
    add(
        "external field",
        "chi_a E² = 0.01 along z",
        |c| {
            c.parameters.field = Some(ExternalField {
                vector: [0.0, 0.0, 0.1],
                anisotropy: 1.0,
            });
        },
        // The field is five numbers of the kernel, and no pass of its own.
        |_| (0, 0),
    );
    add(
        "second precision",
        "discharged in f32 instead of f64",
        |c| c.accuracy.precision = Precision::Single,
        |_| (0, 0),
    );
    terms
}

/// Charges, switches and discharges a colloid.
fn run(
    colloid: &Colloid,
    own: fn(&PhaseReport) -> (u64, u64),
    interrupt: &Interrupt,
) -> Result<Taken, LabError> {
    let run = || {
        let battery = NematicBattery::new(&colloid.parameters, &colloid.accuracy)?;
        let protocol = Protocol {
            charge: ChargeSettings {
                tolerance: 1e-6,
                order_tolerance: 1e-4,
                ..ChargeSettings::default()
            },
            discharge: colloid.discharge.clone(),
            ..Protocol::default()
        };
        let clock = CpuClock::start();
        let (charged, run) = battery.run(&protocol, &mut RunHooks::new(interrupt))?;
        let Some(run) = run else {
            return Ok(Taken::default());
        };
        let report = run.record.report;
        let (term_bytes, term_calls) = own(&report);
        Ok(Taken {
            cpu_seconds: clock.seconds(),
            calls: charged.report().n_steps + report.counters.n_rate_evaluations,
            peak_bytes: report.n_bytes(),
            term_bytes,
            term_calls,
        })
    };
    run().map_err(|source| LabError::Nematic {
        case: "cost of a term".to_owned(),
        source,
    })
}
