//! Three disjoint sets of cases: on one the settings of goals are measured, on one their estimates are scaled, on one both
//! are checked.

use topo_knots::KnotTable;

use crate::LabError;
use crate::elastic::ElasticScene;
use crate::preset::Preset;

/// What a set of cases is for. No case is in two of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CaseSet {
    /// Errors and costs of the settings.
    Table,
    /// The factor between differences and estimates.
    Factor,
    /// How well goals and estimates hold: nothing is set on it.
    Check,
}

impl CaseSet {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Table, Self::Factor, Self::Check];

    /// Name on the command line and of files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Table => "table",
            Self::Factor => "factor",
            Self::Check => "check",
        }
    }
}

/// A particle of a radius (xi_N) with a charge, in a cell of so many radii.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Colloid {
    pub radius: f64,
    pub q: i32,
    pub cell: [f64; 3],
}

impl Colloid {
    /// Name of the case.
    pub(super) fn name(&self) -> String {
        format!("R = {}, q = {}", self.radius, self.q)
    }
}

/// The middle one of those that the table was measured on; costs are in units of its.
pub(crate) const MEASURED: Colloid = Colloid {
    radius: 7.0,
    q: 3,
    cell: [36.0 / 7.0, 36.0 / 7.0, 36.0 / 7.0],
};

/// Of the cases of the published sweep every tenth, so that all knots and all twists are there.
const EVERY: usize = 10;

/// Knots and twists of a set.
pub(super) fn rods(set: CaseSet) -> Result<Vec<(String, f64)>, LabError> {
    let places: &[usize] = match set {
        CaseSet::Table => &[0],
        CaseSet::Factor => &[1, 3, 6, 8],
        CaseSet::Check => &[2, 5],
    };
    let all = ElasticScene::published(Preset::Draft).cases(&KnotTable::builtin())?;
    let named = all
        .into_iter()
        .filter_map(|case| Some((case.knot, case.rod.twist?)))
        .enumerate();
    let of_set = named.filter(|(k, _)| places.contains(&(k % EVERY)));
    Ok(of_set.map(|(_, case)| case).collect())
}

/// Edges of cells (xi_N) that grids of all spacings meet: multiples of 12.
const FLAT: [f64; 3] = [36.0, 36.0, 24.0];
const CUBE: [f64; 3] = [36.0, 36.0, 36.0];
const WIDE: [f64; 3] = [48.0, 48.0, 36.0];
/// Near the default shape at R = 9.8; they meet it nearly.
const DEFAULT: [f64; 3] = [56.0, 56.0, 42.0];

/// Particles small enough for fine grids. Their patterns are about as fine as those of larger ones below the buckling of
/// their rings: 2πR/q is 10 ξ_N or more.
pub(super) fn colloids(set: CaseSet) -> Vec<Colloid> {
    let groups: &[(f64, [f64; 3], &[i32])] = match set {
        CaseSet::Table => &[
            (6.0, FLAT, &[1, 2, 3]),
            (6.5, FLAT, &[1, 2, 3, 4]),
            (7.0, CUBE, &[1, 2, 3, 4]),
            (8.0, WIDE, &[2, 4, 5]),
            (9.0, WIDE, &[3, 5]),
        ],
        CaseSet::Factor => &[
            (6.25, FLAT, &[1, 2, 3]),
            (6.75, CUBE, &[1, 2, 3, 4]),
            (7.25, CUBE, &[1, 2, 3, 4]),
            (8.5, WIDE, &[3, 5]),
            (6.4, FLAT, &[1, 3]),
            (7.6, CUBE, &[1, 2, 3, 4]),
            (8.4, WIDE, &[1, 2, 3, 4]),
            (9.8, DEFAULT, &[2, 4, 6]),
        ],
        CaseSet::Check => &[
            (6.1, FLAT, &[1, 2, 3]),
            (6.9, CUBE, &[2, 3, 4]),
            (7.4, CUBE, &[1, 2, 3]),
            (8.2, WIDE, &[2, 4]),
            (8.8, WIDE, &[3, 5]),
            (9.6, DEFAULT, &[3]),
        ],
    };
    let of = |&(radius, cell, charges): &(f64, [f64; 3], &[i32])| {
        let one = move |&q| Colloid {
            radius,
            q,
            cell: cell.map(|edge| edge / radius),
        };
        charges.iter().map(one).collect::<Vec<_>>()
    };
    groups.iter().flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn no_case_is_in_two_sets_and_all_are_large_enough() {
        let mut seen: BTreeSet<String> = BTreeSet::new();
        for set in CaseSet::ALL {
            let rods = rods(set).unwrap();
            assert!(rods.len() >= 23, "{} rods", rods.len());
            let knots: BTreeSet<_> = rods.iter().map(|c| c.0.clone()).collect();
            assert_eq!(knots.len(), 14, "all knots are in {}", set.name());
            let twists: BTreeSet<_> = rods.iter().map(|c| (c.1 * 4.0) as i32).collect();
            assert!(twists.len() >= 16, "{} twists", twists.len());
            let colloids = colloids(set);
            let least = if set == CaseSet::Table { 16 } else { 12 };
            assert!(colloids.len() >= least, "{} colloids", colloids.len());
            for c in &colloids {
                let wavelength = std::f64::consts::TAU * c.radius / f64::from(c.q);
                assert!(wavelength > 10.0, "{}", c.name());
            }
            let names = rods
                .iter()
                .map(|(knot, twist)| format!("{knot} {twist:+.2}"));
            for name in names.chain(colloids.iter().map(Colloid::name)) {
                assert!(seen.insert(name.clone()), "{name} is there twice");
            }
        }
    }
}
