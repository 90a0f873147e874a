//! Knot types of a cut rod over time, alone or among closed ones, and when it is untied.

use serde::{Deserialize, Serialize};
use topo_core::Vector3;
use topo_knots::{KnotError, KnotTable, LinkTable, identify_open, identify_open_link};

use crate::AnalysisError;

/// Type of an open curve, or of a link with an open component, at one time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TypedSample {
    /// Index of the sample that was typed.
    pub sample: usize,
    /// Its time, in the unit of the samples given.
    pub time: f64,
    /// Most frequent type over the closures, by the hand that is more frequent.
    pub knot: String,
    /// Share of the closures with that type, of either hand.
    pub probability: f64,
    /// Whether by that type the open curve is an unknot, linked with nothing.
    pub is_free: bool,
}

/// The sequence of knot types of a discharge.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Timeline {
    samples: Vec<TypedSample>,
}

/// How types are found: closures per sample, and the stride of samples before refining.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TimelineSettings {
    /// Closures of the open curve, spread over the sphere; 0: no timeline.
    pub closures: usize,
    /// Stride of the samples that are typed first; where two of them differ, all between are typed.
    pub stride: usize,
}

impl Default for TimelineSettings {
    fn default() -> Self {
        Self {
            closures: 32,
            stride: 6,
        }
    }
}

impl Timeline {
    /// Finds the types of the samples of a discharge: of every `stride`-th, and of all between two that differ.
    ///
    /// # Errors
    /// A curve that runs through itself or is not finite; one that is too tangled to be named is `unknown`.
    ///
    /// # Validation
    /// `law_a_cut_component_slips_out_of_its_link`, `law_a_cut_ring_has_a_time_of_untying`
    pub fn of(
        samples: &[(f64, &[Vector3<f64>])],
        table: &KnotTable,
        settings: TimelineSettings,
        seed: u64,
    ) -> Result<Self, AnalysisError> {
        let times: Vec<f64> = samples.iter().map(|(time, _)| *time).collect();
        Self::by(&times, settings, |k| {
            let found = identify_open(samples[k].1, settings.closures, seed, table)?;
            let (knot, probability) = most_frequent(found.distribution, table);
            let is_free = knot == UNKNOT;
            Ok((knot, probability, is_free))
        })
    }

    /// The types of links whose component number `open` is open and all others are closed.
    ///
    /// # Errors
    /// As [`of`](Self::of), and components that touch.
    pub fn of_links(
        samples: &[(f64, Vec<&[Vector3<f64>]>)],
        open: usize,
        table: &LinkTable,
        settings: TimelineSettings,
        seed: u64,
    ) -> Result<Self, AnalysisError> {
        let times: Vec<f64> = samples.iter().map(|(time, _)| *time).collect();
        Self::by(&times, settings, |k| {
            let components = &samples[k].1;
            let found = identify_open_link(components, open, settings.closures, seed, table)?;
            let most = found.first();
            Ok(most.map_or_else(Default::default, |(kind, share)| {
                (kind.label(), *share, kind.is_free(open))
            }))
        })
    }

    /// Looks at samples by number: what is found is a type, its share of the closures, and whether the open curve is free.
    fn by(
        times: &[f64],
        settings: TimelineSettings,
        find: impl Fn(usize) -> Result<(String, f64, bool), AnalysisError>,
    ) -> Result<Self, AnalysisError> {
        if settings.closures == 0 || times.is_empty() {
            return Ok(Self::default());
        }
        let mut typed: Vec<Option<TypedSample>> = vec![None; times.len()];
        let look = |k: usize| -> Result<Option<TypedSample>, AnalysisError> {
            // a curve too tangled to be named is followed all the same
            let (knot, probability, is_free) = match find(k) {
                Err(AnalysisError::Knot(KnotError::TooComplicated { .. })) => {
                    ("unknown".to_owned(), 1.0, false)
                }
                found => found?,
            };
            Ok(Some(TypedSample {
                sample: k,
                time: times[k],
                knot,
                probability,
                is_free,
            }))
        };
        let last = times.len() - 1;
        let looks: Vec<usize> = (0..last)
            .step_by(settings.stride.max(1))
            .chain([last])
            .collect();
        for &k in &looks {
            typed[k] = look(k)?;
        }
        for pair in looks.windows(2) {
            let differ = match (&typed[pair[0]], &typed[pair[1]]) {
                (Some(a), Some(b)) => a.knot != b.knot,
                _ => true,
            };
            if differ {
                for k in pair[0] + 1..pair[1] {
                    typed[k] = look(k)?;
                }
            }
        }
        Ok(Self {
            samples: typed.into_iter().flatten().collect(),
        })
    }

    /// The timeline of the mirror image.
    #[must_use]
    pub fn mirrored(mut self, table: &KnotTable) -> Self {
        for sample in &mut self.samples {
            sample.knot = table.mirror_label(&sample.knot);
        }
        self
    }

    /// The typed samples in time.
    pub fn samples(&self) -> &[TypedSample] {
        &self.samples
    }

    /// The type found at sample `k`, if it was typed.
    pub fn at(&self, k: usize) -> Option<&TypedSample> {
        self.samples
            .binary_search_by_key(&k, |s| s.sample)
            .ok()
            .map(|i| &self.samples[i])
    }

    /// Types in the order of their appearance, repetitions left out.
    pub fn sequence(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.samples.iter().map(|s| s.knot.as_str()).collect();
        names.dedup();
        names
    }

    /// Time of the last change to an open curve that is free, the middle between the two samples around it; `None` if it was not seen.
    pub fn untying_time(&self) -> Option<f64> {
        let knotted = self.samples.iter().rposition(|s| !s.is_free)?;
        let untied = self.samples.get(knotted + 1)?;
        Some(0.5 * (self.samples[knotted].time + untied.time))
    }
}

/// The most frequent type and its share, both hands of a type counted together: of an open curve, closures find either.
fn most_frequent(distribution: Vec<(String, f64)>, table: &KnotTable) -> (String, f64) {
    let pooled = |label: &str, share: f64| {
        let mirror = table.mirror_label(label);
        let other = distribution
            .iter()
            .find(|(l, _)| *l == mirror && l != label);
        share + other.map_or(0.0, |(_, share)| *share)
    };
    let mut best = (String::new(), 0.0);
    for (label, share) in &distribution {
        let share = pooled(label, *share);
        // The hand that comes first is the more frequent one.
        if share > best.1 {
            best = (label.clone(), share);
        }
    }
    best
}

/// Name of the unknot.
pub const UNKNOT: &str = "0_1";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hands_of_a_type_count_together() {
        let table = KnotTable::builtin();
        let of = |list: &[(&str, f64)]| {
            let list = list.iter().map(|(l, p)| ((*l).to_owned(), *p)).collect();
            most_frequent(list, &table)
        };
        let both = of(&[("0_1", 0.44), ("m3_1", 0.25), ("3_1", 0.22), ("4_1", 0.09)]);
        assert_eq!(both, ("m3_1".to_owned(), 0.47));
        assert_eq!(of(&[("4_1", 0.5), ("3_1", 0.5)]).0, "4_1");
        assert_eq!(of(&[]).1, 0.0);
    }

    fn timeline(names: &[&str]) -> Timeline {
        let typed = |(k, n): (usize, &&str)| TypedSample {
            sample: k,
            time: k as f64,
            knot: (*n).to_owned(),
            probability: 1.0,
            is_free: *n == UNKNOT,
        };
        Timeline {
            samples: names.iter().enumerate().map(typed).collect(),
        }
    }

    #[test]
    fn what_is_too_tangled_is_unknown() {
        let find = |k: usize| match k {
            0 => Err(KnotError::TooComplicated { n_crossings: 999 }.into()),
            1 => Ok(("3_1".to_owned(), 0.9, false)),
            _ => Ok((UNKNOT.to_owned(), 1.0, true)),
        };
        let settings = TimelineSettings::default();
        let found = Timeline::by(&[0.0, 1.0, 2.0], settings, find).unwrap();
        assert_eq!(found.sequence(), ["unknown", "3_1", "0_1"]);
        assert_eq!(found.untying_time(), Some(1.5));
        let wrong = |_| Err(KnotError::NoLink.into());
        assert!(Timeline::by(&[0.0], settings, wrong).is_err());
    }

    #[test]
    fn untying_is_the_last_change_to_the_unknot() {
        let t = timeline(&["7_4", "5_2", "0_1", "3_1", "3_1", "0_1", "0_1"]);
        assert_eq!(t.untying_time(), Some(4.5));
        assert_eq!(t.sequence(), ["7_4", "5_2", "0_1", "3_1", "0_1"]);
        assert_eq!(timeline(&["3_1", "3_1"]).untying_time(), None);
        assert_eq!(timeline(&["0_1"]).untying_time(), None);
    }
}
