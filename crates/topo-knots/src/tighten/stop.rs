//! An interrupt of the tightening, and whether work was left undone because of it.

use std::cell::Cell;

use topo_core::Interrupt;

use super::TightKnot;
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

    /// The knot, if nothing was left undone.
    pub(super) fn unless_cut_short(&self, tight: TightKnot) -> Result<TightKnot, KnotError> {
        if self.is_heeded.get() {
            return Err(KnotError::Interrupted {
                best: Box::new(tight),
            });
        }
        Ok(tight)
    }
}

/// What is made of the knot itself, for its mirror image.
pub(crate) fn mirrored(made: Result<TightKnot, KnotError>) -> Result<TightKnot, KnotError> {
    match made {
        Ok(tight) => Ok(tight.mirror()),
        Err(KnotError::Interrupted { best }) => Err(KnotError::Interrupted {
            best: Box::new(best.mirror()),
        }),
        Err(error) => Err(error),
    }
}
