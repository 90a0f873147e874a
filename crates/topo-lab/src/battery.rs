//! A battery, where programs list the batteries that they know.

mod known;
mod options;
mod scene;
mod sweep;

use std::path::Path;

use crate::LabError;
use crate::cost::Probe;
use crate::scene::{Keys, SceneFault};

pub use known::{parse_scene, read_scene, scene_faults};
pub use options::Options;
pub(crate) use options::refused;
pub use scene::Scene;
pub use sweep::{Checked, Stage, Sweep, Swept};

/// A battery whose scenes can be run.
///
/// Programs hold a list of them; nothing else names a battery. A battery of your own is a type with this trait, a [`Scene`] that
/// it reads from a file, and an [`Experiment`](crate::Experiment) that the scene stands for: cases, shards, resumption, tables
/// and progress follow from these.
pub trait Battery: Sync {
    /// What its sweeps are called while they run, such as `elastic`.
    fn name(&self) -> &'static str;

    /// The table of a scene file that tells its scenes from others, such as `rod`.
    fn table(&self) -> &'static str;

    /// What it is, as messages call it, such as "a knotted fibre".
    fn what(&self) -> &'static str;

    /// What its cases call themselves in `run.json`, such as `topo-elastic-case/1`.
    fn schema(&self) -> &'static str;

    /// Changes whenever the same scene gives other numbers than before; finished cases of another version are computed again.
    fn results(&self) -> u32;

    /// The short run that tells how fast this machine is with its cases.
    fn probe(&self) -> &'static Probe;

    /// Reads a scene from the text of a file; `path` names it in messages, and its results.
    ///
    /// [`Document`](crate::Document) knows where keys stand, and [`folder_of`](crate::folder_of) the folder of the results.
    ///
    /// # Errors
    /// File, line, key and what would be right.
    fn parse(&self, text: &str, path: &Path) -> Result<Box<dyn Scene>, LabError>;

    /// The keys of its scenes; nothing where they are not described.
    fn keys(&self) -> Option<&'static Keys> {
        None
    }

    /// Keys with the values that a scene to begin with has, as they are written.
    fn first_scene(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// All that is wrong with the text of a scene file, as far as it can be seen without a run.
    fn faults(&self, text: &str, path: &Path) -> Vec<SceneFault> {
        let refused = self.parse(text, path).err();
        refused.map(|e| e.into_fault(path)).into_iter().collect()
    }
}
