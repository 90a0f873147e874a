//! Settings of the colloid: spacing, tolerance, boundary scheme, storage, flow.

use topo_core::Interrupt;
use topo_nematic::{
    Boundary, ChargeSettings, DischargeSettings, FlowParameters, FreeSurface, NematicAccuracy,
    NematicBattery, NematicError, NematicParameters, Precision, RunHooks, SurfacePattern,
    SwitchSettings, SwitchTarget,
};

use super::{Outcome, Quantities, REFERENCE, Trial};
use crate::nematic::NEMATIC_SHARES;
use crate::system::Effort;
use crate::times::DischargeTimes;
use crate::wish::Point;

/// Radius of the particle, and edges of the cell: multiples of every spacing, so that the cell is the same on all grids.
pub(crate) const MEASURED_RADIUS: f64 = 15.0;
/// Edges of the cell in radii.
pub(crate) const MEASURED_CELL: [f64; 3] = [5.6, 5.6, 4.0];
/// Spacings and tolerances of the numerical settings.
const SPACINGS: [f64; 4] = [2.0, 1.5, 1.2, 1.0];
const TOLERANCES: [f64; 3] = [1e-3, 1e-4, 3e-5];
/// The reference of these.
const REFERENCE_SPACING: f64 = 0.75;
const REFERENCE_TOLERANCE: f64 = 1e-5;
/// Rings that buckle at this radius, where late times hang on how far: told apart from the rest.
const BUCKLED: [i32; 1] = [11];
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
    radius: f64,
    q: i32,
    spacing: f64,
    boundary: Boundary,
    free: FreeSurface,
    accuracy: NematicAccuracy,
    flow: Option<FlowParameters>,
}

fn run(q: i32, spacing: f64, tolerance: f64) -> Run {
    Run {
        radius: MEASURED_RADIUS,
        q,
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
        let parameters = NematicParameters {
            radius: self.radius,
            spacing: self.spacing,
            cell: MEASURED_CELL,
            pattern: SurfacePattern::Charge(self.q),
            boundary: self.boundary,
            ..NematicParameters::default()
        };
        let battery = NematicBattery::new(&parameters, &self.accuracy)?;
        let charged = battery.charge(&ChargeSettings::default(), &mut RunHooks::new(interrupt))?;
        let released = charged.switch(&SwitchSettings {
            to: SwitchTarget::Free(self.free),
            ramp: None,
        })?;
        let discharge = DischargeSettings {
            flow: self.flow,
            ..DischargeSettings::default()
        };
        let run = released.discharge(&discharge, &mut RunHooks::new(interrupt))?;
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
            .max(run.record.report.bytes.total());
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

/// Spacing and tolerance of a resolution by its name.
pub(super) fn resolution_of(name: &str) -> Option<(f64, f64)> {
    let (spacing, tolerance) = name.strip_prefix("h = ")?.split_once(", ")?;
    Some((spacing.parse().ok()?, tolerance.parse().ok()?))
}

/// All runs, references first.
pub(super) fn trials(effort: Effort) -> Vec<Trial> {
    let charges: &[i32] = match effort {
        Effort::Draft => &[2, 5, 8],
        Effort::Standard => &[1, 2, 3, 4, 5, 6, 7, 8],
    };
    let mut all: Vec<(String, &'static str, String, Run)> = Vec::new();
    for &q in charges {
        let mut put =
            |setting, value: String, run| all.push((format!("q = {q}"), setting, value, run));
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
    }
    for q in BUCKLED {
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
    }
    // the error in time alone, on one grid
    for &q in charges {
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
    }
    let flowing: &[i32] = match effort {
        Effort::Draft => &[5],
        Effort::Standard => &[2, 5, 8],
    };
    for &q in flowing {
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
    }
    all.into_iter().map(trial).collect()
}

fn trial((case, setting, value, run): (String, &'static str, String, Run)) -> Trial {
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

/// Radii and charges that no setting was measured on; all below the buckling of their rings.
pub(super) fn held_back_cases() -> Vec<(f64, i32)> {
    let small = [1, 2, 3, 4, 5, 6, 7, 8].map(|q| (13.0, q));
    let large = [4, 7].map(|q| (17.0, q));
    small.into_iter().chain(large).collect()
}

/// Name of such a case.
pub(super) fn case_name((radius, q): &(f64, i32)) -> String {
    format!("R = {radius}, q = {q}")
}

/// Runs of held-back cases: the reference, and the settings of each with their coarser ones.
pub(super) fn held_back_trials(cases: &[(f64, i32)], points: &[Point]) -> Vec<Trial> {
    let mut all = Vec::new();
    for (case, p) in cases.iter().zip(points) {
        let mut put = |setting, spacing, tolerance| {
            let mut run = run(case.1, spacing, tolerance);
            run.radius = case.0;
            all.push((
                case_name(case),
                setting,
                resolution(spacing, tolerance),
                run,
            ));
        };
        put(REFERENCE, REFERENCE_SPACING, REFERENCE_TOLERANCE);
        put("resolution", p.resolution, p.tolerance);
        put("resolution", p.check_resolution, p.check_tolerance);
    }
    all.into_iter().map(trial).collect()
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
            for edge in MEASURED_CELL {
                let half = 0.5 * edge * MEASURED_RADIUS / spacing;
                assert!((half - half.round()).abs() < 1e-9, "{edge} by {spacing}");
            }
        }
    }

    #[test]
    fn every_case_has_one_reference_and_no_run_is_there_twice() {
        for effort in [Effort::Draft, Effort::Standard] {
            let trials = trials(effort);
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
}
