//! What a checkpoint of a charge keeps, and whether a checkpoint fits.

use serde::{Deserialize, Serialize};
use topo_core::{Fire, MOST_COUNTED};

use crate::battery::NematicBattery;
use crate::battery::minimum::MinimumReport;
use crate::relax::Relaxation;
use crate::{NematicError, NematicState};

/// Most kicks along unstable modes.
pub(super) const MOST_KICKS: u32 = 4;

/// The best state so far.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Best {
    pub energy: f64,
    pub state: NematicState,
    pub seed: f64,
    pub rms_field: f64,
}

/// A relaxation in progress.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Moving {
    pub q: Vec<f64>,
    pub velocity: Vec<f64>,
    pub fire: Fire,
    pub last_order: Option<f64>,
}

/// What a checkpoint of a charge keeps between relaxations.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct Progressed {
    /// Start fields gone through.
    pub seed: usize,
    pub n_kicks: u32,
    pub best: Option<Best>,
    pub minimum: Option<MinimumReport>,
    pub n_steps: u64,
    pub n_products: u64,
    pub has_reached_limit: bool,
    pub n_bytes: u64,
    pub cpu_seconds: f64,
}

impl Moving {
    /// The present moment of `relaxation`.
    pub fn of(relaxation: &Relaxation<'_, f64>, last_order: Option<f64>) -> Self {
        Self {
            q: relaxation.q.clone(),
            velocity: relaxation.velocity.clone(),
            fire: relaxation.fire,
            last_order,
        }
    }
}

impl Progressed {
    /// Keeps a relaxed state of `energy`, if there is none of lower energy.
    pub fn offer(
        &mut self,
        energy: f64,
        seed: f64,
        rms_field: f64,
        state: impl FnOnce() -> Result<NematicState, NematicError>,
    ) -> Result<(), NematicError> {
        if self.best.as_ref().is_none_or(|best| energy < best.energy) {
            self.best = Some(Best {
                energy,
                state: state()?,
                seed,
                rms_field,
            });
        }
        Ok(())
    }
}

/// A charge in progress; a finished one has gone through all seeds and its check.
#[derive(Serialize, Deserialize)]
pub(super) struct Unfinished {
    pub progressed: Progressed,
    pub moving: Option<Moving>,
}

impl Unfinished {
    /// What does not fit a charge with so many seeds, on arrays of this length.
    pub fn flaw(
        &self,
        battery: &NematicBattery,
        n_seeds: usize,
        length: usize,
    ) -> Option<&'static str> {
        let whole = |x: &[f64]| x.len() == length && x.iter().all(|x| x.is_finite());
        let kept = |best: &Best| {
            let numbers = [best.energy, best.seed, best.rms_field];
            numbers.iter().all(|x| x.is_finite())
                && *best.state.grid() == battery.grid
                && best.state.particle().copied() == battery.particle
        };
        let moves = |m: &Moving| whole(&m.q) && whole(&m.velocity) && m.fire.is_sound();
        let p = &self.progressed;
        let through = p.seed >= n_seeds;
        let found = |m: &MinimumReport| m.lowest_eigenvalue.is_finite() && m.residual.is_finite();
        if p.seed > n_seeds || (through && p.best.is_none()) || p.n_kicks > MOST_KICKS {
            Some("it has gone through other start fields")
        } else if !p.best.iter().all(kept) || !p.minimum.iter().all(found) {
            Some("the best state is one of another battery")
        } else if !self.moving.iter().all(moves) || (!through && self.moving.is_none()) {
            Some("the relaxation is one of another battery")
        } else if p.n_steps.max(p.n_products) >= MOST_COUNTED || !p.cpu_seconds.is_finite() {
            Some("a counter is out of range")
        } else {
            None
        }
    }
}
