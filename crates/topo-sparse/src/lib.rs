//! Sparse Cholesky factorisation with a fixed pattern: the one file that names faer.
//!
//! A separate crate, so that only crates that factorise wait for faer to be compiled.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltError as PivotError;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky, simplicial, supernodal,
};
use faer::sparse::linalg::{LltError, SupernodalThreshold, amd};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

use self::pattern::{checked_permutation, triangle};
use self::substitute::{Panel, substitute};

pub use error::SparseError;

mod error;
mod pattern;
mod substitute;

/// Where supernodes win, measured on contact graphs of knots with one and three unknowns per vertex: faer's own choice, made
/// for large matrices, comes too late for these.
const DENSE_ENOUGH: SupernodalThreshold = SupernodalThreshold(0.4);

/// Factor L L^T of a symmetric positive definite matrix whose pattern never changes.
///
/// ```math
/// P A P^T = L L^T
/// ```
///
/// The ordering P and the pattern of L are found once; [`factor`](Self::factor) and [`solve_in_place`](Self::solve_in_place)
/// then allocate nothing. Values are kept in the order of P, so that a new factorisation permutes nothing: look up their
/// indices with [`slot`](Self::slot) once at set-up. Entries of the pattern may be zero, so one pattern serves as long as a
/// contact list is valid. Everything runs on the calling thread: at these sizes a second thread makes it slower.
///
/// # Validation
/// `solves_what_it_multiplies`, `refuses_what_is_not_positive_definite`
pub struct SparseCholesky {
    symbolic: SymbolicCholesky<u32>,
    /// Permuted triangle: upper for the simplicial factor, lower for the supernodal one.
    pattern: SymbolicSparseColMat<u32>,
    upper: bool,
    values: Vec<f64>,
    factor_values: Vec<f64>,
    /// Caller's index of each permuted row, and its inverse.
    forward: Vec<u32>,
    inverse: Vec<u32>,
    /// Permuted right-hand sides.
    work: Vec<f64>,
    panels: Vec<Panel>,
    /// What a panel shares with the rows below it.
    outer: Vec<f64>,
    memory: MemBuffer,
    solvable_n_rhs: usize,
    /// Of each permuted row: where the matrix keeps its diagonal entry, and the factor its pivot.
    diagonal_slots: Vec<u32>,
    pivot_slots: Vec<u32>,
    factored: bool,
    n_factorisations: u64,
}

impl SparseCholesky {
    /// Sets up a matrix of `n` rows whose entries may differ from zero at `pattern` (either triangle, duplicates allowed) and
    /// on the diagonal; ordered by approximate minimum degree.
    ///
    /// # Errors
    /// [`SparseError`] when `n` is zero or beyond 32-bit indices, an entry lies outside, or memory runs out.
    pub fn new(n: usize, pattern: &[(u32, u32)]) -> Result<Self, SparseError> {
        Self::with_ordering(n, pattern, None)
    }

    /// As [`new`](Self::new), with the elimination order `ordering` (caller's indices, first eliminated first) if one is given.
    ///
    /// # Errors
    /// As [`new`](Self::new), and [`SparseError::Ordering`] when `ordering` is no permutation of 0..n.
    pub fn with_ordering(
        n: usize,
        pattern: &[(u32, u32)],
        ordering: Option<&[usize]>,
    ) -> Result<Self, SparseError> {
        Self::with_threshold(n, pattern, ordering, DENSE_ENOUGH)
    }

    /// As [`new`](Self::new) for `n_blocks` square blocks of `size` rows: `pattern` names pairs of blocks, which are ordered as
    /// units. This takes a fraction of the time and keeps blocks dense in the factor.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn blocked(
        n_blocks: usize,
        size: usize,
        pattern: &[(u32, u32)],
    ) -> Result<Self, SparseError> {
        let outside = |(i, j): &&(u32, u32)| *i as usize >= n_blocks || *j as usize >= n_blocks;
        if let Some(&(i, j)) = pattern.iter().find(outside) {
            return Err(SparseError::OutOfBounds {
                row: i as usize,
                column: j as usize,
                n: n_blocks,
            });
        }
        let n = n_blocks.saturating_mul(size);
        if n == 0 || n >= i32::MAX as usize {
            return Err(SparseError::Size { n });
        }
        let order = minimum_degree(
            n_blocks,
            &compressed(n_blocks, pattern.iter().copied(), true),
        )
        .ok_or(SparseError::OutOfMemory { n })?;
        let order: Vec<usize> = order
            .iter()
            .flat_map(|&b| (0..size).map(move |k| b as usize * size + k))
            .collect();
        let unit = size as u32;
        let diagonal = (0..n_blocks as u32).map(|i| (i, i));
        let full: Vec<(u32, u32)> = pattern
            .iter()
            .copied()
            .chain(diagonal)
            .flat_map(|(i, j)| {
                (0..unit * unit).map(move |k| (unit * i + k / unit, unit * j + k % unit))
            })
            .collect();
        Self::with_ordering(n, &full, Some(&order))
    }

    fn with_threshold(
        n: usize,
        pattern: &[(u32, u32)],
        ordering: Option<&[usize]>,
        threshold: SupernodalThreshold,
    ) -> Result<Self, SparseError> {
        check_size(n, pattern)?;
        let memory_error = || SparseError::OutOfMemory { n };
        let forward = match ordering {
            Some(order) => checked_permutation(n, order)?,
            None => minimum_degree(n, &compressed(n, pattern.iter().copied(), true))
                .ok_or_else(memory_error)?,
        };
        let mut inverse = vec![0_u32; n];
        for (new, old) in forward.iter().enumerate() {
            inverse[*old as usize] = new as u32;
        }
        let permuted = || {
            pattern
                .iter()
                .map(|(i, j)| (inverse[*i as usize], inverse[*j as usize]))
        };
        let upper_pattern = compressed(n, permuted(), true);
        let symbolic = symbolic(&upper_pattern, threshold).ok_or_else(memory_error)?;
        let upper = matches!(symbolic.raw(), SymbolicCholeskyRaw::Simplicial(_));
        let pattern = if upper {
            upper_pattern
        } else {
            compressed(n, permuted(), false)
        };
        let panels = panels(symbolic.raw());
        let mut cholesky = Self {
            values: vec![0.0; pattern.row_idx().len()],
            factor_values: vec![0.0; symbolic.len_val()],
            work: Vec::new(),
            outer: vec![0.0; n],
            memory: MemBuffer::new(StackReq::empty()),
            solvable_n_rhs: 0,
            diagonal_slots: (0..n).map(|k| diagonal_slot(&pattern, upper, k)).collect(),
            pivot_slots: pivot_slots(symbolic.raw(), &panels),
            panels,
            factored: false,
            n_factorisations: 0,
            symbolic,
            pattern,
            upper,
            forward,
            inverse,
        };
        cholesky.reserve(3);
        Ok(cholesky)
    }

    /// Room for factorising and for solving `n_rhs` right-hand sides at once.
    fn reserve(&mut self, n_rhs: usize) {
        let n = self.n_rows();
        let factor = match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(_) => {
                simplicial::factorize_simplicial_numeric_llt_scratch::<u32, f64>(n)
            }
            SymbolicCholeskyRaw::Supernodal(s) => {
                supernodal::factorize_supernodal_numeric_llt_scratch::<u32, f64>(
                    s,
                    Par::Seq,
                    Default::default(),
                )
            }
        };
        let solve = self.symbolic.solve_in_place_scratch::<f64>(n_rhs, Par::Seq);
        self.memory = MemBuffer::new(factor.or(solve));
        self.work = vec![0.0; n * n_rhs];
        self.solvable_n_rhs = n_rhs;
    }

    /// Number of rows.
    pub fn n_rows(&self) -> usize {
        self.forward.len()
    }

    /// Index into the values of entry (`i`, `j`), which is the same as (`j`, `i`); `None` outside the pattern.
    ///
    /// A binary search: look slots up at set-up, not in loops.
    pub fn slot(&self, i: usize, j: usize) -> Option<usize> {
        let (p, q) = (*self.inverse.get(i)?, *self.inverse.get(j)?);
        let (row, column) = if (p <= q) == self.upper {
            (p, q)
        } else {
            (q, p)
        };
        let range = self.pattern.as_ref().col_range(column as usize);
        let within = self.pattern.row_idx()[range.clone()]
            .binary_search(&row)
            .ok()?;
        Some(range.start + within)
    }

    /// Values of the matrix, indexed by [`slot`](Self::slot); an entry off the diagonal is stored once.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Values of the matrix, to be written before [`factor`](Self::factor).
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Number of stored entries: the pattern's triangle with its diagonal.
    pub fn n_nonzeros(&self) -> usize {
        self.values.len()
    }

    /// Number of stored entries of the factor (a supernodal factor also stores some zeros).
    pub fn n_factor_nonzeros(&self) -> usize {
        self.factor_values.len()
    }

    /// How often [`factor`](Self::factor) was called: the cost of a run in factorisations.
    pub fn n_factorisations(&self) -> u64 {
        self.n_factorisations
    }

    /// Factorises the present values.
    ///
    /// # Errors
    /// [`SparseError::NotFinite`] names the entry that is NaN or infinite, [`SparseError::NotPositiveDefinite`] the column
    /// (both in the caller's numbering) at which a pivot fails.
    pub fn factor(&mut self) -> Result<(), SparseError> {
        self.n_factorisations += 1;
        self.factored = false;
        if let Some(slot) = self.values.iter().position(|v| !v.is_finite()) {
            let (row, column) = self.place_of(slot);
            return Err(SparseError::NotFinite { row, column });
        }
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), self.values.as_slice());
        let stack = MemStack::new(&mut self.memory);
        let out = &mut self.factor_values;
        let outcome = match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(s) => simplicial::factorize_simplicial_numeric_llt(
                out,
                matrix,
                Default::default(),
                s,
                stack,
            )
            .map_err(LltError::from),
            SymbolicCholeskyRaw::Supernodal(s) => supernodal::factorize_supernodal_numeric_llt(
                out,
                matrix,
                Default::default(),
                s,
                Par::Seq,
                stack,
                Default::default(),
            )
            .map_err(LltError::from),
        };
        match outcome {
            Ok(_) => {}
            Err(LltError::Numeric(PivotError::NonPositivePivot { index })) => {
                // The simplicial code counts from one, the dense kernel of the supernodal code from zero.
                let column = if self.upper {
                    index.saturating_sub(1)
                } else {
                    index
                };
                let column = self.forward[column.min(self.n_rows() - 1)] as usize;
                return Err(SparseError::NotPositiveDefinite { column });
            }
            Err(LltError::Generic(_)) => return Err(SparseError::OutOfMemory { n: self.n_rows() }),
        }
        self.check_pivots()?;
        self.factored = true;
        Ok(())
    }

    /// Refuses a pivot that is rounding noise of its diagonal: it passes the sign test by luck alone.
    fn check_pivots(&self) -> Result<(), SparseError> {
        let noise = f64::EPSILON * self.n_rows() as f64;
        let slots = self.diagonal_slots.iter().zip(&self.pivot_slots);
        for (column, (diagonal, pivot)) in slots.enumerate() {
            let pivot = self.factor_values[*pivot as usize];
            if !pivot.is_finite() || pivot * pivot <= noise * self.values[*diagonal as usize] {
                let column = self.forward[column] as usize;
                return Err(SparseError::NotPositiveDefinite { column });
            }
        }
        Ok(())
    }

    /// Replaces the `n_rhs` right-hand sides, stored column after column in `rhs`, by the solutions.
    ///
    /// # Panics
    /// When the last [`factor`](Self::factor) failed or was never called, or `rhs` is not n x `n_rhs` long.
    pub fn solve_in_place(&mut self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n_rows();
        assert!(self.factored, "solve without a factor");
        assert_eq!(rhs.len(), n * n_rhs, "right-hand sides of wrong length");
        if n_rhs > self.solvable_n_rhs {
            self.reserve(n_rhs);
        }
        let work = &mut self.work[..n * n_rhs];
        for (permuted, given) in work.chunks_exact_mut(n).zip(rhs.chunks_exact(n)) {
            for (x, old) in permuted.iter_mut().zip(&self.forward) {
                *x = given[*old as usize];
            }
        }
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(_) => {
                let matrix = MatMut::from_column_major_slice_mut(work, n, n_rhs);
                let stack = MemStack::new(&mut self.memory);
                LltRef::new(&self.symbolic, &self.factor_values).solve_in_place_with_conj(
                    Conj::No,
                    matrix,
                    Par::Seq,
                    stack,
                );
            }
            SymbolicCholeskyRaw::Supernodal(_) => {
                for x in work.chunks_exact_mut(n) {
                    substitute(&self.panels, &self.factor_values, x, &mut self.outer);
                }
            }
        }
        for (permuted, solved) in work.chunks_exact(n).zip(rhs.chunks_exact_mut(n)) {
            for (x, new) in solved.iter_mut().zip(&self.inverse) {
                *x = permuted[*new as usize];
            }
        }
    }

    /// `y = A x` with the present values.
    ///
    /// # Panics
    /// When `x` or `y` is not n long.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let n = self.n_rows();
        assert!(x.len() == n && y.len() == n, "vectors of wrong length");
        y.fill(0.0);
        let rows = self.pattern.row_idx();
        for column in 0..n {
            let j = self.forward[column] as usize;
            let mut sum = 0.0;
            for slot in self.pattern.as_ref().col_range(column) {
                let i = self.forward[rows[slot] as usize] as usize;
                sum += self.values[slot] * x[i];
                if i != j {
                    y[i] += self.values[slot] * x[j];
                }
            }
            y[j] += sum;
        }
    }

    /// Caller's row and column of a slot, the larger first.
    fn place_of(&self, slot: usize) -> (usize, usize) {
        let column = self
            .pattern
            .col_ptr()
            .partition_point(|start| *start as usize <= slot)
            - 1;
        let i = self.forward[self.pattern.row_idx()[slot] as usize] as usize;
        let j = self.forward[column] as usize;
        (i.max(j), i.min(j))
    }
}

impl std::fmt::Debug for SparseCholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SparseCholesky")
            .field("n_rows", &self.n_rows())
            .field("n_nonzeros", &self.n_nonzeros())
            .field("n_factor_nonzeros", &self.n_factor_nonzeros())
            .field("supernodal", &!self.upper)
            .field("n_factorisations", &self.n_factorisations)
            .finish()
    }
}

/// The symbolic factor of a pattern as it is ordered; none where memory does not suffice.
fn symbolic(
    upper: &SymbolicSparseColMat<u32>,
    threshold: SupernodalThreshold,
) -> Option<SymbolicCholesky<u32>> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: threshold,
        ..Default::default()
    };
    let ordering = SymmetricOrdering::Identity;
    factorize_symbolic_cholesky(upper.as_ref(), Side::Upper, ordering, params).ok()
}

/// Refuses an empty or a too large matrix, and entries outside of it.
fn check_size(n: usize, pattern: &[(u32, u32)]) -> Result<(), SparseError> {
    if n == 0 || n >= i32::MAX as usize {
        return Err(SparseError::Size { n });
    }
    let outside = |(i, j): &&(u32, u32)| *i as usize >= n || *j as usize >= n;
    match pattern.iter().find(outside) {
        Some(&(i, j)) => Err(SparseError::OutOfBounds {
            row: i as usize,
            column: j as usize,
            n,
        }),
        None => Ok(()),
    }
}

/// One triangle of a symmetric pattern with its diagonal, as faer expects it.
fn compressed(
    n: usize,
    entries: impl Iterator<Item = (u32, u32)> + Clone,
    upper: bool,
) -> SymbolicSparseColMat<u32> {
    let (starts, rows) = triangle(n, entries, upper);
    SymbolicSparseColMat::new_checked(n, n, starts, None, rows)
}

/// The diagonal entry closes a column of the upper triangle and opens one of the lower.
fn diagonal_slot(pattern: &SymbolicSparseColMat<u32>, upper: bool, column: usize) -> u32 {
    let starts = pattern.col_ptr();
    if upper {
        starts[column + 1] - 1
    } else {
        starts[column]
    }
}

/// The panels of a supernodal factor; none of a simplicial one.
fn panels(symbolic: &SymbolicCholeskyRaw<u32>) -> Vec<Panel> {
    let SymbolicCholeskyRaw::Supernodal(s) = symbolic else {
        return Vec::new();
    };
    let panel = |node: usize| Panel {
        begin: s.supernode_begin()[node] as usize,
        end: s.supernode_end()[node] as usize,
        start: s.col_ptr_for_val()[node] as usize,
        below: s.supernode(node).pattern().to_vec(),
    };
    (0..s.n_supernodes()).map(panel).collect()
}

/// Where the factor keeps the diagonal entry of each column.
fn pivot_slots(symbolic: &SymbolicCholeskyRaw<u32>, panels: &[Panel]) -> Vec<u32> {
    match symbolic {
        SymbolicCholeskyRaw::Simplicial(s) => s.col_ptr()[..s.ncols()].to_vec(),
        SymbolicCholeskyRaw::Supernodal(_) => {
            let of_panel = |p: &Panel| {
                let (start, stride) = (p.start, p.n_rows() + 1);
                (0..p.n_columns()).map(move |k| (start + k * stride) as u32)
            };
            panels.iter().flat_map(of_panel).collect()
        }
    }
}

/// Approximate minimum degree ordering of an upper triangle; `None` when memory runs out.
fn minimum_degree(n: usize, upper: &SymbolicSparseColMat<u32>) -> Option<Vec<u32>> {
    let (mut forward, mut inverse) = (vec![0_u32; n], vec![0_u32; n]);
    let scratch = amd::order_maybe_unsorted_scratch::<u32>(n, upper.row_idx().len());
    let mut memory = MemBuffer::try_new(scratch).ok()?;
    let stack = MemStack::new(&mut memory);
    amd::order_maybe_unsorted(
        &mut forward,
        &mut inverse,
        upper.as_ref(),
        amd::Control::default(),
        stack,
    )
    .ok()?;
    Some(forward)
}

#[cfg(test)]
mod tests;
