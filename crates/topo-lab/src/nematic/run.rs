//! One case: charge a colloid, switch its anchoring, follow the discharge, and write a folder.

use std::path::Path;

use serde_json::json;
use topo_analysis::{
    DischargeTimes, NEMATIC_SHARES, NematicRow, NematicSample, Warnings, late_rate,
};
use topo_core::{Progress, StopReason, load_checkpoint, save_checkpoint};
use topo_nematic::flow::FlowCoupling;
use topo_nematic::record::{ChargeReport, FinalSource, FinalState, MinimumState};
use topo_nematic::{
    ChargedNematic, Discharge, DischargeSettings, NematicAccuracy, NematicBattery, NematicError,
    NematicState, RunHooks, SwitchedNematic, Threads,
};

use super::case::NematicCase;
use super::field::{self, FieldSnapshot};
use super::scene::NematicScene;
use super::snapshot::{RING_ORDER, Snapshots, centre};
use crate::LabError;
use crate::folder::{Outcome, forget_checkpoints, forget_file, make_folder};
use crate::sweep::{About, Place, value};

/// Schema of the checkpoint of snapshots.
const KEPT: &str = "nematic-snapshots/4";

/// How a case runs.
pub(super) struct ColloidRun<'a> {
    pub scene: &'a NematicScene,
    pub case: &'a NematicCase,
    pub place: &'a Place<'a>,
    pub threads: Threads,
}

impl ColloidRun<'_> {
    /// Runs the case and writes its folder; `None` when interrupted: then its checkpoint stays.
    pub fn run(&self) -> Result<Option<Outcome<NematicRow>>, LabError> {
        self.place.or_anew(|| self.attempt())
    }

    fn refuse(&self, source: NematicError) -> LabError {
        LabError::Nematic {
            case: self.place.name.to_owned(),
            source,
        }
    }

    fn attempt(&self) -> Result<Option<Outcome<NematicRow>>, LabError> {
        let Place {
            folder,
            settings: sweep,
            ..
        } = *self.place;
        let interrupt = &sweep.interrupt;
        let refuse = |source| self.refuse(source);
        make_folder(folder)?;
        let accuracy = NematicAccuracy {
            threads: self.threads,
            ..self.scene.accuracy
        };
        let battery = NematicBattery::new(&self.case.nematic, &accuracy).map_err(refuse)?;
        let mut tell = |p: &Progress| self.place.progressed(p);
        forget_checkpoints(folder, self.place.fingerprint)?;
        let mut hooks = RunHooks::new(interrupt)
            .with_progress(&mut tell)
            .with_checkpoint(&self.place.checkpoint("charge"), sweep.checkpoint_seconds);
        let charged = battery
            .charge(&self.scene.charge, &mut hooks)
            .map_err(refuse)?;
        if interrupt.is_requested() {
            return Ok(None);
        }
        let released = charged.switch(&self.scene.switch).map_err(refuse)?;
        let end = released
            .final_state(&mut RunHooks::new(interrupt).with_progress(&mut tell))
            .map_err(refuse)?;
        let Some((run, kept)) = self.discharge(&charged, &released, &end)? else {
            return Ok(None);
        };
        let row = self.row(&battery, &charged, &run);
        let outcome = Outcome {
            failure: failure(&charged, &run),
            rows: vec![row],
        };
        self.write(&charged, &run, &kept, &outcome)?;
        forget_checkpoints(folder, "")?;
        Ok(Some(outcome))
    }

    /// Follows the discharge and keeps what snapshots need; `None` when interrupted.
    fn discharge(
        &self,
        charged: &ChargedNematic,
        released: &SwitchedNematic,
        end: &FinalState,
    ) -> Result<Option<(Discharge, Snapshots)>, LabError> {
        let Place {
            folder,
            settings: sweep,
            ..
        } = *self.place;
        let settings = DischargeSettings {
            flow: self.case.flow,
            ..self.scene.discharge.clone()
        };
        // a run that keeps fields cannot go on from one that did not
        let [snapshots, discharge] = if sweep.keep_fields {
            ["snapshots-fields", "discharge-fields"]
        } else {
            ["snapshots", "discharge"]
        };
        let (place, discharge) = (
            self.place.checkpoint(snapshots),
            self.place.checkpoint(discharge),
        );
        let mut kept = self.kept_before(&place, &discharge)?;
        if sweep.keep_fields {
            let state = charged.state();
            FieldSnapshot::of(None, state, None, centre(state)).write(folder, 0)?;
        }
        let mut failed: Option<LabError> = None;
        let mut see = |s: &topo_nematic::record::NematicSample,
                       state: &NematicState,
                       flow: Option<&FlowCoupling>| {
            let share = released
                .stored(end)
                .map_or(1.0, |stored| (s.energy.total() - end.energy) / stored);
            if failed.is_none() && kept.see(s.time, share, state, flow) {
                let saved = self
                    .keep_field(s.time, kept.n_kept, state, flow)
                    .and_then(|()| Ok(save_checkpoint(&place, KEPT, &kept)?));
                failed = saved.err();
            }
        };
        let mut tell = |p: &Progress| self.place.progressed(p);
        let mut hooks = RunHooks::new(&sweep.interrupt)
            .with_progress(&mut tell)
            .with_samples(&mut see)
            .with_checkpoint(&discharge, sweep.checkpoint_seconds);
        let run = released.discharge(&settings, &mut hooks);
        let run = run.map_err(|source| self.refuse(source))?;
        if let Some(error) = failed {
            return Err(error);
        }
        let is_over = run.record.report.stop != StopReason::Interrupted;
        Ok(is_over.then_some((run, kept)))
    }

    /// What a run before has kept in `place`; where that is nothing, the discharge begins again.
    fn kept_before(&self, place: &Path, discharge: &Path) -> Result<Snapshots, LabError> {
        let there = place.exists();
        let kept: Snapshots = load_checkpoint(place, KEPT).unwrap_or_default();
        if kept == Snapshots::default() {
            if there {
                self.place.tell_damaged();
            }
            // what was seen before cannot be seen again without going through the discharge again
            forget_file(discharge)?;
            field::forget(self.place.folder)?;
        }
        Ok(kept)
    }

    fn keep_field(
        &self,
        time: f64,
        number: usize,
        state: &NematicState,
        flow: Option<&FlowCoupling>,
    ) -> Result<(), LabError> {
        let Place {
            folder, settings, ..
        } = *self.place;
        if settings.keep_fields {
            FieldSnapshot::of(Some(time), state, flow, centre(state)).write(folder, number)?;
        }
        Ok(())
    }

    fn row(
        &self,
        battery: &NematicBattery,
        charged: &ChargedNematic,
        run: &Discharge,
    ) -> NematicRow {
        let curve = &run.record.curve;
        let names: Vec<&str> = curve.parts().iter().map(String::as_str).collect();
        let f_charged = charged.energy().total();
        let end = run.final_state.energy;
        let times = |start: f64| {
            let start = if run.stored.is_some() { start } else { end };
            DischargeTimes::between(curve, &names, [start, end], &NEMATIC_SHARES)
        };
        let (after, whole) = (times(run.start), times(f_charged));
        let at = |times: &DischargeTimes, k: usize| times.at(NEMATIC_SHARES[k]).map(|t| t.value);
        let ring = charged.ring(RING_ORDER);
        let (charge, discharge) = (charged.report(), &run.record.report);
        let minimum = charge.minimum.as_ref();
        let flow = discharge.own.flow.as_ref().map(|f| f.counters);
        let mut row = NematicRow {
            f_charged,
            f_after_switch: run.start,
            f_final: end,
            order_parameter: charged.order().magnitude(),
            lowest_eigenvalue: minimum.map(|m| m.lowest_eigenvalue),
            state: minimum.map(|m| m.state),
            ring_radius: ring.as_ref().map(|r| r.radius),
            ring_mode: ring.as_ref().map(|r| r.mode() as u32),
            ring_amplitude: ring.as_ref().map(|r| r.amplitude()),
            t50: at(&after, 0),
            t90: at(&after, 1),
            t99: at(&after, 2),
            t999: at(&after, 3),
            t50_charged: at(&whole, 0),
            t90_charged: at(&whole, 1),
            t99_charged: at(&whole, 2),
            t999_charged: at(&whole, 3),
            late_rate: late_rate(curve, end),
            steps: discharge.n_steps,
            evaluations: charge.n_steps + discharge.counters.n_rate_evaluations,
            stokes_updates: flow.map_or(0, |f| f.n_updates),
            stokes_iterations: flow.map_or(0, |f| f.n_boundary_solves),
            cpu_seconds: charge.cpu_seconds + discharge.cpu_seconds,
            peak_bytes: charge.bytes.total().max(discharge.n_bytes()),
            ..self.scene.blank_row(self.case)
        };
        for text in battery.warnings() {
            row.warnings.push(text.as_str());
        }
        run_warnings(charge, run, &mut row.warnings);
        row
    }

    fn write(
        &self,
        charged: &ChargedNematic,
        run: &Discharge,
        kept: &Snapshots,
        outcome: &Outcome<NematicRow>,
    ) -> Result<(), LabError> {
        let row = &outcome.rows[0];
        let mut all = Snapshots::default();
        all.keep(None, charged.state(), None);
        all.lines.extend(kept.lines.iter().cloned());
        all.slices.extend(kept.slices.iter().cloned());
        all.ring.extend(kept.ring.iter().cloned());
        let series: Vec<NematicSample> = run.record.samples.iter().map(sample).collect();
        let mut folder = self.place.open()?;
        folder.table("lines.csv", &all.lines)?;
        folder.table("ring.csv", &all.ring)?;
        folder.table("slices.csv", &all.slices)?;
        folder.table("series.csv", &series)?;
        let about = About {
            case: value(self.case),
            scene: value(self.scene),
            seed: None,
            units: ["xi_N", "tau_N", "L xi_N"],
            ledger_residual: run.record.report.ledger_residual,
            more: json!({
                "charge": charged.report(),
                "energy_charged": charged.energy(),
                "order_charged": charged.order(),
                "minimum": charged.report().minimum,
                "ring_charged": charged.ring(RING_ORDER),
                "energy_removed_by_switch": run.removed,
                "energy_after_switch": run.start,
                "final_state": run.final_state,
                "discharge": run.record.report,
            }),
        };
        let mut json = folder.about(outcome, about);
        json["warnings"] = value(&row.warnings);
        if self.place.settings.keep_fields {
            json.insert("n_fields".to_owned(), (kept.n_kept + 1).into());
        }
        folder.finish(&json)
    }
}

/// Why a run did not finish.
fn failure(charged: &ChargedNematic, run: &Discharge) -> Option<String> {
    let (charge, stop) = (charged.report(), &run.record.report.stop);
    if !charge.is_converged() {
        return Some(format!("charge not converged: {}", charge.stop));
    }
    (!stop.is_success()).then(|| format!("discharge stopped: {stop}"))
}

/// What went otherwise than asked for.
fn run_warnings(charge: &ChargeReport, run: &Discharge, warnings: &mut Warnings) {
    let discharge = &run.record.report;
    if !charge.is_converged() {
        warnings.push(format!(
            "charge not converged: {}, rms H {:.1e}",
            charge.stop, charge.rms_field
        ));
    }
    if let Some(text) = stability_warning(charge) {
        warnings.push(text);
    }
    if !discharge.stop.is_success() {
        warnings.push(format!("discharge stopped: {}", discharge.stop));
    }
    final_state_warnings(run, warnings);
    if discharge.stop == StopReason::ReachedTime {
        warnings.push("discharge not finished in the longest time followed");
    }
    if discharge.ledger_residual > 0.01 {
        warnings.push(format!(
            "energy account open by {:.1} %",
            100.0 * discharge.ledger_residual
        ));
    }
}

/// What is to be said of the state that released energy counts down to.
fn final_state_warnings(run: &Discharge, warnings: &mut Warnings) {
    let end = &run.final_state;
    match run.stored {
        None => warnings.push("nothing is stored: there are no discharge times"),
        Some(stored) if stored < 0.0 => warnings.push(format!(
            "the final state lies {:.4} L xi_N above the present one: there are no discharge times",
            -stored
        )),
        Some(stored) => {
            let last = run.record.curve.len().checked_sub(1);
            let left = last.map_or(0.0, |i| run.record.curve.stored_total(i) - end.energy);
            if left < -BELOW * stored {
                warnings.push(format!("the discharge ended {:.4} L xi_N below the state that its times count down to: it relaxed to another",
                    -left
                ));
            }
        }
    }
    if end.source == FinalSource::Unconverged {
        warnings.push("the final state did not converge: its energy is an upper bound");
    }
}

/// Share of the energy stored by which a discharge may end below its final state: beyond is not rounding.
const BELOW: f64 = 1e-3;

/// What the check of the charged state found that a reader of its row must know.
fn stability_warning(charge: &ChargeReport) -> Option<String> {
    match &charge.minimum {
        Some(m) if m.state == MinimumState::Saddle => Some(format!(
            "charged state is a saddle after {} kicks: lowest eigenvalue {:.1e}",
            m.n_kicks, m.lowest_eigenvalue
        )),
        None if charge.is_converged() => {
            Some("lowest mode of the charged state was not found".to_owned())
        }
        _ => None,
    }
}

fn sample(s: &topo_nematic::record::NematicSample) -> NematicSample {
    NematicSample {
        time: s.time,
        energy: s.energy.total(),
        dissipated_rotation: s.dissipated[0],
        dissipated_flow: s.dissipated[1],
        order_x: s.order.tilt[0],
        order_y: s.order.tilt[1],
        tilt: s.order.director_magnitude(),
        ring_radius: s.ring.as_ref().map(|r| r.radius),
        max_speed: s.max_speed,
        power: None,
        flow_correlation: s.flow_correlation,
    }
}
