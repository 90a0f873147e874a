//! The matrix of the linearly implicit steps on the rotations of the edges.

use serde::{Deserialize, Serialize};
use topo_sparse::SparseError;

use crate::Layout;
use crate::viscosity::TwistViscosity;

/// The matrix of the linearly implicit steps on the edge rotations, M_θ + s H_θ with H_θ of the twist energy.
#[derive(Debug)]
pub(crate) struct NewtonTwist {
    viscosity: TwistViscosity,
    layout: Layout,
    cosine: Vec<f64>,
    stiffness: f64,
    held: Vec<bool>,
    work: Vec<f64>,
}

/// What the twist matrix remembers: of what it was made.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct NewtonTwistMemory {
    cosine: Vec<f64>,
    stiffness: f64,
    n_factorisations: Option<u64>,
}

impl NewtonTwistMemory {
    /// Whether it is that of a rod of `n` vertices; values that are not finite are refused when they are factorised.
    pub(crate) fn is_of(&self, n: usize) -> bool {
        self.cosine.len()
            == if self.n_factorisations.is_some() {
                n
            } else {
                0
            }
    }
}

impl NewtonTwist {
    /// What it remembers.
    pub(crate) fn memory(&self) -> NewtonTwistMemory {
        NewtonTwistMemory {
            cosine: self.cosine.clone(),
            stiffness: self.stiffness,
            n_factorisations: self.viscosity.memory(),
        }
    }

    /// Makes the matrix again that was remembered.
    pub(crate) fn recall(
        &mut self,
        layout: &Layout,
        memory: NewtonTwistMemory,
    ) -> Result<(), SparseError> {
        if memory.n_factorisations.is_some() {
            self.layout.clone_from(layout);
            self.stiffness = memory.stiffness;
            self.work = vec![0.0; layout.n_edges()];
        }
        self.cosine = memory.cosine;
        self.viscosity.recall(
            layout,
            &self.cosine,
            self.stiffness,
            memory.n_factorisations,
        )
    }

    pub(crate) fn new(held: Vec<bool>) -> Self {
        let viscosity = TwistViscosity::new(held.clone());
        Self {
            viscosity,
            layout: Layout::default(),
            cosine: Vec::new(),
            stiffness: 0.0,
            held,
            work: Vec::new(),
        }
    }

    /// The same for other edges that are held.
    pub(crate) fn hold(&mut self, fixed: &[bool]) {
        self.held = fixed.to_vec();
        self.viscosity.hold(fixed);
    }

    /// The same with other joints that are [loose](TwistViscosity::loosen).
    pub(crate) fn loosen(&mut self, seams: &[usize]) {
        self.viscosity.loosen(seams);
    }

    pub(crate) fn n_factorisations(&self) -> u64 {
        self.viscosity.n_factorisations()
    }

    pub(crate) fn n_bytes(&self) -> usize {
        let vectors = self.cosine.capacity() + self.work.capacity();
        self.viscosity.n_bytes() + size_of::<f64>() * vectors
    }

    pub(crate) fn prepare(
        &mut self,
        layout: &Layout,
        cosine: &[f64],
        stiffness: f64,
    ) -> Result<(), SparseError> {
        self.layout.clone_from(layout);
        self.cosine.clear();
        self.cosine.extend_from_slice(cosine);
        self.stiffness = stiffness;
        self.viscosity.prepare(layout, cosine, stiffness)
    }

    /// w ← (M_θ + s H_θ)⁻¹ M_θ w, with the turns of loose joints in `joints`; entries of held edges stay as they are.
    pub(crate) fn solve(&mut self, w: &mut [f64], joints: &mut [f64]) {
        self.work.clear();
        self.work.extend_from_slice(w);
        let right = &mut *w;
        let given: Vec<(usize, f64)> = self
            .held
            .iter()
            .enumerate()
            .filter(|h| *h.1)
            .map(|(j, _)| (j, right[j]))
            .collect();
        right.fill(0.0);
        let mut loose = joints.iter_mut();
        for chain in self.layout.components() {
            let half = 0.5 / chain.rest_length();
            for i in chain.interior() {
                let (a, b) = (chain.edge_before(i), i);
                let (before, mut behind) = (self.work[a], self.work[b]);
                if self.viscosity.is_loose(i)
                    && let Some(turn) = loose.next()
                {
                    behind += *turn;
                    *turn = half * (behind - self.cosine[i] * before);
                }
                right[a] += half * (before - self.cosine[i] * behind);
                right[b] += half * (behind - self.cosine[i] * before);
            }
        }
        given.iter().for_each(|g| right[g.0] = g.1);
        self.viscosity
            .solve(&self.layout, &self.cosine, self.stiffness, right, joints);
        given.iter().for_each(|g| right[g.0] = g.1);
    }
}
