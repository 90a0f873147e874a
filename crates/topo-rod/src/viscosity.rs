//! Internal viscosity: what resists motion of the centreline and rotation of the edges.
//!
//! The damping is internal, so it does not resist a translation: one vertex is grounded, which for a balanced force is the
//! exact solution with that vertex at rest, and the mean velocity is then removed. Several components are grounded each, and get the
//! velocity of each by their drag (`drag.rs`).

mod twist;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use topo_sparse::{SparseCholesky, SparseError};

use crate::contact::{ContactPairs, KnownPairs};
use crate::drag::{Drag, DragCorrection};
use crate::friction::Friction;
use crate::load::{LoadCorrection, LoadLine};
use crate::{Chain, Layout, RodState};

pub use twist::TwistViscosity;

/// Mobility of the centreline: turns forces f into velocities v, the three components at once.
///
/// ```math
/// (\eta K + \eta_f C)\, v = f, \qquad v \cdot K v = \sum_j \frac{|v_{j+1} - v_j|^2}{l_0}
/// ```
///
/// K is the stiffness matrix of −d²/ds² on the natural arclength, C the matrix of the [friction](crate::friction::Friction).
#[derive(Debug)]
pub struct CentrelineViscosity {
    solver: Option<SparseCholesky>,
    diagonal: Vec<usize>,
    next: Vec<usize>,
    pairs: KnownPairs,
    /// Where the matrix keeps the entry of each pair.
    rubbing: Vec<usize>,
    fixed: Vec<bool>,
    grounded: bool,
    drag: Option<DragCorrection>,
    load: Option<LoadCorrection>,
    is_current: bool,
    n_patterns: u64,
    n_factorisations: u64,
}

/// What the mobility remembers of its patterns.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct MobilityMemory {
    pub(crate) pairs: KnownPairs,
    has_pattern: bool,
    n_patterns: u64,
    n_factorisations: u64,
}

impl CentrelineViscosity {
    /// What it remembers: without friction its matrix is constant, with friction it is assembled at every state.
    pub(crate) fn memory(&self) -> MobilityMemory {
        MobilityMemory {
            pairs: self.pairs.clone(),
            has_pattern: self.solver.is_some(),
            n_patterns: self.n_patterns,
            n_factorisations: self.n_factorisations,
        }
    }

    /// Makes the pattern again that was remembered, and the matrix where it is constant.
    pub(crate) fn recall(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        friction: Option<Friction>,
        memory: MobilityMemory,
    ) -> Result<(), SparseError> {
        self.pairs = memory.pairs;
        if memory.has_pattern {
            self.build_pattern(state)?;
            if friction.is_none() {
                self.prepare(state, pairs, None)?;
            }
        }
        self.n_patterns = memory.n_patterns;
        self.n_factorisations = memory.n_factorisations;
        Ok(())
    }

    /// For a rod whose vertices marked in `fixed` have a prescribed velocity.
    pub fn new(fixed: Vec<bool>) -> Self {
        let grounded = !fixed.iter().any(|&f| f);
        Self {
            solver: None,
            diagonal: Vec::new(),
            next: Vec::new(),
            pairs: KnownPairs::default(),
            rubbing: Vec::new(),
            fixed,
            grounded,
            drag: None,
            load: None,
            is_current: false,
            n_patterns: 0,
            n_factorisations: 0,
        }
    }

    /// The same for other vertices that are held.
    pub(crate) fn hold(&mut self, fixed: &[bool]) {
        self.fixed = fixed.to_vec();
        self.grounded = !fixed.contains(&true);
        self.is_current = false;
    }

    /// The same with the drag on floating components of several.
    pub(crate) fn with_drag(mut self, drag: Option<Drag>) -> Self {
        self.drag = drag.map(|drag| DragCorrection::new(drag, 1));
        self
    }

    /// The same with the dashpot of a load.
    pub(crate) fn with_load(mut self, line: LoadLine) -> Self {
        self.load = Some(LoadCorrection::new(line));
        self
    }

    /// The dashpot of a load, if there is one.
    pub(crate) fn load(&self) -> Option<&LoadCorrection> {
        self.load.as_ref()
    }

    /// Sets the resistance of the dashpot of a load for the next solutions.
    pub(crate) fn damp(&mut self, damping: Matrix3<f64>) {
        if let Some(load) = &mut self.load {
            load.damping = damping;
        }
    }

    /// The drag on floating components, if there are several.
    pub(crate) fn drag(&self) -> Option<&DragCorrection> {
        self.drag.as_ref()
    }

    /// How often a matrix was factorised.
    pub fn n_factorisations(&self) -> u64 {
        self.n_factorisations
    }

    /// Number of stored values of matrix and factor.
    pub fn n_nonzeros(&self) -> usize {
        self.solver
            .as_ref()
            .map_or(0, |s| s.n_nonzeros() + s.n_factor_nonzeros())
    }

    /// Whether no vertex is held, so that only velocities up to a common one are defined.
    pub fn is_floating(&self) -> bool {
        self.grounded
    }

    /// How often a pattern was made, which without friction is once.
    pub fn n_patterns(&self) -> u64 {
        self.n_patterns
    }

    /// Finds a pattern of entries, unless the present one can be used.
    fn keep_pattern(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        rubs: bool,
    ) -> Result<(), SparseError> {
        let (n, none) = (state.n_vertices(), std::iter::empty);
        if self.solver.is_none() || rubs && !self.pairs.serve(n, pairs.active(), none()) {
            if rubs {
                self.pairs.renew(state, pairs, none());
            }
            self.build_pattern(state)?;
        }
        Ok(())
    }

    /// Assembles and factorises the matrix at a state. Without friction it is constant and factorised once.
    ///
    /// # Errors
    /// [`SparseError`] when the matrix cannot be factorised.
    pub fn prepare(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        friction: Option<Friction>,
    ) -> Result<(), SparseError> {
        let rubs = friction.is_some();
        self.keep_pattern(state, pairs, rubs)?;
        if self.is_current && !rubs {
            return Ok(());
        }
        let Some(solver) = self.solver.as_mut() else {
            return Ok(());
        };
        let values = solver.values_mut();
        values.fill(0.0);
        for chain in state.components() {
            let stiffness = 1.0 / chain.rest_length();
            for j in chain.edges() {
                let (a, b) = (j, chain.edge_end(j));
                couple(
                    values,
                    &self.fixed,
                    (self.diagonal[a], self.diagonal[b], self.next[j]),
                    (a, b),
                    stiffness,
                );
            }
        }
        if let Some(friction) = friction {
            // both lists ascend; the active pairs are a part of the known ones
            let active = pairs.active().iter().map(|p| (p.i, p.j));
            for (place, pair) in self.pairs.places(active).zip(pairs.active()) {
                let c = friction.coefficient(pair);
                if c > 0.0 {
                    let (a, b) = (pair.i as usize, pair.j as usize);
                    couple(
                        values,
                        &self.fixed,
                        (self.diagonal[a], self.diagonal[b], self.rubbing[place]),
                        (a, b),
                        c,
                    );
                }
            }
        }
        for (i, &fixed) in self.fixed.iter().enumerate() {
            if fixed {
                values[self.diagonal[i]] = 1.0;
            }
        }
        match &self.drag {
            Some(several) => {
                let grounds = several.drag().grounds();
                grounds.for_each(|(i, ground)| values[self.diagonal[i]] += ground);
            }
            None if self.grounded => values[self.diagonal[0]] += 1.0 / state.rest_length(),
            None => {}
        }
        self.n_factorisations += 1;
        self.is_current = true;
        solver.factor()?;
        if let Some(several) = &mut self.drag {
            several.prepare(solver);
        }
        if let Some(load) = &mut self.load {
            let column = load.unit(&self.fixed);
            solver.solve_in_place(column, 1);
            if let Some(several) = &self.drag {
                several.correct(column);
            }
        }
        Ok(())
    }

    fn build_pattern(&mut self, layout: &Layout) -> Result<(), SparseError> {
        let n = layout.n_vertices();
        let edges = || {
            let chains = layout.components().iter();
            chains.flat_map(|chain| chain.edges().map(|j| (j, chain.edge_end(j))))
        };
        let mut pattern: Vec<(u32, u32)> = edges().map(|(a, b)| (a as u32, b as u32)).collect();
        pattern.extend(self.pairs.list());
        let solver = SparseCholesky::new(n, &pattern)?;
        let slot = |i: usize, j: usize| solver.slot(i, j).unwrap_or_default();
        self.diagonal = (0..n).map(|i| slot(i, i)).collect();
        self.next = vec![0; layout.n_edges()];
        edges().for_each(|(a, b)| self.next[a] = slot(a, b));
        self.rubbing.clear();
        let pairs = self.pairs.list().iter();
        self.rubbing
            .extend(pairs.map(|&(i, j)| slot(i as usize, j as usize)));
        self.solver = Some(solver);
        self.n_patterns += 1;
        Ok(())
    }

    /// Turns forces into velocities, component-major 3 × n; entries of held vertices come in as their prescribed velocity.
    pub fn solve(&mut self, layout: &Layout, couplings: &[(u32, u32, f64)], v: &mut [f64]) {
        let n = layout.n_vertices();
        if !self.grounded {
            let held: Vec<[f64; 3]> = (0..n)
                .map(|i| {
                    if self.fixed[i] {
                        [v[i], v[n + i], v[2 * n + i]]
                    } else {
                        [0.0; 3]
                    }
                })
                .collect();
            let along = |chain: &Chain| {
                let (chain, stiffness) = (*chain, 1.0 / chain.rest_length());
                let edges = chain.edges();
                edges.map(move |j| (j as u32, chain.edge_end(j) as u32, stiffness))
            };
            let edges = layout.components().iter().flat_map(along);
            for (i, j, c) in edges.chain(couplings.iter().copied()) {
                for (a, b) in [(i as usize, j as usize), (j as usize, i as usize)] {
                    if self.fixed[a] && !self.fixed[b] {
                        for k in 0..3 {
                            v[k * n + b] += c * held[a][k];
                        }
                    }
                }
            }
        }
        if let Some(solver) = self.solver.as_mut() {
            solver.solve_in_place(v, 3);
        }
        if let Some(several) = &self.drag {
            several.correct(v);
        }
        if let Some(load) = &self.load {
            load.correct(v);
        }
        match &self.drag {
            Some(several) => several.drag().keep_centroid(v),
            None if self.grounded => remove_mean(v, n),
            None => {}
        }
    }
}

/// Adds c (u_a − u_b)² to the quadratic form, leaving rows of held vertices out.
#[inline]
fn couple(
    values: &mut [f64],
    fixed: &[bool],
    slots: (usize, usize, usize),
    (a, b): (usize, usize),
    c: f64,
) {
    values[slots.0] += c;
    values[slots.1] += c;
    if !fixed[a] && !fixed[b] {
        values[slots.2] -= c;
    }
}

/// Takes the mean of each component out of a component-major vector.
pub(crate) fn remove_mean(v: &mut [f64], n: usize) {
    for component in v[..3 * n].chunks_exact_mut(n) {
        let mean = component.iter().sum::<f64>() / n as f64;
        component.iter_mut().for_each(|c| *c -= mean);
    }
}

/// u·K v of two component-major displacements or velocities.
pub fn centreline_form(layout: &Layout, u: &[f64], v: &[f64]) -> f64 {
    let n = layout.n_vertices();
    let of = |chain: &Chain| {
        let mut sum = 0.0;
        for j in chain.edges() {
            let b = chain.edge_end(j);
            let along = |w: &[f64], k: usize| w[k * n + b] - w[k * n + j];
            sum += (0..3).map(|k| along(u, k) * along(v, k)).sum::<f64>();
        }
        sum / chain.rest_length()
    };
    layout.components().iter().map(of).sum()
}

/// u·M_θ w of edge rotations, with c_i the cosine of the turning angle at vertex i.
///
/// ```math
/// w \cdot M_\theta w = \frac{\eta}{2 l_0} \sum_i |w_i t_i - w_{i-1} t_{i-1}|^2
/// ```
pub fn twist_form(layout: &Layout, cosine: impl Fn(usize) -> f64, u: &[f64], w: &[f64]) -> f64 {
    let of = |chain: &Chain| {
        let terms = chain.interior().map(|i| {
            let before = chain.edge_before(i);
            u[before] * w[before] + u[i] * w[i] - cosine(i) * (u[before] * w[i] + u[i] * w[before])
        });
        terms.sum::<f64>() / (2.0 * chain.rest_length())
    };
    layout.components().iter().map(of).sum()
}
