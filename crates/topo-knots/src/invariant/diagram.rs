//! A diagram of a knot or a link as a signed Gauss code, and the moves that shorten it.

use crate::rings::Rings;

/// One passage of the curve through a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Visit {
    /// Index of the crossing.
    pub crossing: u32,
    /// Whether the curve runs above here.
    pub over: bool,
}

/// A diagram: the 2n visits along the curve, or along one component after the other, and the sign of each of the n crossings.
#[derive(Debug, Clone, Default)]
pub(crate) struct Diagram {
    /// Visits in the order of the curve.
    pub visits: Vec<Visit>,
    /// +1 where the lower strand crosses the upper one from right to left, else -1.
    pub signs: Vec<i8>,
    /// The visits of each component; one without any is a circle apart from the rest.
    pub rings: Rings,
}

impl Diagram {
    /// Number of crossings.
    pub fn n_crossings(&self) -> usize {
        self.signs.len()
    }

    /// Removes crossings by Reidemeister's first and second move until neither applies.
    ///
    /// Two crossings that follow each other on both of their strands bound a bigon in any planar diagram, but for what is apart
    /// from the rest or joined to it by a single crossing, which can be moved away. So the code alone shows where the second move applies.
    pub fn cancel(&mut self) {
        let mut alive = vec![true; self.signs.len()];
        let mut place = vec![[0usize; 2]; self.signs.len()];
        let mut any = false;
        loop {
            let n = self.visits.len();
            if n == 0 {
                break;
            }
            for (k, v) in self.visits.iter().enumerate() {
                place[v.crossing as usize][usize::from(v.over)] = k;
            }
            let next = self.rings.next();
            let mut changed = false;
            for k in 0..n {
                let (a, b) = (self.visits[k], self.visits[next[k]]);
                let (ca, cb) = (a.crossing as usize, b.crossing as usize);
                if !alive[ca] || !alive[cb] {
                    continue;
                }
                if ca == cb {
                    alive[ca] = false;
                    changed = true;
                } else if a.over == b.over {
                    let other = usize::from(!a.over);
                    let (pa, pb) = (place[ca][other], place[cb][other]);
                    if next[pa] == pb || next[pb] == pa {
                        alive[ca] = false;
                        alive[cb] = false;
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
            any = true;
            self.keep(&alive);
        }
        if any {
            self.renumber(&alive);
        }
    }

    /// Drops the visits of crossings that are not alive.
    fn keep(&mut self, alive: &[bool]) {
        let visits = &self.visits;
        self.rings = self.rings.retained(|k| alive[visits[k].crossing as usize]);
        self.visits.retain(|v| alive[v.crossing as usize]);
    }

    /// Lifts off each component that lies above or below all it crosses; true if there was one.
    ///
    /// # Validation
    /// `components_above_all_else_are_lifted_off`
    pub fn lift(&mut self) -> bool {
        let mut alive = vec![true; self.signs.len()];
        for range in self.rings.ranges() {
            let own = &self.visits[range];
            let over = own.first().is_some_and(|v| v.over);
            if own.iter().all(|v| v.over == over) {
                own.iter().for_each(|v| alive[v.crossing as usize] = false);
            }
        }
        let any = alive.contains(&false);
        if any {
            self.keep(&alive);
            self.renumber(&alive);
        }
        any
    }

    /// The two components of each crossing, the upper one first.
    pub fn crossing_rings(&self) -> Vec<[usize; 2]> {
        let mut rings = vec![[0; 2]; self.n_crossings()];
        for (k, visit) in self.visits.iter().enumerate() {
            rings[visit.crossing as usize][usize::from(!visit.over)] = self.rings.ring(k);
        }
        rings
    }

    /// The diagram of some components that no crossing joins to the others.
    pub fn part(&self, components: &[usize]) -> Self {
        let mut part = self.clone();
        let is_in = |k: usize| components.contains(&self.rings.ring(k));
        let mut alive = vec![false; self.signs.len()];
        let visits = self.visits.iter().enumerate();
        visits.for_each(|(k, v)| alive[v.crossing as usize] |= is_in(k));
        part.keep(&alive);
        part.renumber(&alive);
        part.rings = Rings::of(components.iter().map(|ring| self.rings.range(*ring).len()));
        part
    }

    /// Sum of the signs of the crossings of components with themselves: it does not depend on the orientations.
    pub fn own_writhe(&self) -> i32 {
        let rings = self.crossing_rings();
        let own = rings.iter().zip(&self.signs).filter(|([a, b], _)| a == b);
        own.map(|(_, sign)| i32::from(*sign)).sum()
    }

    /// Place of a half-edge, counterclockwise from the outgoing upper one.
    pub fn slot(&self, visit: Visit, outgoing: bool) -> usize {
        match (visit.over, outgoing) {
            (true, true) => 0,
            (true, false) => 2,
            (false, _) if outgoing == (self.signs[visit.crossing as usize] > 0) => 1,
            (false, _) => 3,
        }
    }

    /// The other half of each half-edge; half-edge k of crossing c is number 4 c + k.
    pub fn twins(&self) -> Vec<usize> {
        let next = self.rings.next();
        let mut twin = vec![0; 4 * self.n_crossings()];
        for (k, here) in self.visits.iter().enumerate() {
            let there = self.visits[next[k]];
            let out = 4 * here.crossing as usize + self.slot(*here, true);
            let into = 4 * there.crossing as usize + self.slot(there, false);
            (twin[out], twin[into]) = (into, out);
        }
        twin
    }

    fn renumber(&mut self, alive: &[bool]) {
        let mut next = 0;
        let mut name = vec![0u32; alive.len()];
        for (c, live) in alive.iter().enumerate() {
            if *live {
                name[c] = next;
                self.signs[next as usize] = self.signs[c];
                next += 1;
            }
        }
        self.signs.truncate(next as usize);
        for v in &mut self.visits {
            v.crossing = name[v.crossing as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(visits: &[(u32, bool)], signs: &[i8]) -> Diagram {
        Diagram {
            visits: visits
                .iter()
                .map(|&(crossing, over)| Visit { crossing, over })
                .collect(),
            signs: signs.to_vec(),
            rings: Rings::one(visits.len()),
        }
    }

    #[test]
    fn components_above_all_else_are_lifted_off() {
        let mut above = code(&[(0, true), (1, true), (0, false), (1, false)], &[1, -1]);
        above.rings = Rings::of([2, 2]);
        assert!(above.lift() && !above.lift());
        assert_eq!((above.n_crossings(), above.rings), (0, Rings::of([0, 0])));
        let mut linked = code(&[(0, true), (1, false), (0, false), (1, true)], &[1, 1]);
        linked.rings = Rings::of([2, 2]);
        assert!(!linked.lift());
        linked.cancel();
        assert_eq!((linked.n_crossings(), linked.own_writhe()), (2, 0));
        assert_eq!(linked.crossing_rings(), [[0, 1], [1, 0]]);
    }

    #[test]
    fn trefoil_stays_and_a_loop_on_it_goes() {
        let trefoil = [
            (0, true),
            (1, false),
            (2, true),
            (0, false),
            (1, true),
            (2, false),
        ];
        let mut plain = code(&trefoil, &[1, 1, 1]);
        plain.cancel();
        assert_eq!(plain.n_crossings(), 3);
        let mut visits = trefoil.to_vec();
        visits.insert(2, (3, true));
        visits.insert(3, (3, false));
        let mut curled = code(&visits, &[1, 1, 1, -1]);
        curled.cancel();
        assert_eq!(curled.visits, plain.visits);
    }

    #[test]
    fn a_strand_laid_over_another_is_lifted_off() {
        let mut laid = code(&[(0, true), (1, true), (0, false), (1, false)], &[1, -1]);
        laid.cancel();
        assert_eq!(laid.n_crossings(), 0);
    }
}
