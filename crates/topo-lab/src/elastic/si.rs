//! Results in SI units, of a scene that says what its fibre is made of.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_analysis::{SweepRow, write_table};
use topo_core::{InvalidValue, RodUnits, positive};

use crate::LabError;
use crate::folder::forget_file;

/// What the fibre is, for times in seconds and energies in joules beside those in T_0 and E_0.
///
/// Nothing that is computed depends on it: a scene may be given one, or another one, after its cases have been run.
///
/// # Validation
/// `val_the_cut_circle_in_seconds_and_joules`
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Si {
    /// Radius h of the fibre.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0), example = 1e-3)]
    pub radius: f64,
    /// Bending modulus E_b.
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0), example = 1e7)]
    pub bending_modulus: f64,
    /// Internal viscosity η.
    #[schemars(extend("x-unit" = "Pa s", "exclusiveMinimum" = 0), example = 1e4)]
    pub viscosity: f64,
    /// Density, for energies per mass.
    #[schemars(extend("x-unit" = "kg/m³", "exclusiveMinimum" = 0, "x-default" = "no energies per mass"), example = 1100.0)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
}

/// The units of a fibre of some length, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    /// L, in metres.
    pub length: f64,
    /// T_0, in seconds.
    pub time: f64,
    /// E_0, in joules.
    pub energy: f64,
    /// Mass, in kilograms, if the density is known.
    pub mass: Option<f64>,
}

impl Si {
    /// Checks every number.
    ///
    /// # Errors
    /// Names the first value that is not positive and finite.
    pub fn checked(self) -> Result<Self, InvalidValue> {
        self.units()?;
        if let Some(density) = self.density {
            positive("density", density)?;
        }
        Ok(self)
    }

    fn units(&self) -> Result<RodUnits, InvalidValue> {
        RodUnits::new(self.radius, self.bending_modulus, self.viscosity)
    }

    /// The units of the fibre of a row; none where its length is not known, as in tables of earlier programs.
    pub(super) fn scale(&self, row: &SweepRow) -> Option<Scale> {
        let (units, length) = (self.units().ok()?, row.length?);
        Some(Scale {
            length: units.length_to_metres(length),
            time: units.reference_seconds(length),
            energy: units.reference_joules(length),
            mass: self.density.map(|density| units.kilograms(length, density)),
        })
    }
}

/// A row of `sweep-si.csv`: the factors, and what a row of `sweep.csv` holds in SI units.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
struct SiRow {
    case: String,
    knot: String,
    twist: f64,
    cut: f64,
    length_metres: Option<f64>,
    mass_kilograms: Option<f64>,
    /// T_0.
    t0_seconds: Option<f64>,
    /// E_0.
    e0_joules: Option<f64>,
    energy_joules: Option<f64>,
    energy_joules_per_kilogram: Option<f64>,
    t50_seconds: Option<f64>,
    t90_seconds: Option<f64>,
    t95_seconds: Option<f64>,
    t99_seconds: Option<f64>,
    t_untie_seconds: Option<f64>,
    energy_in_joules: Option<f64>,
    work_joules: Option<f64>,
    work_joules_per_kilogram: Option<f64>,
    heat_joules: Option<f64>,
    peak_power_watts: Option<f64>,
}

impl SiRow {
    fn of(si: &Si, row: &SweepRow) -> Self {
        let named = Self {
            case: row.case.clone(),
            knot: row.knot.clone(),
            twist: row.twist,
            cut: row.cut,
            ..Self::default()
        };
        let Some(scale) = si.scale(row) else {
            return named;
        };
        let seconds = |t: Option<f64>| t.map(|t| t * scale.time);
        let joules = |e: Option<f64>| e.map(|e| e * scale.energy);
        let per_kilogram = |e: Option<f64>| Some(joules(e)? / scale.mass?);
        Self {
            length_metres: Some(scale.length),
            mass_kilograms: scale.mass,
            t0_seconds: Some(scale.time),
            e0_joules: Some(scale.energy),
            energy_joules: joules(Some(row.energy)),
            energy_joules_per_kilogram: per_kilogram(Some(row.energy)),
            t50_seconds: seconds(row.t50),
            t90_seconds: seconds(row.t90),
            t95_seconds: seconds(row.t95),
            t99_seconds: seconds(row.t99),
            t_untie_seconds: seconds(row.t_untie),
            energy_in_joules: joules(row.energy_in),
            work_joules: joules(row.work),
            work_joules_per_kilogram: per_kilogram(row.work),
            heat_joules: joules(row.heat),
            peak_power_watts: joules(row.peak_power).map(|e| e / scale.time),
            ..named
        }
    }
}

/// Writes the table in SI units beside that in T_0 and E_0; none is there where the scene does not say what the fibre is.
pub(super) fn write(folder: &Path, si: Option<&Si>, rows: &[SweepRow]) -> Result<(), LabError> {
    let path = folder.join("sweep-si.csv");
    let Some(si) = si else {
        return forget_file(&path);
    };
    let rows: Vec<SiRow> = rows.iter().map(|row| SiRow::of(si, row)).collect();
    Ok(write_table(&path, &rows)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Silicone, h = 1 mm, L = 50 h: T_0 = 2 L η/(h E_b) = 0.1 s, E_0 = E_b h² L = 0.5 J, and 1100 kg/m³ of π h² L weigh 0.17 g.
    #[test]
    fn val_rows_of_silicone_in_si_units() {
        let si = Si {
            radius: 1e-3,
            bending_modulus: 1e7,
            viscosity: 1e4,
            density: Some(1100.0),
        };
        let row = SweepRow {
            length: Some(50.0),
            energy: 0.2,
            t50: Some(2.0),
            t99: Some(19.5),
            work: Some(0.04),
            peak_power: Some(0.3),
            ..SweepRow::default()
        };
        let found = SiRow::of(&si, &row);
        let is = |found: Option<f64>, exact: f64| {
            let found = found.unwrap();
            assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        };
        is(found.length_metres, 0.05);
        is(found.t0_seconds, 0.1);
        is(found.e0_joules, 0.5);
        is(found.energy_joules, 0.1);
        is(found.t50_seconds, 0.2);
        is(found.t99_seconds, 1.95);
        assert_eq!(found.t90_seconds, None);
        let mass = 1100.0 * std::f64::consts::PI * 1e-6 * 0.05;
        is(found.mass_kilograms, mass);
        is(found.energy_joules_per_kilogram, 0.1 / mass);
        is(found.work_joules, 0.02);
        is(found.work_joules_per_kilogram, 0.02 / mass);
        // E_0/T_0 is 5 W
        is(found.peak_power_watts, 1.5);
        assert_eq!(found.heat_joules, None);
        // of an earlier program, a knot of its own length: nothing rather than a guess
        let unknown = SweepRow {
            length: None,
            ..row
        };
        assert_eq!(SiRow::of(&si, &unknown).t99_seconds, None);
    }
}
