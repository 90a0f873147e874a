//! Bounding boxes of edges in levels, laid out so that eight are compared at once.

use crate::V;

/// Boxes compared together.
const LANES: usize = 8;

/// An axis-aligned box in single precision, padded so that rounding cannot lose an overlap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Aabb {
    pub low: [f32; 3],
    pub high: [f32; 3],
}

impl Aabb {
    /// Box around points, grown by `pad`.
    pub fn around(points: &[&V], pad: [f32; 3]) -> Self {
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for x in points {
            for k in 0..3 {
                low[k] = low[k].min(x[k] as f32);
                high[k] = high[k].max(x[k] as f32);
            }
        }
        for k in 0..3 {
            low[k] -= pad[k];
            high[k] += pad[k];
        }
        Self { low, high }
    }
}

/// Boxes of one level; missing ones are empty and overlap nothing.
#[derive(Debug, Default)]
struct Level {
    low: [Vec<f32>; 3],
    high: [Vec<f32>; 3],
}

impl Level {
    fn reset(&mut self, n: usize) {
        let padded = n.div_ceil(LANES) * LANES;
        for k in 0..3 {
            self.low[k].clear();
            self.low[k].resize(padded, f32::INFINITY);
            self.high[k].clear();
            self.high[k].resize(padded, f32::NEG_INFINITY);
        }
    }

    fn set(&mut self, i: usize, b: &Aabb) {
        for k in 0..3 {
            self.low[k][i] = b.low[k];
            self.high[k][i] = b.high[k];
        }
    }

    fn grow(&mut self, i: usize, b: &Aabb) {
        for k in 0..3 {
            self.low[k][i] = self.low[k][i].min(b.low[k]);
            self.high[k][i] = self.high[k][i].max(b.high[k]);
        }
    }

    fn clear(&mut self, i: usize) {
        self.set(
            i,
            &Aabb {
                low: [f32::INFINITY; 3],
                high: [f32::NEG_INFINITY; 3],
            },
        );
    }

    /// Which of the eight boxes from `first` on overlap `b`, as bits.
    fn overlaps(&self, first: usize, b: &Aabb) -> u32 {
        let mut hit = [1_u32; LANES];
        for k in 0..3 {
            let low = &self.low[k][first..first + LANES];
            let high = &self.high[k][first..first + LANES];
            for lane in 0..LANES {
                hit[lane] &= u32::from(low[lane] <= b.high[k]) & u32::from(high[lane] >= b.low[k]);
            }
        }
        let mut bits = 0;
        for (lane, h) in hit.iter().enumerate() {
            bits |= h << lane;
        }
        bits
    }
}

/// Boxes of edges, above them of runs of eight edges, above those of runs of eight runs, until few are left.
#[derive(Debug, Default)]
pub(crate) struct EdgeBoxes {
    /// The edges first.
    levels: Vec<Level>,
    n_levels: usize,
}

/// Boxes on the uppermost level: comparing so many one after the other costs less than another level.
const MOST_ON_TOP: usize = 64;

impl EdgeBoxes {
    /// Empties all and makes room for `n` edges.
    pub fn reset(&mut self, n: usize) {
        self.n_levels = 0;
        let mut n_boxes = n;
        loop {
            if self.levels.len() == self.n_levels {
                self.levels.push(Level::default());
            }
            self.levels[self.n_levels].reset(n_boxes);
            self.n_levels += 1;
            if self.n_levels > 1 && n_boxes <= MOST_ON_TOP {
                break;
            }
            n_boxes = n_boxes.div_ceil(LANES);
        }
    }

    /// Sets the box of an edge; the boxes of its runs only grow.
    pub fn set(&mut self, edge: usize, b: &Aabb) {
        self.levels[0].set(edge, b);
        let mut place = edge;
        for level in &mut self.levels[1..self.n_levels] {
            place /= LANES;
            level.grow(place, b);
        }
    }

    /// Takes an edge out.
    pub fn clear(&mut self, edge: usize) {
        self.levels[0].clear(edge);
    }

    /// Whether `blocks` holds for any edge whose box overlaps `b`.
    pub fn any(&self, b: &Aabb, mut blocks: impl FnMut(usize) -> bool) -> bool {
        let top = self.n_levels - 1;
        (0..self.levels[top].low[0].len())
            .step_by(LANES)
            .any(|first| self.any_below(top, first, b, &mut blocks))
    }

    /// The same among the eight boxes from `first` on of a level.
    fn any_below(
        &self,
        level: usize,
        first: usize,
        b: &Aabb,
        blocks: &mut impl FnMut(usize) -> bool,
    ) -> bool {
        let mut hits = self.levels[level].overlaps(first, b);
        while hits != 0 {
            let place = first + hits.trailing_zeros() as usize;
            hits &= hits - 1;
            let found = if level == 0 {
                blocks(place)
            } else {
                self.any_below(level - 1, place * LANES, b, blocks)
            };
            if found {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_brute_force_finds() {
        for n in [5, 83, 700, 5000] {
            check(n);
        }
    }

    fn check(n: usize) {
        let point = |k: usize| {
            let s = k as f64;
            V::new((1.7 * s).sin(), (2.3 * s).cos(), (0.9 * s).sin())
        };
        let boxes: Vec<Aabb> = (0..n)
            .map(|k| Aabb::around(&[&point(k), &point(k + 1)], [0.0; 3]))
            .collect();
        let mut all = EdgeBoxes::default();
        all.reset(boxes.len());
        boxes.iter().enumerate().for_each(|(k, b)| all.set(k, b));
        all.clear(3);
        for query in boxes.iter().step_by(1 + n / 100) {
            let mut found = Vec::new();
            all.any(query, |k| {
                found.push(k);
                false
            });
            let overlap =
                |b: &Aabb| (0..3).all(|k| b.low[k] <= query.high[k] && b.high[k] >= query.low[k]);
            let expected: Vec<usize> = (0..boxes.len())
                .filter(|&k| k != 3 && overlap(&boxes[k]))
                .collect();
            assert_eq!(found, expected);
        }
    }
}
