//! Working memory for lines along z, several modes side by side.

use topo_fourier::Complex64;

/// Modes k_y that are solved side by side.
pub(super) const N_LANES: usize = 16;

/// One number of each mode.
pub(super) type Lane = [f64; N_LANES];

/// Working memory of one thread.
pub(super) struct Lines {
    /// Real and imaginary part of the transverse velocity along z.
    pub transverse: Vec<[Lane; 2]>,
    /// Real and imaginary part of the normal velocity.
    pub normal: Vec<[Lane; 2]>,
    /// Inverse pivots of the tridiagonal and the pentadiagonal matrix, and the first subdiagonal of the factor of the latter.
    pub factor: Vec<[Lane; 3]>,
    /// Lines of the three components with periodic z: (component, mode, z).
    pub periodic: Vec<Complex64>,
}

impl Lines {
    pub fn new(n_z: usize, periodic: bool) -> Self {
        let zero = [0.0; N_LANES];
        let n_walled = if periodic { 0 } else { n_z };
        Self {
            transverse: vec![[zero; 2]; n_walled],
            normal: vec![[zero; 2]; n_walled],
            factor: vec![[zero; 3]; n_walled],
            periodic: vec![Complex64::default(); if periodic { 3 * N_LANES * n_z } else { 0 }],
        }
    }

    pub fn n_bytes(&self) -> usize {
        self.factor.len() * 7 * size_of::<Lane>() + self.periodic.len() * size_of::<Complex64>()
    }
}
