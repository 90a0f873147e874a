//! The bytes of a curve file, and what to say where there are none.

use std::io::Read as _;
use std::path::Path;

use super::fault::fault;
use crate::KnotError;
use strsim::levenshtein;

/// Whether a path means the standard input.
pub(super) fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// The content of a file or of the standard input.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, KnotError> {
    let io = |source| KnotError::Io {
        path: path.to_owned(),
        action: "read",
        source,
    };
    if is_standard_input(path) {
        let mut bytes = Vec::new();
        std::io::stdin().read_to_end(&mut bytes).map_err(io)?;
        return Ok(bytes);
    }
    if path.is_dir() {
        return Err(fault(path, "this is a folder; name a file in it"));
    }
    std::fs::read(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => {
            let near =
                near(path).map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
            fault(path, format!("there is no such file{near}"))
        }
        _ => io(source),
    })
}

/// The file in the same folder whose name is most like that of `path`, if it is like it at all.
fn near(path: &Path) -> Option<String> {
    let asked = path.file_name()?.to_str()?.to_lowercase();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let names = entries
        .flatten()
        .filter_map(|e| e.file_name().into_string().ok());
    let like = |name: &String| levenshtein(&asked, &name.to_lowercase());
    let best = names.map(|name| (like(&name), name)).min()?;
    (best.0 <= 1 + asked.chars().count() / 5).then_some(best.1)
}
