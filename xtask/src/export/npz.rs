//! Archives of arrays for numpy; the only file that names the crates which write them.

use crate::data;
use crate::error::XtaskError;
use ndarray::{ArrayD, IxDyn};
use ndarray_npy::{NpzWriter, WritableElement};
use std::io::Cursor;
use std::path::Path;

/// An archive in the making.
pub struct Archive {
    writer: NpzWriter<Cursor<Vec<u8>>>,
}

impl Archive {
    /// An empty one.
    pub fn new() -> Self {
        Self {
            writer: NpzWriter::new(Cursor::new(Vec::new())),
        }
    }

    /// Adds an array, its last index running fastest.
    pub fn add<T: WritableElement>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: Vec<T>,
    ) -> Result<(), XtaskError> {
        let wrong = |reason: String| XtaskError::Drawing {
            reason: format!("array {name}: {reason}"),
        };
        let array =
            ArrayD::from_shape_vec(IxDyn(shape), values).map_err(|e| wrong(e.to_string()))?;
        self.writer
            .add_array(name, &array)
            .map_err(|e| wrong(e.to_string()))?;
        Ok(())
    }

    /// Writes the archive.
    pub fn write(self, path: &Path) -> Result<(), XtaskError> {
        let bytes = self.writer.finish().map_err(|e| XtaskError::Drawing {
            reason: format!("{}: {e}", path.display()),
        })?;
        data::write(path, bytes.get_ref())
    }
}
