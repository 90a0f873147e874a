//! The discharge curve: what every battery produces and every analysis uses.

use serde::{Deserialize, Serialize};

/// Why a sample does not fit a discharge curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DischargeError {
    /// A sample or a series has the wrong length.
    #[error("{what} has {found} entries instead of {expected}")]
    Length {
        /// Which list.
        what: &'static str,
        /// How many entries it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A number is NaN or infinite.
    #[error("{what} of sample {sample} is not finite")]
    NotFinite {
        /// Which number.
        what: &'static str,
        /// Index of the sample.
        sample: usize,
    },
    /// Times do not grow.
    #[error("time {time} of sample {sample} does not exceed the one before")]
    NotIncreasing {
        /// Index of the sample.
        sample: usize,
        /// Its time, in the unit of the curve.
        time: f64,
    },
}

/// Stored energy by part and dissipated energy by channel over time.
///
/// Times grow strictly and all numbers are finite, also when read back. Times and energies are in the units that the battery
/// reports.
///
/// # Validation
/// `what_does_not_fit_is_refused`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct DischargeCurve {
    time: Vec<f64>,
    parts: Vec<String>,
    /// One series per part.
    stored: Vec<Vec<f64>>,
    channels: Vec<String>,
    /// One series per channel, cumulated since the start.
    dissipated: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Unchecked {
    time: Vec<f64>,
    parts: Vec<String>,
    stored: Vec<Vec<f64>>,
    channels: Vec<String>,
    dissipated: Vec<Vec<f64>>,
}

impl TryFrom<Unchecked> for DischargeCurve {
    type Error = DischargeError;
    fn try_from(raw: Unchecked) -> Result<Self, DischargeError> {
        let n = raw.time.len();
        expect_length("stored", raw.stored.len(), raw.parts.len())?;
        expect_length("dissipated", raw.dissipated.len(), raw.channels.len())?;
        for series in raw.stored.iter().chain(&raw.dissipated) {
            expect_length("series", series.len(), n)?;
        }
        let mut curve = Self::new(raw.parts, raw.channels);
        let (mut stored, mut dissipated) = (
            vec![0.0; curve.parts.len()],
            vec![0.0; curve.channels.len()],
        );
        for i in 0..n {
            stored
                .iter_mut()
                .zip(&raw.stored)
                .for_each(|(e, series)| *e = series[i]);
            dissipated
                .iter_mut()
                .zip(&raw.dissipated)
                .for_each(|(e, series)| *e = series[i]);
            curve.push(raw.time[i], &stored, &dissipated)?;
        }
        Ok(curve)
    }
}

fn expect_length(what: &'static str, found: usize, expected: usize) -> Result<(), DischargeError> {
    if found == expected {
        Ok(())
    } else {
        Err(DischargeError::Length {
            what,
            found,
            expected,
        })
    }
}

impl DischargeCurve {
    /// An empty curve of these parts of the stored energy and these dissipation channels.
    pub fn new<P: Into<String>, C: Into<String>>(
        parts: impl IntoIterator<Item = P>,
        channels: impl IntoIterator<Item = C>,
    ) -> Self {
        let parts: Vec<String> = parts.into_iter().map(Into::into).collect();
        let channels: Vec<String> = channels.into_iter().map(Into::into).collect();
        Self {
            time: Vec::new(),
            stored: vec![Vec::new(); parts.len()],
            dissipated: vec![Vec::new(); channels.len()],
            parts,
            channels,
        }
    }

    /// Appends a sample: `stored` has one entry per part, `dissipated` one per channel.
    ///
    /// # Errors
    /// [`DischargeError`] when lengths differ, a number is not finite, or `time` does not exceed the last one; the curve then
    /// stays as it was.
    pub fn push(
        &mut self,
        time: f64,
        stored: &[f64],
        dissipated: &[f64],
    ) -> Result<(), DischargeError> {
        let sample = self.time.len();
        expect_length("stored", stored.len(), self.parts.len())?;
        expect_length("dissipated", dissipated.len(), self.channels.len())?;
        for (what, values) in [
            ("time", &[time][..]),
            ("stored energy", stored),
            ("dissipated energy", dissipated),
        ] {
            if values.iter().any(|v| !v.is_finite()) {
                return Err(DischargeError::NotFinite { what, sample });
            }
        }
        if self.time.last().is_some_and(|last| time <= *last) {
            return Err(DischargeError::NotIncreasing { sample, time });
        }
        self.time.push(time);
        self.stored
            .iter_mut()
            .zip(stored)
            .for_each(|(series, e)| series.push(*e));
        self.dissipated
            .iter_mut()
            .zip(dissipated)
            .for_each(|(series, e)| series.push(*e));
        Ok(())
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Times of the samples.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Names of the parts of the stored energy.
    pub fn parts(&self) -> &[String] {
        &self.parts
    }

    /// Series of the stored energy, one per part.
    pub fn stored(&self) -> &[Vec<f64>] {
        &self.stored
    }

    /// Names of the dissipation channels.
    pub fn channels(&self) -> &[String] {
        &self.channels
    }

    /// Series of the dissipated energy, one per channel.
    pub fn dissipated(&self) -> &[Vec<f64>] {
        &self.dissipated
    }

    /// Series of the part or channel `name`, if there is one.
    pub fn series(&self, name: &str) -> Option<&[f64]> {
        let names = self.parts.iter().chain(&self.channels);
        let mut series = self.stored.iter().chain(&self.dissipated);
        names
            .zip(&mut series)
            .find(|(n, _)| *n == name)
            .map(|(_, s)| s.as_slice())
    }

    /// Stored energy of sample `i` in all parts.
    ///
    /// # Panics
    /// When there is no such sample.
    pub fn stored_total(&self, i: usize) -> f64 {
        self.stored.iter().map(|series| series[i]).sum()
    }

    /// Dissipated energy of sample `i` in all channels.
    ///
    /// # Panics
    /// When there is no such sample.
    pub fn dissipated_total(&self, i: usize) -> f64 {
        self.dissipated.iter().map(|series| series[i]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> DischargeCurve {
        let mut curve = DischargeCurve::new(["bend", "twist"], ["internal"]);
        curve.push(0.0, &[1.0, 2.0], &[0.0]).unwrap();
        curve.push(0.5, &[0.5, 1.0], &[1.5]).unwrap();
        curve
    }

    #[test]
    fn totals_and_series() {
        let curve = curve();
        assert_eq!(
            (curve.len(), curve.stored_total(0), curve.stored_total(1)),
            (2, 3.0, 1.5)
        );
        assert_eq!(curve.dissipated_total(1), 1.5);
        assert_eq!(curve.series("twist"), Some(&[2.0, 1.0][..]));
        assert_eq!(curve.series("internal"), Some(&[0.0, 1.5][..]));
        assert_eq!(curve.series("contact"), None);
        assert_eq!(
            (curve.time(), curve.parts()),
            (&[0.0, 0.5][..], &["bend".into(), "twist".into()][..])
        );
        assert_eq!(
            (curve.channels(), curve.dissipated()),
            (&["internal".into()][..], &[vec![0.0, 1.5]][..])
        );
        assert_eq!(curve.stored(), [[1.0, 0.5], [2.0, 1.0]]);
        assert!(!curve.is_empty() && DischargeCurve::new(["bend"], ["internal"]).is_empty());
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let mut c = curve();
        assert!(matches!(
            c.push(1.0, &[1.0], &[0.0]),
            Err(DischargeError::Length { .. })
        ));
        assert!(matches!(
            c.push(1.0, &[1.0, 1.0], &[]),
            Err(DischargeError::Length { .. })
        ));
        assert!(matches!(
            c.push(1.0, &[1.0, f64::NAN], &[0.0]),
            Err(DischargeError::NotFinite { sample: 2, .. })
        ));
        assert!(matches!(
            c.push(f64::NAN, &[1.0, 1.0], &[0.0]),
            Err(DischargeError::NotFinite { .. })
        ));
        assert!(matches!(
            c.push(0.5, &[1.0, 1.0], &[0.0]),
            Err(DischargeError::NotIncreasing { .. })
        ));
        assert_eq!(c, curve());
    }

    #[test]
    fn reads_back_what_it_wrote_and_nothing_broken() {
        let text = serde_json::to_string(&curve()).unwrap();
        assert_eq!(
            serde_json::from_str::<DischargeCurve>(&text).unwrap(),
            curve()
        );
        let broken = text.replace("[0.0,0.5]", "[0.5,0.0]");
        assert_ne!(broken, text);
        assert!(
            serde_json::from_str::<DischargeCurve>(&broken)
                .unwrap_err()
                .to_string()
                .contains("does not exceed")
        );
        assert!(
            serde_json::from_str::<DischargeCurve>(&text.replace("[0.0,0.5]", "[0.0]")).is_err()
        );
    }
}
