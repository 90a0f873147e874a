//! The tables that figures are drawn from, read back from a results folder.

mod curves;
mod file;
mod nematic;

use crate::error::ViewError;
pub use curves::{Curve, Moment, Snapshot, points_of, series, snapshots};
pub use file::{read_csv, write};
pub use nematic::{DefectLine, NematicSweep, Slice, rings, slices};
use std::path::Path;
pub use topo_analysis::{KnotRow, SweepRow as Cut};

/// The 14 knots to seven crossings, in the order of the tables.
pub const KNOTS: [&str; 14] = [
    "3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3", "7_1", "7_2", "7_3", "7_4", "7_5", "7_6",
    "7_7",
];

/// All cuts of one charged state.
#[derive(Debug, Clone)]
pub struct Case {
    /// The cuts, in the order of the table; never empty.
    pub cuts: Vec<Cut>,
}

impl Case {
    /// The cut that stands for the case where one is needed: the first of the table.
    pub fn first(&self) -> &Cut {
        &self.cuts[0]
    }

    /// Folder of the case inside `elastic/`.
    pub fn folder(&self) -> String {
        self.first().case.clone()
    }

    /// Mean, smallest and largest of a time over the cuts that have it.
    pub fn spread(&self, time: impl Fn(&Cut) -> Option<f64>) -> Option<[f64; 3]> {
        let times: Vec<f64> = self
            .cuts
            .iter()
            .filter_map(time)
            .filter(|t| *t > 0.0)
            .collect();
        if times.is_empty() {
            return None;
        }
        let mean = times.iter().sum::<f64>() / times.len() as f64;
        let (low, high) = times
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), t| (a.min(*t), b.max(*t)));
        Some([mean, low, high])
    }
}

/// `elastic/sweep.csv`, gathered by charged state.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// Charged states, by knot and then twist.
    pub cases: Vec<Case>,
}

impl Sweep {
    /// Reads the sweep of a results folder.
    pub fn read(results: &Path) -> Result<Self, ViewError> {
        Self::of_folder(&results.join("elastic"))
    }

    /// Reads the `sweep.csv` of a folder.
    pub fn of_folder(folder: &Path) -> Result<Self, ViewError> {
        let path = folder.join("sweep.csv");
        Self::of_rows(read_csv(&path)?).ok_or_else(|| ViewError::Table {
            path,
            reason: "no rows".to_owned(),
        })
    }

    /// Gathers rows and keeps the states of one reading and resolution: those with the
    /// most rows, so that side studies in the same table do not mix into the figures.
    /// `None` if there are no rows.
    pub fn of_rows(cuts: Vec<Cut>) -> Option<Self> {
        let key = |c: &Cut| (c.reading.clone(), c.edges);
        let count = |k: &(String, usize)| cuts.iter().filter(|c| key(c) == *k).count();
        let main = cuts.iter().map(key).max_by_key(count)?;
        let mut cases: Vec<Case> = Vec::new();
        for cut in cuts.into_iter().filter(|c| key(c) == main) {
            let same = |c: &&mut Case| {
                c.first().knot == cut.knot && (c.first().twist - cut.twist).abs() < 1e-9
            };
            match cases.iter_mut().find(same) {
                Some(case) => case.cuts.push(cut),
                None => cases.push(Case { cuts: vec![cut] }),
            }
        }
        let rank = |knot: &str| KNOTS.iter().position(|k| *k == knot).unwrap_or(KNOTS.len());
        cases.sort_by(|a, b| {
            let (a, b) = (a.first(), b.first());
            (rank(&a.knot), &a.knot)
                .cmp(&(rank(&b.knot), &b.knot))
                .then(a.twist.total_cmp(&b.twist))
        });
        Some(Self { cases })
    }

    /// Names of the knots, in order.
    pub fn knots(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.cases.iter().map(|c| c.first().knot.as_str()).collect();
        names.dedup();
        names
    }

    /// Twist densities, in order.
    pub fn twists(&self) -> Vec<f64> {
        let mut twists: Vec<f64> = self.cases.iter().map(|c| c.first().twist).collect();
        twists.sort_by(f64::total_cmp);
        twists.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        twists
    }

    /// States of one knot, by twist.
    pub fn of(&self, knot: &str) -> Vec<&Case> {
        self.cases
            .iter()
            .filter(|c| c.first().knot == knot)
            .collect()
    }

    /// The state of a knot at a twist.
    pub fn at(&self, knot: &str, twist: f64) -> Option<&Case> {
        self.of(knot)
            .into_iter()
            .find(|c| (c.first().twist - twist).abs() < 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "case,knot,twist,cut,reading,edges,energy,bend,twist_energy,stretch,writhe,total_twist,t50,t90,t95,t99,t50_after_cut,t90_after_cut,t95_after_cut,t99_after_cut,t_untie,link_drift,min_distance_over_contact,steps,rejected,cpu_seconds,warnings";

    fn row(knot: &str, twist: f64, reading: &str, t99: &str) -> String {
        format!(
            "{knot}_twist{twist:+.2}_{reading}_n200,{knot},{twist},0.1,{reading},200,1,0.5,0.4,0.1,3.4,1,0.5,1,2,{t99},0.5,1,2,{t99},,1e-12,0.98,100,2,0.5,"
        )
    }

    fn folder(rows: &[String]) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let text = format!("{HEADER}\n{}\n", rows.join("\n"));
        write(&dir.path().join("elastic/sweep.csv"), text.as_bytes()).unwrap();
        dir
    }

    #[test]
    fn cuts_are_gathered_and_side_studies_left_out() {
        let dir = folder(&[
            row("7_4", 0.0, "shrunk", "6"),
            row("7_4", 0.0, "shrunk", "18"),
            row("3_1", -0.25, "shrunk", ""),
            row("3_1", 0.0, "tight", "9"),
        ]);
        let sweep = Sweep::read(dir.path()).unwrap();
        assert_eq!(sweep.knots(), ["3_1", "7_4"]);
        assert_eq!(sweep.twists(), [-0.25, 0.0]);
        let case = sweep.at("7_4", 0.0).unwrap();
        assert_eq!(case.folder(), "7_4_twist+0.00_shrunk_n200");
        assert_eq!(case.spread(|c| c.t99), Some([12.0, 6.0, 18.0]));
        assert_eq!(sweep.at("3_1", -0.25).unwrap().spread(|c| c.t99), None);
    }

    #[test]
    fn bad_tables_name_file_and_place() {
        let dir = folder(&[row("3_1", 0.0, "shrunk", "soon")]);
        let e = Sweep::read(dir.path()).unwrap_err();
        assert!(
            e.to_string().contains("sweep.csv") && e.to_string().contains("line: 2"),
            "{e}"
        );
        let e = Sweep::read(&dir.path().join("nowhere")).unwrap_err();
        assert!(matches!(e, ViewError::Missing { .. }));
    }
}
