//! What of the numerics decides where the ring buckles: charges near the critical one under other spacings, seeds, tolerances and
//! boundary schemes.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use topo_core::Interrupt;
use topo_nematic::record::{ChargeStop, MinimumState};
use topo_nematic::{
    Boundary, ChargeSettings, NematicAccuracy, NematicBattery, NematicError, NematicParameters,
    RunHooks, SurfacePattern,
};

use super::identity::RESULTS_VERSION;
use crate::LabError;
use topo_analysis::BUCKLED;

/// Settings that all others differ from in one thing.
const SPACING: f64 = 1.5;
const SEED: f64 = 0.05;
const TOLERANCE: f64 = 1e-8;
/// What is tried instead.
const SPACINGS: [f64; 3] = [2.0, 1.2, 1.0];
const LARGE_SEED: f64 = 0.25;
const TOLERANCES: [f64; 2] = [1e-6, 1e-10];

/// A particle whose charges are studied.
struct Size {
    radius: f64,
    /// Edges of the cell: whole even numbers of every spacing tried, so that the cell is the same on all grids.
    cell: [f64; 3],
    /// Charges around the critical one.
    charges: &'static [u32],
    /// Whether only boundary scheme and seed are varied, as other spacings and tolerances would take hours.
    is_large: bool,
}

const SIZES: [Size; 3] = [
    Size {
        radius: 15.0,
        cell: [84.0, 84.0, 60.0],
        charges: &[8, 9, 10, 11],
        is_large: false,
    },
    Size {
        radius: 25.0,
        cell: [144.0, 144.0, 108.0],
        charges: &[5, 6, 7],
        is_large: false,
    },
    Size {
        radius: 52.5,
        cell: [300.0, 300.0, 225.0],
        charges: &[7],
        is_large: true,
    },
];

/// One charge to come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BucklingCase {
    radius: f64,
    cell: [f64; 3],
    q: u32,
    spacing: f64,
    boundary: Boundary,
    seed: f64,
    tolerance: f64,
}

/// One charge of the study, as its table holds it: lengths in ξ_N, energies in L ξ_N.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BucklingRow {
    /// Version of the results.
    pub results: u32,
    /// Radius of the particle.
    pub radius: f64,
    /// Distance of the plates.
    pub thickness: f64,
    /// Winding of the anchoring.
    pub q: u32,
    /// How the particle's surface meets the grid.
    pub boundary: Boundary,
    /// Edge of a cell.
    pub spacing: f64,
    /// Spacings a wavelength of the pattern has on the equator.
    pub nodes: f64,
    /// Tilt of the start field.
    pub seed: f64,
    /// Root mean square of the molecular field that counts as converged.
    pub tolerance: f64,
    /// Free energy.
    pub f_charged: f64,
    /// Size of the horizontal order parameter.
    pub order_parameter: f64,
    /// Amplitude of the strongest mode of the ring's height.
    pub ring_amplitude: Option<f64>,
    /// Lowest eigenvalue of the Hessian, over that of the director between the plates, L π²/L_z².
    pub eigenvalue: Option<f64>,
    /// What it says: minimum, saddle or marginal.
    pub state: Option<MinimumState>,
    /// How the charge ended.
    pub stop: ChargeStop,
    /// Steps.
    pub steps: u64,
    /// Processor seconds.
    pub cpu_seconds: f64,
}

impl BucklingRow {
    /// Whether the ring is buckled.
    pub fn is_buckled(&self) -> bool {
        self.order_parameter > BUCKLED
    }

    /// Whether it was relaxed to the end.
    pub fn has_converged(&self) -> bool {
        self.stop == ChargeStop::Converged
    }
}

/// The charges of a radius; `None` for one that is not studied.
pub fn buckling_cases(radius: f64) -> Option<Vec<BucklingCase>> {
    let size = SIZES.iter().find(|size| size.radius == radius)?;
    let mut cases = Vec::new();
    for boundary in [Boundary::CutLink, Boundary::NodeMask] {
        for &q in size.charges {
            let usual = BucklingCase {
                radius,
                cell: size.cell.map(|edge| edge / radius),
                q,
                spacing: SPACING,
                boundary,
                seed: SEED,
                tolerance: TOLERANCE,
            };
            let seeded = BucklingCase {
                seed: LARGE_SEED,
                ..usual
            };
            cases.extend([usual, seeded]);
            if size.is_large {
                continue;
            }
            cases.extend(SPACINGS.map(|spacing| BucklingCase { spacing, ..usual }));
            cases.extend(TOLERANCES.map(|tolerance| BucklingCase { tolerance, ..usual }));
        }
    }
    Some(cases)
}

impl BucklingCase {
    fn is_of(&self, row: &BucklingRow) -> bool {
        row.results == RESULTS_VERSION
            && row.q == self.q
            && row.boundary == self.boundary
            && [row.radius, row.spacing, row.seed, row.tolerance]
                == [self.radius, self.spacing, self.seed, self.tolerance]
    }

    fn name(&self) -> String {
        format!(
            "q = {}, R = {}, h = {}, {}",
            self.q,
            self.radius,
            self.spacing,
            self.boundary.name()
        )
    }

    fn run(&self, interrupt: &Interrupt) -> Result<BucklingRow, NematicError> {
        let parameters = NematicParameters {
            radius: self.radius,
            spacing: self.spacing,
            cell: self.cell,
            pattern: SurfacePattern::Winding(self.q as i32),
            boundary: self.boundary,
            ..NematicParameters::default()
        };
        let battery = NematicBattery::new(&parameters, &NematicAccuracy::default())?;
        let settings = ChargeSettings {
            seeds: vec![self.seed],
            tolerance: self.tolerance,
            ..ChargeSettings::default()
        };
        let charged = battery.charge(&settings, &mut RunHooks::new(interrupt))?;
        let report = charged.report();
        let thickness = battery.grid().extent()[2];
        let minimum = report.minimum.as_ref();
        let unit = parameters.material.elastic_constant * (PI / thickness).powi(2);
        Ok(BucklingRow {
            results: RESULTS_VERSION,
            radius: self.radius,
            thickness,
            q: self.q,
            boundary: self.boundary,
            spacing: self.spacing,
            nodes: TAU * self.radius / (self.spacing * f64::from(self.q)),
            seed: self.seed,
            tolerance: self.tolerance,
            f_charged: charged.energy().total(),
            order_parameter: charged.order().magnitude(),
            ring_amplitude: charged
                .ring(super::snapshot::RING_ORDER)
                .map(|r| r.amplitude()),
            eigenvalue: minimum.map(|m| m.lowest_eigenvalue / unit),
            state: minimum.map(|m| m.state),
            stop: report.stop,
            steps: report.n_steps,
            cpu_seconds: report.cpu_seconds,
        })
    }
}

/// Charges all cases on the present pool of threads, telling of each finished one; `known` ones are not charged again. When
/// interrupted, what is finished is returned.
///
/// # Errors
/// A grid that does not fit in memory.
///
/// # Validation
/// `known_charges_are_kept_and_others_run`
pub fn buckling_study(
    cases: &[BucklingCase],
    known: &[BucklingRow],
    interrupt: &Interrupt,
    report: &(dyn Fn(&BucklingRow) + Sync),
) -> Result<Vec<BucklingRow>, LabError> {
    let one = |case: &BucklingCase| {
        if let Some(row) = known.iter().find(|row| case.is_of(row)) {
            return Ok(Some(row.clone()));
        }
        if interrupt.is_requested() {
            return Ok(None);
        }
        let row = case.run(interrupt).map_err(|source| LabError::Nematic {
            case: case.name(),
            source,
        })?;
        // a charge that was interrupted has not ended as it would
        if interrupt.is_requested() {
            return Ok(None);
        }
        report(&row);
        Ok(Some(row))
    };
    let rows = cases.par_iter().with_max_len(1).map(one);
    let rows: Vec<Option<BucklingRow>> = rows.collect::<Result<_, LabError>>()?;
    Ok(rows.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spacing_divides_the_cell() {
        assert!(buckling_cases(20.0).is_none());
        for size in &SIZES {
            let cases = buckling_cases(size.radius).unwrap();
            let each = if size.is_large { 4 } else { 14 };
            assert_eq!(cases.len(), each * size.charges.len());
            for case in cases.iter().filter(|_| !size.is_large) {
                for edge in size.cell {
                    let n = edge / case.spacing;
                    assert!(
                        (n - n.round()).abs() < 1e-9 && n.round() % 2.0 == 0.0,
                        "{n}"
                    );
                }
            }
        }
    }

    #[test]
    fn known_charges_are_kept_and_others_run() {
        let case = BucklingCase {
            radius: 5.0,
            cell: [4.0, 4.0, 4.0],
            q: 2,
            spacing: 1.0,
            boundary: Boundary::NodeMask,
            seed: 0.05,
            tolerance: 1e-5,
        };
        let finer = BucklingCase {
            tolerance: 1e-6,
            ..case
        };
        let never = Interrupt::new();
        let report = std::sync::atomic::AtomicUsize::new(0);
        let tell = |_: &BucklingRow| {
            report.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        };
        let first = buckling_study(&[case], &[], &never, &tell).unwrap();
        assert!(first[0].has_converged() && !first[0].is_buckled());
        assert!((first[0].thickness, first[0].boundary) == (20.0, Boundary::NodeMask));
        // marked, to be replaced by a row made again
        let mut known = first.clone();
        known[0].f_charged = 1.0;
        let both = buckling_study(&[case, finer], &known, &never, &tell).unwrap();
        assert!(both[0] == known[0] && both[1].f_charged > 10.0);
        assert_eq!(report.into_inner(), 2);
        known[0].results -= 1;
        let old = buckling_study(&[case], &known, &never, &|_| {}).unwrap();
        assert_eq!(old[0].f_charged, first[0].f_charged);
        never.request();
        assert!(
            buckling_study(&[case], &[], &never, &|_| {})
                .unwrap()
                .is_empty()
        );
    }
}
