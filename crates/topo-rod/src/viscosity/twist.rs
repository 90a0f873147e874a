//! What resists the rotation of the edges.

use topo_sparse::{SparseCholesky, SparseError};

use crate::{Chain, Layout};

/// Twist viscosity, optionally with a multiple of the twist stiffness: solves (M_θ + s H_θ) w = q, a (cyclic) tridiagonal system.
#[derive(Debug)]
pub struct TwistViscosity {
    solver: Option<SparseCholesky>,
    diagonal: Vec<usize>,
    next: Vec<usize>,
    fixed: Vec<bool>,
    /// Vertices at which the turn of two ends against each other is an unknown too.
    loose: Vec<usize>,
    n_factorisations: u64,
}

impl TwistViscosity {
    /// Bytes held by the matrix, its factor and where their entries are.
    pub fn n_bytes(&self) -> usize {
        let matrix = self
            .solver
            .as_ref()
            .map_or(0, |s| s.n_nonzeros() + s.n_factor_nonzeros());
        size_of::<f64>() * matrix
            + size_of::<usize>() * (self.diagonal.capacity() + self.next.capacity())
    }

    /// For a rod whose edges marked in `fixed` have a prescribed rotation.
    pub fn new(fixed: Vec<bool>) -> Self {
        Self {
            solver: None,
            diagonal: Vec::new(),
            next: Vec::new(),
            fixed,
            loose: Vec::new(),
            n_factorisations: 0,
        }
    }

    /// The same with the joints at the first vertices `seams` of closed components loose: a torque turns their ends against each other.
    pub(crate) fn loosen(&mut self, seams: &[usize]) {
        self.loose = seams.to_vec();
    }

    /// Whether the joint at vertex `i` is loose.
    pub(crate) fn is_loose(&self, i: usize) -> bool {
        self.loose.contains(&i)
    }

    /// The same for other edges that are held.
    pub(crate) fn hold(&mut self, fixed: &[bool]) {
        self.fixed = fixed.to_vec();
    }

    /// How often a matrix was factorised.
    pub fn n_factorisations(&self) -> u64 {
        self.n_factorisations
    }

    /// Whether a matrix was factorised, and how often.
    pub(crate) fn memory(&self) -> Option<u64> {
        self.solver.as_ref().map(|_| self.n_factorisations)
    }

    /// Makes a matrix again, as [`prepare`](Self::prepare), where one was remembered.
    pub(crate) fn recall(
        &mut self,
        layout: &Layout,
        cosine: &[f64],
        stiffness: f64,
        memory: Option<u64>,
    ) -> Result<(), SparseError> {
        if let Some(n_factorisations) = memory {
            self.prepare(layout, cosine, stiffness)?;
            self.n_factorisations = n_factorisations;
        }
        Ok(())
    }

    /// Assembles and factorises M_θ + `stiffness` Σ_i (w_i − w_{i−1})². Of several components, `stiffness` is that of the first; it
    /// is inverse to the natural length of an edge.
    ///
    /// # Errors
    /// [`SparseError`] when the matrix cannot be factorised.
    pub fn prepare(
        &mut self,
        layout: &Layout,
        cosine: &[f64],
        stiffness: f64,
    ) -> Result<(), SparseError> {
        if self.solver.is_none() {
            self.build_pattern(layout)?;
        }
        let Some(solver) = self.solver.as_mut() else {
            return Ok(());
        };
        let values = solver.values_mut();
        values.fill(0.0);
        for (chain, stiffness) in stiffnesses(layout, stiffness) {
            let half = 0.5 / chain.rest_length();
            for i in chain.interior() {
                let (a, b) = (chain.edge_before(i), i);
                if self.loose.contains(&i) {
                    let coupling = half * cosine[i] + stiffness;
                    values[self.diagonal[a]] +=
                        half + stiffness - coupling * coupling / (half + stiffness);
                    continue;
                }
                values[self.diagonal[a]] += half + stiffness;
                values[self.diagonal[b]] += half + stiffness;
                if !self.fixed[a] && !self.fixed[b] {
                    values[self.next[i]] -= half * cosine[i] + stiffness;
                }
            }
        }
        for (j, &fixed) in self.fixed.iter().enumerate() {
            // a straight free rod spins about itself at no cost; the torques of its edges sum to zero, so a trace of
            // resistance fixes the spin at none
            values[self.diagonal[j]] = if fixed {
                1.0
            } else {
                values[self.diagonal[j]] * (1.0 + 1e-11)
            };
        }
        self.n_factorisations += 1;
        solver.factor()
    }

    fn build_pattern(&mut self, layout: &Layout) -> Result<(), SparseError> {
        let joints = || {
            let chains = layout.components().iter();
            chains.flat_map(|chain| chain.interior().map(|i| (chain.edge_before(i), i)))
        };
        let n = layout.n_edges();
        let pattern: Vec<(u32, u32)> = joints().map(|(a, b)| (a as u32, b as u32)).collect();
        let solver = SparseCholesky::new(n, &pattern)?;
        let slot = |a: usize, b: usize| solver.slot(a, b).unwrap_or_default();
        self.diagonal = (0..n).map(|j| slot(j, j)).collect();
        self.next = vec![0; layout.n_vertices()];
        joints().for_each(|(a, b)| self.next[b] = slot(a, b));
        self.solver = Some(solver);
        Ok(())
    }

    /// Turns torques into rotation rates; entries of held edges come in as their prescribed rate.
    ///
    /// At a loose joint the ends turn against each other by φ̇ besides, which is eliminated: with c the cosine, s the stiffness and P the
    /// torque that its own equation leaves to be balanced,
    ///
    /// ```math
    /// \left(\tfrac{1}{2 l_0} + s\right) (w_0 + \dot\varphi) - \left(\tfrac{c}{2 l_0} + s\right) w_{-1} = P
    /// ```
    ///
    /// `joints` has P of each and becomes φ̇; what is behind them stays.
    pub fn solve(
        &mut self,
        layout: &Layout,
        cosine: &[f64],
        stiffness: f64,
        w: &mut [f64],
        joints: &mut [f64],
    ) {
        if self.fixed.iter().any(|&f| f) {
            for (chain, stiffness) in stiffnesses(layout, stiffness) {
                let half = 0.5 / chain.rest_length();
                for i in chain.interior() {
                    for (a, b) in [(chain.edge_before(i), i), (i, chain.edge_before(i))] {
                        if self.fixed[a] && !self.fixed[b] {
                            w[b] += (half * cosine[i] + stiffness) * w[a];
                        }
                    }
                }
            }
        }
        let loose = |(k, &seam): (usize, &usize)| {
            let chain = layout.chain_of(seam);
            let stiffness =
                stiffness * (layout.components()[0].rest_length() / chain.rest_length());
            let half = 0.5 / chain.rest_length();
            let (own, coupling) = (half + stiffness, half * cosine[seam] + stiffness);
            (k, seam, chain.edge_before(seam), own, coupling)
        };
        for (k, seam, before, own, coupling) in self.loose.iter().enumerate().map(loose) {
            w[seam] -= joints[k];
            w[before] += coupling / own * joints[k];
        }
        if let Some(solver) = self.solver.as_mut() {
            solver.solve_in_place(w, 1);
        }
        for (k, seam, before, own, coupling) in self.loose.iter().enumerate().map(loose) {
            joints[k] = (joints[k] + coupling * w[before]) / own - w[seam];
        }
    }
}

/// Each component with its stiffness of a joint, by that of the first one.
fn stiffnesses(layout: &Layout, first: f64) -> impl Iterator<Item = (&Chain, f64)> {
    let chains = layout.components();
    let rest_length = chains.first().map_or(0.0, Chain::rest_length);
    let of = move |chain: &Chain| first * (rest_length / chain.rest_length());
    chains.iter().map(move |chain| (chain, of(chain)))
}
