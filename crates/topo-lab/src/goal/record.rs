//! The recorded tables and factors: what they say, of which code, and whether that is the present one.

use serde::{Deserialize, Serialize};

use super::choice::Point;
use crate::elastic;
use crate::nematic;
use crate::system::System;

/// Where numbers were measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stamp {
    /// Version of the results, as in `run.json`.
    pub results: u32,
    /// Commit of the code.
    pub commit: String,
    /// Day of the measurement.
    pub date: String,
    /// Cases it was measured on.
    pub n_cases: usize,
}

/// The factor between differences and estimates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// BLAKE3 hash of the table that it belongs to.
    pub table: String,
    /// Share of the errors of its cases that the estimates cover.
    pub share: f64,
    /// The factor.
    pub scale: f64,
    /// Where it was measured.
    pub measured: Stamp,
}

/// What stands beside a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Where the table was measured.
    pub table: Stamp,
    /// The factor; none until it is measured.
    pub factor: Option<Factor>,
}

/// Tables of both systems, as recorded by `cargo xtask tradeoff --quality standard --record` and `--set factor --record`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measured {
    /// Rods: error of t99.
    Rod,
    /// Colloids: error of t99.9.
    Nematic,
}

impl Measured {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Rod, Self::Nematic];

    /// The system.
    pub fn system(self) -> System {
        match self {
            Self::Rod => System::Rod,
            Self::Nematic => System::Nematic,
        }
    }

    /// Version of the results of the present code.
    pub fn results_version(self) -> u32 {
        match self {
            Self::Rod => elastic::RESULTS_VERSION,
            Self::Nematic => nematic::NEMATIC_RESULTS_VERSION,
        }
    }

    /// What the resolution of its settings counts.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Rod => "edges",
            Self::Nematic => "ξ_N a cell",
        }
    }

    fn table(self) -> &'static str {
        match self {
            Self::Rod => include_str!("../../data/tradeoff-rod.csv"),
            Self::Nematic => include_str!("../../data/tradeoff-nematic.csv"),
        }
    }

    /// The settings of its table, cheapest first.
    pub fn points(self) -> Vec<Point> {
        let rows = csv::Reader::from_reader(self.table().as_bytes()).into_deserialize::<Point>();
        // a test reads every row
        let mut points: Vec<Point> = rows.filter_map(Result::ok).collect();
        points.sort_by(|a, b| a.cpu_seconds.total_cmp(&b.cpu_seconds));
        points
    }

    /// What stands beside the table; a test reads it.
    pub fn record(self) -> Option<Record> {
        serde_json::from_str(match self {
            Self::Rod => include_str!("../../data/tradeoff-rod.json"),
            Self::Nematic => include_str!("../../data/tradeoff-nematic.json"),
        })
        .ok()
    }

    /// What is wrong with the table as a statement about the present code, with the remedy; nothing if it is of this code.
    pub fn stale(self) -> Option<String> {
        stale(
            self.record().as_ref(),
            &table_hash(self.table()),
            self.results_version(),
        )
    }
}

/// Hash of a table's text.
pub fn table_hash(table: &str) -> String {
    blake3::hash(table.as_bytes()).to_hex().to_string()
}

fn stale(record: Option<&Record>, content: &str, results: u32) -> Option<String> {
    const TABLE: &str = "measure it again with `cargo xtask tradeoff --quality standard --record`";
    const FACTOR: &str = "measure it again with `cargo xtask tradeoff --set factor --record`";
    let Some(record) = record else {
        return Some(format!(
            "the table of settings says nothing of its origin: {TABLE}"
        ));
    };
    let old = |what: &str, stamp: &Stamp, remedy: &str| {
        (stamp.results != results).then(|| {
            format!(
                "{what} is of results {} ({}), this code makes results {results}: errors may be others; {remedy}",
                stamp.results, stamp.date
            )
        })
    };
    old("the table of settings", &record.table, TABLE).or_else(|| match &record.factor {
        Some(factor) if factor.table == content => {
            old("the factor of the estimates", &factor.measured, FACTOR)
        }
        _ => Some(format!(
            "the factor of the estimates is not of this table: {FACTOR}"
        )),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recorded_tables_are_whole() {
        for table in Measured::ALL {
            let points = table.points();
            assert_eq!(points.len() + 1, table.table().lines().count(), "{table:?}");
            assert!(points.len() >= 4, "{table:?}");
            for p in points {
                assert!(p.cpu_seconds > 0.0 && p.high_error >= p.median_error);
                assert!(p.n_cases >= if table == Measured::Rod { 24 } else { 16 });
            }
            let record = table.record().unwrap();
            let factor = record.factor.unwrap();
            assert!(factor.scale > 0.0 && factor.share >= 0.9);
            assert!(factor.measured.n_cases >= 12);
        }
    }

    /// Fails when the results move on and the tables do not: measure them again (docs/tradeoff.md says how).
    #[test]
    fn the_recorded_tables_are_of_the_present_results() {
        for table in Measured::ALL {
            assert_eq!(table.stale(), None, "{table:?}");
        }
    }

    #[test]
    fn tables_of_other_results_or_factors_of_other_tables_are_named() {
        let stamp = |results| Stamp {
            results,
            commit: "abc".to_owned(),
            date: "2026-01-02".to_owned(),
            n_cases: 24,
        };
        let record = |table, factor: Option<(&str, u32)>| Record {
            table: stamp(table),
            factor: factor.map(|(table, results)| Factor {
                table: table.to_owned(),
                share: 0.95,
                scale: 1.5,
                measured: stamp(results),
            }),
        };
        assert_eq!(stale(Some(&record(5, Some(("t", 5)))), "t", 5), None);
        for (record, words) in [
            (None, "origin"),
            (
                Some(record(4, Some(("t", 5)))),
                "results 4 (2026-01-02), this code makes results 5",
            ),
            (Some(record(5, Some(("t", 4)))), "the factor"),
            (Some(record(5, Some(("other", 5)))), "not of this table"),
            (Some(record(5, None)), "--set factor --record"),
        ] {
            let message = stale(record.as_ref(), "t", 5).unwrap();
            assert!(
                message.contains(words) && message.contains("cargo xtask"),
                "{message}"
            );
        }
    }
}
