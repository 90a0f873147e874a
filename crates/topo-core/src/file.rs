//! Files that are whole or absent: atomic writes, and errors that say what to do.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Why a file could not be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system refused.
    #[error("cannot {action} {}: {source}; {}", path.display(), remedy(source))]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file is shorter than its header says.
    #[error("{} is truncated: the write was cut off; start from an earlier file", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
    },
    /// The file is no checkpoint at all.
    #[error("{} is no checkpoint: check the path", path.display())]
    NotACheckpoint {
        /// The file.
        path: PathBuf,
    },
    /// The checkpoint has another format.
    #[error("{} has checkpoint format {found}, this program reads {expected}: use the program version that wrote it", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Format of the file.
        found: u32,
        /// Format that can be read.
        expected: u32,
    },
    /// The checkpoint holds something else.
    #[error("{} holds `{found}` instead of `{expected}`: give a checkpoint of this kind of run", path.display())]
    Schema {
        /// The file.
        path: PathBuf,
        /// What it holds.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// The content does not match its checksum, or cannot be understood.
    #[error("{} is corrupt ({what}): start from an earlier file", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The checkpoint belongs to another case.
    #[error("the checkpoint {} belongs to another case: remove it or use another folder", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// The value cannot be written in this format.
    #[error("cannot write {}: {what}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What cannot be written.
        what: String,
    },
    /// A line of a table cannot be read.
    #[error("{}, line {line}, column {column}: {what}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        what: String,
    },
}

impl FileError {
    /// Whether the reason is a checkpoint that cannot be used: a run can then start from its beginning.
    pub fn is_unusable_checkpoint(&self) -> bool {
        matches!(
            self,
            Self::Truncated { .. }
                | Self::NotACheckpoint { .. }
                | Self::Version { .. }
                | Self::Schema { .. }
                | Self::Corrupt { .. }
                | Self::Foreign { .. }
        )
    }

    pub(crate) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io {
            action,
            path: path.to_owned(),
            source,
        }
    }
}

/// What to do about an error of the operating system.
fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some disk space and run again"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder you may write to, or fix its permissions"
        }
        io::ErrorKind::NotFound => "check the path, and create the folder if it is missing",
        io::ErrorKind::IsADirectory | io::ErrorKind::NotADirectory => {
            "a file and a folder are mixed up in the path"
        }
        _ => "check the disk and the path",
    }
}

/// Writes a file atomically: at any moment, even after a crash, the path holds either the whole new content or the old one.
///
/// `content` writes to a temporary file in the same folder, which is flushed to disk and then renamed; the folder is flushed as
/// well. When anything fails, the temporary file is removed and the old content stays.
///
/// # Errors
/// [`FileError::Io`] names the file and the remedy.
///
/// # Validation
/// `a_failed_write_leaves_the_old_file`
pub fn write_atomic(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), FileError> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let failed = |source| FileError::io("write", path, source);
    if path.file_name().is_none() {
        return Err(failed(io::Error::from(io::ErrorKind::IsADirectory)));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".partial-");
    // Temporary files are private by default; results should follow the user's umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut writer = BufWriter::new(builder.tempfile_in(folder).map_err(failed)?);
    content(&mut writer).map_err(failed)?;
    let file = writer.into_inner().map_err(|e| failed(e.into_error()))?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    // Only some systems can flush a folder; there, the rename must reach the disk too.
    if cfg!(unix) {
        File::open(folder)
            .and_then(|f| f.sync_all())
            .map_err(failed)?;
    }
    Ok(())
}

/// Writes `bytes` as [`write_atomic`] does.
///
/// # Errors
/// [`FileError::Io`] names the file and the remedy.
pub fn write_atomic_bytes(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_atomic(path, |w| w.write_all(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.json");
        write_atomic_bytes(&path, b"old").unwrap();
        let full = || io::Error::from(io::ErrorKind::StorageFull);
        let error =
            write_atomic(&path, |w| w.write_all(&[b'x'; 100_000]).and(Err(full()))).unwrap_err();
        let message = error.to_string();
        assert!(
            message.contains("run.json") && message.contains("free some disk space"),
            "{message}"
        );
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        write_atomic_bytes(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            1,
            "no temporary file stays"
        );
    }

    #[test]
    fn errors_name_path_and_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("nowhere/run.json");
        let message = write_atomic_bytes(&missing, b"").unwrap_err().to_string();
        assert!(
            message.contains("nowhere") && message.contains("create the folder"),
            "{message}"
        );
        let file = folder.path().join("file");
        write_atomic_bytes(&file, b"").unwrap();
        assert!(
            write_atomic_bytes(&file.join("below"), b"")
                .unwrap_err()
                .to_string()
                .contains("mixed up")
        );
        assert!(write_atomic_bytes(Path::new("/"), b"").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn results_are_as_readable_as_other_files() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_atomic_bytes(&ours, b"").unwrap();
        std::fs::write(&plain, b"").unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
