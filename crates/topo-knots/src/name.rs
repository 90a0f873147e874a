//! Names of knots and of their sums: factors joined by `#`, each with a leading `m` where it is a mirror image.

use std::cmp::Ordering;
use std::fmt;

use serde::{Deserialize, Serialize};
use strsim::levenshtein;

/// Name of the unknot.
pub(crate) const UNKNOT: &str = "0_1";

/// The prime knots of at most ten crossings that equal their mirror image.
///
/// # References
/// [livingston2026]
///
/// [livingston2026]: https://knotinfo.org
pub(crate) const AMPHICHIRAL: [&str; 20] = [
    "4_1", "6_3", "8_3", "8_9", "8_12", "8_17", "8_18", "10_17", "10_33", "10_37", "10_43",
    "10_45", "10_79", "10_81", "10_88", "10_99", "10_109", "10_115", "10_118", "10_123",
];

/// Whether a knot of the published tables equals its mirror image.
pub(crate) fn is_amphichiral(knot: &str) -> bool {
    AMPHICHIRAL.contains(&knot)
}

/// Crossing number and place of a name such as `7_4`; none of any other name.
pub(crate) fn rolfsen(knot: &str) -> Option<(u32, u32)> {
    let (crossings, place) = knot.split_once('_')?;
    Some((crossings.parse().ok()?, place.parse().ok()?))
}

/// One factor of a sum: a knot of the table, or its mirror image.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Factor {
    /// Name of the knot of the table.
    pub knot: String,
    /// Whether its mirror image is meant.
    pub mirrored: bool,
}

impl Factor {
    /// Order in which factors are written: crossing number, place in the table, the knot before its mirror image; other names last.
    fn rank(&self) -> (u32, u32, &str, bool) {
        let (crossings, place) = rolfsen(&self.knot).unwrap_or((u32::MAX, u32::MAX));
        (crossings, place, &self.knot, self.mirrored)
    }
}

impl fmt::Display for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hand = if self.mirrored { "m" } else { "" };
        write!(f, "{hand}{}", self.knot)
    }
}

impl PartialOrd for Factor {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Factor {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank().cmp(&other.rank())
    }
}

/// Name of a knot or of a sum of knots, such as `m3_1#5_2`: the left-handed trefoil and 5_2 of the table.
///
/// Each factor has its own `m`; factors are in the order of the table, and one that equals its mirror image has no `m`. So
/// every type has one name, and that of the mirror image of `3_1#4_1` is `m3_1#4_1`.
///
/// # Validation
/// `sums_have_one_name_each`
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct KnotName {
    factors: Vec<Factor>,
}

impl KnotName {
    /// Reads a name; knots of the published tables that equal their mirror image lose their `m`.
    pub fn parse(text: &str) -> Self {
        Self::parse_with(text, &is_amphichiral)
    }

    /// The same, with a function that says which knots equal their mirror image.
    pub(crate) fn parse_with(text: &str, is_amphichiral: &dyn Fn(&str) -> bool) -> Self {
        let factor = |text: &str| {
            let (knot, mirrored) = match text.strip_prefix('m') {
                Some(knot) => (knot, !is_amphichiral(knot)),
                None => (text, false),
            };
            Factor {
                knot: knot.to_owned(),
                mirrored,
            }
        };
        Self::of(text.split('#').map(factor).collect())
    }

    /// The sum of factors, put into order.
    pub(crate) fn of(mut factors: Vec<Factor>) -> Self {
        // The unknot adds nothing to a sum.
        factors.sort();
        let n_unknots = factors.iter().take_while(|f| f.knot == UNKNOT).count();
        factors.drain(..n_unknots.min(factors.len() - 1));
        Self { factors }
    }

    /// Its factors, in order.
    pub fn factors(&self) -> &[Factor] {
        &self.factors
    }

    pub(crate) fn into_factors(self) -> Vec<Factor> {
        self.factors
    }

    /// Whether it is a sum of several.
    pub fn is_sum(&self) -> bool {
        self.factors.len() > 1
    }

    /// The name of the mirror image.
    #[must_use]
    pub fn mirror(&self) -> Self {
        self.mirror_with(&is_amphichiral)
    }

    /// The same, with a function that says which knots equal their mirror image.
    #[must_use]
    pub(crate) fn mirror_with(&self, is_amphichiral: &dyn Fn(&str) -> bool) -> Self {
        let turned = |factor: &Factor| Factor {
            knot: factor.knot.clone(),
            mirrored: !factor.mirrored && !is_amphichiral(&factor.knot),
        };
        Self::of(self.factors.iter().map(turned).collect())
    }

    /// The name, or that of the mirror image, whichever comes first.
    #[must_use]
    pub fn unsided(&self) -> Self {
        self.clone().min(self.mirror())
    }
}

impl fmt::Display for KnotName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, factor) in self.factors.iter().enumerate() {
            let joint = if k > 0 { "#" } else { "" };
            write!(f, "{joint}{factor}")?;
        }
        Ok(())
    }
}

impl From<String> for KnotName {
    fn from(text: String) -> Self {
        Self::parse(&text)
    }
}

impl From<KnotName> for String {
    fn from(name: KnotName) -> Self {
        name.to_string()
    }
}

/// The names most like a name that is not known, at most two letters away.
pub(crate) fn similar<'a>(name: &str, known: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut near: Vec<(usize, &String)> = known
        .map(|known| (levenshtein(name, known), known))
        .filter(|(distance, _)| *distance <= 2)
        .collect();
    near.sort_unstable();
    let nearest = near.into_iter().take(4);
    nearest.map(|(_, known)| known.clone()).collect()
}

/// Name of the mirror image of a shape. A knot gains or loses its leading `m`, even where the mirror image is the same knot
/// turned around (`m4_1`). A sum follows [`KnotName`]: `m3_1#4_1` for `3_1#4_1`.
pub fn mirror_name(name: &str) -> String {
    if name.contains('#') {
        return KnotName::parse(name).mirror().to_string();
    }
    match name.strip_prefix('m') {
        Some(rest) => rest.to_owned(),
        None => format!("m{name}"),
    }
}

/// Whether a shape of that name is the mirror image of the one that comes first.
pub(crate) fn is_mirror_image(name: &str) -> bool {
    if name.contains('#') {
        let name = KnotName::parse(name);
        return name.mirror() < name;
    }
    name.starts_with('m')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_one_name_each() {
        for (text, name, mirror) in [
            ("3_1", "3_1", "m3_1"),
            ("m4_1", "4_1", "4_1"),
            ("5_2#m3_1", "m3_1#5_2", "3_1#m5_2"),
            ("m3_1#3_1", "3_1#m3_1", "3_1#m3_1"),
            ("m3_1#m3_1", "m3_1#m3_1", "3_1#3_1"),
            ("m4_1#3_1", "3_1#4_1", "m3_1#4_1"),
            ("m3_1#3_1#m3_1", "3_1#m3_1#m3_1", "3_1#3_1#m3_1"),
            ("10_124#9_1#tre", "9_1#10_124#tre", "m9_1#m10_124#mtre"),
        ] {
            let read = KnotName::parse(text);
            assert_eq!(read.to_string(), name);
            assert_eq!(read.mirror().to_string(), mirror);
            assert_eq!(KnotName::parse(name), read);
            assert_eq!(read.mirror().mirror(), read);
            assert_eq!(read.mirror().unsided(), read.unsided());
        }
    }

    #[test]
    fn mirrored_shapes_are_known_by_their_name() {
        for name in ["m3_1", "m4_1", "m3_1#4_1", "4_1#m5_1", "3_1#m3_1#m3_1"] {
            assert!(is_mirror_image(name), "{name}");
            assert!(!is_mirror_image(&mirror_name(name)), "{name}");
        }
        assert!(!is_mirror_image("3_1#m3_1"));
        assert_eq!(mirror_name("4_1"), "m4_1");
    }
}
