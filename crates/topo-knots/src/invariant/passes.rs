//! Pass moves: a stretch of strand that runs above all else, or below, is moved to the path with the fewest crossings.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::VecDeque;

use super::diagram::{Diagram, Visit};
use crate::rings::Rings;

/// Most crossings of a diagram that is treated: the work grows with their third power.
const MOST_CROSSINGS: usize = 300;

impl Diagram {
    /// Removes crossings by Reidemeister's moves and by pass moves, until none shortens the diagram.
    ///
    /// # Validation
    /// `pass_moves_keep_the_knot`
    pub fn simplify(&mut self) {
        self.cancel();
        if self.n_crossings() <= MOST_CROSSINGS {
            while self.pass(None) || self.rings.n_rings() > 1 && self.lift() {
                self.cancel();
            }
        }
    }

    /// Shuffles the diagram by pass moves that keep its number of crossings, `n_tries` times, and simplifies it after each, until no
    /// more than `enough` crossings are left.
    pub fn shuffle(&mut self, enough: usize, n_tries: usize) {
        let mut rng = Pcg64::seed_from_u64(1);
        for _ in 0..n_tries {
            if self.n_crossings() <= enough || self.n_crossings() > MOST_CROSSINGS {
                return;
            }
            self.pass(Some(&mut rng));
            self.simplify();
        }
    }

    /// Moves one run to another path: the first run that gets shorter or, with the state of a random number generator, any that
    /// gets no longer.
    fn pass(&mut self, mut random: Option<&mut Pcg64>) -> bool {
        let (next, before) = (self.rings.next(), self.rings.before());
        let begins = |k: &usize| self.visits[*k].over != self.visits[before[*k]].over;
        let mut starts: Vec<usize> = (0..self.visits.len()).filter(begins).collect();
        if let Some(rng) = random.as_deref_mut() {
            let by = rng.random_range(0..starts.len().max(1));
            starts.rotate_left(by);
            starts.truncate(1);
        }
        let faces = FaceGraph::of(self);
        for start in starts {
            let over = self.visits[start].over;
            let mut run = vec![start];
            let mut last = start;
            while self.visits[next[last]].over == over {
                last = next[last];
                run.push(last);
            }
            let most = run.len() - usize::from(random.is_none());
            let way = faces.way(before[start], &run, most, random.as_deref_mut());
            if let Some(way) = way {
                *self = self.rerouted(&run, &way);
                return true;
            }
        }
        false
    }

    /// The diagram with the run of visits laid along `way`.
    fn rerouted(&self, run: &[usize], way: &[Step]) -> Self {
        let n = self.visits.len();
        let start = run[0];
        let over = self.visits[start].over;
        let mut name = vec![Some(0); self.signs.len()];
        for k in run {
            name[self.visits[*k].crossing as usize] = None;
        }
        let mut signs = Vec::with_capacity(self.signs.len());
        for (name, sign) in name.iter_mut().zip(&self.signs) {
            if let Some(name) = name {
                *name = signs.len() as u32;
                signs.push(*sign);
            }
        }
        let first_new = signs.len() as u32;
        let mut crossed = vec![None; n];
        for (k, step) in way.iter().enumerate() {
            crossed[step.edge] = Some(first_new + k as u32);
            // Of a strand upwards, one above it from left to right crosses it in the positive sense.
            signs.push(if step.from_left == over { 1 } else { -1 });
        }
        let mut visits = Vec::with_capacity(2 * signs.len());
        let mut sizes = Vec::with_capacity(self.rings.n_rings());
        for range in self.rings.ranges() {
            let before = visits.len();
            // The component of the run begins after it.
            let (first, n_left) = match range.contains(&start) {
                true => (start - range.start + run.len(), range.len() - run.len()),
                false => (0, range.len()),
            };
            for m in first..first + n_left {
                let j = range.start + m % range.len();
                let visit = self.visits[j];
                if let Some(crossing) = name[visit.crossing as usize] {
                    visits.push(Visit { crossing, ..visit });
                }
                if let Some(crossing) = crossed[j] {
                    visits.push(Visit {
                        crossing,
                        over: !over,
                    });
                }
            }
            if range.contains(&start) {
                let new = (0..way.len() as u32).map(|k| Visit {
                    crossing: first_new + k,
                    over,
                });
                visits.extend(new);
            }
            sizes.push(visits.len() - before);
        }
        Self {
            visits,
            signs,
            rings: Rings::of(sizes),
        }
    }
}

/// One edge crossed on a way, and from which side.
#[derive(Debug, Clone, Copy)]
struct Step {
    edge: usize,
    from_left: bool,
}

/// The faces of a diagram, and the edges at each.
struct FaceGraph {
    /// Faces left and right of the edge after each visit.
    sides: Vec<[usize; 2]>,
    edges: Vec<Vec<usize>>,
}

impl FaceGraph {
    fn of(diagram: &Diagram) -> Self {
        let twin = diagram.twins();
        let mut face = vec![usize::MAX; twin.len()];
        let mut n_faces = 0;
        for start in 0..twin.len() {
            let mut corner = start;
            while face[corner] == usize::MAX {
                face[corner] = n_faces;
                let arrival = twin[corner];
                corner = 4 * (arrival / 4) + (arrival + 3) % 4;
            }
            n_faces = n_faces.max(face[start] + 1);
        }
        let side = |visit: &Visit| {
            let c = visit.crossing as usize;
            let out = diagram.slot(*visit, true);
            [face[4 * c + out], face[4 * c + (out + 3) % 4]]
        };
        let sides: Vec<[usize; 2]> = diagram.visits.iter().map(side).collect();
        let mut edges = vec![Vec::new(); n_faces];
        for (edge, [left, right]) in sides.iter().enumerate() {
            edges[*left].push(edge);
            if right != left {
                edges[*right].push(edge);
            }
        }
        Self { sides, edges }
    }

    /// The way with the fewest crossings from the edge before a run to the edge after it, if there are at most so many; the run itself
    /// is no obstacle.
    fn way(
        &self,
        before: usize,
        run: &[usize],
        most: usize,
        mut random: Option<&mut Pcg64>,
    ) -> Option<Vec<Step>> {
        let after = run[run.len() - 1];
        let mut of_run = vec![false; self.sides.len()];
        of_run[before] = true;
        run.iter().for_each(|edge| of_run[*edge] = true);
        let is_of_run = |edge: usize| of_run[edge];
        let mut cost = vec![usize::MAX; self.edges.len()];
        let mut from: Vec<Option<(usize, Step)>> = vec![None; self.edges.len()];
        let mut queue = VecDeque::new();
        for face in self.sides[before] {
            cost[face] = 0;
            queue.push_back(face);
        }
        while let Some(face) = queue.pop_front() {
            if self.sides[after].contains(&face) {
                return (cost[face] <= most).then(|| trace(face, &from, is_of_run));
            }
            let edges = &self.edges[face];
            let turn = random
                .as_deref_mut()
                .map_or(0, |rng| rng.random_range(0..edges.len().max(1)));
            for k in 0..edges.len() {
                let edge = edges[(k + turn) % edges.len()];
                let [left, right] = self.sides[edge];
                let from_left = face == left;
                let other = if from_left { right } else { left };
                let price = usize::from(!is_of_run(edge));
                if cost[face] + price < cost[other] && cost[face] + price <= most {
                    cost[other] = cost[face] + price;
                    from[other] = Some((face, Step { edge, from_left }));
                    if price == 0 {
                        queue.push_front(other);
                    } else {
                        queue.push_back(other);
                    }
                }
            }
        }
        None
    }
}

/// The edges crossed on the way to a face.
fn trace(
    mut face: usize,
    from: &[Option<(usize, Step)>],
    is_of_run: impl Fn(usize) -> bool,
) -> Vec<Step> {
    let mut way = Vec::new();
    while let Some((previous, step)) = from[face] {
        if !is_of_run(step.edge) {
            way.push(step);
        }
        face = previous;
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use crate::invariant::{Invariants, one_view};
    use crate::{KnotTable, closed_braid};

    /// From every view of the table's braids, with a strand drawn far over the others, back to few crossings of the same knot.
    #[test]
    fn pass_moves_keep_the_knot() {
        let (mut n_before, mut n_after, mut n_least) = (0, 0, 0);
        for knot in KnotTable::builtin().iter().filter(|k| !k.is_unknot()) {
            let curve = closed_braid(&knot.braid).expect("a knot");
            for seed in 0..8 {
                let mut diagram = one_view(curve.vertices(), seed);
                let jones = Invariants::jones_of(&diagram);
                n_before += diagram.n_crossings();
                diagram.simplify();
                let found = Invariants::of_diagram(&diagram).expect("a diagram");
                assert_eq!(found, knot.invariants, "{}", knot.name);
                let kept = Invariants::jones_of(&diagram);
                assert!(jones.is_none() || jones == kept, "{}", knot.name);
                diagram.shuffle(0, 20);
                let found = Invariants::of_diagram(&diagram).expect("a diagram");
                assert_eq!(found, knot.invariants, "{}", knot.name);
                assert_eq!(Invariants::jones_of(&diagram), kept, "{}", knot.name);
                assert!(diagram.n_crossings() >= knot.crossing_number as usize);
                n_after += diagram.n_crossings();
                n_least += knot.crossing_number as usize;
            }
        }
        println!("{n_before} crossings, {n_after} left, {n_least} if all were minimal");
        assert!(n_after <= n_least + n_least / 50);
    }
}
