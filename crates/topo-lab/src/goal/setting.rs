//! A setting of the measured table.

/// A setting with the coarser one beside it: resolutions and tolerances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Setting {
    pub fine: (f64, f64),
    pub coarse: (f64, f64),
}

impl Setting {
    /// By how much it is finer than the coarser one.
    pub(super) fn ratio(&self) -> f64 {
        let ratio = self.coarse.0 / self.fine.0;
        ratio.max(1.0 / ratio)
    }
}
