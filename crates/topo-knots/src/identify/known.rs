//! Which knots, and which sums of two or three, have given invariants.

use serde::{Deserialize, Serialize};

use crate::name::{Factor, KnotName, rolfsen};
use crate::{Chirality, Invariants, Jones, KnotEntry, KnotTable};

/// A type that fits, with the name of its mirror image.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(super) struct Candidate {
    pub name: KnotName,
    pub mirror: KnotName,
}

impl Candidate {
    /// The name of the type or of its mirror image, whichever comes first in the table.
    pub fn unsided(&self) -> &KnotName {
        (&self.name).min(&self.mirror)
    }
}

/// What was found of a curve, to be looked up.
pub(super) struct Found<'a> {
    pub invariants: &'a Invariants,
    /// `None` where it was not computed.
    pub jones: Option<&'a Jones>,
    /// Crossings of its diagram: no knot with a larger crossing number can have it.
    pub n_crossings: usize,
}

/// The prime knots known, then the sums of two or three of them, that have the invariants found; each hand by itself.
pub(super) fn candidates(found: &Found<'_>, table: &KnotTable) -> Vec<Candidate> {
    let mut search = Search {
        found,
        table,
        primes: Vec::new(),
        list: Vec::new(),
    };
    let known = || table.iter().chain(table.census());
    for knot in known().filter(|knot| !knot.is_unknot()) {
        let divides = |whole: u64, part: u64| part != 0 && whole.is_multiple_of(part);
        if divides(found.invariants.determinant, knot.invariants.determinant)
            && least_crossings(knot) <= found.n_crossings
        {
            search.compare(&[knot]);
            if !knot.is_composite() {
                search.primes.push(knot);
            }
        }
    }
    search.list.sort_by_cached_key(|c| {
        let (crossings, place) = rolfsen(&c.unsided().to_string()).unwrap_or((u32::MAX, 0));
        (c.name.is_sum(), crossings, place)
    });
    search.sums();
    search.list
}

/// Crossing number of a knot of the published tables; of another, whose file may give too many, none.
fn least_crossings(knot: &KnotEntry) -> usize {
    let factors = knot.name.split('#').map(|f| f.trim_start_matches('m'));
    factors
        .map(|factor| rolfsen(factor).map_or(0, |(crossings, _)| crossings as usize))
        .sum()
}

struct Search<'a> {
    found: &'a Found<'a>,
    table: &'a KnotTable,
    /// Those whose determinant divides the one looked for.
    primes: Vec<&'a KnotEntry>,
    list: Vec<Candidate>,
}

impl<'a> Search<'a> {
    /// Sums of two and of three.
    fn sums(&mut self) {
        let primes = std::mem::take(&mut self.primes);
        let determinant = self.found.invariants.determinant;
        let fits = |knots: &[&KnotEntry]| {
            knots.iter().map(|k| least_crossings(k)).sum::<usize>() <= self.found.n_crossings
                && knots
                    .iter()
                    .map(|k| k.invariants.alexander.len() - 1)
                    .sum::<usize>()
                    < self.found.invariants.alexander.len()
        };
        let mut pairs: Vec<[&'a KnotEntry; 2]> = Vec::new();
        let mut triples: Vec<[&'a KnotEntry; 3]> = Vec::new();
        for (i, a) in primes.iter().enumerate() {
            for (j, b) in primes.iter().enumerate().skip(i) {
                let Some(two) = a
                    .invariants
                    .determinant
                    .checked_mul(b.invariants.determinant)
                else {
                    continue;
                };
                if !determinant.is_multiple_of(two) || !fits(&[a, b]) {
                    continue;
                }
                if two == determinant {
                    pairs.push([a, b]);
                }
                for c in &primes[j..] {
                    if determinant / two == c.invariants.determinant && fits(&[a, b, c]) {
                        triples.push([a, b, c]);
                    }
                }
            }
        }
        pairs.iter().for_each(|knots| self.compare(knots));
        triples.iter().for_each(|knots| self.compare(knots));
    }

    /// Lists the sum of the knots, with every choice of hands that fits.
    fn compare(&mut self, knots: &[&KnotEntry]) {
        let found = self.found;
        let product = |sum: Invariants, k: &&KnotEntry| sum.sum(&k.invariants);
        let plain = knots.iter().try_fold(Invariants::unknot(), product);
        if plain.is_none_or(|plain| plain.alexander != found.invariants.alexander) {
            return;
        }
        for hands in 0..1_u32 << knots.len() {
            let is_mirrored = |k: usize| hands >> k & 1 == 1;
            let signature: i32 = knots
                .iter()
                .enumerate()
                .map(|(k, knot)| match is_mirrored(k) {
                    true => -knot.invariants.signature,
                    false => knot.invariants.signature,
                })
                .sum();
            let is_turned = |(k, knot): (usize, &&KnotEntry)| {
                is_mirrored(k) && knot.chirality == Chirality::Amphichiral
            };
            if signature != found.invariants.signature || knots.iter().enumerate().any(is_turned) {
                continue;
            }
            if let Some(jones) = found.jones
                && product_of_jones(knots, is_mirrored).is_some_and(|own| own != *jones)
            {
                continue;
            }
            self.push(knots, is_mirrored);
        }
    }

    fn push(&mut self, knots: &[&KnotEntry], is_mirrored: impl Fn(usize) -> bool) {
        let is_amphichiral = |knot: &str| self.table.is_amphichiral(knot);
        let factors = knots.iter().enumerate().flat_map(|(k, knot)| {
            let name = KnotName::parse_with(&knot.name, &is_amphichiral);
            let turned = is_mirrored(k).then(|| name.mirror_with(&is_amphichiral));
            turned.unwrap_or(name).into_factors()
        });
        let name = KnotName::of(factors.collect::<Vec<Factor>>());
        if self.list.iter().all(|c| c.name != name) {
            let mirror = name.mirror_with(&is_amphichiral);
            self.list.push(Candidate { name, mirror });
        }
    }
}

/// Jones polynomial of the sum; `None` if that of a factor is not known.
fn product_of_jones(knots: &[&KnotEntry], is_mirrored: impl Fn(usize) -> bool) -> Option<Jones> {
    knots
        .iter()
        .enumerate()
        .try_fold(Jones::one(), |product, (k, knot)| {
            let own = knot.jones.as_ref()?;
            match is_mirrored(k) {
                true => product.product(&own.mirror()),
                false => product.product(own),
            }
        })
}
