//! One case: charge a knot, cut it where the scene says, follow each discharge, and write a folder.

use std::path::Path;

use topo_core::{CpuClock, CurveError, Polyline, Progress, StopReason};
use topo_knots::{KnotError, identify};
use topo_rod::{ChargedRod, Guards, PhaseReport, RodBattery, RunHooks};

use super::breaking;
use super::case::ElasticCase;
use super::case_run::{CaseInputs, CutResults};
use super::identity::starts_from_two_images;
use super::imperfection::perturbed;
use super::observable::further;
use super::record::{CaseResults, write_case};
use super::sites::{Chosen, place, site, sites};
use super::tied::label;
use super::types::timeline;
use crate::LabError;
use crate::folder::{Outcome, forget_checkpoints};
use crate::sweep::Place;
use topo_analysis::{DischargeTimes, ELASTIC_SHARES, SweepRow, Warning, Warnings};

/// A charged case.
#[derive(Debug)]
pub(crate) struct ChargedCase {
    pub rod: ChargedRod,
    /// Processor seconds of all charges, those before a checkpoint included.
    pub cpu_seconds: f64,
    /// Elastic energy of the image that was charged too and not kept, in E_0; none if only one was or it did not finish.
    pub energy_other_image: Option<f64>,
}

/// Twists and relaxes the knot of a case.
///
/// The tight curve of an amphichiral knot need not be its own mirror image, as that of 6_3, and a rod so tightly tied stays
/// in the one of the two minima that it starts from. The image that stores less under the twist of the case is taken, so
/// that the energy of such a knot does not depend on the sign of the twist. The other image stores what the one kept would
/// under the opposite twist: how far a single curve sees the sign is the difference of the two energies. A natural shape is that of the
/// fibre, whichever image it is tied along: one with a hand is charged from both images without twist too, and the energy of the other
/// is that of the mirrored shape.
///
/// The mirror image of a knot starts from the mirror image of its start curve, imperfections included, so that at the opposite
/// twist all of its run is the mirror image of the knot's.
///
/// `kept` names the checkpoint files of the curve itself and of its image.
///
/// # Validation
/// `amphichiral_knots_are_charged_from_both_images_and_the_other_is_reported`, `law_mirrored_knots_give_mirrored_runs`.
pub(crate) fn charge(
    inputs: &CaseInputs<'_>,
    hooks: &mut RunHooks<'_>,
    kept: Option<[&Path; 2]>,
) -> Result<ChargedCase, LabError> {
    let CaseInputs {
        scene,
        case,
        start,
        table,
    } = *inputs;
    let refuse = |source| inputs.refused(source);
    let entry = case.entry(table)?;
    let centrelines = start.centrelines()?;
    let (rod, accuracy, guards) = (&case.rod, &scene.accuracy, Guards::default());
    let battery = match &scene.pull {
        Some(_) => RodBattery::open(rod, accuracy, guards, &centrelines[0]),
        None => RodBattery::link(rod, accuracy, guards, &centrelines),
    };
    let mut battery = battery.map_err(refuse)?;
    if let Some(rest) = &case.rest {
        battery = rest.of(battery).map_err(refuse)?;
    }
    for term in &scene.own_terms {
        battery = term.added_to(battery).map_err(refuse)?;
    }
    if case.tied.is_some() {
        let kept = entry.verify(battery.centrelines());
        kept.map_err(|e| inputs.too_coarse(&e))?;
    }
    if case.imperfection > 0.0 {
        let moved = imperfect(&battery, case, entry.is_mirror_image());
        let moved = moved.map_err(|e| refuse(e.into()))?;
        battery = battery.disturbed_link(&moved).map_err(refuse)?;
    }
    let mut from = |battery: &RodBattery, image: usize| {
        if let Some(paths) = kept {
            hooks.keep_in(paths[image]);
        }
        match &scene.pull {
            Some(pull) => battery.pull(pull, hooks).map_err(refuse),
            None => battery.charge(&scene.charge, hooks).map_err(refuse),
        }
    };
    let charged = from(&battery, 0)?;
    if !starts_from_two_images(scene, case, &entry) {
        return Ok(ChargedCase {
            cpu_seconds: charged.record().report.cpu_seconds,
            rod: charged,
            energy_other_image: None,
        });
    }
    let image = from(&battery.mirrored().map_err(refuse)?, 1)?;
    let stored = |rod: &ChargedRod| {
        let last = rod.record().samples.last();
        let energy = last.map_or(f64::INFINITY, |s| s.elastic());
        (!rod.record().report.stop.is_success(), energy)
    };
    let cpu_seconds = [&charged, &image].map(|rod| rod.record().report.cpu_seconds);
    let (rod, other) = if stored(&image) < stored(&charged) {
        (image, charged)
    } else {
        (charged, image)
    };
    let (has_failed, energy) = stored(&other);
    Ok(ChargedCase {
        cpu_seconds: cpu_seconds.iter().sum(),
        rod,
        energy_other_image: Some(energy).filter(|_| !has_failed),
    })
}

/// The start curves of a battery with the imperfections of a case, others in each component.
///
/// The mirror image of a knot has the mirror image of its imperfections.
fn imperfect(
    battery: &RodBattery,
    case: &ElasticCase,
    is_mirror_image: bool,
) -> Result<Vec<Polyline>, CurveError> {
    let start = battery.centrelines();
    let length: f64 = start.iter().map(Polyline::length).sum();
    let size = case.imperfection * length / battery.tube().start_length;
    let moved = |(k, curve): (usize, &Polyline)| {
        let seed = case.seed.wrapping_add(k as u64);
        if is_mirror_image {
            perturbed(&curve.mirrored(), size, seed).map(|curve| curve.mirrored())
        } else {
            perturbed(curve, size, seed)
        }
    };
    start.iter().enumerate().map(moved).collect()
}

/// Runs a case and writes its folder; `None` when interrupted: then its checkpoints stay.
pub(crate) fn run(
    inputs: &CaseInputs<'_>,
    place: &Place<'_>,
) -> Result<Option<Outcome<SweepRow>>, LabError> {
    place.or_anew(|| attempt(inputs, place))
}

fn attempt(
    inputs: &CaseInputs<'_>,
    place: &Place<'_>,
) -> Result<Option<Outcome<SweepRow>>, LabError> {
    forget_checkpoints(place.folder, place.fingerprint)?;
    let paths = ["charge", "charge-of-image"].map(|phase| place.checkpoint(phase));
    let mut tell = |p: &Progress| place.progressed(p);
    let mut hooks = RunHooks::new(&place.settings.interrupt)
        .with_progress(&mut tell)
        .with_checkpoint(&paths[0], place.settings.checkpoint_seconds);
    let charged_case = charge(inputs, &mut hooks, Some([&paths[0], &paths[1]]))?;
    if hooks.is_interrupted() {
        return Ok(None);
    }
    let charge_seconds = charged_case.cpu_seconds;
    let charged = &charged_case.rod;
    let sites = sites(inputs, charged);
    let mut base = charged_row(inputs, charged);
    base.energy_other_image = charged_case.energy_other_image;
    let mut runs = Vec::new();
    if charged.record().report.stop.is_success() {
        for (k, chosen) in sites.iter().enumerate() {
            hooks.keep_in(&place.checkpoint(&format!("discharge-{k}")));
            let Some(mut run) = follow(inputs, charged, chosen, &mut hooks)? else {
                return Ok(None);
            };
            let cpu_seconds = run.cpu_seconds + charge_seconds / sites.len() as f64;
            run.row = discharge_row(&base, &run, cpu_seconds);
            runs.push(run);
        }
    }
    if runs.is_empty() {
        base.cpu_seconds = charge_seconds;
    }
    let rows: Vec<SweepRow> = if runs.is_empty() {
        vec![base]
    } else {
        runs.iter().map(|r| r.row.clone()).collect()
    };
    let outcome = Outcome {
        rows,
        failure: failure(charged, &runs),
    };
    let made = CaseResults {
        inputs,
        charged,
        runs: &runs,
        outcome: &outcome,
        charge_seconds,
    };
    finish(&made, place)?;
    Ok(Some(outcome))
}

/// Writes the folder of a case; its checkpoints are of no more use then.
fn finish(made: &CaseResults<'_>, place: &Place<'_>) -> Result<(), LabError> {
    let folder = place.folder;
    if let Err(error) = write_case(made, place) {
        // a folder without its run.json is of no use to anybody; what matters is the first error
        if let Err(left) = std::fs::remove_dir_all(folder) {
            tracing::debug!(folder = %folder.display(), %left, "an incomplete case stays behind");
        }
        return Err(error);
    }
    forget_checkpoints(folder, "")
}

/// Follows the discharge after a cut; its row is still blank. `None` when interrupted.
fn follow(
    inputs: &CaseInputs<'_>,
    charged: &ChargedRod,
    chosen: &Chosen,
    hooks: &mut RunHooks<'_>,
) -> Result<Option<CutResults>, LabError> {
    let site = site(charged, chosen.place);
    let discharge = inputs.discharge(charged, site, &inputs.scene.discharge, hooks)?;
    if hooks.is_interrupted() {
        return Ok(None);
    }
    let clock = CpuClock::start();
    let timeline = timeline(inputs, &discharge)?;
    let (curve, parts) = (
        &discharge.record.curve,
        discharge.record.report.own.parts.elastic(),
    );
    let released = |of: f64| DischargeTimes::of(curve, &parts, of, &ELASTIC_SHARES);
    Ok(Some(CutResults {
        times: released(discharge.start),
        times_after_cut: released(discharge.after_cut),
        cpu_seconds: discharge.record.report.cpu_seconds + clock.seconds(),
        cut: place(charged, discharge.component, discharge.at),
        cut_by: chosen.criteria(),
        discharge,
        timeline,
        row: SweepRow::default(),
    }))
}

/// Why a case did not finish.
fn failure(charged: &ChargedRod, runs: &[CutResults]) -> Option<String> {
    let stop = &charged.record().report.stop;
    if !stop.is_success() {
        return Some(format!("charge stopped: {stop}"));
    }
    runs.iter().find_map(|run| {
        let stop = &run.discharge.record.report.stop;
        let at = run.cut;
        (!stop.is_success()).then(|| format!("discharge after the cut at {at:.4} stopped: {stop}"))
    })
}

fn phase_warnings(phase: &str, report: &PhaseReport, warnings: &mut Warnings) {
    if !report.stop.is_success() {
        warnings.push(format!("{phase} stopped: {}", report.stop));
    }
    if report.ledger_residual > 0.01 {
        warnings.push(format!(
            "{phase}: energy account open by {:.1} %",
            100.0 * report.ledger_residual
        ));
    }
    if report
        .own
        .min_distance_over_contact
        .is_some_and(|d| d < 0.75)
    {
        warnings.push(format!("{phase}: strands overlap deeply"));
    }
}

/// Linking numbers of a charged link, 1 and 2, 1 and 3 and so on.
fn linking(report: &PhaseReport) -> String {
    let pairs = report.own.linking.iter();
    // not -0
    let whole = pairs.map(|pair| (pair.start.round() + 0.0).to_string());
    whole.collect::<Vec<_>>().join(";")
}

/// The part of a row that all cuts share.
fn charged_row(inputs: &CaseInputs<'_>, charged: &ChargedRod) -> SweepRow {
    let case = inputs.case;
    let record = charged.record();
    let report = &record.report;
    let mut row = SweepRow {
        link_drift: report.own.link_drift,
        min_distance_over_contact: report.own.min_distance_over_contact,
        steps: report.n_steps,
        rejected: report.rejections.total(),
        linking: linking(report),
        length: Some(charged.battery().tube().length),
        ..inputs.scene.blank_row(inputs.case)
    };
    if let Some(last) = record.samples.last() {
        row.energy = last.elastic();
        row.energy_in = charged.energy_in();
        row.energy_per_mass = Some(topo_core::energy_per_mass(row.energy));
        row.bend = last.stored.of("bend");
        row.twist_energy = last.stored.of("twist");
        row.stretch = last.stored.of("stretch");
        row.further = further(last, &inputs.scene.observables);
        (row.writhe, row.total_twist) = (last.writhe, last.total_twist);
    }
    if let Some(bears) = inputs.scene.charge.breaking {
        row.further.extend(breaking::columns(bears, charged));
        if let Some(text) = breaking::unbroken(bears, charged) {
            row.warnings.push(text);
        }
    }
    phase_warnings("charge", report, &mut row.warnings);
    if case.rod.contact.is_none() {
        row.warnings
            .push("no contact: strands pass through each other");
    }
    match found(inputs, charged) {
        Ok(None) => {}
        Ok(Some(found)) => row.warnings.push(Warning::Retied { found }),
        Err(error) => row
            .warnings
            .push(format!("the charged rod has no knot type: {error}")),
    }
    row
}

/// The type of a charged rod, if it is not that of its case; of an open one, that of most of its closures.
fn found(inputs: &CaseInputs<'_>, charged: &ChargedRod) -> Result<Option<String>, LabError> {
    let (case, table) = (inputs.case, inputs.table);
    let state = charged.state();
    let Some(tied) = &case.tied else {
        let kind = identify(state.vertices(), table)?;
        return Ok((!kind.fits(&case.knot)).then(|| kind.label()));
    };
    let refuse = |source| LabError::Rod {
        case: tied.name.clone(),
        source,
    };
    let curves = state.centrelines().map_err(refuse)?;
    if let [only] = &curves[..]
        && !only.is_closed()
    {
        let n_closures = inputs.scene.timeline.closures;
        return Ok(tied
            .entry
            .open_mismatch(only, n_closures, case.seed, table)?);
    }
    match tied.entry.verify(&curves) {
        Ok(()) => Ok(None),
        Err(KnotError::Mismatch { .. }) => Ok(Some(label(&curves, table)?)),
        Err(error) => Err(error.into()),
    }
}

/// Work on the load over what the charge took; none where either is not there.
fn efficiency(energy_in: Option<f64>, work: Option<f64>) -> Option<f64> {
    Some(work? / energy_in.filter(|e| *e > 0.0)?)
}

fn discharge_row(base: &SweepRow, run: &CutResults, cpu_seconds: f64) -> SweepRow {
    let report = &run.discharge.record.report;
    let at = |times: &DischargeTimes, share| times.at(share).map(|t| t.value);
    let (times, after_cut) = (&run.times, &run.times_after_cut);
    let mut row = SweepRow {
        cut: run.cut,
        cut_by: run.cut_by.clone(),
        t50: at(times, 0.5),
        t90: at(times, 0.9),
        t95: at(times, 0.95),
        t99: at(times, 0.99),
        t50_after_cut: at(after_cut, 0.5),
        t90_after_cut: at(after_cut, 0.9),
        t95_after_cut: at(after_cut, 0.95),
        t99_after_cut: at(after_cut, 0.99),
        t_untie: run.timeline.untying_time(),
        work: report.own.load.map(|load| load.work),
        heat: run.discharge.heat(),
        residual: Some(report.ledger_residual),
        peak_power: report.own.load.map(|load| load.peak_power),
        efficiency: efficiency(base.energy_in, report.own.load.map(|load| load.work)),
        min_distance_over_contact: base
            .min_distance_over_contact
            .into_iter()
            .chain(report.own.min_distance_over_contact)
            .reduce(f64::min),
        steps: base.steps + report.n_steps,
        rejected: base.rejected + report.rejections.total(),
        cpu_seconds,
        ..base.clone()
    };
    if report.stop == StopReason::ReachedTime {
        row.warnings
            .push("discharge not finished in the longest time followed");
    }
    phase_warnings("discharge", report, &mut row.warnings);
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ElasticScene, Preset};
    use topo_knots::KnotTable;
    use topo_knots::{TightenSettings, tighten_entry};
    use topo_rod::energy::RodParts;
    use topo_rod::{Breaking, Criterion};

    /// The two images of the tight 6_3 are two curves: either one alone stores energies that depend on the sign of the twist, by the
    /// 2.4e-3 that the finest runs give at 80 edges too. The one that stores less is kept and the other one's energy reported.
    #[test]
    fn amphichiral_knots_are_charged_from_both_images_and_the_other_is_reported() {
        let table = KnotTable::builtin();
        let entry = table.get("6_3").unwrap();
        let quick = TightenSettings {
            n_variants: 0,
            n_kicks: 0,
            ..TightenSettings::draft()
        };
        let tight = tighten_entry(&entry, &quick).unwrap();
        let mut scene = ElasticScene::published(Preset::Draft);
        (scene.rod.n_edges, scene.imperfection) = (80, 0.0);
        let of = |rod: &ChargedRod| rod.record().samples.last().unwrap().elastic();
        let run = |twist: Option<f64>| {
            let case = scene.case("6_3", twist);
            let inputs = CaseInputs {
                scene: &scene,
                case: &case,
                start: (&tight).into(),
                table: &table,
            };
            let charged = charge(&inputs, &mut RunHooks::default(), None).unwrap();
            // the one curve alone
            let curve = tight.centreline().unwrap();
            let battery =
                RodBattery::new(&case.rod, &scene.accuracy, Guards::default(), &curve).unwrap();
            let single = battery
                .charge(&scene.charge, &mut RunHooks::default())
                .unwrap();
            (of(&charged.rod), charged.energy_other_image, of(&single))
        };
        let ((kept, other, plus), (_, other_minus, minus)) = (run(Some(0.5)), run(Some(-0.5)));
        let difference = (plus / minus - 1.0).abs();
        println!("6_3 from one image, theta' h = 0.5: sign of the twist felt by {difference:.2e}");
        assert!((1.5e-3..3.5e-3).contains(&difference), "{difference:.1e}");
        assert_eq!((kept, other), (plus.min(minus), Some(plus.max(minus))));
        assert_eq!(other_minus, other);
        assert_eq!(run(Some(0.0)).1, None);
    }

    /// Half of 4 = 1 + 1 + 2 is gone when the stretch is, at 1 T_0; what contact holds does not count.
    #[test]
    fn val_released_shares_count_bend_twist_and_stretch() {
        let names = RodParts::default();
        let mut curve = topo_core::DischargeCurve::new(names.names(), Vec::<String>::new());
        curve.push(0.0, &[1.0, 1.0, 2.0, 50.0], &[]).unwrap();
        curve.push(1.0, &[1.0, 1.0, 0.0, 40.0], &[]).unwrap();
        curve.push(2.0, &[0.0, 1.0, 0.0, 40.0], &[]).unwrap();
        curve.push(3.0, &[0.0, 0.0, 0.0, 40.0], &[]).unwrap();
        let times = DischargeTimes::of(&curve, &RodParts::default().elastic(), 4.0, &[0.5, 0.75]);
        assert_eq!(times.at(0.5).unwrap().value, 1.0);
        assert_eq!(times.at(0.75).unwrap().value, 2.0);
    }

    #[test]
    fn identities_of_chiral_and_untwisted_cases_know_of_one_image() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::published(Preset::Draft);
        let case = |knot: &str, twist| scene.case(knot, twist);
        for (knot, twist, two) in [
            ("6_3", Some(0.5), true),
            ("6_3", Some(0.0), false),
            ("6_3", None, false),
            ("6_2", Some(0.5), false),
        ] {
            let case = case(knot, twist);
            let entry = case.entry(&table).unwrap();
            assert_eq!(starts_from_two_images(&scene, &case, &entry), two);
            let breaking = Breaking {
                criterion: Criterion::Tension,
                threshold: 0.5,
            };
            let mut breaks = scene.clone();
            breaks.charge.breaking = Some(breaking);
            assert!(!starts_from_two_images(&breaks, &case, &entry));
        }
    }
}
