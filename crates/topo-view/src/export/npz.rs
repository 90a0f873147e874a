//! Archives of arrays for numpy: `.npz`, a zip file of arrays in the format `.npy`.

use super::about::{About, Fact};
use crate::data;
use crate::error::ViewError;
use std::io::{Cursor, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// An archive in the making.
pub struct Archive {
    writer: ZipWriter<Cursor<Vec<u8>>>,
}

impl Archive {
    /// One that says what it is about.
    pub fn new(about: &About) -> Result<Self, ViewError> {
        let mut archive = Self {
            writer: ZipWriter::new(Cursor::new(Vec::new())),
        };
        for (name, fact) in about.facts() {
            match fact {
                Fact::Numbers(values) if values.len() == 1 => {
                    archive.add(name, &[], values.clone())?;
                }
                Fact::Numbers(values) => archive.add(name, &[values.len()], values.clone())?,
                Fact::Words(words) => archive.add_words(name, words)?,
            }
        }
        Ok(archive)
    }

    /// Adds an array, its last index running fastest.
    pub fn add<T: Element>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: Vec<T>,
    ) -> Result<(), ViewError> {
        let n: usize = shape.iter().product();
        if n != values.len() {
            let reason = format!("{} values for the shape {shape:?}", values.len());
            return Err(wrong(name, reason));
        }
        let mut array = header(T::TYPE, shape);
        array.reserve(size_of_val(values.as_slice()));
        values.into_iter().for_each(|x| x.append(&mut array));
        self.put(name, &array)
    }

    /// Adds a string.
    fn add_words(&mut self, name: &str, words: &str) -> Result<(), ViewError> {
        // numpy has no type of strings without a character, and drops zeros at the end
        let words = if words.is_empty() { "\0" } else { words };
        let mut array = header(&format!("<U{}", words.chars().count()), &[]);
        array.extend(words.chars().flat_map(|c| u32::from(c).to_le_bytes()));
        self.put(name, &array)
    }

    fn put(&mut self, name: &str, array: &[u8]) -> Result<(), ViewError> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(u32::try_from(array.len()).is_err());
        self.writer
            .start_file(format!("{name}.npy"), options)
            .map_err(|e| wrong(name, e.to_string()))?;
        self.writer
            .write_all(array)
            .map_err(|e| wrong(name, e.to_string()))
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

/// What stands before the values of an array: version 1.0 of the format of
/// [`numpy.lib.format`](https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html), in which values begin at a
/// multiple of 64 bytes.
///
/// A library for these lines would bring a parser of Python's literals, and with it a dozen crates.
fn header(of: &str, shape: &[usize]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let lengths: String = shape.iter().map(|n| format!("{n}, ")).collect();
    let text = format!("{{'descr': '{of}', 'fortran_order': False, 'shape': ({lengths})}}");
    // two bytes for the length of the text, one for the end of its line
    let before = bytes.len() + 2;
    let width = (before + text.len() + 1).next_multiple_of(64) - before - 1;
    bytes.extend((width as u16 + 1).to_le_bytes());
    bytes.extend(format!("{text:<width$}\n").into_bytes());
    bytes
}

/// What an array can hold.
pub trait Element {
    /// Its name in the format: order of bytes, kind, number of bytes.
    const TYPE: &'static str;

    /// Appends its bytes.
    fn append(self, to: &mut Vec<u8>);
}

macro_rules! element {
    ($type:ty, $name:literal) => {
        impl Element for $type {
            const TYPE: &'static str = $name;

            fn append(self, to: &mut Vec<u8>) {
                to.extend(self.to_le_bytes());
            }
        }
    };
}

element!(f64, "<f8");
element!(f32, "<f4");
element!(i64, "<i8");
element!(u8, "|u1");

impl Element for bool {
    const TYPE: &'static str = "|b1";

    fn append(self, to: &mut Vec<u8>) {
        to.push(u8::from(self));
    }
}
