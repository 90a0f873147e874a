//! Which knots of the table, and which sums of two of them, have given invariants.

use std::borrow::Cow;

use super::Handedness;
use crate::{Chirality, Invariants, Jones, KnotEntry, KnotTable};

/// Names that fit, and the handedness with respect to the first.
pub(super) struct Finding {
    pub names: Vec<String>,
    pub handedness: Handedness,
}

/// A knot that may be the one looked for.
struct Known<'a> {
    name: Cow<'a, str>,
    signature: i32,
    jones: Option<Cow<'a, Jones>>,
    amphichiral: bool,
}

impl Known<'_> {
    /// Which of the knot and its mirror image have the invariants; none if neither has.
    fn compare(&self, signature: i32, jones: Option<&Jones>) -> Option<Handedness> {
        let fits = |mirrored: bool| {
            let turned = if mirrored {
                -self.signature
            } else {
                self.signature
            };
            turned == signature
                && match (jones, &self.jones) {
                    (Some(found), Some(own)) if mirrored => *found == own.mirror(),
                    (Some(found), Some(own)) => *found == **own,
                    _ => true,
                }
        };
        match (fits(false), fits(true)) {
            (false, false) => None,
            _ if self.amphichiral => Some(Handedness::Amphichiral),
            (true, true) => Some(Handedness::Undecided),
            (true, false) => Some(Handedness::Tabulated),
            (false, true) => Some(Handedness::Mirrored),
        }
    }
}

/// The knots of the table, then the sums of two, that have the invariants, and the Jones polynomial where it is known.
pub(super) fn matches(found: &Invariants, jones: Option<&Jones>, table: &KnotTable) -> Finding {
    let mut finding = Finding {
        names: Vec::new(),
        handedness: Handedness::Undecided,
    };
    let mut compare = |known: &Known<'_>| {
        if let Some(sense) = known.compare(found.signature, jones) {
            if finding.names.is_empty() {
                finding.handedness = sense;
            }
            finding.names.push(known.name.clone().into_owned());
        }
    };
    for knot in table.iter().filter(|knot| !knot.is_unknot()) {
        if knot.invariants.alexander == found.alexander {
            compare(&Known {
                name: Cow::Borrowed(&knot.name),
                signature: knot.invariants.signature,
                jones: knot.jones.as_ref().map(Cow::Borrowed),
                amphichiral: knot.chirality == Chirality::Amphichiral,
            });
        }
    }
    for sum in sums(found, table) {
        compare(&sum);
    }
    finding
}

/// Sums of two knots of the table, not themselves in it, that have the Alexander polynomial looked for.
fn sums<'a>(found: &Invariants, table: &KnotTable) -> Vec<Known<'a>> {
    let mut sums: Vec<Known<'a>> = Vec::new();
    for (k, a) in table.iter().enumerate() {
        let divides = found.determinant.is_multiple_of(a.invariants.determinant);
        if !divides || a.is_composite() || a.is_unknot() {
            continue;
        }
        for b in table.iter().skip(k) {
            if a.invariants.determinant * b.invariants.determinant != found.determinant
                || a.invariants.sum(&b.invariants).alexander != found.alexander
            {
                continue;
            }
            let mirrored = a.mirror();
            for first in [a, &mirrored] {
                let sum = sum(first, b, table);
                if table.get(&sum.name).is_err() && sums.iter().all(|s| s.name != sum.name) {
                    sums.push(sum);
                }
            }
        }
    }
    sums
}

/// The sum of two knots, or its mirror image, whichever has the simpler name.
fn sum<'a>(a: &KnotEntry, b: &KnotEntry, table: &KnotTable) -> Known<'a> {
    let mut factors: Vec<Factor> = [a, b]
        .iter()
        .flat_map(|knot| knot.name.split('#'))
        .map(|name| Factor::of(name, table))
        .collect();
    let mut flipped = factors.clone();
    flipped.iter_mut().for_each(|f| f.mirrored ^= f.chiral);
    factors.sort();
    flipped.sort();
    let signature = a.invariants.signature + b.invariants.signature;
    let jones = match (&a.jones, &b.jones) {
        (Some(a), Some(b)) => a.product(b),
        _ => None,
    };
    let amphichiral = factors == flipped;
    let (factors, signature, jones) = if flipped < factors {
        (flipped, -signature, jones.map(|jones| jones.mirror()))
    } else {
        (factors, signature, jones)
    };
    let names: Vec<String> = factors.iter().map(Factor::name).collect();
    Known {
        name: Cow::Owned(names.join("#")),
        signature,
        jones: jones.map(Cow::Owned),
        amphichiral,
    }
}

/// A prime factor of a sum; the order is that in which factors are named.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Factor {
    place: usize,
    mirrored: bool,
    base: String,
    chiral: bool,
}

impl Factor {
    fn of(name: &str, table: &KnotTable) -> Self {
        let base = name.strip_prefix('m').unwrap_or(name);
        let entry = table.iter().enumerate().find(|(_, k)| k.name == base);
        let chiral = entry.is_none_or(|(_, k)| k.chirality == Chirality::Chiral);
        Self {
            place: entry.map_or(usize::MAX, |(place, _)| place),
            mirrored: chiral && base != name,
            base: base.to_owned(),
            chiral,
        }
    }

    fn name(&self) -> String {
        let prefix = if self.mirrored { "m" } else { "" };
        format!("{prefix}{}", self.base)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_one_name_each() {
        let table = KnotTable::builtin();
        let name = |a: &str, b: &str| {
            let (a, b) = (table.get(a).expect(a), table.get(b).expect(b));
            sum(a, b, &table).name.into_owned()
        };
        assert_eq!(name("5_2", "m3_1"), "3_1#m5_2");
        assert_eq!(name("m5_2", "3_1"), "3_1#m5_2");
        assert_eq!(name("m3_1", "m5_2"), "3_1#5_2");
        assert_eq!(name("4_1", "m4_1"), "4_1#4_1");
        assert_eq!(name("m5_2", "4_1"), "4_1#5_2");
        assert_eq!(name("m3_1", "3_1#m3_1"), "3_1#3_1#m3_1");
    }

    /// Every knot of at most eight crossings, sums included, has invariants of its own.
    #[test]
    fn knots_of_eight_crossings_are_told_apart() {
        let table = KnotTable::builtin();
        let mut all: Vec<(String, Invariants, Option<Jones>)> = Vec::new();
        for knot in table
            .iter()
            .filter(|k| (1..=8).contains(&k.crossing_number))
        {
            all.push((
                knot.name.clone(),
                knot.invariants.clone(),
                knot.jones.clone(),
            ));
        }
        for (a, b) in [("3_1", "5_1"), ("3_1", "5_2"), ("4_1", "4_1")] {
            let (a, b) = (table.get(a).expect(a), table.get(b).expect(b));
            for a in [a.clone(), a.mirror()] {
                let known = sum(&a, b, &table);
                let invariants = a.invariants.sum(&b.invariants);
                let invariants = if known.signature == invariants.signature {
                    invariants
                } else {
                    invariants.mirror()
                };
                all.push((
                    known.name.into_owned(),
                    invariants,
                    known.jones.map(Cow::into_owned),
                ));
            }
        }
        assert_eq!(all.len(), 35 + 3 + 6);
        let mut n_ambiguous = 0;
        for (name, invariants, jones) in &all {
            let jones = jones.as_ref().expect("known");
            let found = matches(invariants, Some(jones), &table);
            assert_eq!(found.names, [name.as_str()]);
            assert_ne!(found.handedness, Handedness::Undecided, "{name}");
            let mirror = matches(&invariants.mirror(), Some(&jones.mirror()), &table);
            assert_eq!(mirror.names, [name.as_str()]);
            n_ambiguous += usize::from(matches(invariants, None, &table).names.len() > 1);
        }
        // The Jones polynomial was needed.
        assert!(n_ambiguous >= 4, "{n_ambiguous}");
    }
}
