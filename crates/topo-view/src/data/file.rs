//! Files: tables read row by row, writing that leaves nothing half done.

use crate::error::ViewError;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};
use topo_core::{FileError, write_atomic_bytes};

/// Reads a CSV file with a header.
pub fn read_csv<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, ViewError> {
    let file = std::fs::File::open(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => ViewError::Missing {
            path: path.to_owned(),
        },
        _ => ViewError::File {
            path: path.to_owned(),
            source,
        },
    })?;
    let rows = csv::Reader::from_reader(std::io::BufReader::new(file)).into_deserialize();
    rows.collect::<Result<_, _>>()
        .map_err(|e| ViewError::Table {
            path: path.to_owned(),
            reason: e.to_string(),
        })
}

/// Writes a file whole or not at all: beside its place first, then renamed.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), ViewError> {
    let fail = |source| ViewError::File {
        path: PathBuf::from(path),
        source,
    };
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(fail)?;
    write_atomic_bytes(path, bytes).map_err(|e| match e {
        FileError::Io { source, .. } => fail(source),
        other => fail(std::io::Error::other(other.to_string())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn write_refuses_a_folder_that_is_a_file() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("a");
        write(&file, b"1").unwrap();
        assert!(write(&file.join("b"), b"2").is_err());
        assert_eq!(std::fs::read(&file).unwrap(), b"1");
    }
}
