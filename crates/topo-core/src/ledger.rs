//! Where the energy is and where it went.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

type Name = Cow<'static, str>;

/// A sum that keeps what rounding drops (Neumaier's variant of Kahan's), so that a million small terms add up accurately.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompensatedSum {
    sum: f64,
    lost: f64,
}

impl CompensatedSum {
    /// Adds `term`.
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.lost += if self.sum.abs() >= term.abs() {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
    }

    /// The sum so far.
    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

/// A named jump of the energy, such as that of a cut.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyEvent {
    /// What happened.
    pub name: Name,
    /// When it happened, in the model's unit of time.
    pub time: f64,
    /// Stored energy that left the system with it, in the model's unit.
    pub removed: f64,
}

/// Energy account of a run: stored by term, dissipated by channel, work done on it, energy removed by events.
///
/// ```math
/// \text{residual} = (E - E_0) + \text{dissipated} - \text{work} + \text{removed}
/// ```
///
/// vanishes for an exact trajectory, and with the order of the integrator for a computed one. Energies are in the model's unit.
/// Only events allocate memory.
///
/// # Validation
/// `books_balance`, `a_million_small_losses_add_up`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Ledger {
    terms: Vec<Name>,
    stored: Vec<f64>,
    channels: Vec<Name>,
    dissipated: Vec<CompensatedSum>,
    work: CompensatedSum,
    removed: CompensatedSum,
    events: Vec<EnergyEvent>,
    stored_start: Option<f64>,
    largest_stored: f64,
}

#[derive(Deserialize)]
struct Unchecked {
    terms: Vec<Name>,
    stored: Vec<f64>,
    channels: Vec<Name>,
    dissipated: Vec<CompensatedSum>,
    work: CompensatedSum,
    removed: CompensatedSum,
    events: Vec<EnergyEvent>,
    stored_start: Option<f64>,
    largest_stored: f64,
}

impl TryFrom<Unchecked> for Ledger {
    type Error = &'static str;
    fn try_from(raw: Unchecked) -> Result<Self, &'static str> {
        if raw.stored.len() != raw.terms.len() || raw.dissipated.len() != raw.channels.len() {
            return Err("the energy account has other names than numbers");
        }
        let sums = raw.dissipated.iter().chain([&raw.work, &raw.removed]);
        let events = raw.events.iter().flat_map(|e| [e.time, e.removed]);
        let numbers = sums
            .flat_map(|s| [s.sum, s.lost])
            .chain(events)
            .chain(raw.stored.iter().copied())
            .chain(raw.stored_start)
            .chain([raw.largest_stored]);
        if numbers.into_iter().any(|x| !x.is_finite()) {
            return Err("the energy account has a number that is not finite");
        }
        Ok(Self {
            terms: raw.terms,
            stored: raw.stored,
            channels: raw.channels,
            dissipated: raw.dissipated,
            work: raw.work,
            removed: raw.removed,
            events: raw.events,
            stored_start: raw.stored_start,
            largest_stored: raw.largest_stored,
        })
    }
}

impl Ledger {
    /// An empty account of the energy terms `terms` and the dissipation channels `channels`.
    pub fn new(terms: &[&'static str], channels: &[&'static str]) -> Self {
        Self {
            terms: terms.iter().map(|n| Name::Borrowed(*n)).collect(),
            stored: vec![0.0; terms.len()],
            channels: channels.iter().map(|n| Name::Borrowed(*n)).collect(),
            dissipated: vec![CompensatedSum::default(); channels.len()],
            ..Self::default()
        }
    }

    /// Sets the stored energies, in the order of the terms; the first call also sets where the account starts.
    ///
    /// # Panics
    /// When `energies` does not have one entry per term.
    pub fn set_stored(&mut self, energies: &[f64]) {
        self.stored.copy_from_slice(energies);
        let total = self.stored_total();
        self.stored_start.get_or_insert(total);
        self.largest_stored = self.largest_stored.max(total.abs());
    }

    /// Adds `energy` to what channel number `channel` has dissipated.
    ///
    /// # Panics
    /// When there is no such channel.
    pub fn dissipate(&mut self, channel: usize, energy: f64) {
        self.dissipated[channel].add(energy);
    }

    /// Adds `energy` to the work done on the system from outside.
    pub fn add_work(&mut self, energy: f64) {
        self.work.add(energy);
    }

    /// Records that the event `name` removed the stored energy `removed` (negative if it added energy).
    pub fn record_event(&mut self, name: impl Into<Cow<'static, str>>, time: f64, removed: f64) {
        self.removed.add(removed);
        self.events.push(EnergyEvent {
            name: name.into(),
            time,
            removed,
        });
    }

    /// Names of the terms of the stored energy.
    pub fn terms(&self) -> &[Cow<'static, str>] {
        &self.terms
    }

    /// Stored energies, in the order of the terms.
    pub fn stored(&self) -> &[f64] {
        &self.stored
    }

    /// Stored energy of the term `name`, if there is one.
    pub fn stored_in(&self, name: &str) -> Option<f64> {
        self.terms
            .iter()
            .position(|n| n == name)
            .map(|i| self.stored[i])
    }

    /// Stored energy in all terms.
    pub fn stored_total(&self) -> f64 {
        self.stored.iter().sum()
    }

    /// Stored energy at the start of the account.
    pub fn stored_start(&self) -> f64 {
        self.stored_start.unwrap_or(0.0)
    }

    /// Names of the dissipation channels.
    pub fn channels(&self) -> &[Cow<'static, str>] {
        &self.channels
    }

    /// Energy dissipated so far by channel number `channel`.
    ///
    /// # Panics
    /// When there is no such channel.
    pub fn dissipated(&self, channel: usize) -> f64 {
        self.dissipated[channel].value()
    }

    /// Energy dissipated so far by the channel `name`, if there is one.
    pub fn dissipated_by(&self, name: &str) -> Option<f64> {
        self.channels
            .iter()
            .position(|n| n == name)
            .map(|i| self.dissipated(i))
    }

    /// Energy dissipated so far by all channels.
    pub fn dissipated_total(&self) -> f64 {
        self.dissipated.iter().map(CompensatedSum::value).sum()
    }

    /// Work done on the system so far.
    pub fn work(&self) -> f64 {
        self.work.value()
    }

    /// Energy removed by events so far.
    pub fn removed_total(&self) -> f64 {
        self.removed.value()
    }

    /// The events, in order.
    pub fn events(&self) -> &[EnergyEvent] {
        &self.events
    }

    /// Residual of the account: 0 for an exact trajectory.
    pub fn residual(&self) -> f64 {
        (self.stored_total() - self.stored_start()) + self.dissipated_total() - self.work()
            + self.removed_total()
    }

    /// Absolute residual over the larger of the largest stored energy seen and the dissipated energy; 0 for an empty account.
    pub fn relative_residual(&self) -> f64 {
        let scale = self.largest_stored.max(self.dissipated_total().abs());
        if scale > 0.0 {
            self.residual().abs() / scale
        } else {
            self.residual().abs()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn books_balance() {
        let mut ledger = Ledger::new(&["bend", "twist"], &["internal", "friction"]);
        ledger.set_stored(&[3.0, 7.0]);
        ledger.dissipate(0, 1.0);
        ledger.dissipate(1, 0.5);
        ledger.add_work(2.0);
        ledger.record_event("cut", 4.0, 0.25);
        ledger.set_stored(&[3.0, 7.25]);
        assert_eq!(ledger.residual(), 0.0);
        ledger.set_stored(&[3.0, 7.0]);
        assert_eq!(
            (ledger.residual(), ledger.relative_residual()),
            (-0.25, 0.25 / 10.25)
        );
        assert_eq!(
            (ledger.stored_in("twist"), ledger.stored_in("contact")),
            (Some(7.0), None)
        );
        assert_eq!(
            (ledger.dissipated_by("friction"), ledger.dissipated_total()),
            (Some(0.5), 1.5)
        );
        assert_eq!(ledger.events()[0].name, "cut");
        assert_eq!(ledger.channels(), ["internal", "friction"]);
        assert_eq!(Ledger::default().relative_residual(), 0.0);
    }

    #[test]
    fn a_million_small_losses_add_up() {
        let mut ledger = Ledger::new(&[], &["drag"]);
        ledger.dissipate(0, 1e6);
        for _ in 0..1_000_000 {
            ledger.dissipate(0, 0.1);
        }
        // Plain summation is off by about 1e-5 here.
        assert!((ledger.dissipated(0) - 1.1e6).abs() < 1e-9);
    }
}
