//! The type of a link from the coordinates of its components.

use serde::{Deserialize, Serialize};
use topo_core::closest_points;

use super::{LinkEntry, LinkInvariants, LinkTable};
use crate::invariant::{Diagram, kauffman, least_crossing_of, usable_vertices};
use crate::reduce::Reducer;
use crate::rings::Rings;
use crate::{Chirality, KnotError, KnotTable, KnotType, V, braid_closure, identify};

/// Directions tried for a projection with few crossings.
const N_PROJECTIONS: usize = 12;
/// Times that the link is looked at again where its diagram keeps more crossings than a certain name may have.
const N_MORE_LOOKS: u64 = 4;
/// Pass moves tried at random on each diagram then.
const N_SHUFFLES: usize = 300;
/// Crossing number up to which all links are known.
const COMPLETE_UP_TO: usize = LinkType::CERTAIN_TO as usize;
/// Distance over size below which components count as touching: a few hundred roundings.
const TOUCHING: f64 = 1e-13;

/// A part of a link that no sphere separates, as far as the diagram shows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinkPart {
    /// Which components it has.
    pub components: Vec<usize>,
    /// Names that fit, with their hands: of a link, or of a knot if it has one component; empty if nothing known fits.
    pub candidates: Vec<String>,
    /// Crossings of the simplest diagram found.
    pub n_crossings: usize,
    /// Whether the only candidate is proved.
    pub certain: bool,
}

/// What a link was found to be, order and orientations of its components left aside.
///
/// # Validation
/// `links_are_named_from_braids_and_their_mirrors`, `val_tight_links_are_named`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LinkType {
    /// Each component by itself.
    pub components: Vec<KnotType>,
    /// Linking numbers with the orientations of the coordinates, and the polynomial.
    pub invariants: LinkInvariants,
    /// Its parts: more than one if the link is split.
    pub parts: Vec<LinkPart>,
}

impl LinkType {
    /// Crossing number up to which every prime link was compared and distinguished from every sum.
    pub const CERTAIN_TO: u32 = 7;

    /// Whether it falls into parts that can be moved apart.
    pub fn is_split(&self) -> bool {
        self.parts.len() > 1
    }

    /// Its name in the table of links, if it is in one part and only one fits.
    pub fn name(&self) -> Option<&str> {
        match &self.parts[..] {
            [part] => match &part.candidates[..] {
                [only] => Some(only),
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether component `k` is an unknot that can be moved away from the others.
    pub fn is_free(&self, k: usize) -> bool {
        let alone = |part: &LinkPart| part.components == [k] && part.candidates == ["0_1"];
        self.parts.iter().any(alone)
    }

    /// Whether every part has one name that is proved: its diagram has so few crossings that all links it could be were compared.
    pub fn is_certain(&self) -> bool {
        self.parts.iter().all(|part| part.certain)
    }

    /// Crossings of the simplest diagram found.
    pub fn n_crossings(&self) -> usize {
        self.parts.iter().map(|part| part.n_crossings).sum()
    }

    /// The name with its hand, as `mL4a1`; parts of a split link joined by `+`, names that fit alike by `|`, and `unknown` where
    /// none does.
    pub fn label(&self) -> String {
        let label = |part: &LinkPart| match part.candidates.is_empty() {
            true => "unknown".to_owned(),
            false => part.candidates.join("|"),
        };
        let labels: Vec<String> = self.parts.iter().map(label).collect();
        labels.join("+")
    }

    /// The finding as a sentence.
    ///
    /// # Validation
    /// `links_are_described`
    pub fn describe(&self) -> String {
        let n = self.components.len();
        let one = |part: &LinkPart| match (&part.candidates[..], part.certain) {
            ([], _) => format!(
                "unknown: no link of the table has the invariants found ({})",
                self.invariants.text()
            ),
            ([only], true) => format!("{only} (certain)"),
            ([only], false) => format!("consistent with {only}"),
            (several, _) => format!("one of {}", several.join(", ")),
        };
        if let [part] = &self.parts[..] {
            return format!("{}, a link of {n} components", one(part));
        }
        let listed = |part: &LinkPart| {
            let places: Vec<String> = part
                .components
                .iter()
                .map(|k| (k + 1).to_string())
                .collect();
            let what = if places.len() > 1 {
                "components"
            } else {
                "component"
            };
            format!("{what} {}: {}", places.join(", "), one(part))
        };
        let parts: Vec<String> = self.parts.iter().map(listed).collect();
        format!("a split link of {n} components; {}", parts.join("; "))
    }
}

/// The type of the link whose components are the closed polygons through `components`.
///
/// Each component is shortened while the triangles with its neighbours are free of itself and of the others; what is left is projected
/// and simplified. Parts of the diagram that nothing joins are separate. Each is looked up by the types of its components, their
/// linking numbers, the Jones polynomial without its power that depends on orientations and, where several links fit, Kauffman's
/// polynomial.
///
/// # Errors
/// [`KnotError::NoLink`] for fewer than two components, [`KnotError::Component`] for one with too few vertices, a coordinate that is
/// not finite, or that runs through itself, [`KnotError::ComponentsTouch`] for two that meet, and [`KnotError::TooComplicated`].
///
/// # Validation
/// `links_are_named_from_braids_and_their_mirrors`, `what_is_no_link_is_refused`
///
/// # References
/// [koniaris1991], [kauffman1987], [kauffman1990]
///
/// [koniaris1991]: https://doi.org/10.1063/1.460889
/// [kauffman1987]: https://doi.org/10.1016/0040-9383(87)90009-7
/// [kauffman1990]: https://doi.org/10.1090/S0002-9947-1990-0958895-7
pub fn identify_link(components: &[&[V]], table: &LinkTable) -> Result<LinkType, KnotError> {
    identify_link_of(components, &vec![None; components.len()], table)
}

/// The same, where the types of some components are known.
pub(super) fn identify_link_of(
    components: &[&[V]],
    known: &[Option<KnotType>],
    table: &LinkTable,
) -> Result<LinkType, KnotError> {
    if components.len() < 2 {
        return Err(KnotError::NoLink);
    }
    let knots = KnotTable::builtin();
    let own = |(k, vertices): (usize, &&[V])| {
        if let Some(kind) = &known[k] {
            return Ok(kind.clone());
        }
        identify(vertices, &knots).map_err(|reason| KnotError::Component {
            component: k + 1,
            reason: Box::new(reason),
        })
    };
    let kinds = components.iter().enumerate().map(own);
    let kinds = kinds.collect::<Result<Vec<_>, _>>()?;
    let chains = shortened(components)?;
    let diagram = match diagram(&chains) {
        Err(KnotError::Degenerate) => return Err(touching(components)),
        found => found?,
    };
    let own = kinds.iter().map(|kind| kind.invariants.clone()).collect();
    let invariants = LinkInvariants::of_diagram(&diagram, own);
    let parts = separated(&diagram)
        .into_iter()
        .map(|part| name(part, &diagram, &kinds, table))
        .collect::<Result<_, KnotError>>()?;
    Ok(LinkType {
        components: kinds,
        invariants,
        parts,
    })
}

/// The components with as few vertices as removing them one by one leaves, those of the others in the way.
fn shortened(components: &[&[V]]) -> Result<Vec<Vec<V>>, KnotError> {
    let all: Vec<V> = components.iter().flat_map(|x| x.iter().copied()).collect();
    let scaled = usable_vertices(&all, true)?;
    let rings = Rings::of(components.iter().map(|x| x.len()));
    let mut reducer = Reducer::default();
    let mut chains: Vec<Vec<V>> = Vec::new();
    for range in rings.ranges() {
        reducer.load(&scaled[range], true);
        chains.push(reducer.x.clone());
    }
    let n_vertices = |chains: &[Vec<V>]| chains.iter().map(Vec::len).sum::<usize>();
    loop {
        let before = n_vertices(&chains);
        for k in 0..chains.len() {
            let others = chains.iter().enumerate().filter(|(j, _)| *j != k);
            reducer.others = others.flat_map(|(_, x)| edges(x)).collect();
            reducer.load(&chains[k], true);
            reducer.reduce(true, &[]);
            chains[k].clone_from(&reducer.x);
        }
        if n_vertices(&chains) == before {
            return Ok(chains);
        }
    }
}

fn edges(x: &[V]) -> impl Iterator<Item = [V; 2]> {
    (0..x.len()).map(move |i| [x[i], x[(i + 1) % x.len()]])
}

/// A small diagram of closed chains, with more effort if it has more crossings than a certain name may have.
fn diagram(chains: &[Vec<V>]) -> Result<Diagram, KnotError> {
    if let Some(k) = chains.iter().position(|x| x.len() < 3) {
        return Err(KnotError::Component {
            component: k + 1,
            reason: Box::new(KnotError::Degenerate),
        });
    }
    let rings = Rings::of(chains.iter().map(Vec::len));
    let all: Vec<V> = chains.concat();
    let look = |seed: u64| {
        let mut found = least_crossing_of(&all, &rings, N_PROJECTIONS, seed)?;
        found.shuffle(COMPLETE_UP_TO, N_SHUFFLES);
        Ok::<_, KnotError>(found)
    };
    let mut best = look(0)?;
    for seed in 1..=N_MORE_LOOKS {
        if best.n_crossings() <= COMPLETE_UP_TO {
            break;
        }
        let other = look(seed)?;
        if other.n_crossings() < best.n_crossings() {
            best = other;
        }
    }
    Ok(best)
}

/// Why there is no diagram: which components meet.
fn touching(components: &[&[V]]) -> KnotError {
    let all = || components.iter().flat_map(|x| x.iter());
    let size = all().map(V::amax).fold(f64::MIN_POSITIVE, f64::max);
    let distance = |p: &V, x: &[V]| {
        let to_edge = |[a, b]: [V; 2]| closest_points(p, p, &a, &b).0;
        edges(x).map(to_edge).fold(f64::INFINITY, f64::min).sqrt() / size
    };
    for (k, x) in components.iter().enumerate() {
        for (j, y) in components.iter().enumerate().skip(k + 1) {
            let near = |p: &&V| distance(p, y) < TOUCHING;
            let share = x.iter().filter(near).count() as f64 / x.len() as f64;
            let pairs = edges(x).flat_map(|e| edges(y).map(move |f| (e, f)));
            let between = pairs.map(|([a, b], [c, d])| closest_points(&a, &b, &c, &d).0);
            let depth = between.fold(f64::INFINITY, f64::min).sqrt() / size;
            if share > 0.0 || depth < TOUCHING {
                return KnotError::ComponentsTouch {
                    first: k + 1,
                    second: j + 1,
                    share,
                    depth,
                };
            }
        }
    }
    KnotError::Degenerate
}

/// The components of each part of a diagram that no crossing joins to the rest.
fn separated(diagram: &Diagram) -> Vec<Vec<usize>> {
    let n = diagram.rings.n_rings();
    let mut part: Vec<usize> = (0..n).collect();
    for [a, b] in diagram.crossing_rings() {
        let (from, to) = (part[a].max(part[b]), part[a].min(part[b]));
        part.iter_mut()
            .filter(|p| **p == from)
            .for_each(|p| *p = to);
    }
    let of_part = |p: usize| (0..n).filter(|k| part[*k] == p).collect::<Vec<_>>();
    (0..n).map(of_part).filter(|own| !own.is_empty()).collect()
}

/// Names a part of a link.
fn name(
    part: Vec<usize>,
    whole: &Diagram,
    kinds: &[KnotType],
    table: &LinkTable,
) -> Result<LinkPart, KnotError> {
    if let [only] = part[..] {
        let kind = &kinds[only];
        return Ok(LinkPart {
            candidates: kind.candidates().map(ToString::to_string).collect(),
            n_crossings: kind.n_crossings,
            certain: kind.is_certain(),
            components: part,
        });
    }
    let diagram = whole.part(&part);
    let own = part.iter().map(|k| kinds[*k].invariants.clone()).collect();
    let found = LinkInvariants::of_diagram(&diagram, own);
    if found.jones.is_none() {
        let n_crossings = diagram.n_crossings();
        return Err(KnotError::TooComplicated { n_crossings });
    }
    let mut fitting = candidates(&found, diagram.n_crossings(), table);
    if fitting.len() > 1
        && let Some(value) = kauffman(&diagram)
    {
        fitting.retain(|entry| kauffman_of(entry).is_none_or(|own| own == value));
    }
    let n_crossings = diagram.n_crossings();
    Ok(LinkPart {
        certain: fitting.len() == 1 && n_crossings <= COMPLETE_UP_TO,
        candidates: fitting.into_iter().map(|entry| entry.name).collect(),
        components: part,
        n_crossings,
    })
}

/// The links of the table, each hand by itself, and larger chains and torus links, with the invariants found.
fn candidates(found: &LinkInvariants, n_crossings: usize, table: &LinkTable) -> Vec<LinkEntry> {
    let n = found.n_components();
    let families = [format!("chain({n})"), format!("T({n},{n})")];
    let larger = families.iter().filter_map(|name| table.get(name).ok());
    let larger = larger.map(|entry| entry.into_owned());
    let listed = table.iter().cloned();
    let mut list: Vec<LinkEntry> = Vec::new();
    for entry in listed.chain(larger) {
        if entry.crossing_number as usize > n_crossings || entry.n_components() != n {
            continue;
        }
        let mirror = (entry.chirality == Chirality::Chiral).then(|| entry.mirror());
        for hand in [Some(entry), mirror].into_iter().flatten() {
            let is_known = list.iter().any(|known| known.name == hand.name);
            if !is_known && found.fits(&hand.invariants) {
                list.push(hand);
            }
        }
    }
    list
}

/// Kauffman's polynomial of an entry, from its word.
fn kauffman_of(entry: &LinkEntry) -> Option<u64> {
    let parts = braid_closure(&entry.braid).ok()?;
    let rings = Rings::of(parts.iter().map(|part| part.n_vertices()));
    let all: Vec<V> = parts
        .iter()
        .flat_map(|part| part.vertices())
        .copied()
        .collect();
    kauffman(&least_crossing_of(&all, &rings, N_PROJECTIONS, 0).ok()?)
}

#[cfg(test)]
mod tests;
