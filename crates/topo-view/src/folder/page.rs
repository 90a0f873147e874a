//! The page that shows the pictures of a folder.

use maud::{Markup, PreEscaped, html};
use std::path::{Path, PathBuf};

use super::drawn::DrawnSweep;
use crate::gallery::document;
use crate::plot::text::{escape, significant};

/// Most rows that the page lists.
const MOST_ROWS: usize = 60;

/// The page: it lies beside the pictures.
pub(super) fn write(folder: &Path, sweeps: &[DrawnSweep], foreign: &[(PathBuf, String)]) -> String {
    let content = html! {
        @if sweeps.len() > 1 {
            nav {
                @for sweep in sweeps { a href={ "#" (sweep.name) } { (sweep.name) } " " }
            }
        }
        @for sweep in sweeps { (section(sweep)) }
        @if !foreign.is_empty() {
            section {
                h2 { "Not drawn" }
                ul {
                    @for (place, why) in foreign { li { (place.display()) ": " (why) } }
                }
            }
        }
    };
    document(&format!("Results in {}", folder.display()), "", &content)
}

fn section(sweep: &DrawnSweep) -> Markup {
    let cases = &sweep.cases;
    let shared: Vec<String> = cases.shared().iter().map(|s| markup(s).0).collect();
    let lacks = sweep.lacks();
    html! {
        section id=(sweep.name) {
            h2 { (sweep.name) }
            p {
                (capital(sweep.what)) ": " (cases.first_rows().len()) " finished cases, " (cases.rows.len()) " discharges."
                @if !shared.is_empty() { " All: " (PreEscaped(shared.join(", "))) "." }
            }
            @if !lacks.is_empty() {
                ul {
                    @for line in &lacks { li { (line) } }
                }
            }
            @for shot in &sweep.shots {
                h3 { (markup(&shot.title)) }
                a href={ (shot.name) ".svg" } { img alt=(plain(&shot.title)) src={ (shot.name) ".png" }; }
                p.files {
                    (markup(&shot.drawn.finding)) " Files: "
                    a href={ (shot.name) ".svg" } { "SVG" } ", "
                    a href={ (shot.name) ".png" } { "PNG" } ", "
                    a href={ (shot.name) ".csv" } { "numbers drawn" }
                }
            }
            (rows(sweep))
        }
    }
}

/// The rows as a table: what is swept, and the results that have a panel of their own.
fn rows(sweep: &DrawnSweep) -> Markup {
    let cases = &sweep.cases;
    if cases.rows.is_empty() || cases.rows.len() > MOST_ROWS {
        return html! {};
    }
    let columns = cases.guide.results.iter().flat_map(|q| q.columns);
    let columns: Vec<(&str, &str)> = columns.filter_map(|c| Some((c.name, c.alone?))).collect();
    html! {
        table {
            tr {
                td { "Case" }
                @for swept in &cases.swept { td { (markup(swept.setting.label)) } }
                @for (_, label) in &columns { td { (markup(label)) } }
            }
            @for row in &cases.rows {
                tr {
                    td { (row.case()) }
                    @for swept in &cases.swept { td { (markup(&swept.say(row.text(swept.setting.column)))) } }
                    @for (name, _) in &columns {
                        td { (row.number(name).map_or_else(String::new, |v| significant(v, 4))) }
                    }
                }
            }
        }
    }
}

/// A label of pictures as HTML.
fn markup(label: &str) -> Markup {
    let mut out = String::new();
    let (mut is_italic, mut open) = (false, Vec::new());
    let text = escape(label);
    let mut rest = text.as_str();
    while let Some(c) = rest.chars().next() {
        let script = [("_{", "sub"), ("^{", "sup")]
            .into_iter()
            .find(|(mark, _)| rest.starts_with(mark));
        if let Some((_, tag)) = script {
            out += &format!("<{tag}>");
            open.push(tag);
            rest = &rest[2..];
            continue;
        }
        match (c, open.last()) {
            ('*', _) => {
                out += if is_italic { "</i>" } else { "<i>" };
                is_italic = !is_italic;
            }
            ('}', Some(tag)) => {
                out += &format!("</{tag}>");
                open.pop();
            }
            _ => out.push(c),
        }
        rest = &rest[c.len_utf8()..];
    }
    PreEscaped(out)
}

/// The same without its marks.
fn plain(label: &str) -> String {
    let marks = ['*', '{', '}', '_', '^'];
    label.replace(marks, "")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_become_html() {
        assert_eq!(
            markup("Time *t*_{99} / *T*_{0} < 1 (10^{−3})").0,
            "Time <i>t</i><sub>99</sub> / <i>T</i><sub>0</sub> &lt; 1 (10<sup>−3</sup>)"
        );
        assert_eq!(plain("*t*_{99}"), "t99");
    }
}
