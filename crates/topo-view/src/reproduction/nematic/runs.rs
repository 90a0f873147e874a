//! The runs that a claim may rest on, sorted by the side of the buckling they lie on.

use crate::data::NematicSweep;
use crate::reproduction::claim::{Said, Tables, Verdict};
use topo_analysis::{NematicRow, buckling};

/// Runs of a sweep without those that carry warnings, by q.
pub struct Runs<'a> {
    /// Where their files are.
    pub sweep: &'a NematicSweep,
    /// Those without warnings.
    pub rows: Vec<NematicRow>,
    /// The q of the others.
    flagged: Vec<u32>,
}

impl<'a> Runs<'a> {
    /// Those without flow; with flow where a sweep has only such.
    pub fn still(t: &'a Tables) -> Option<Self> {
        let sweep = t.nematic.as_ref()?;
        Some(Self::of(sweep, &sweep.rows))
    }

    /// Those with flow.
    pub fn flowing(t: &'a Tables) -> Option<Self> {
        let sweep = t.nematic.as_ref()?;
        Some(Self::of(sweep, &sweep.flowing))
    }

    fn of(sweep: &'a NematicSweep, rows: &[NematicRow]) -> Self {
        let (rows, flagged): (Vec<_>, Vec<_>) =
            rows.iter().cloned().partition(|r| r.warnings.is_empty());
        Self {
            sweep,
            rows,
            flagged: flagged.iter().map(|r| r.q).collect(),
        }
    }

    /// States without tilt.
    pub fn below(&self) -> Vec<&NematicRow> {
        self.rows.iter().filter(|r| !r.is_buckled()).collect()
    }

    /// States with a tilt.
    pub fn above(&self) -> Vec<&NematicRow> {
        self.rows.iter().filter(|r| r.is_buckled()).collect()
    }

    /// Smallest q that is buckled.
    pub fn onset(&self) -> Option<u32> {
        buckling(&self.rows)
    }

    /// Whether there are states on both sides of the buckling.
    pub fn has_both_sides(&self) -> bool {
        !self.below().is_empty() && !self.above().is_empty()
    }

    /// The finding, with what was left out of it.
    pub fn said(&self, found: String, verdict: Verdict) -> Said {
        let left_out = match self.flagged.as_slice() {
            [] => String::new(),
            flagged => format!("; left out for their warnings: {}", charges(flagged)),
        };
        Some((found + &left_out, verdict))
    }

    /// Not judged, as what was run lies on one side of the buckling only.
    pub fn one_sided(&self) -> Said {
        let run: Vec<u32> = self.rows.iter().map(|r| r.q).collect();
        if run.is_empty() {
            return self.said("no run without warnings".to_owned(), Verdict::NotJudged);
        }
        let side = if self.above().is_empty() {
            "no ring is buckled"
        } else {
            "all rings are buckled"
        };
        self.said(
            format!("{} only: {side}", charges(&run)),
            Verdict::NotJudged,
        )
    }
}

/// "q = 1 to 5", or a list where some between are missing.
pub fn charges(q: &[u32]) -> String {
    match q {
        [first, .., last] if q.windows(2).all(|w| w[1] == w[0] + 1) => {
            format!("q = {first} to {last}")
        }
        _ => {
            let all: Vec<String> = q.iter().map(u32::to_string).collect();
            format!("q = {}", all.join(", "))
        }
    }
}

/// In how many steps a quantity grows; confirmed if in all, in part if it does from the first to the last.
pub fn growth(values: &[f64]) -> (usize, Verdict) {
    let steps = values.windows(2).filter(|w| w[1] > w[0]).count();
    let verdict = match values {
        [first, .., last] if steps + 1 == values.len() && last > first => Verdict::Confirmed,
        [first, .., last] if last > first => Verdict::Partly,
        _ => Verdict::NotConfirmed,
    };
    (steps, verdict)
}

/// Verdict on a whole range: what holds on one side of the buckling only is left open, what fails there fails.
pub fn over_both_sides(runs: &Runs, verdict: Verdict) -> Verdict {
    match verdict {
        Verdict::Confirmed | Verdict::Partly if !runs.has_both_sides() => Verdict::NotJudged,
        other => other,
    }
}
