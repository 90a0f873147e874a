//! Where components lie in one list: of vertices, or of visits of a diagram.

use std::ops::Range;

/// Components one after the other in one list, each of which closes on itself. Edge i goes out from item i.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Rings {
    /// End of each component, the beginning of the next.
    ends: Vec<usize>,
}

impl Rings {
    /// One component of `n` items.
    pub fn one(n: usize) -> Self {
        Self { ends: vec![n] }
    }

    /// Components of the given sizes.
    pub fn of(sizes: impl IntoIterator<Item = usize>) -> Self {
        let mut end = 0;
        let ends = sizes.into_iter().map(|n| {
            end += n;
            end
        });
        Self {
            ends: ends.collect(),
        }
    }

    /// Number of items of all.
    pub fn n(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Number of components.
    pub fn n_rings(&self) -> usize {
        self.ends.len()
    }

    /// Component that item `i` belongs to.
    pub fn ring(&self, i: usize) -> usize {
        match self.ends.len() {
            1 => 0,
            _ => self.ends.partition_point(|end| *end <= i),
        }
    }

    /// Items of a component.
    pub fn range(&self, ring: usize) -> Range<usize> {
        let first = if ring == 0 { 0 } else { self.ends[ring - 1] };
        first..self.ends[ring]
    }

    /// Items of each component.
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        (0..self.ends.len()).map(|ring| self.range(ring))
    }

    /// The item after each.
    pub fn next(&self) -> Vec<usize> {
        let mut next: Vec<usize> = (1..=self.n()).collect();
        for range in self.ranges().filter(|range| !range.is_empty()) {
            next[range.end - 1] = range.start;
        }
        next
    }

    /// The item before each.
    pub fn before(&self) -> Vec<usize> {
        let mut before: Vec<usize> = (0..self.n()).map(|i| i.wrapping_sub(1)).collect();
        for range in self.ranges().filter(|range| !range.is_empty()) {
            before[range.start] = range.end - 1;
        }
        before
    }

    /// The components with only the items that are kept.
    pub fn retained(&self, is_kept: impl Fn(usize) -> bool) -> Self {
        Self::of(
            self.ranges()
                .map(|range| range.filter(|i| is_kept(*i)).count()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_lie_one_after_the_other() {
        let rings = Rings::of([3, 0, 4]);
        assert_eq!((rings.n(), rings.n_rings()), (7, 3));
        assert_eq!([0, 2, 3, 6].map(|i| rings.ring(i)), [0, 0, 2, 2]);
        assert_eq!(rings.next(), [1, 2, 0, 4, 5, 6, 3]);
        assert_eq!(rings.before(), [2, 0, 1, 6, 3, 4, 5]);
        assert_eq!(Rings::one(3).next(), [1, 2, 0]);
        assert_eq!(rings.retained(|i| i % 2 == 0), Rings::of([2, 0, 2]));
    }
}
