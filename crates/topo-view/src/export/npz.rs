//! Archives of arrays for numpy; the only file that names the crates which write them.

use super::about::{About, Fact};
use crate::data;
use crate::error::ViewError;
use ndarray::{ArrayD, IxDyn};
use ndarray_npy::{NpzWriter, WritableElement, WriteDataError};
use std::io::{Cursor, Write};
use std::path::Path;

/// An archive in the making.
pub struct Archive {
    writer: NpzWriter<Cursor<Vec<u8>>>,
}

impl Archive {
    /// One that says what it is about.
    pub fn new(about: &About) -> Result<Self, ViewError> {
        let mut archive = Self {
            writer: NpzWriter::new(Cursor::new(Vec::new())),
        };
        for (name, fact) in about.facts() {
            match fact {
                Fact::Numbers(values) if values.len() == 1 => {
                    archive.add(name, &[], values.clone())?;
                }
                Fact::Numbers(values) => archive.add(name, &[values.len()], values.clone())?,
                Fact::Words(words) => archive.add(name, &[], vec![Words::new(name, words)?])?,
            }
        }
        Ok(archive)
    }

    /// Adds an array, its last index running fastest.
    pub fn add<T: WritableElement>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: Vec<T>,
    ) -> Result<(), ViewError> {
        let array =
            ArrayD::from_shape_vec(IxDyn(shape), values).map_err(|e| wrong(name, e.to_string()))?;
        self.writer
            .add_array(name, &array)
            .map_err(|e| wrong(name, e.to_string()))?;
        Ok(())
    }

    /// Writes the archive.
    pub fn write(self, path: &Path) -> Result<(), ViewError> {
        let bytes = self.writer.finish().map_err(|e| ViewError::Drawing {
            reason: format!("{}: {e}", path.display()),
        })?;
        data::write(path, bytes.get_ref())
    }
}

fn wrong(name: &str, reason: String) -> ViewError {
    ViewError::Drawing {
        reason: format!("array {name}: {reason}"),
    }
}

/// Most characters of words. Numpy's strings have a fixed length, which belongs to the type, and drop the zeros at the end.
const LONGEST: usize = 256;

/// A string of numpy.
struct Words([char; LONGEST]);

impl Words {
    fn new(name: &str, words: &str) -> Result<Self, ViewError> {
        if words.chars().count() > LONGEST {
            let reason = format!("more than {LONGEST} characters: {words}");
            return Err(wrong(name, reason));
        }
        let mut all = ['\0'; LONGEST];
        all.iter_mut().zip(words.chars()).for_each(|(a, c)| *a = c);
        Ok(Self(all))
    }
}

impl WritableElement for Words {
    fn type_descriptor() -> py_literal::Value {
        py_literal::Value::String(format!("<U{LONGEST}"))
    }

    fn write<W: Write>(&self, mut writer: W) -> Result<(), WriteDataError> {
        for c in self.0 {
            writer.write_all(&u32::from(c).to_le_bytes())?;
        }
        Ok(())
    }

    fn write_slice<W: Write>(slice: &[Self], mut writer: W) -> Result<(), WriteDataError> {
        slice.iter().try_for_each(|words| words.write(&mut writer))
    }
}
