//! Which open component has which end conditions.

use nalgebra::Vector3;

use super::{EndCondition, Ends};
use crate::{Chain, Layout, RodError};

/// The end conditions of a state: those of its only open component, or of any by their numbers. The rest is free.
#[derive(Debug, Clone, PartialEq)]
pub enum RodEnds {
    /// Of the only open component; free ends suit any state.
    Only(Ends),
    /// Of open components, each by its number.
    Each(Vec<(usize, Ends)>),
}

impl Default for RodEnds {
    fn default() -> Self {
        Self::Only(Ends::default())
    }
}

impl From<Ends> for RodEnds {
    fn from(ends: Ends) -> Self {
        Self::Only(ends)
    }
}

impl RodEnds {
    /// The ends that are held, moved or loaded, of a state joined like `layout`.
    ///
    /// # Errors
    /// Ends of a component that is closed or missing, or named twice; one pair of ends for several open components; a contradiction.
    pub(crate) fn placed(
        &self,
        layout: &Layout,
        has_twist: bool,
    ) -> Result<Vec<PlacedEnds>, RodError> {
        let closed = RodError::WrongTopology {
            operation: "an end condition",
            needed: "an open",
        };
        let chains = layout.components();
        let each = match self {
            Self::Only(ends) if ends.is_free() => Vec::new(),
            Self::Only(ends) => {
                let mut open = (0..chains.len()).filter(|&c| !chains[c].is_closed());
                match (open.next(), open.next()) {
                    (None, _) => return Err(closed),
                    (Some(c), None) => vec![(c, *ends)],
                    _ => {
                        return Err(RodError::Ends {
                            reason: "several components are open: say of which these are the ends",
                        });
                    }
                }
            }
            Self::Each(each) => each.clone(),
        };
        let mut placed: Vec<PlacedEnds> = Vec::new();
        for (c, ends) in each {
            let n_components = chains.len();
            let chain = *chains
                .get(c)
                .ok_or(RodError::Component { c, n_components })?;
            if placed.iter().any(|other| other.chain == chain) {
                return Err(RodError::Component { c, n_components });
            }
            if chain.is_closed() {
                return Err(closed);
            }
            let ends = ends.checked(has_twist)?;
            placed.push(PlacedEnds { chain, ends });
        }
        placed.retain(|placed| !placed.ends.is_free());
        Ok(placed)
    }
}

/// The ends of one open component.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedEnds {
    pub(crate) chain: Chain,
    pub(crate) ends: Ends,
}

impl PlacedEnds {
    /// First and last vertex.
    pub(crate) fn vertices(&self) -> [usize; 2] {
        [self.chain.first(), self.chain.last()]
    }

    /// First and last edge.
    pub(crate) fn edges(&self) -> [usize; 2] {
        [self.chain.first(), self.chain.last() - 1]
    }

    /// Vertices that are held, each with its prescribed velocity, in h E_b/η.
    pub(crate) fn held_vertices(&self) -> Vec<(usize, Vector3<f64>)> {
        let [first, last] = self.vertices();
        let mut held = Vec::new();
        for (end, order) in [[first, first + 1], [last, last - 1]]
            .into_iter()
            .enumerate()
        {
            let n = match self.ends.conditions[end] {
                EndCondition::Free => 0,
                EndCondition::Pinned => 1,
                EndCondition::Clamped => 2,
            };
            let velocity = Vector3::from(self.ends.motions[end].velocity);
            held.extend(order[..n].iter().map(|&i| (i, velocity)));
        }
        held
    }

    /// Edges whose rotation is held, each with its prescribed rate, in E_b/η.
    pub(crate) fn held_edges(&self) -> Vec<(usize, f64)> {
        let is_clamped = |end: &usize| self.ends.conditions[*end] == EndCondition::Clamped;
        let clamped = [0, 1].into_iter().filter(is_clamped);
        clamped
            .map(|end| (self.edges()[end], self.ends.motions[end].rotation_rate))
            .collect()
    }
}
