//! What a phase of a run leaves behind, the same for every battery.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use crate::control::RejectionCounts;
use crate::discharge::DischargeCurve;
use crate::integrate::Counters;
use crate::ledger::Ledger;
use crate::stop::StopReason;

/// What only one battery reports of a phase, and where its keys go among the common ones.
///
/// The two functions write the keys before and after the energy account, in the order of the battery's `run.json`.
pub trait PhaseExtension {
    /// Bytes held by all components together.
    fn n_bytes(&self) -> u64;

    /// Writes the keys before the energy account.
    ///
    /// # Errors
    /// Those of the serializer.
    fn write_before<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        let _ = map;
        Ok(())
    }

    /// Writes the keys after the energy account.
    ///
    /// # Errors
    /// Those of the serializer.
    fn write_after<M: SerializeMap>(&self, cpu_seconds: f64, map: &mut M) -> Result<(), M::Error>;
}

/// Counters and guards of a phase; times and energies are in the battery's own units.
#[derive(Debug, Clone)]
pub struct PhaseReport<E> {
    /// Why it ended.
    pub stop: StopReason,
    /// Time it covered, in the battery's unit.
    pub time: f64,
    /// Accepted steps.
    pub n_steps: u64,
    /// Refused steps by name.
    pub rejections: RejectionCounts,
    /// Work of the integrator.
    pub counters: Counters,
    /// The energy account.
    pub ledger: Ledger,
    /// Relative residual of the energy account.
    pub ledger_residual: f64,
    /// Processor seconds of the calling thread, those before a checkpoint included.
    pub cpu_seconds: f64,
    /// What only this battery reports.
    pub own: E,
}

impl<E: PhaseExtension> PhaseReport<E> {
    /// Bytes held by all components together.
    pub fn n_bytes(&self) -> u64 {
        self.own.n_bytes()
    }
}

impl<E: PhaseExtension> Serialize for PhaseReport<E> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(None)?;
        map.serialize_entry("stop", &self.stop)?;
        map.serialize_entry("time", &self.time)?;
        map.serialize_entry("n_steps", &self.n_steps)?;
        map.serialize_entry("rejections", &self.rejections)?;
        map.serialize_entry("counters", &self.counters)?;
        self.own.write_before(&mut map)?;
        map.serialize_entry("ledger_residual", &self.ledger_residual)?;
        map.serialize_entry("ledger", &self.ledger)?;
        self.own.write_after(self.cpu_seconds, &mut map)?;
        map.end()
    }
}

/// What a phase leaves behind: `S` is what is seen at output times, `E` what only this battery reports.
#[derive(Debug, Clone)]
pub struct RunRecord<S, E> {
    /// Energies at every accepted step.
    pub curve: DischargeCurve,
    /// The system at output times.
    pub samples: Vec<S>,
    /// Counters and guards.
    pub report: PhaseReport<E>,
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Own;

    impl PhaseExtension for Own {
        fn n_bytes(&self) -> u64 {
            8
        }

        fn write_before<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
            map.serialize_entry("work", &1)
        }

        fn write_after<M: SerializeMap>(&self, seconds: f64, map: &mut M) -> Result<(), M::Error> {
            map.serialize_entry("cpu_seconds", &seconds)
        }
    }

    #[test]
    fn keys_of_a_battery_stand_around_the_account() {
        let report = PhaseReport {
            stop: StopReason::ReachedTime,
            time: 1.0,
            n_steps: 2,
            rejections: RejectionCounts::default(),
            counters: Counters::default(),
            ledger: Ledger::default(),
            ledger_residual: 0.5,
            cpu_seconds: 3.0,
            own: Own,
        };
        let text = serde_json::to_string(&report).unwrap();
        let places: Vec<_> = [
            "stop",
            "counters",
            "work",
            "ledger_residual",
            "ledger\"",
            "cpu_seconds",
        ]
        .iter()
        .map(|key| text.find(&format!("\"{key}")).unwrap())
        .collect();
        assert!(places.is_sorted(), "{text}");
        assert_eq!(report.n_bytes(), 8);
    }
}
