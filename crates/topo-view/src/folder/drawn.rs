//! A sweep with its pictures.

use crate::figures::Drawn;
use crate::sweeps::Cases;

/// A picture of a sweep before it is written.
pub(super) struct Shot {
    pub name: String,
    pub title: String,
    pub drawn: Drawn,
}

/// A sweep with its pictures.
pub(super) struct DrawnSweep {
    /// Name of its folder.
    pub name: String,
    /// What battery it is of.
    pub what: &'static str,
    pub cases: Cases,
    pub shots: Vec<Shot>,
    /// What the reader should know of all of it.
    pub notes: Vec<String>,
}

impl DrawnSweep {
    /// Everything that the sweep lacks, in sentences.
    pub(super) fn lacks(&self) -> Vec<String> {
        let failed = self.cases.failed.iter();
        let failed = failed.map(|f| format!("{}: failed: {}: {}", self.name, f.case, f.reason));
        failed.chain(self.remarks()).collect()
    }

    /// What the sweep lacks besides failed cases, in sentences.
    pub(super) fn remarks(&self) -> Vec<String> {
        let Cases {
            unfinished, lost, ..
        } = &self.cases;
        let named = |what: &str, names: &[String]| {
            (!names.is_empty()).then(|| format!("{}: {what}: {}", self.name, names.join(", ")))
        };
        let mut all: Vec<String> = Vec::new();
        all.extend(named("not finished", unfinished));
        all.extend(named("in the table, but without a folder", lost));
        all.extend(self.notes.iter().map(|n| format!("{}: {n}", self.name)));
        all
    }
}
