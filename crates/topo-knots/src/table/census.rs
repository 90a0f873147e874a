//! The prime knots of nine and ten crossings that have no file of their own: their published words and invariants, without a
//! tight shape.

use std::sync::LazyLock;

use crate::invariant::at_minus_one;
use crate::invariant::numbers;
use crate::{Chirality, Invariants, Jones, KnotEntry, name};

static TEXT: &str = include_str!("../../data/primes.csv");

static ENTRIES: LazyLock<Vec<KnotEntry>> =
    LazyLock::new(|| TEXT.lines().skip(1).filter_map(entry).collect());

/// Those knots, in the order of Rolfsen's table, read when they are first needed.
///
/// # Validation
/// `all_primes_from_words_and_planar_diagrams`
///
/// # References
/// [livingston2026]
///
/// [livingston2026]: https://knotinfo.org
pub(crate) fn entries() -> &'static [KnotEntry] {
    &ENTRIES
}

/// The knot of a line `name,braid,alexander,signature,jones_lowest,jones`, lists with blanks between their numbers.
fn entry(line: &str) -> Option<KnotEntry> {
    let mut cells = line.split(',');
    let mut next = || cells.next();
    let name = next()?;
    let braid = numbers(next()?)?;
    let alexander: Vec<i64> = numbers(next()?)?;
    let signature = next()?.parse().ok()?;
    let lowest = next()?.parse().ok()?;
    let jones = Jones {
        lowest,
        coefficients: numbers(next()?)?,
    };
    let chirality = if name::is_amphichiral(name) {
        Chirality::Amphichiral
    } else {
        Chirality::Chiral
    };
    Some(KnotEntry {
        name: name.to_owned(),
        braid,
        other_braids: Vec::new(),
        crossing_number: name::rolfsen(name)?.0,
        chirality,
        invariants: Invariants {
            determinant: at_minus_one(&alexander),
            alexander,
            signature,
        },
        jones: Some(jones),
        aliases: Vec::new(),
        length_over_radius: None,
        source: None,
        start: None,
    })
}
