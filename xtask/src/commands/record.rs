//! Tables of the documentation, written by the commands that measured them.

use crate::workspace::workspace;
use topo_cli::CliError;
use topo_view::data;

/// Puts the table of a page of `docs` in the place of the one before.
pub fn record(page: &str, table: &str) -> Result<(), CliError> {
    record_part(page, "table", table)
}

/// Where a generated part begins and ends in a page.
fn marks(part: &str) -> [String; 2] {
    [
        format!("<!-- {part} -->\n"),
        format!("<!-- end of {part} -->"),
    ]
}

/// Puts a named part of a page of `docs` in the place of the one before.
pub fn record_part(page: &str, part: &str, table: &str) -> Result<(), CliError> {
    let path = workspace().join("docs").join(page);
    let text = std::fs::read_to_string(&path).map_err(|source| CliError::File {
        path: path.clone(),
        source,
    })?;
    let text = replaced(&text, part, table).ok_or_else(|| {
        let [begin, end] = marks(part);
        let begin = begin.trim();
        CliError::Input(format!("{}: no `{begin}` before `{end}`", path.display()))
    })?;
    Ok(data::write(&path, text.as_bytes())?)
}

/// A named part of a page.
#[cfg(test)]
pub fn part<'a>(page: &'a str, name: &str) -> Option<&'a str> {
    let [begin, end] = marks(name);
    Some(page.split_once(&begin)?.1.split_once(&end)?.0)
}

fn replaced(page: &str, part: &str, table: &str) -> Option<String> {
    let [begin, end] = marks(part);
    let (before, rest) = page.split_once(&begin)?;
    let (_, after) = rest.split_once(&end)?;
    Some(format!("{before}{begin}{table}{end}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_table_changes() {
        let page = "a\n<!-- table -->\nold\n<!-- end of table -->\nb\n";
        let expected = "a\n<!-- table -->\nnew\n<!-- end of table -->\nb\n";
        assert_eq!(replaced(page, "table", "new\n").as_deref(), Some(expected));
        assert_eq!(
            replaced(expected, "table", "new\n").as_deref(),
            Some(expected)
        );
        assert_eq!(replaced("no mark", "table", "new\n"), None);
    }

    #[test]
    fn the_pages_have_a_place() {
        for page in ["cost.md", "fuzzing.md", "nematic-model.md"] {
            let text = std::fs::read_to_string(workspace().join("docs").join(page)).unwrap();
            assert!(replaced(&text, "table", "").is_some(), "{page}");
        }
        let page = std::fs::read_to_string(workspace().join("docs/tradeoff.md")).unwrap();
        for system in ["rod", "nematic"] {
            for part in ["settings", "check"] {
                let part = format!("{system} {part}");
                assert!(replaced(&page, &part, "").is_some(), "{part}");
            }
        }
    }
}
