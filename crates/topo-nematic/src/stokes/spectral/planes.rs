//! Planes that wait for the solve across them.

use std::sync::{Mutex, MutexGuard, PoisonError};

use topo_fourier::Complex64;

/// The tiles of one k_x, plane after plane.
pub(super) struct Planes<'a> {
    pub(super) tiles: &'a [Mutex<Vec<Complex64>>],
    pub(super) n_columns: usize,
    pub(super) column: usize,
    /// Whether a plane has forces; else its tiles are stale.
    pub(super) forced: &'a (dyn Fn(usize) -> bool + Sync),
    /// Whether a plane's velocities are needed.
    pub(super) wanted: &'a (dyn Fn(usize) -> bool + Sync),
}

impl Planes<'_> {
    pub(super) fn tile(&self, k: usize) -> MutexGuard<'_, Vec<Complex64>> {
        lock(&self.tiles[k * self.n_columns + self.column])
    }
}

/// Nothing panics while it holds one of these locks, and numbers cannot be left half-written.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
