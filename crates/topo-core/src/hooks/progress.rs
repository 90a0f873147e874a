//! How far a run is.

use std::fmt;

/// Which phase a run is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Relaxing with what stores the energy.
    Charge,
    /// Relaxing to the state that released energy counts from.
    FinalState,
    /// After the release.
    Discharge,
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Charge => "charging",
            Self::FinalState => "final state",
            Self::Discharge => "discharging",
        })
    }
}

/// How far a run is; values that a phase does not have are absent. Times and energies are in the battery's own units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The phase.
    pub phase: Phase,
    /// Steps taken in it.
    pub step: u64,
    /// Time reached in it; 0 where the phase has none.
    pub time: f64,
    /// Time at which it ends at the latest, in the battery's unit.
    pub until: Option<f64>,
    /// Share of the energy that is released, for a phase that ends by it.
    pub released: Option<f64>,
    /// Energy, in the battery's unit.
    pub energy: Option<f64>,
    /// Root mean square of the molecular field of a nematic that relaxes, in L/ξ_N².
    pub rms_field: Option<f64>,
}

impl Progress {
    /// The beginning of a phase.
    pub fn at(phase: Phase) -> Self {
        Self {
            phase,
            step: 0,
            time: 0.0,
            until: None,
            released: None,
            energy: None,
            rms_field: None,
        }
    }
}

/// One line for people.
impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: step {}", self.phase, self.step)?;
        if let Some(until) = self.until {
            let share = 100.0 * self.time / until;
            write!(f, ", t {:.3e} ({share:.1} % of the longest)", self.time)?;
        }
        if let Some(released) = self.released {
            write!(f, ", {:.1} % released", 100.0 * released)?;
        }
        if let Some(rms_field) = self.rms_field {
            write!(f, ", rms H {rms_field:.1e}")?;
        }
        match self.energy {
            Some(energy) => write!(f, ", energy {energy:.4e}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_what_is_known() {
        let relaxing = Progress {
            step: 25,
            rms_field: Some(1.5e-3),
            ..Progress::at(Phase::FinalState)
        };
        assert_eq!(relaxing.to_string(), "final state: step 25, rms H 1.5e-3");
        let opening = Progress {
            step: 4,
            time: 1.0,
            until: Some(500.0),
            released: Some(0.125),
            energy: Some(2.0),
            ..Progress::at(Phase::Discharge)
        };
        assert_eq!(
            opening.to_string(),
            "discharging: step 4, t 1.000e0 (0.2 % of the longest), 12.5 % released, energy 2.0000e0"
        );
    }
}
