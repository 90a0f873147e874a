//! Tables of the documentation, written by the commands that measured them.

use crate::data;
use crate::error::XtaskError;
use crate::provenance::workspace;

/// Where a generated table begins and ends in a page.
const MARKS: [&str; 2] = ["<!-- table -->\n", "<!-- end of table -->"];

/// Puts a table into a page of `docs`, in the place of the one before.
pub fn record(page: &str, table: &str) -> Result<(), XtaskError> {
    let path = workspace().join("docs").join(page);
    let text = std::fs::read_to_string(&path).map_err(|source| XtaskError::File {
        path: path.clone(),
        source,
    })?;
    let text = replaced(&text, table).ok_or_else(|| {
        let [begin, end] = MARKS.map(str::trim);
        XtaskError::Input(format!("{}: no `{begin}` before `{end}`", path.display()))
    })?;
    data::write(&path, text.as_bytes())
}

fn replaced(page: &str, table: &str) -> Option<String> {
    let (before, rest) = page.split_once(MARKS[0])?;
    let (_, after) = rest.split_once(MARKS[1])?;
    Some(format!("{before}{}{table}{}{after}", MARKS[0], MARKS[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_table_changes() {
        let page = "a\n<!-- table -->\nold\n<!-- end of table -->\nb\n";
        let expected = "a\n<!-- table -->\nnew\n<!-- end of table -->\nb\n";
        assert_eq!(replaced(page, "new\n").as_deref(), Some(expected));
        assert_eq!(replaced(expected, "new\n").as_deref(), Some(expected));
        assert_eq!(replaced("no mark", "new\n"), None);
    }

    #[test]
    fn the_pages_have_a_place() {
        for page in ["cost.md", "fuzzing.md", "nematic-model.md"] {
            let text = std::fs::read_to_string(workspace().join("docs").join(page)).unwrap();
            assert!(replaced(&text, "").is_some(), "{page}");
        }
    }
}
