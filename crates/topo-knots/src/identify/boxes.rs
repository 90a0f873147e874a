//! Bounding boxes of edges in two levels, laid out so that eight are compared at once.

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
    pub fn around(points: &[&V], pad: f32) -> Self {
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for x in points {
            for k in 0..3 {
                low[k] = low[k].min(x[k] as f32);
                high[k] = high[k].max(x[k] as f32);
            }
        }
        for k in 0..3 {
            low[k] -= pad;
            high[k] += pad;
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

/// Boxes of edges and, above them, of runs of eight edges.
#[derive(Debug, Default)]
pub(crate) struct EdgeBoxes {
    edges: Level,
    runs: Level,
}

impl EdgeBoxes {
    /// Empties all and makes room for `n` edges.
    pub fn reset(&mut self, n: usize) {
        self.edges.reset(n);
        self.runs.reset(n.div_ceil(LANES));
    }

    /// Sets the box of an edge; the box of its run only grows.
    pub fn set(&mut self, edge: usize, b: &Aabb) {
        self.edges.set(edge, b);
        self.runs.grow(edge / LANES, b);
    }

    /// Takes an edge out.
    pub fn clear(&mut self, edge: usize) {
        self.edges.clear(edge);
    }

    /// Whether `blocks` holds for any edge whose box overlaps `b`.
    pub fn any(&self, b: &Aabb, mut blocks: impl FnMut(usize) -> bool) -> bool {
        for group in (0..self.runs.low[0].len()).step_by(LANES) {
            let mut runs = self.runs.overlaps(group, b);
            while runs != 0 {
                let first = (group + runs.trailing_zeros() as usize) * LANES;
                runs &= runs - 1;
                let mut edges = self.edges.overlaps(first, b);
                while edges != 0 {
                    if blocks(first + edges.trailing_zeros() as usize) {
                        return true;
                    }
                    edges &= edges - 1;
                }
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
        let point = |k: usize| {
            let s = k as f64;
            V::new((1.7 * s).sin(), (2.3 * s).cos(), (0.9 * s).sin())
        };
        let boxes: Vec<Aabb> = (0..83)
            .map(|k| Aabb::around(&[&point(k), &point(k + 1)], 0.0))
            .collect();
        let mut all = EdgeBoxes::default();
        all.reset(boxes.len());
        boxes.iter().enumerate().for_each(|(k, b)| all.set(k, b));
        all.clear(11);
        for query in &boxes {
            let mut found = Vec::new();
            all.any(query, |k| {
                found.push(k);
                false
            });
            let overlap =
                |b: &Aabb| (0..3).all(|k| b.low[k] <= query.high[k] && b.high[k] >= query.low[k]);
            let expected: Vec<usize> = (0..boxes.len())
                .filter(|&k| k != 11 && overlap(&boxes[k]))
                .collect();
            assert_eq!(found, expected);
        }
    }
}
