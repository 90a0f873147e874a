//! The whole field at one time, kept for other tools where that is asked for.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use topo_core::{load_checkpoint, parse_checkpoint, save_checkpoint};
use topo_nematic::NematicState;
use topo_nematic::flow::FlowCoupling;
use topo_nematic::tensor::Tensor5;

use crate::LabError;

/// Schema of the file.
const SCHEMA: &str = "nematic-field/1";
/// How the names of such files end.
const ENDING: &str = ".field";

/// The tensor and the velocity at the centres of all cells at one time; lengths in ξ_N, times in τ_N.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FieldSnapshot {
    /// Time since the switch; `None` for the charged state.
    pub time: Option<f64>,
    /// Cells along x, y, z; the index of x runs fastest.
    pub cells: [usize; 3],
    /// Distance of neighbouring centres.
    pub spacing: f64,
    /// Centre of the first cell, relative to the particle's centre, or to that of the box without a particle.
    pub origin: [f64; 3],
    /// Whether each cell lies in the fluid.
    pub fluid: Vec<bool>,
    /// Tensor of each cell, in the five components of [`topo_nematic::tensor::Tensor5`], component by component, to single precision.
    pub q: Vec<f32>,
    /// Velocity of each cell, component by component, to single precision; none without flow.
    pub velocity: Option<Vec<f32>>,
}

impl FieldSnapshot {
    /// What a state looks like at a time.
    pub(super) fn of(
        time: Option<f64>,
        state: &NematicState,
        flow: Option<&FlowCoupling>,
        centre: [f64; 3],
    ) -> Self {
        let grid = state.grid();
        let [nx, ny, nz] = grid.cells();
        let first = grid.centre([0, 0, 0]);
        let mut fluid = Vec::with_capacity(grid.n_cells());
        for k in 0..nz {
            for j in 0..ny {
                fluid.extend((0..nx).map(|i| state.is_fluid([i, j, k])));
            }
        }
        let single = |values: &[f64]| values.iter().map(|x| *x as f32).collect();
        Self {
            time,
            cells: grid.cells(),
            spacing: grid.spacing(),
            origin: [0, 1, 2].map(|a| first[a] - centre[a]),
            fluid,
            q: single(state.q_tensor()),
            velocity: flow.map(|f| single(&f.centred_velocity())),
        }
    }

    /// The tensor of a cell.
    ///
    /// # Panics
    /// When there is no such cell.
    pub fn tensor(&self, cell: usize) -> Tensor5 {
        let n = self.fluid.len();
        std::array::from_fn(|c| f64::from(self.q[c * n + cell]))
    }

    /// Reads a file that a sweep kept.
    ///
    /// # Errors
    /// A file that cannot be read, is no field, or is damaged.
    pub fn read(path: &Path) -> Result<Self, LabError> {
        load_checkpoint::<Self>(path, SCHEMA)?.checked(path)
    }

    /// Reads the bytes of such a file; `path` names it in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read), but for those of the file system.
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, LabError> {
        parse_checkpoint::<Self>(path, bytes, SCHEMA)?.checked(path)
    }

    fn checked(self, path: &Path) -> Result<Self, LabError> {
        let n = self.fluid.len();
        let cells = self
            .cells
            .iter()
            .try_fold(1, |n: usize, k| n.checked_mul(*k));
        let whole = cells == Some(n)
            && self.q.len() == 5 * n
            && self.velocity.as_ref().is_none_or(|u| u.len() == 3 * n);
        if whole {
            Ok(self)
        } else {
            Err(topo_core::FileError::Corrupt {
                path: path.to_owned(),
                what: "its arrays do not fit its cells".to_owned(),
            }
            .into())
        }
    }

    /// The fields that a case kept, charged state first.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn files(case: &Path) -> Result<Vec<PathBuf>, LabError> {
        let wrong = |source| LabError::Output {
            path: case.to_owned(),
            source,
        };
        let mut files = Vec::new();
        for entry in std::fs::read_dir(case).map_err(wrong)? {
            let path = entry.map_err(wrong)?.path();
            if path.to_string_lossy().ends_with(ENDING) {
                files.push(path);
            }
        }
        files.sort();
        Ok(files)
    }

    /// Writes the field with a number into the folder of its case.
    pub(super) fn write(&self, case: &Path, number: usize) -> Result<(), LabError> {
        Ok(save_checkpoint(&place(case, number), SCHEMA, self)?)
    }
}

fn place(case: &Path, number: usize) -> PathBuf {
    case.join(format!("field-{number:02}{ENDING}"))
}

/// Whether a finished case kept its fields and they are still there.
pub(super) fn are_kept(case: &Path) -> bool {
    let text = std::fs::read_to_string(case.join("run.json")).unwrap_or_default();
    let run: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    let n = run["n_fields"].as_u64().unwrap_or(0);
    n > 0 && (0..n).all(|k| place(case, k as usize).exists())
}

/// Removes the fields of an earlier run.
pub(super) fn forget(case: &Path) -> Result<(), LabError> {
    for path in FieldSnapshot::files(case)? {
        std::fs::remove_file(&path).map_err(|source| LabError::Output {
            path: path.clone(),
            source,
        })?;
    }
    Ok(())
}
