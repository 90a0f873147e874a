//! What a battery says of its results, so that they are exported and drawn: the one place where pictures meet a battery.

mod colloid;
mod elastic;

use crate::error::ViewError;
use crate::export::files::{Files, Wanted};
use crate::export::finished::Finished;
use crate::guide::Guide;
use crate::sweeps::OwnPicture;
use topo_lab::Battery;

/// A battery whose cases are exported and whose sweeps are drawn.
///
/// A program holds a list of them: a folder of results is that of the battery whose [`schema`](Battery::schema) its cases carry.
pub trait Shown: Battery {
    /// What the columns of its tables are.
    fn guide(&self) -> Guide;

    /// Writes the shapes and fields of a finished case of its present results version.
    ///
    /// # Errors
    /// Files that are damaged, or that the case does not have.
    fn export(
        &self,
        case: &Finished<'_>,
        wanted: &Wanted,
        files: &mut Files<'_>,
    ) -> Result<(), ViewError>;

    /// Pictures of its own, besides those that every battery has from its guide.
    fn pictures(&self) -> &'static [OwnPicture] {
        &[]
    }
}
