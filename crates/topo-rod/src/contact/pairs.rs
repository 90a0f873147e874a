//! Verlet list of vertex pairs, and the pairs in reach at the current state.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{BroadPhase, Core, CorePair, Window, arc_separation};
use crate::{RodState, Tips};

/// A pair of vertices in reach of each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ActivePair {
    /// Smaller index.
    pub i: u32,
    /// Larger index.
    pub j: u32,
    /// w_i w_j W: quadrature weights times the window, in h².
    pub weight: f64,
    /// Distance r, in h.
    pub distance: f64,
    /// (x_i − x_j)/r.
    pub normal: Vector3<f64>,
    /// Whether W = 1: not neighbours along the rod by any measure, as vertices of two components never are.
    pub strands: bool,
}

#[derive(Debug, Clone, Copy)]
struct Candidate {
    i: u32,
    j: u32,
    weight: f64,
    strands: bool,
}

/// Pairs of vertices that may touch or rub: a list with a skin, rebuilt when a vertex has moved half of it.
#[derive(Debug)]
pub struct ContactPairs {
    window: Window,
    reach: f64,
    skin: f64,
    cyclic: bool,
    /// The ends, of several components, that count as joined while `cyclic`.
    joined: Option<Tips>,
    candidates: Vec<Candidate>,
    reference: Vec<Vector3<f64>>,
    active: Vec<ActivePair>,
    has_core: bool,
    core: Vec<CorePair>,
    broad_phase: BroadPhase,
    n_rebuilds: u64,
}

/// What a list remembers: where the rod was when it was built, from which it is built again.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PairsMemory {
    cyclic: bool,
    reference: Vec<Vector3<f64>>,
    n_rebuilds: u64,
    /// Room for listed pairs and for those in reach, which the account of bytes reports.
    room: [usize; 2],
}

impl PairsMemory {
    /// Makes it one that no run can produce.
    #[cfg(test)]
    pub(crate) fn spoil(&mut self) {
        self.reference.truncate(3);
    }

    /// Whether it is that of a rod of `n` vertices.
    pub(crate) fn is_of(&self, n: usize) -> bool {
        let most = 2 * n * n;
        (self.reference.is_empty() || self.reference.len() == n)
            && self.reference.iter().flatten().all(|x| x.is_finite())
            && self.room.iter().all(|room| *room <= most)
            && self.n_rebuilds < topo_core::MOST_COUNTED
    }
}

impl ContactPairs {
    /// What the list remembers.
    pub(crate) fn memory(&self) -> PairsMemory {
        PairsMemory {
            cyclic: self.cyclic,
            reference: self.reference.clone(),
            n_rebuilds: self.n_rebuilds,
            room: [self.candidates.capacity(), self.active.capacity()],
        }
    }

    /// Builds the list again that was remembered; `state` is any state of the same rod.
    pub(crate) fn recall(&mut self, state: &RodState, memory: PairsMemory) {
        self.cyclic = memory.cyclic;
        self.candidates = Vec::with_capacity(memory.room[0]);
        self.active = Vec::with_capacity(memory.room[1]);
        self.reference.clear();
        if !memory.reference.is_empty() {
            self.rebuild(&state.with_vertices(memory.reference));
        }
        self.n_rebuilds = memory.n_rebuilds;
    }

    /// A list for strands that act on each other up to the distance `reach`, with a skin of width `skin`, both in h.
    pub fn new(reach: f64, skin: f64) -> Self {
        Self {
            window: Window::new(reach),
            reach,
            skin,
            cyclic: true,
            joined: None,
            candidates: Vec::new(),
            reference: Vec::new(),
            active: Vec::new(),
            has_core: false,
            core: Vec::new(),
            broad_phase: BroadPhase::default(),
            n_rebuilds: 0,
        }
    }

    /// Pairs in reach at the state of the last update, in ascending order.
    pub fn active(&self) -> &[ActivePair] {
        &self.active
    }

    /// Also looks for neighbours along the rod that are closer than a tube can be bent.
    pub fn with_core(mut self) -> Self {
        self.has_core = true;
        self
    }

    /// Neighbours along the rod too close at the state of the last update, ascending; empty unless
    /// [`with_core`](Self::with_core) was called.
    pub fn core(&self) -> &[CorePair] {
        &self.core
    }

    /// Pairs (i, j) of the list, ascending.
    pub fn candidates(&self) -> impl ExactSizeIterator<Item = (u32, u32)> + '_ {
        self.candidates.iter().map(|c| (c.i, c.j))
    }

    /// Listed pairs closer than the reach plus `margin` at `state`, ascending.
    pub fn near(&self, state: &RodState, margin: f64, out: &mut Vec<(u32, u32)>) {
        let (x, limit) = (state.vertices(), (self.reach + margin).powi(2));
        out.clear();
        let close = |c: &&Candidate| (x[c.i as usize] - x[c.j as usize]).norm_squared() < limit;
        out.extend(self.candidates.iter().filter(close).map(|c| (c.i, c.j)));
    }

    /// Listed pairs of weight between `least` and `most` apart at positions `x`, ascending.
    pub(crate) fn between<'a>(
        &'a self,
        x: &'a [Vector3<f64>],
        least: f64,
        most: f64,
    ) -> impl Iterator<Item = ActivePair> + 'a {
        self.candidates.iter().filter_map(move |c| {
            let d = x[c.i as usize] - x[c.j as usize];
            let square = d.norm_squared();
            if square < least * least || square >= most * most {
                return None;
            }
            let distance = square.sqrt();
            Some(ActivePair {
                i: c.i,
                j: c.j,
                weight: c.weight,
                distance,
                normal: d / distance,
                strands: c.strands,
            })
        })
    }

    /// Least distance between two vertices of different strands, in h, if any are in reach.
    pub fn least_distance(&self) -> Option<f64> {
        self.active
            .iter()
            .filter(|p| p.strands)
            .map(|p| p.distance)
            .min_by(f64::total_cmp)
    }

    /// How often the list was built.
    pub fn n_rebuilds(&self) -> u64 {
        self.n_rebuilds
    }

    /// The window along the rod.
    pub fn window(&self) -> Window {
        self.window
    }

    /// Bytes held.
    pub fn n_bytes(&self) -> usize {
        self.candidates.capacity() * size_of::<Candidate>()
            + self.reference.capacity() * size_of::<Vector3<f64>>()
            + self.active.capacity() * size_of::<ActivePair>()
    }

    /// Names the ends that a cut has made, of several components: `set_cyclic` is about the arclength across them alone. Without it, open
    /// components of several have ends like any.
    pub fn set_joined(&mut self, tips: Option<Tips>) {
        if tips != self.joined {
            self.joined = tips;
            self.reference.clear();
        }
    }

    /// The first of two components across whose ends arclength is counted.
    pub(crate) fn first_of_two(&self) -> Option<usize> {
        match self.joined {
            Some(Tips::Between(c)) if self.cyclic => Some(c),
            _ => None,
        }
    }

    /// Whether arclength along component `c` is counted the shorter way round.
    pub(crate) fn is_cyclic_along(&self, state: &RodState, c: usize) -> bool {
        is_cyclic(state, c, (self.cyclic, self.joined))
    }

    /// Whether arclength is counted the shorter way round: always while closed, and after a cut until the tips have parted.
    pub fn set_cyclic(&mut self, cyclic: bool) {
        if cyclic != self.cyclic {
            self.cyclic = cyclic;
            self.reference.clear();
        }
    }

    /// Whether arclength is counted the shorter way round.
    pub fn is_cyclic(&self) -> bool {
        self.cyclic
    }

    /// Rebuilds the list if it does not cover `state`; returns whether it was rebuilt.
    pub fn ensure(&mut self, state: &RodState) -> bool {
        let x = state.vertices();
        let limit = (0.5 * self.skin).powi(2);
        let stale = self.reference.len() != x.len()
            || x.iter()
                .zip(&self.reference)
                .any(|(a, b)| (a - b).norm_squared() > limit);
        if stale {
            self.rebuild(state);
        }
        stale
    }

    /// Listed pairs closer than `limit` at positions `x`; false if the list does not reach that far.
    pub fn vertices_within(
        &self,
        limit: f64,
        x: &[Vector3<f64>],
        near: &mut Vec<(u32, u32)>,
    ) -> bool {
        near.clear();
        if limit > self.reach {
            return false;
        }
        let square = limit * limit;
        let close = |c: &&Candidate| (x[c.i as usize] - x[c.j as usize]).norm_squared() < square;
        near.extend(self.candidates.iter().filter(close).map(|c| (c.i, c.j)));
        true
    }

    /// Pairs within reach at `state`; returns whether the list had to be rebuilt.
    pub fn update(&mut self, state: &RodState) -> bool {
        let x = state.vertices();
        let stale = self.ensure(state);
        if self.has_core {
            Core::find(state, &mut self.core);
        }
        self.active.clear();
        let reach = self.reach * self.reach;
        for c in &self.candidates {
            let d = x[c.i as usize] - x[c.j as usize];
            let square = d.norm_squared();
            if square < reach {
                let distance = square.sqrt();
                // two vertices in one point have no direction; the certificate stops the run there, the force stays finite
                let normal = if distance > 1e-9 {
                    d / distance
                } else {
                    Vector3::zeros()
                };
                self.active.push(ActivePair {
                    i: c.i,
                    j: c.j,
                    weight: c.weight,
                    distance: distance.max(1e-9),
                    normal,
                    strands: c.strands,
                });
            }
        }
        stale
    }

    fn rebuild(&mut self, state: &RodState) {
        let (x, n, window) = (state.vertices(), state.n_vertices(), self.window);
        let within = self.reach + self.skin;
        let stride = (within / (2.0 * state.rest_length())).round() as usize;
        let stride = stride.clamp(1, n.div_ceil(4));
        let seam = (self.cyclic, self.joined);
        let first_of_two = self.first_of_two();
        // vertices of two components are never neighbours, but where a cut has just parted them
        let apart = |i: usize, j: usize| match first_of_two {
            Some(c) if [c, c + 1] == [i, j].map(|k| state.component_of(k)) => {
                (j - i - 1) as f64 * state.components()[c].rest_length()
            }
            _ => f64::INFINITY,
        };
        let separation = |i: usize, j: usize| {
            state.common_chain(i, j).map_or_else(
                || apart(i, j),
                |chain| {
                    let cyclic = is_cyclic(state, state.component_of(i), seam);
                    arc_separation(i, j, chain.rest_length(), chain.length(), cyclic)
                },
            )
        };
        let share = |i: usize| state.chain_of(i).share(i);
        let candidates = &mut self.candidates;
        candidates.clear();
        // the closing edge of a link of several would be none of theirs
        let closing = state.is_closed() && state.n_components() == 1;
        self.broad_phase
            .for_each_pair(x, closing, stride, within, |a, b| {
                for i in a * stride..((a + 1) * stride).min(n) {
                    for j in (b * stride).max(i + 1)..((b + 1) * stride).min(n) {
                        let separation = separation(i, j);
                        if separation > window.inner()
                            && (x[i] - x[j]).norm_squared() < within * within
                        {
                            let weight = share(i) * share(j) * window.weight(separation);
                            candidates.push(Candidate {
                                i: i as u32,
                                j: j as u32,
                                weight,
                                strands: separation >= window.outer(),
                            });
                        }
                    }
                }
            });
        candidates.sort_unstable_by_key(|c| (c.i, c.j));
        self.reference.clear();
        self.reference.extend_from_slice(x);
        self.n_rebuilds += 1;
    }
}

/// Whether arclength along component `c` is counted the shorter way round.
#[inline]
fn is_cyclic(state: &RodState, c: usize, (cyclic, joined): (bool, Option<Tips>)) -> bool {
    match state.components() {
        [_] => cyclic,
        several => several[c].is_closed() || cyclic && joined == Some(Tips::Of(c)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_core::Polyline;

    #[test]
    fn straight_rod_has_no_pair_in_any_reach() {
        let line: Vec<_> = (0..=200)
            .map(|k| Vector3::new(0.25 * k as f64, 0.0, 0.0))
            .collect();
        let rod = RodState::new(&Polyline::new(line, false).unwrap(), 50.0, 0.0).unwrap();
        for reach in [2.0, 1.57, 3.05] {
            let mut pairs = ContactPairs::new(reach, 0.5);
            pairs.set_cyclic(false);
            pairs.update(&rod);
            assert!(pairs.active().is_empty());
        }
    }

    #[test]
    fn list_agrees_with_brute_force_while_the_rod_moves_inside_the_skin() {
        let n = 120;
        let curve: Vec<_> = (0..n)
            .map(|k| {
                let u = std::f64::consts::TAU * k as f64 / n as f64;
                Vector3::new(
                    (2.0 + u.sin() * 0.3) * (2.0 * u).cos() * 1.5,
                    1.5 * (2.0 * u).sin(),
                    (3.0 * u).sin(),
                )
            })
            .collect();
        let rod = RodState::new(&Polyline::new(curve, true).unwrap(), 40.0, 0.0).unwrap();
        let mut pairs = ContactPairs::new(1.8, 0.5);
        assert!(pairs.update(&rod));
        let mut moved = rod.clone();
        let step: Vec<f64> = (0..3 * n).map(|k| 0.1 * (k as f64).sin()).collect();
        rod.moved_by(&step, false, 1, &mut moved);
        assert!(!pairs.update(&moved));
        let (x, w) = (moved.vertices(), Window::new(1.8));
        let mut brute = Vec::new();
        for i in 0..n {
            for j in i + 1..n {
                let s = arc_separation(i, j, moved.rest_length(), moved.length(), true);
                if (x[i] - x[j]).norm() < 1.8 && w.weight(s) > 0.0 {
                    brute.push((i as u32, j as u32));
                }
            }
        }
        assert!(brute.len() > 20);
        let found: Vec<_> = pairs.active().iter().map(|p| (p.i, p.j)).collect();
        assert_eq!(found, brute);
    }
}
