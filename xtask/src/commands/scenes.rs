//! `cargo xtask scenes`: the reference of scene files and their schema, from the types that read them.

use std::fmt::Write as _;

use topo_cli::commands::scene::schema_text;
use topo_cli::{BATTERIES, CliError};
use topo_lab::{KeyRow, Keys};
use topo_view::data;

use super::record::record_part;
use crate::workspace::workspace;

const PAGE: &str = "scenes.md";
const SCHEMA: &str = "docs/scene.schema.json";

/// Writes both.
pub fn run() -> Result<(), CliError> {
    for (name, keys) in described() {
        record_part(PAGE, name, &reference(keys))?;
    }
    let text = schema_text(&BATTERIES);
    Ok(data::write(&workspace().join(SCHEMA), text.as_bytes())?)
}

/// The batteries whose keys are described, by the table that their scenes have.
fn described() -> impl Iterator<Item = (&'static str, &'static Keys)> {
    BATTERIES
        .into_iter()
        .filter_map(|battery| Some((battery.table(), battery.keys()?)))
}

/// The tables of a battery's keys.
fn reference(keys: &Keys) -> String {
    let mut text = String::new();
    let mut table = None;
    for row in keys.rows() {
        if table.as_ref() != Some(&row.table) {
            text += &head(keys, &row.table);
            table = Some(row.table.clone());
        }
        // writing to a string cannot fail
        let _ = writeln!(text, "{}", line(&row));
    }
    text
}

fn head(keys: &Keys, table: &str) -> String {
    let title = match table {
        "" => "Above the tables".to_owned(),
        table => format!("`[{table}]`"),
    };
    let about = match table {
        "" => String::new(),
        table => format!("{}\n\n", keys.about(table)),
    };
    format!(
        "\n### {title}\n\n{about}<!-- settings -->\n\n| key | unit | left out | one value | means | example |\n|---|---|---|---|---|---|\n"
    )
}

fn line(row: &KeyRow) -> String {
    let default = match (row.has_default, row.is_required) {
        (true, _) => format!("`{}`", row.default),
        (false, true) => "must be there".to_owned(),
        (false, false) => row.default.clone(),
    };
    let several = if row.is_several { "; several" } else { "" };
    let words = row.words.iter().filter(|(_, about)| !about.is_empty());
    let words: Vec<String> = words
        .map(|(word, about)| format!("`\"{word}\"`: {}", about.trim_end_matches('.')))
        .collect();
    let means = [row.meaning.clone(), words.join("; ")];
    let cells = [
        format!("`{}`", row.name),
        row.unit.clone(),
        default,
        format!("{}{several}", row.forms),
        means.join(" ").trim().to_owned(),
        format!("`{}`", row.example),
    ];
    format!(
        "| {} |",
        cells.map(|cell| cell.replace('|', "\\|")).join(" | ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::record::part;

    /// After a change of a file type: `cargo xtask scenes`.
    #[test]
    fn the_reference_and_the_schema_are_what_the_types_say() {
        let page = std::fs::read_to_string(workspace().join("docs").join(PAGE)).unwrap();
        for (name, keys) in described() {
            assert_eq!(part(&page, name), Some(reference(keys).as_str()), "{name}");
        }
        let schema = std::fs::read_to_string(workspace().join(SCHEMA)).unwrap();
        assert!(schema == schema_text(&BATTERIES), "{SCHEMA} is not current");
    }
}
