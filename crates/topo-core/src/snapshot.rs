//! Snapshots: vertices and quantities along them as a table that any program can read.

use std::fmt::{Display, Write as _};
use std::path::Path;

use nalgebra::Vector3;

use crate::file::{FileError, write_atomic_bytes};

/// Vertices with named columns of one number per vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    vertices: Vec<Vector3<f64>>,
    columns: Vec<(String, Vec<f64>)>,
}

impl Snapshot {
    /// A snapshot of `vertices` without further columns.
    pub fn new(vertices: Vec<Vector3<f64>>) -> Self {
        Self {
            vertices,
            columns: Vec::new(),
        }
    }

    /// The same snapshot with a column; its name may hold a unit, as in `density [E_b h^2]`.
    pub fn with_column(mut self, name: impl Into<String>, values: Vec<f64>) -> Self {
        self.columns.push((name.into(), values));
        self
    }

    /// The vertices.
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// Values of the column `name`, if there is one.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns
            .iter()
            .find(|(n, _)| n == name)
            .map(|(_, values)| values.as_slice())
    }

    /// Names and values of the further columns.
    pub fn columns(&self) -> &[(String, Vec<f64>)] {
        &self.columns
    }

    /// Writes the table as comma-separated values, atomically; every number reads back to the bit.
    ///
    /// # Errors
    /// [`FileError::Unwritable`] when a column has a wrong length, a number that is not finite, or a name that is empty,
    /// padded, doubled, or holds a comma, a quote or a line break; [`FileError::Io`] when the file cannot be written.
    ///
    /// # Validation
    /// `reads_back_what_it_wrote`
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        write_atomic_bytes(path, self.text(path)?.as_bytes())
    }

    /// The text that [`write`](Self::write) writes; `path` names it in messages.
    ///
    /// # Errors
    /// As [`write`](Self::write), except those of the file system.
    pub fn text(&self, path: &Path) -> Result<String, FileError> {
        let unwritable = |what: String| {
            Err(FileError::Unwritable {
                path: path.to_owned(),
                what,
            })
        };
        for (i, (name, values)) in self.columns.iter().enumerate() {
            let repeated = ["x", "y", "z"].contains(&name.as_str())
                || self.columns[..i].iter().any(|(n, _)| n == name);
            if name.is_empty()
                || name.trim() != name
                || name.contains([',', '"', '\n', '\r'])
                || repeated
            {
                return unwritable(format!(
                    "column name `{name}`: give each column its own name without commas, quotes or line breaks"
                ));
            }
            if values.len() != self.vertices.len() {
                return unwritable(format!(
                    "column `{name}` has {} values for {} vertices",
                    values.len(),
                    self.vertices.len()
                ));
            }
        }
        let numbers = self
            .vertices
            .iter()
            .flatten()
            .chain(self.columns.iter().flat_map(|(_, values)| values));
        if numbers.into_iter().any(|x| !x.is_finite()) {
            return unwritable("a number is not finite: the run that made it is broken".to_owned());
        }
        let mut text = "x,y,z".to_owned();
        for (name, _) in &self.columns {
            text.push(',');
            text.push_str(name);
        }
        text.push('\n');
        for (i, v) in self.vertices.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(text, "{:?},{:?},{:?}", v.x, v.y, v.z);
            for (_, values) in &self.columns {
                let _ = write!(text, ",{:?}", values[i]);
            }
            text.push('\n');
        }
        Ok(text)
    }

    /// Reads a table whose first columns are `x,y,z`.
    ///
    /// # Errors
    /// [`FileError::Table`] names file, line and column of what cannot be read; [`FileError::Io`] when there is no such file.
    ///
    /// # Validation
    /// `flaws_are_located`
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = std::fs::read_to_string(path).map_err(|e| FileError::io("read", path, e))?;
        Self::parse(path, &text)
    }

    /// Reads such a table from a text; `path` names it in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read), except those of the file system.
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        let flaw = |line: usize, column: usize, what: &dyn Display| FileError::Table {
            path: path.to_owned(),
            line,
            column,
            what: what.to_string(),
        };
        let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line));
        let header: Vec<&str> = lines.next().map_or(Vec::new(), |(_, line)| {
            line.split(',').map(str::trim).collect()
        });
        for (i, axis) in ["x", "y", "z"].iter().enumerate() {
            if header.get(i) != Some(axis) {
                return Err(flaw(
                    1,
                    i + 1,
                    &format_args!(
                        "the header must begin with x,y,z; column {} is not `{axis}`",
                        i + 1
                    ),
                ));
            }
        }
        let mut snapshot = Self {
            vertices: Vec::new(),
            columns: header[3..]
                .iter()
                .map(|name| ((*name).to_owned(), Vec::new()))
                .collect(),
        };
        let mut row = vec![0.0; header.len()];
        for (line, text) in lines.filter(|(_, text)| !text.trim().is_empty()) {
            let n_fields = text.split(',').count();
            if n_fields != header.len() {
                return Err(flaw(
                    line,
                    n_fields.min(header.len()) + 1,
                    &format_args!("{n_fields} fields instead of {}", header.len()),
                ));
            }
            for (column, (field, value)) in text.split(',').zip(&mut row).enumerate() {
                let parsed = field.trim().parse::<f64>().ok().filter(|x| x.is_finite());
                *value = parsed.ok_or_else(|| {
                    flaw(
                        line,
                        column + 1,
                        &format_args!("`{}` is no finite number", field.trim()),
                    )
                })?;
            }
            snapshot.vertices.push(Vector3::new(row[0], row[1], row[2]));
            for ((_, values), value) in snapshot.columns.iter_mut().zip(&row[3..]) {
                values.push(*value);
            }
        }
        Ok(snapshot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn snapshot() -> Snapshot {
        Snapshot::new(vec![
            Vector3::new(0.1, 1e-300, -0.0),
            Vector3::new(1e300, 1.0 / 3.0, 5e-324),
        ])
        .with_column("density [E_b h^2]", vec![2.0, -1e-17])
    }

    #[test]
    fn reads_back_what_it_wrote() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("vertices.csv");
        for table in [
            snapshot(),
            Snapshot::default(),
            Snapshot::new(snapshot().vertices),
        ] {
            table.write(&path).unwrap();
            assert_eq!(Snapshot::read(&path).unwrap(), table);
        }
        snapshot().write(&path).unwrap();
        let back = Snapshot::read(&path).unwrap();
        assert!(
            back.vertices()[0].z.is_sign_negative(),
            "the sign of zero survives"
        );
        assert_eq!(back.column("density [E_b h^2]"), Some(&[2.0, -1e-17][..]));
        assert_eq!(back.column("twist"), None);
    }

    #[test]
    fn flaws_are_located() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("vertices.csv");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Snapshot::read(&path).unwrap_err().to_string()
        };
        assert!(read("").contains("line 1, column 1"));
        assert!(read("x,y\n").contains("line 1, column 3"));
        assert!(
            read("x,y,z\n1,2,3\n1,two,3\n").contains("line 3, column 2: `two` is no finite number")
        );
        assert!(read("x,y,z\n1,2,nan\n").contains("line 2, column 3"));
        assert!(read("x,y,z,e\n1,2,3\n").contains("3 fields instead of 4"));
        assert!(read("x,y,z\n1,2,3,4\n").contains("line 2, column 4"));
        assert!(
            Snapshot::read(&folder.path().join("none.csv"))
                .unwrap_err()
                .to_string()
                .contains("none.csv")
        );
    }

    #[test]
    fn what_would_not_read_back_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("vertices.csv");
        for name in ["", "a,b", "x", " padded", "two\nlines", "density [E_b h^2]"] {
            let broken = snapshot().with_column(name, vec![0.0, 0.0]);
            assert!(
                matches!(broken.write(&path), Err(FileError::Unwritable { .. })),
                "{name}"
            );
        }
        assert!(
            snapshot()
                .with_column("short", vec![0.0])
                .write(&path)
                .is_err()
        );
        assert!(
            snapshot()
                .with_column("nan", vec![0.0, f64::NAN])
                .write(&path)
                .is_err()
        );
        assert!(!path.exists());
    }
}
