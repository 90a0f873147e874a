//! How long to search and how fine to tighten.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::KnotError;

/// Settings of the tightening.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TightenSettings {
    /// Vertices per unit of ropelength at the finest level; coarser levels are halvings of it down to 4.
    pub per_unit: f64,
    /// Vertices of the search for the basin.
    pub search_vertices: usize,
    /// Random words of the same closed braid from which the search starts too.
    pub n_variants: usize,
    /// Inversions in spheres around random points from which the search starts too: where the other starts lead to poor minima.
    pub n_inversions: usize,
    /// Random kicks of each start.
    pub n_kicks_a_start: usize,
    /// Random kicks and squeezes of the best curves of the search.
    pub n_kicks: usize,
    /// Seed of variants and kicks.
    pub seed: u64,
    /// A level ends when the ropelength falls by less than this fraction within a few steps.
    pub tolerance: f64,
    /// Largest number of quadratic programs per level.
    pub max_steps: usize,
}

impl TightenSettings {
    /// Four vertices per unit of ropelength: within half a percent of the tight length.
    pub fn draft() -> Self {
        Self {
            per_unit: 4.0,
            search_vertices: 150,
            n_variants: 1,
            n_inversions: 0,
            n_kicks_a_start: 2,
            n_kicks: 4,
            seed: 1,
            tolerance: 2e-4,
            max_steps: 80,
        }
    }

    /// Eight vertices per unit of ropelength: within about a tenth of a percent.
    pub fn standard() -> Self {
        Self {
            per_unit: 8.0,
            tolerance: 1e-4,
            ..Self::draft()
        }
    }

    /// Sixteen vertices per unit of ropelength and a longer search.
    pub fn fine() -> Self {
        Self {
            per_unit: 16.0,
            n_variants: 3,
            n_kicks: 12,
            tolerance: 2e-5,
            max_steps: 200,
            ..Self::draft()
        }
    }

    /// Numbers of vertices per unit of ropelength, coarse to fine.
    pub(crate) fn levels(&self) -> Vec<f64> {
        let mut levels = vec![self.per_unit];
        while levels[0] >= 8.0 {
            levels.insert(0, 0.5 * levels[0]);
        }
        levels
    }

    /// Curves of the search that go on to the first level: at low resolution, basins that differ by less than a tenth of a
    /// percent may change places.
    pub(crate) fn n_finalists(&self) -> usize {
        if self.per_unit > 8.0 { 4 } else { 1 }
    }

    /// Refuses settings out of range.
    ///
    /// # Errors
    /// [`KnotError::Setting`] naming the setting, its value and its range.
    pub fn check(&self) -> Result<(), KnotError> {
        let within = |name, value: f64, range: RangeInclusive<f64>, expected| {
            let setting = KnotError::Setting {
                name,
                value,
                expected,
            };
            range.contains(&value).then_some(()).ok_or(setting)
        };
        let count =
            |name, value: usize, range, expected| within(name, value as f64, range, expected);
        let per_unit = "expected 1 to 64 vertices per unit of ropelength";
        within("per_unit", self.per_unit, 1.0..=64.0, per_unit)?;
        let (vertices, few) = (self.search_vertices, 0.0..=1000.0);
        count(
            "search_vertices",
            vertices,
            32.0..=4096.0,
            "expected 32 to 4096",
        )?;
        let at_most = "expected at most 1000";
        count("n_variants", self.n_variants, few.clone(), at_most)?;
        count("n_inversions", self.n_inversions, few.clone(), at_most)?;
        count("n_kicks_a_start", self.n_kicks_a_start, few, at_most)?;
        count("n_kicks", self.n_kicks, 0.0..=1e4, "expected at most 10000")?;
        let tolerance = "expected 1e-9 to 1e-2";
        within("tolerance", self.tolerance, 1e-9..=1e-2, tolerance)?;
        count(
            "max_steps",
            self.max_steps,
            1.0..=1e5,
            "expected 1 to 100000",
        )?;
        Ok(())
    }
}

impl Default for TightenSettings {
    fn default() -> Self {
        Self::standard()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_pass_and_levels_double() {
        for preset in [
            TightenSettings::draft(),
            TightenSettings::standard(),
            TightenSettings::fine(),
        ] {
            preset.check().expect("in range");
        }
        assert_eq!(TightenSettings::draft().levels(), [4.0]);
        assert_eq!(TightenSettings::fine().levels(), [4.0, 8.0, 16.0]);
    }

    #[test]
    fn settings_out_of_range_are_named() {
        let bad = TightenSettings {
            tolerance: f64::NAN,
            ..TightenSettings::draft()
        };
        assert!(matches!(
            bad.check(),
            Err(KnotError::Setting {
                name: "tolerance",
                ..
            })
        ));
    }
}
