//! An interrupt of the tightening, and whether work was left undone because of it.

use std::cell::Cell;

use topo_core::Interrupt;

use super::origin::Tight;
use crate::KnotError;

/// An interrupt, and whether work was left undone because of it.
#[derive(Debug, Default)]
pub(crate) struct Stop {
    interrupt: Interrupt,
    is_heeded: Cell<bool>,
}

impl Stop {
    /// Stops when `interrupt` requests it.
    pub(crate) fn at(interrupt: &Interrupt) -> Self {
        Self {
            interrupt: interrupt.clone(),
            is_heeded: Cell::new(false),
        }
    }

    /// Whether to leave the rest undone; a caller that reads `true` must do so.
    pub(crate) fn asks(&self) -> bool {
        if self.interrupt.is_requested() {
            self.is_heeded.set(true);
        }
        self.is_heeded.get()
    }

    /// The knot or link, if nothing was left undone.
    pub(super) fn unless_cut_short<T: Tight>(&self, tight: T) -> Result<T, KnotError> {
        match self.is_heeded.get() {
            true => Err(tight.interrupted()),
            false => Ok(tight),
        }
    }
}

/// What is made of the knot or link itself, for its mirror image.
pub(crate) fn mirrored<T: Tight>(made: Result<T, KnotError>) -> Result<T, KnotError> {
    match made {
        Ok(tight) => Ok(tight.mirrored()),
        Err(KnotError::Interrupted { best }) => Err(best.mirror().interrupted()),
        Err(KnotError::InterruptedLink { best }) => Err(best.mirror().interrupted()),
        Err(error) => Err(error),
    }
}
