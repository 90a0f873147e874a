//! Link types of closed components with an open one among them, which is closed along many directions.

use super::identify::identify_link_of;
use super::{LinkTable, LinkType};
use crate::identify::far_points;
use crate::{KnotError, KnotType, V};

/// The types of the link of `components`, the ends of number `open` joined to each of `n_closures` far points spread over the sphere, each with
/// its share of the closures, most frequent first, then by label. `seed` turns the directions.
///
/// # Errors
/// As [`identify_link`](crate::identify_link), and [`KnotError::Setting`] for no closure at all or an open component that there is not.
///
/// # Validation
/// `val_share_of_the_closures_of_a_rod_that_link_its_ring`
///
/// # References
/// [tubiana2011], closures of single curves
///
/// [tubiana2011]: https://doi.org/10.1143/PTPS.191.192
pub fn identify_open_link(
    components: &[&[V]],
    open: usize,
    n_closures: usize,
    seed: u64,
    table: &LinkTable,
) -> Result<Vec<(LinkType, f64)>, KnotError> {
    let Some(chain) = components.get(open) else {
        return Err(KnotError::Setting {
            name: "open",
            value: open as f64,
            expected: "the number of a component, counted from 0, is needed",
        });
    };
    let all: Vec<V> = components.iter().flat_map(|x| x.iter().copied()).collect();
    let far = far_points(&all, n_closures, seed)?;
    // ends that coincide are closed already: the way to the far point and back would run through itself
    let is_closed = chain.first() == chain.last();
    let mut kinds: Vec<Option<KnotType>> = vec![None; components.len()];
    let mut found: Vec<(LinkType, usize)> = Vec::new();
    for point in far {
        let mut closed = chain.to_vec();
        match is_closed {
            true => closed.truncate(chain.len() - 1),
            false => closed.push(point),
        }
        let mut components = components.to_vec();
        components[open] = &closed;
        let kind = identify_link_of(&components, &kinds, table)?;
        // the others are the same in every closure
        kinds = kind.components.iter().cloned().map(Some).collect();
        kinds[open] = None;
        match found.iter_mut().find(|(k, _)| k.label() == kind.label()) {
            Some((_, count)) => *count += 1,
            None => found.push((kind, 1)),
        }
    }
    found.sort_by(|(a, m), (b, n)| n.cmp(m).then_with(|| a.label().cmp(&b.label())));
    let share = |(kind, count)| (kind, count as f64 / n_closures as f64);
    Ok(found.into_iter().map(share).collect())
}
