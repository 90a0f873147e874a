//! The cases of a scene, their runs and the table.

use serde::Serialize;
use serde_json::json;
use topo_analysis::{DischargeTimes, Warnings};
use topo_core::{CpuClock, StopReason};
use topo_lab::{
    About, Battery, CaseName, Cost, Event, LabError, Outcome, Place, SweepSettings, identity,
};

use crate::battery::{Fibres, Unwinding};
use crate::fibre::{self, TWIST};
use crate::rows::{Row, Sample, Vertex};

/// A scene as an experiment.
#[derive(Debug)]
pub struct Experiment(pub Fibres);

/// One fibre.
#[derive(Debug, Clone, Serialize)]
pub struct Case {
    length: f64,
    turn: f64,
    edges: f64,
}

impl Case {
    /// The vertices, charged and at the end of a run with these angles.
    fn vertices(&self, angles: &[f64]) -> Vec<Vertex> {
        let n = angles.len();
        let vertex = |i: usize| {
            let share = i as f64 / n as f64;
            Vertex {
                s: share * self.length,
                charged: share * self.turn,
                end: i.checked_sub(1).map_or(0.0, |k| angles[k]),
            }
        };
        (0..=n).map(vertex).collect()
    }
}

const SHARES: [f64; 4] = [0.5, 0.9, 0.95, 0.99];

impl Experiment {
    fn row(&self, case: &Case, run: &fibre::Discharge) -> Row {
        let curve = &run.curve;
        let energy = curve.stored_total(0);
        let times = DischargeTimes::of(curve, &[TWIST], energy, &SHARES);
        let at = |share| times.at(share).map(|t| t.value);
        let last = curve.len() - 1;
        let mut warnings = Warnings::default();
        if run.stop == StopReason::ReachedTime {
            warnings.push("not finished in 100 L²");
        }
        Row {
            energy,
            energy_left: curve.stored_total(last),
            dissipated: curve.dissipated_total(last),
            t50: at(0.5),
            t90: at(0.9),
            t95: at(0.95),
            t99: at(0.99),
            ledger_residual: run.ledger_residual,
            steps: run.n_steps,
            warnings,
            ..topo_lab::Experiment::blank_row(self, case)
        }
    }
}

impl topo_lab::Experiment for Experiment {
    type Case = Case;
    type Row = Row;
    type Start = ();

    fn battery(&self) -> &'static dyn Battery {
        &Unwinding
    }

    fn folder(&self) -> &str {
        &self.0.folder
    }

    fn text(&self) -> String {
        self.0.text()
    }

    fn cases(&self) -> Result<Vec<Case>, LabError> {
        let mut cases = Vec::new();
        for &length in &self.0.lengths {
            for &turn in &self.0.turns {
                let of = |&edges| Case {
                    length,
                    turn,
                    edges,
                };
                cases.extend(self.0.edges.iter().map(of));
            }
        }
        Ok(cases)
    }

    fn name(&self, case: &Case) -> String {
        let usual = [1e-4, 0.999];
        CaseName::of("straight")
            .number("l", case.length)
            .signed("turn", case.turn)
            .number("n", case.edges)
            .unsaid_if([self.0.tolerance, self.0.until_released] != usual)
            .finish(|| json!([case, self.0.tolerance, self.0.until_released]))
    }

    fn fingerprint(&self, case: &Case) -> Result<String, LabError> {
        Ok(identity(&json!({
            "version": Unwinding.results(), "case": case, "tolerance": self.0.tolerance,
            "until_released": self.0.until_released,
        })))
    }

    fn blank_row(&self, case: &Case) -> Row {
        Row {
            case: self.name(case),
            length: case.length,
            turn: case.turn,
            edges: case.edges,
            ..Row::default()
        }
    }

    fn cost(&self, case: &Case, _n_rows: Option<usize>) -> Result<Cost, LabError> {
        Ok(Cost {
            seconds: 2e-6 * case.edges * self.0.tolerance.powf(-1.0 / 3.0),
            bytes: 100 * case.edges as u64,
        })
    }

    fn prepare(
        &self,
        _todo: &[&Case],
        _settings: &SweepSettings,
        _progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<(), LabError> {
        Ok(())
    }

    fn run(
        &self,
        case: &Case,
        _start: &(),
        place: &Place<'_>,
    ) -> Result<Option<Outcome<Row>>, LabError> {
        let clock = CpuClock::start();
        place.working("discharging");
        let run = fibre::discharge(
            [case.length, case.turn],
            case.edges as usize,
            self.0.tolerance,
            self.0.until_released,
            &place.settings.interrupt,
        );
        let run = run.map_err(|source| LabError::Case {
            case: place.name.to_owned(),
            source: source.into(),
        })?;
        if run.stop == StopReason::Interrupted {
            return Ok(None);
        }
        let row = Row {
            cpu_seconds: clock.seconds(),
            ..self.row(case, &run)
        };
        let failed = !run.stop.is_success();
        let outcome = Outcome {
            rows: vec![row],
            failure: failed.then(|| format!("discharge stopped: {}", run.stop)),
        };
        let curve = &run.curve;
        let sample = |(i, &time)| Sample {
            time,
            energy: curve.stored_total(i),
            dissipated: curve.dissipated_total(i),
        };
        let series: Vec<Sample> = curve.time().iter().enumerate().map(sample).collect();
        let mut folder = place.open()?;
        folder.table("series.csv", &series)?;
        folder.table("angles.csv", &case.vertices(&run.angles))?;
        let about = About {
            case: json!(case),
            scene: json!(self.0),
            seed: None,
            units: ["h", "zeta h^2/C", "C/h"],
            ledger_residual: run.ledger_residual,
            more: json!({ "steps": run.n_steps }),
        };
        let run = folder.about(&outcome, about);
        folder.finish(&run)?;
        Ok(Some(outcome))
    }

    fn header(&self) -> String {
        "   L/h    turn  edges        E     t50     t99".to_owned()
    }

    fn line(&self, row: &Row) -> String {
        let cell = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.3}"));
        format!(
            "{:6.2} {:+7.3} {:6} {:8.5} {} {}",
            row.length,
            row.turn,
            row.edges,
            row.energy,
            cell(row.t50),
            cell(row.t99)
        )
    }
}
