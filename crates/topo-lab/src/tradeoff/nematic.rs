//! Settings of the colloid: spacing, tolerance, boundary scheme, storage, flow.

use topo_core::Interrupt;
use topo_nematic::{
    Boundary, DischargeSettings, FlowParameters, FreeSurface, NematicAccuracy, NematicBattery,
    NematicError, NematicParameters, Precision, Protocol, RunHooks, SurfacePattern, SwitchSettings,
    SwitchTarget,
};

use super::sets::{CaseSet, Colloid, colloids};
use super::trial::{Outcome, Quantities, REFERENCE, TradeoffRun, Trial};
use crate::goal::extrapolated;
use crate::nematic::fit;
use topo_analysis::{DischargeTimes, NEMATIC_SHARES};

/// Radius of the particle, and edges of the cell: multiples of every spacing, so that the cell is the same on all grids.
const RADIUS: f64 = 15.0;
/// Edges of the cell in radii.
const CELL: [f64; 3] = [5.6, 5.6, 4.0];
/// Spacings and tolerances of the numerical settings.
const SPACINGS: [f64; 4] = [2.0, 1.5, 1.2, 1.0];
const TOLERANCES: [f64; 3] = [1e-3, 1e-4, 3e-5];
/// The reference of these.
const REFERENCE_SPACING: f64 = 0.75;
const REFERENCE_TOLERANCE: f64 = 1e-5;
/// Rings that buckle at this radius, where late times depend on how far: kept apart from the rest.
const BUCKLED: [i32; 1] = [11];
/// Charges followed with flow.
const FLOWING: [i32; 1] = [5];
/// Spacing at which tolerance, storage and flow are compared on their own, and the tolerance of their references.
const MIDDLE_SPACING: f64 = 1.5;
const FINEST_TOLERANCE: f64 = 1e-6;
/// Tolerance at which boundary residuals of flows are compared, and the residual of their reference.
const FLOW_TOLERANCE: f64 = 3e-5;
const FLOW_RESIDUAL: f64 = 1e-4;

const QUANTITIES: [&str; 4] = ["F", "order parameter", "t50", "t99.9"];

/// One run.
#[derive(Debug, Clone)]
struct Run {
    colloid: Colloid,
    spacing: f64,
    boundary: Boundary,
    free: FreeSurface,
    accuracy: NematicAccuracy,
    flow: Option<FlowParameters>,
}

fn run(q: i32, spacing: f64, tolerance: f64) -> Run {
    Run {
        colloid: Colloid {
            radius: RADIUS,
            q,
            cell: CELL,
        },
        spacing,
        boundary: Boundary::default(),
        free: FreeSurface::default(),
        accuracy: NematicAccuracy {
            tolerance,
            ..NematicAccuracy::default()
        },
        flow: None,
    }
}

impl Run {
    fn go(&self, interrupt: &Interrupt) -> Result<(Quantities, u64), NematicError> {
        let mut parameters = NematicParameters {
            radius: self.colloid.radius,
            cell: self.colloid.cell,
            pattern: SurfacePattern::Winding(self.colloid.q),
            boundary: self.boundary,
            ..NematicParameters::default()
        };
        fit(&mut parameters, self.spacing);
        let battery = NematicBattery::new(&parameters, &self.accuracy)?;
        let protocol = Protocol {
            switch: SwitchSettings {
                to: SwitchTarget::Free(self.free),
                ramp: None,
            },
            discharge: DischargeSettings {
                flow: self.flow,
                ..DischargeSettings::default()
            },
            ..Protocol::default()
        };
        let (charged, run) = battery.run(&protocol, &mut RunHooks::new(interrupt))?;
        let Some(run) = run else {
            return Ok((Quantities::default(), 0));
        };
        let curve = &run.record.curve;
        let names: Vec<&str> = curve.parts().iter().map(String::as_str).collect();
        let times = DischargeTimes::between(
            curve,
            &names,
            [run.start, run.final_state.energy],
            &NEMATIC_SHARES,
        );
        let at = |share| times.at(share).map(|t| t.value);
        let bytes = charged
            .report()
            .bytes
            .total()
            .max(run.record.report.n_bytes());
        let found = [
            Some(charged.energy().total()),
            Some(charged.order().magnitude()),
            at(0.5),
            at(0.999),
        ];
        Ok((QUANTITIES.into_iter().zip(found).collect(), bytes))
    }
}

/// Name of a resolution.
pub(super) fn resolution(spacing: f64, tolerance: f64) -> String {
    format!("h = {spacing}, {tolerance:e}")
}

/// A run with its case, its setting and the value of that.
type Named = (String, &'static str, String, Run);

/// Charges on which all settings but flow are compared.
const CHARGES: [i32; 3] = [2, 5, 8];

/// All runs, references first.
pub(super) fn trials() -> Vec<Trial> {
    let grids = CHARGES.into_iter().flat_map(grids);
    let buckled = BUCKLED.into_iter().flat_map(buckled);
    let times = CHARGES.into_iter().flat_map(times);
    let flows = FLOWING.into_iter().flat_map(flows);
    let all = grids.chain(buckled).chain(times).chain(flows);
    all.map(trial).collect()
}

/// Resolutions and boundary schemes.
fn grids(q: i32) -> Vec<Named> {
    let mut all = Vec::new();
    let mut put = |setting, value: String, run| all.push((format!("q = {q}"), setting, value, run));
    let name = resolution;
    put(
        REFERENCE,
        name(REFERENCE_SPACING, REFERENCE_TOLERANCE),
        run(q, REFERENCE_SPACING, REFERENCE_TOLERANCE),
    );
    for spacing in SPACINGS {
        for tolerance in TOLERANCES {
            put(
                "resolution",
                name(spacing, tolerance),
                run(q, spacing, tolerance),
            );
        }
    }
    for (boundary, free) in [
        (Boundary::NodeMask, FreeSurface::CutCell),
        (Boundary::CutLink, FreeSurface::Staircase),
        (Boundary::NodeMask, FreeSurface::Staircase),
    ] {
        for spacing in [MIDDLE_SPACING, 1.0] {
            let run = Run {
                boundary,
                free,
                ..run(q, spacing, TOLERANCES[1])
            };
            let value = format!("{}, {}, h = {spacing}", boundary.name(), free.name());
            put("boundary", value, run);
        }
    }
    all
}

/// Resolutions of a ring that buckles.
fn buckled(q: i32) -> Vec<Named> {
    let mut all = Vec::new();
    let mut put = |setting, spacing, tolerance| {
        let name = resolution(spacing, tolerance);
        all.push((
            format!("q = {q}"),
            setting,
            name,
            run(q, spacing, tolerance),
        ));
    };
    put(REFERENCE, REFERENCE_SPACING, REFERENCE_TOLERANCE);
    for spacing in SPACINGS {
        put("buckled ring", spacing, TOLERANCES[1]);
    }
    all
}

/// The error in time alone, on one grid.
fn times(q: i32) -> Vec<Named> {
    let mut all = Vec::new();
    let mut put = |setting, value: String, run| {
        all.push((
            format!("q = {q}, h = {MIDDLE_SPACING}"),
            setting,
            value,
            run,
        ));
    };
    let name = |tolerance: f64| format!("{tolerance:e}");
    let at = |tolerance| run(q, MIDDLE_SPACING, tolerance);
    put(REFERENCE, name(FINEST_TOLERANCE), at(FINEST_TOLERANCE));
    for tolerance in TOLERANCES {
        put("tolerance", name(tolerance), at(tolerance));
    }
    let mut single = at(TOLERANCES[2]);
    single.accuracy.precision = Precision::Single;
    put("storage", Precision::Single.name().to_owned(), single);
    put(
        "storage",
        Precision::Double.name().to_owned(),
        at(TOLERANCES[2]),
    );
    all
}

/// Flow, without it and with residuals on the boundary.
fn flows(q: i32) -> Vec<Named> {
    let mut all = Vec::new();
    let mut put = |setting, value: String, tolerance: f64, residual: Option<f64>| {
        let mut run = run(q, MIDDLE_SPACING, tolerance);
        run.flow = residual.map(|boundary_residual| FlowParameters {
            boundary_residual,
            ..FlowParameters::default()
        });
        let case = format!("q = {q}, h = {MIDDLE_SPACING}, flow");
        all.push((case, setting, value, run));
    };
    let name = |tolerance: f64, residual: f64| format!("{tolerance:e}, residual {residual:e}");
    put(
        REFERENCE,
        name(FINEST_TOLERANCE, FLOW_RESIDUAL),
        FINEST_TOLERANCE,
        Some(FLOW_RESIDUAL),
    );
    put("flow", "off".to_owned(), FLOW_TOLERANCE, None);
    for (tolerance, residual) in [
        (FLOW_TOLERANCE, 1e-3),
        (FLOW_TOLERANCE, 1e-2),
        (FLOW_TOLERANCE, 0.1),
        (1e-3, 1e-2),
        (1e-4, 1e-2),
        (1e-5, 1e-2),
    ] {
        put(
            "flow solver",
            name(tolerance, residual),
            tolerance,
            Some(residual),
        );
    }
    all
}

fn trial((case, setting, value, run): Named) -> Trial {
    Trial {
        case,
        setting,
        value,
        run: Box::new(move |meter, interrupt| {
            let (found, cpu_seconds, counted) = meter.measure(|| run.go(interrupt));
            if interrupt.is_requested() {
                return Ok(None);
            }
            let lost = || (QUANTITIES.map(|n| (n, None)).to_vec(), counted);
            let (quantities, held) = found.and_then(Result::ok).unwrap_or_else(lost);
            Ok(Some(Outcome {
                quantities,
                cpu_seconds,
                peak_bytes: counted.max(held),
            }))
        }),
    }
}

/// What goals choose from, from coarse to fine; each has a coarser one beside it, so that the first is none of them.
pub(super) const LADDER: [(f64, f64); 6] = [
    (2.0, 1e-4),
    (1.5, 1e-4),
    (1.2, 1e-4),
    (1.0, 1e-4),
    (0.75, 3e-5),
    (0.5, 3e-5),
];
/// The grid of the reference, which is none of the ladder, and the one that it is extrapolated with.
const FINE: (f64, f64) = (0.6, 3e-5);
const BESIDE: (f64, f64) = (1.2, 1e-4);
/// Its setting.
const FINE_GRID: &str = "grid of the reference";

/// The ladder and the grid of the reference on the cases of a set, case by case.
pub(super) fn ladder_trials(set: CaseSet) -> Vec<Trial> {
    let mut all = Vec::new();
    let settings = || {
        let ladder = LADDER.into_iter().map(|at| ("resolution", at));
        ladder.chain([(FINE_GRID, FINE)])
    };
    for colloid in colloids(set) {
        for (setting, (spacing, tolerance)) in settings() {
            let run = Run {
                colloid,
                ..run(colloid.q, spacing, tolerance)
            };
            all.push((colloid.name(), setting, resolution(spacing, tolerance), run));
        }
    }
    all.into_iter().map(trial).collect()
}

/// The spacing of a case's grid, fitted to its cell; none for a case of no set.
pub(super) fn fitted(case: &str, spacing: f64) -> Option<f64> {
    let all = CaseSet::ALL.into_iter().flat_map(colloids);
    let of = all.into_iter().find(|c| c.name() == case)?;
    let mut parameters = NematicParameters {
        radius: of.radius,
        cell: of.cell,
        ..NematicParameters::default()
    };
    fit(&mut parameters, spacing);
    Some(parameters.spacing)
}

/// Runs of the ladder with the references of their cases: what a fine grid and one twice as coarse
/// extrapolate to, the error being of second order in the spacing.
///
/// # Validation
/// `references_are_extrapolated`, `long_extrapolated_references_hold`
pub(super) fn with_references(mut runs: Vec<TradeoffRun>) -> Vec<TradeoffRun> {
    let coarse = resolution(BESIDE.0, BESIDE.1);
    let fine = resolution(FINE.0, FINE.1);
    let of = |run: &TradeoffRun| {
        let beside = runs
            .iter()
            .find(|r| r.case == run.case && r.quantity == run.quantity && r.value == coarse);
        let [a, b] = [BESIDE.0, FINE.0].map(|spacing| fitted(&run.case, spacing));
        let pair = run.result.zip(beside?.result);
        let ratio = a? / b?;
        Some(TradeoffRun {
            setting: REFERENCE.to_owned(),
            value: format!("h = {} and {}, extrapolated", FINE.0, BESIDE.0),
            // without both there is none
            result: pair.map(|(fine, coarse)| extrapolated(fine, coarse, ratio)),
            ..run.clone()
        })
    };
    let found: Vec<TradeoffRun> = runs
        .iter()
        .filter(|r| r.value == fine)
        .filter_map(of)
        .collect();
    runs.extend(found);
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_the_same_on_all_grids() {
        for spacing in SPACINGS
            .into_iter()
            .chain([REFERENCE_SPACING, MIDDLE_SPACING])
        {
            for edge in CELL {
                let half = 0.5 * edge * RADIUS / spacing;
                assert!((half - half.round()).abs() < 1e-9, "{edge} by {spacing}");
            }
        }
    }

    #[test]
    fn references_are_extrapolated() {
        let case = colloids(CaseSet::Check)[0].name();
        let time = |spacing| {
            let h: f64 = fitted(&case, spacing).unwrap();
            assert!(h < spacing + 1e-9, "a fitted grid is finer");
            7.0 + 0.3 * h * h
        };
        let mut runs = Vec::new();
        for (spacing, tolerance) in LADDER.into_iter().chain([FINE]) {
            runs.push(TradeoffRun {
                case: case.clone(),
                setting: "any".to_owned(),
                value: resolution(spacing, tolerance),
                quantity: "t99.9".to_owned(),
                result: Some(time(spacing)),
                cpu_seconds: 1.0,
                peak_bytes: 1,
            });
        }
        let all = with_references(runs.clone());
        assert_eq!(all.len(), runs.len() + 1);
        let reference = &all[runs.len()];
        assert_eq!(reference.setting, REFERENCE);
        assert!((reference.result.unwrap() - 7.0).abs() < 1e-12);
        runs[2].result = None;
        let n = runs.len();
        assert_eq!(with_references(runs)[n].result, None);
    }

    #[test]
    #[ignore = "long: 15 CPU seconds"]
    fn long_extrapolated_references_hold() {
        // what the grid of the reference extrapolates to, beside what a finer one does
        let run_at = |spacing| {
            let colloid = colloids(CaseSet::Table)[4];
            let run = Run {
                colloid,
                ..run(colloid.q, spacing, 3e-5)
            };
            let (found, _) = run.go(&Interrupt::new()).unwrap();
            found[3].1
        };
        let [a, b, c, d] = [1.2, 0.6, 1.0, 0.5].map(run_at);
        let of = |fine: Option<f64>, coarse: Option<f64>| {
            extrapolated(fine.unwrap(), coarse.unwrap(), 2.0)
        };
        let (reference, finer) = (of(b, a), of(d, c));
        println!("{a:?} {b:?} {c:?} {d:?}: {reference} {finer}");
        assert!(
            (reference / finer - 1.0).abs() < 5e-3,
            "{reference} {finer}"
        );
    }

    #[test]
    fn every_case_has_one_reference_and_no_run_is_there_twice() {
        let trials = trials();
        for (k, t) in trials.iter().enumerate() {
            assert!(
                !trials[..k].iter().any(|o| o.name() == t.name()),
                "{}",
                t.name()
            );
            let of_case = trials.iter().filter(|o| o.case == t.case);
            assert_eq!(of_case.filter(|o| o.setting == REFERENCE).count(), 1);
        }
    }
}
