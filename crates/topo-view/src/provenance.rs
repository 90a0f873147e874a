//! `provenance.json`: which code, inputs and machine time the figures come from.

use crate::data;
use crate::error::ViewError;
use crate::figures::Done;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use topo_analysis::Warnings;
use topo_lab::Estimate;
use topo_lab::Preset;

/// Where figures come from.
#[derive(Debug, Serialize)]
pub struct Provenance {
    /// Version of the workspace.
    pub version: &'static str,
    /// Commit, with `+changes` when files differ from it.
    pub commit: String,
    /// BLAKE3 hash of `Cargo.lock`.
    pub lock_blake3: String,
    /// Quality preset.
    pub quality: Preset,
    /// Presets and seeds of the runs, by name.
    pub presets: BTreeMap<String, String>,
    /// Wall seconds by stage.
    pub wall_seconds: BTreeMap<String, f64>,
    /// What sweeps were expected to take and took, of those that computed anything.
    pub estimates: BTreeMap<String, EstimateAndTime>,
    /// What the numbers of each figure say.
    pub findings: BTreeMap<String, String>,
    /// Warnings of the runs, each with the number of runs that gave it.
    pub warnings: BTreeMap<String, usize>,
}

/// An estimate beside the time that was taken.
#[derive(Debug, Serialize)]
pub struct EstimateAndTime {
    /// What was expected.
    pub estimate: Estimate,
    /// Seconds that it took.
    pub wall_seconds: f64,
}

impl Provenance {
    /// Collects what is known of the code; `root` is the workspace's folder, if the program runs from one.
    pub fn collect(root: Option<&Path>, quality: Preset) -> Self {
        let unknown = || "unknown".to_owned();
        let lock = root.and_then(|root| std::fs::read(root.join("Cargo.lock")).ok());
        Self {
            version: env!("CARGO_PKG_VERSION"),
            commit: root.map_or_else(unknown, commit),
            lock_blake3: lock.map_or_else(unknown, |b| blake3::hash(&b).to_hex().to_string()),
            quality,
            presets: BTreeMap::new(),
            wall_seconds: BTreeMap::new(),
            estimates: BTreeMap::new(),
            findings: BTreeMap::new(),
            warnings: BTreeMap::new(),
        }
    }

    /// Adds the times and findings of drawing.
    pub fn drew(&mut self, done: &[Done]) {
        for d in done {
            let name = d.figure.name;
            self.wall_seconds.insert(format!("draw {name}"), d.seconds);
            self.findings.insert(name.to_owned(), d.finding.clone());
        }
    }

    /// Notes what a sweep was expected to take and took.
    pub fn estimated(&mut self, stage: &str, estimate: &Estimate, wall_seconds: f64) {
        if estimate.n_cases > 0 {
            let expected = EstimateAndTime {
                estimate: *estimate,
                wall_seconds,
            };
            self.estimates.insert(stage.to_owned(), expected);
        }
    }

    /// Counts the warnings of a row.
    pub fn warn(&mut self, warnings: &Warnings) {
        for warning in warnings {
            *self.warnings.entry(warning.to_string()).or_insert(0) += 1;
        }
    }

    /// Key and value, for reading.
    pub fn rows(&self) -> Vec<(&str, String)> {
        let wall: f64 = self.wall_seconds.values().sum();
        let warnings = if self.warnings.is_empty() {
            "none".to_owned()
        } else {
            let each = self.warnings.iter().map(|(w, n)| format!("{w} ({n})"));
            each.collect::<Vec<_>>().join("; ")
        };
        let mut rows = vec![
            ("Version", self.version.to_owned()),
            ("Commit", self.commit.clone()),
            ("Lock file (BLAKE3)", self.lock_blake3.clone()),
            ("Quality", self.quality.to_string()),
        ];
        rows.extend(self.presets.iter().map(|(k, v)| (k.as_str(), v.clone())));
        rows.push(("Wall time", format!("{wall:.1} s")));
        if !self.estimates.is_empty() {
            let each = self.estimates.iter().map(|(stage, e)| {
                format!(
                    "{stage}: {} cases in {:.0} s, estimated {:.0} s",
                    e.estimate.n_cases, e.wall_seconds, e.estimate.wall_seconds
                )
            });
            rows.push(("Estimates", each.collect::<Vec<_>>().join("; ")));
        }
        rows.push(("Warnings", warnings));
        rows
    }

    /// Writes `provenance.json` into the results folder.
    pub fn write(&self, results: &Path) -> Result<(), ViewError> {
        let text = serde_json::to_string_pretty(self).map_err(|e| ViewError::Drawing {
            reason: format!("provenance: {e}"),
        })?;
        data::write(&results.join("provenance.json"), text.as_bytes())
    }
}

/// Findings that an earlier command noted in a results folder.
pub fn earlier_findings(results: &Path) -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(results.join("provenance.json")).unwrap_or_default();
    let old: Option<serde_json::Value> = serde_json::from_str(&text).ok();
    old.and_then(|v| serde_json::from_value(v.get("findings")?.clone()).ok())
        .unwrap_or_default()
}

/// The commit of a folder, with `+changes` when files differ from it.
pub fn commit(root: &Path) -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git")
            .arg("-C")
            .arg(root)
            .args(arguments)
            .output()
            .ok()?;
        output
            .status
            .success()
            .then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    match (git(&["rev-parse", "HEAD"]), git(&["status", "--porcelain"])) {
        (Some(head), Some(changes)) if !changes.is_empty() => format!("{head}+changes"),
        (Some(head), _) => head,
        (None, _) => "unknown".to_owned(),
    }
}
