//! The matrix of the linearly implicit steps, η K + η_f C + s H, on the centreline.

mod twist;

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use topo_sparse::{SparseCholesky, SparseError};

use crate::contact::{ContactPairs, KnownPairs};
use crate::drag::{Drag, DragCorrection};
use crate::energy::Stiffness;
use crate::load::LoadLine;
use crate::viscosity::remove_mean;
use crate::{Chain, Layout, RodState};
pub(crate) use twist::{NewtonTwist, NewtonTwistMemory};

/// Block matrix of the centreline with a symbolic factor that is kept as long as the pairs in contact are known to it.
#[derive(Debug, Default)]
pub(crate) struct NewtonMatrix {
    solver: Option<SparseCholesky>,
    blocks: Vec<[usize; 9]>,
    pairs: KnownPairs,
    couplings: Vec<(u32, u32, f64)>,
    /// Blocks (free, held) that carry a prescribed motion over to the free vertices.
    driven: Vec<(usize, usize, Matrix3<f64>)>,
    fixed: Vec<bool>,
    floating: bool,
    /// Whether a term may hold the rod as a whole.
    is_tethered: bool,
    drag: Option<DragCorrection>,
    /// The vertices that a load acts on, and the resistance of its dashpot.
    load: Option<(LoadLine, Matrix3<f64>)>,
    layout: Layout,
    work: Vec<f64>,
    right: Vec<f64>,
    pub n_patterns: u64,
    pub n_factorisations: u64,
}

/// What the matrix remembers: the pairs of its pattern, and the values of the factor in use.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct NewtonMemory {
    pub(crate) pairs: KnownPairs,
    has_pattern: bool,
    pub(crate) factor: Option<FactorMemory>,
    n_patterns: u64,
    n_factorisations: u64,
}

/// A matrix of an earlier state that can still be used.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct FactorMemory {
    values: Vec<f64>,
    couplings: Vec<(u32, u32, f64)>,
    driven: Vec<(usize, usize, Matrix3<f64>)>,
    damping: Option<Matrix3<f64>>,
}

impl FactorMemory {
    /// Whether it is that of a rod of `n` vertices; values that are not finite are refused when they are factorised.
    pub(crate) fn is_of(&self, n: usize) -> bool {
        let of_rod = |&(i, j, c): &(u32, u32, f64)| (i.max(j) as usize) < n && c.is_finite();
        let free_and_held = |d: &(usize, usize, Matrix3<f64>)| d.0.max(d.1) < n;
        self.couplings.iter().all(of_rod) && self.driven.iter().all(free_and_held)
    }
}

/// Change of the resistance of a dashpot, in η/h, that is none: the softest rods resist with η/L.
const LEAST_CHANGE: f64 = 1e-9;

impl NewtonMatrix {
    /// What it remembers, with its factor if that is in use.
    pub(crate) fn memory(&self, is_in_use: bool) -> NewtonMemory {
        let factor = |solver: &SparseCholesky| FactorMemory {
            values: solver.values().to_vec(),
            couplings: self.couplings.clone(),
            driven: self.driven.clone(),
            damping: self.load.map(|load| load.1),
        };
        NewtonMemory {
            pairs: self.pairs.clone(),
            has_pattern: self.solver.is_some(),
            factor: self.solver.as_ref().filter(|_| is_in_use).map(factor),
            n_patterns: self.n_patterns,
            n_factorisations: self.n_factorisations,
        }
    }

    /// Makes pattern and factor again that were remembered; false if they do not fit each other.
    pub(crate) fn recall(
        &mut self,
        state: &RodState,
        memory: NewtonMemory,
    ) -> Result<bool, SparseError> {
        self.pairs = memory.pairs;
        if memory.has_pattern {
            self.build_pattern(state)?;
        }
        if let Some(factor) = memory.factor {
            let Some(solver) = self.solver.as_mut() else {
                return Ok(false);
            };
            if factor.values.len() != solver.n_nonzeros() {
                return Ok(false);
            }
            solver.values_mut().copy_from_slice(&factor.values);
            solver.factor()?;
            if let Some(several) = &mut self.drag {
                several.prepare(solver);
            }
            (self.couplings, self.driven) = (factor.couplings, factor.driven);
            if let (Some(load), Some(damping)) = (&mut self.load, factor.damping) {
                load.1 = damping;
            }
            self.layout.clone_from(state);
        }
        self.n_patterns = memory.n_patterns;
        self.n_factorisations = memory.n_factorisations;
        Ok(true)
    }

    pub(crate) fn new(fixed: Vec<bool>) -> Self {
        let floating = !fixed.iter().any(|&f| f);
        Self {
            fixed,
            floating,
            ..Self::default()
        }
    }

    /// The same for other vertices that are held.
    pub(crate) fn hold(&mut self, fixed: &[bool]) {
        self.fixed = fixed.to_vec();
        self.floating = !fixed.contains(&true);
    }

    /// The same with the drag on floating components of several.
    pub(crate) fn with_drag(mut self, drag: Option<Drag>) -> Self {
        self.drag = drag.map(|drag| DragCorrection::new(drag, 3));
        self
    }

    /// The same with the dashpot of a load.
    pub(crate) fn with_load(mut self, line: LoadLine) -> Self {
        self.load = Some((line, Matrix3::zeros()));
        self
    }

    /// Sets the resistance of the dashpot of a load before a matrix is made; with that of the spring it is in the stiffness.
    pub(crate) fn damp(&mut self, damping: Matrix3<f64>) {
        if let Some(load) = &mut self.load {
            load.1 = damping;
        }
    }

    /// Whether the dashpot of a load resists in another way by now than in the matrix, because its line has turned. A strong dashpot
    /// along a line that has turned by a few degrees lets the ends drift by many times the tolerance.
    pub(crate) fn is_stale(&self, damping: &Matrix3<f64>) -> bool {
        self.load
            .is_some_and(|(_, own)| (own - damping).norm() > LEAST_CHANGE)
    }

    /// Bytes held for further components.
    pub(crate) fn n_component_bytes(&self) -> usize {
        self.drag.as_ref().map_or(0, DragCorrection::n_bytes)
    }

    /// Grounds a floating rod by a trace only, for terms that may hold it as a whole: with their stiffness in the matrix a firm ground
    /// would be a spring at one vertex, and without it a trace is enough.
    pub(crate) fn loosen_ground(&mut self) {
        self.is_tethered = true;
    }

    pub(crate) fn n_nonzeros(&self) -> usize {
        self.solver
            .as_ref()
            .map_or(0, |s| s.n_nonzeros() + s.n_factor_nonzeros())
    }

    /// Assembles and factorises at a state; `stiffness` is H, `s` its factor, `couplings` the friction pairs.
    pub(crate) fn prepare(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        stiffness: &Stiffness,
        s: f64,
        couplings: &[(u32, u32, f64)],
    ) -> Result<(), SparseError> {
        let n = state.n_vertices();
        self.keep_pattern(state, pairs, stiffness)?;
        self.couplings.clear();
        self.couplings.extend_from_slice(couplings);
        self.layout.clone_from(state);
        let Some(solver) = self.solver.as_mut() else {
            return Ok(());
        };
        let values = solver.values_mut();
        values.fill(0.0);
        let identity = |c: f64| Matrix3::from_diagonal_element(c);
        self.driven.clear();
        let mut add = |block: usize, (a, b): (usize, usize), m: Matrix3<f64>, diagonal: bool| {
            match (self.fixed[a], self.fixed[b]) {
                (false, false) => {}
                (true, true) => return,
                (false, true) => return self.driven.push((a, b, m)),
                (true, false) => return self.driven.push((b, a, m.transpose())),
            }
            for (k, &slot) in self.blocks[block].iter().enumerate() {
                let (row, column) = (k / 3, k % 3);
                if !diagonal || row >= column {
                    values[slot] += m[(row, column)];
                }
            }
        };
        for i in 0..n {
            add(i, (i, i), stiffness.diagonal[i] * s, true);
        }
        for chain in state.components() {
            let viscous = identity(1.0 / chain.rest_length());
            for j in chain.edges() {
                let (a, b) = (j, chain.edge_end(j));
                add(a, (a, a), viscous, true);
                add(b, (b, b), viscous, true);
                add(n + j, (a, b), stiffness.next[j] * s - viscous, false);
            }
        }
        for (i, far) in second_neighbours(state) {
            add(2 * n + i, (i, far), stiffness.second[i] * s, false);
        }
        let active = pairs.active().iter().map(|p| (p.i, p.j));
        for ((place, pair), block) in (self.pairs.places(active))
            .zip(pairs.active())
            .zip(&stiffness.contact)
        {
            let (i, j) = (pair.i as usize, pair.j as usize);
            add(3 * n + place, (i, j), block * s, false);
        }
        let further = stiffness.further.iter().map(|p| (p.0, p.1));
        for (place, &(i, j, block)) in self.pairs.places(further).zip(&stiffness.further) {
            add(3 * n + place, (i as usize, j as usize), block * s, false);
        }
        let rubbing = couplings.iter().map(|c| (c.0, c.1));
        for (place, &(i, j, c)) in self.pairs.places(rubbing).zip(couplings) {
            let (i, j) = (i as usize, j as usize);
            add(i, (i, i), identity(c), true);
            add(j, (j, j), identity(c), true);
            add(3 * n + place, (i, j), identity(-c), false);
        }
        // a rod that its own terms may hold as a whole is grounded just enough to be solved for
        let trace = if self.is_tethered { LOOSE_GROUND } else { 1.0 };
        let (blocks, fixed) = (&self.blocks, &self.fixed);
        match &self.drag {
            Some(several) => hold(values, blocks, fixed, several.drag().grounds()),
            None => {
                let first = self
                    .floating
                    .then(|| (0, trace * (1.0 / state.rest_length())));
                hold(values, blocks, fixed, first.into_iter());
            }
        }
        self.n_factorisations += 1;
        solver.factor()?;
        if let Some(several) = &mut self.drag {
            several.prepare(solver);
        }
        Ok(())
    }

    /// Makes a new pattern where the present one cannot be used.
    fn keep_pattern(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        stiffness: &Stiffness,
    ) -> Result<(), SparseError> {
        let further = || stiffness.further.iter().map(|p| (p.0, p.1));
        let n = state.n_vertices();
        if self.solver.is_none() || !self.pairs.serve(n, pairs.active(), further()) {
            self.pairs.renew(state, pairs, further());
            self.build_pattern(state)?;
        }
        Ok(())
    }

    fn build_pattern(&mut self, state: &RodState) -> Result<(), SparseError> {
        let n = state.n_vertices();
        let mut blocks: Vec<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
        for chain in state.components() {
            let end = |j| {
                if chain.edges().contains(&j) {
                    chain.edge_end(j)
                } else {
                    j
                }
            };
            blocks.extend(chain.vertices().map(|j| (j, end(j))));
        }
        let mut second = vec![(0, 0); n];
        for (i, far) in second_neighbours(state) {
            second[i] = (i, far);
        }
        blocks.extend(second);
        blocks.extend(
            self.pairs
                .list()
                .iter()
                .map(|&(i, j)| (i as usize, j as usize)),
        );
        let pattern: Vec<(u32, u32)> = blocks.iter().map(|&(a, b)| (a as u32, b as u32)).collect();
        let solver = SparseCholesky::blocked(n, 3, &pattern)?;
        self.blocks.clear();
        self.blocks.extend(blocks.iter().map(|&(a, b)| {
            std::array::from_fn(|k| {
                solver
                    .slot(3 * a + k / 3, 3 * b + k % 3)
                    .unwrap_or_default()
            })
        }));
        self.solver = Some(solver);
        self.n_patterns += 1;
        Ok(())
    }

    /// r ← (M + s H)⁻¹ M r on a component-major vector; entries of held vertices stay as they are.
    pub(crate) fn solve(&mut self, r: &mut [f64]) {
        let n = self.layout.n_vertices();
        self.work.clear();
        self.work.extend_from_slice(&r[..3 * n]);
        self.right.clear();
        self.right.resize(3 * n, 0.0);
        for chain in self.layout.components() {
            let viscous = 1.0 / chain.rest_length();
            for j in chain.edges() {
                let edge = (j, chain.edge_end(j));
                multiply_pair(&self.work, &mut self.right, n, edge, viscous);
            }
        }
        for &(i, j, c) in &self.couplings {
            multiply_pair(&self.work, &mut self.right, n, (i as usize, j as usize), c);
        }
        if let Some(several) = &self.drag {
            several.drag().add_product(&self.work, &mut self.right);
        }
        if let Some((line, damping)) = &self.load {
            let push = damping * line.relative(&self.work, n);
            let ends = line.from.map(|i| (i, -1.0));
            for (i, side) in ends.into_iter().chain([(line.to, 1.0)]) {
                for k in 0..3 {
                    self.right[3 * i + k] += side * push[k];
                }
            }
        }
        for (free, held, block) in &self.driven {
            let w = Vector3::from_fn(|k, _| self.work[k * n + held]);
            let pull = block * w;
            for k in 0..3 {
                self.right[3 * free + k] -= pull[k];
            }
        }
        if let Some(solver) = self.solver.as_mut() {
            for i in (0..n).filter(|&i| self.fixed[i]) {
                for k in 0..3 {
                    self.right[3 * i + k] = 0.0;
                }
            }
            solver.solve_in_place(&mut self.right, 1);
        }
        if let Some(several) = &self.drag {
            several.correct(&mut self.right);
        }
        for i in (0..n).filter(|&i| !self.fixed[i]) {
            for k in 0..3 {
                r[k * n + i] = self.right[3 * i + k];
            }
        }
        match &self.drag {
            Some(several) => several.drag().keep_centroid(r),
            None if self.floating => remove_mean(r, n),
            None => {}
        }
    }
}

/// Closes the rows of held vertices by ones, and adds the `grounds` of what floats.
fn hold(
    values: &mut [f64],
    blocks: &[[usize; 9]],
    fixed: &[bool],
    grounds: impl Iterator<Item = (usize, f64)>,
) {
    let held = (0..fixed.len()).filter(|&i| fixed[i]).map(|i| (i, 1.0));
    for (i, value) in held.chain(grounds) {
        for k in [0, 4, 8] {
            values[blocks[i][k]] += value;
        }
    }
}

/// Ground of a rod that may be held as a whole, over its viscosity.
const LOOSE_GROUND: f64 = 1e-9;

/// Adds c (u_a − u_b)² as a matrix: component-major in, vertex-major out.
#[inline]
fn multiply_pair(u: &[f64], out: &mut [f64], n: usize, (a, b): (usize, usize), c: f64) {
    for k in 0..3 {
        let d = c * (u[k * n + a] - u[k * n + b]);
        out[3 * a + k] += d;
        out[3 * b + k] -= d;
    }
}

/// Pairs (i, i + 2) along each component.
fn second_neighbours(state: &RodState) -> impl Iterator<Item = (usize, usize)> {
    let along = |chain: &Chain| {
        let (first, n) = (chain.first(), chain.n_vertices());
        let n_pairs = if chain.is_closed() { n } else { n - 2 };
        (0..n_pairs).map(move |i| (first + i, first + (i + 2) % n))
    };
    state.components().iter().flat_map(along)
}

#[cfg(test)]
mod tests;
