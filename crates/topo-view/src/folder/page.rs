//! The page that shows the pictures of a folder.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::DrawnSweep;
use crate::gallery::STYLE;
use crate::plot::font;
use crate::plot::text::{escape, significant};

/// Most rows that the page lists.
const MOST_ROWS: usize = 60;

/// The page: it lies beside the pictures.
pub(super) fn write(folder: &Path, sweeps: &[DrawnSweep], foreign: &[(PathBuf, String)]) -> String {
    let title = format!("Results in {}", escape(&folder.display().to_string()));
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
         <title>{title}</title><style>{}{STYLE}</style></head><body><main>\n<h1>{title}</h1>\n",
        font::style()
    );
    if sweeps.len() > 1 {
        html += "<nav>";
        for sweep in sweeps {
            let name = escape(&sweep.name);
            add(&mut html, format_args!("<a href=\"#{name}\">{name}</a> "));
        }
        html += "</nav>\n";
    }
    for sweep in sweeps {
        section(&mut html, sweep);
    }
    if !foreign.is_empty() {
        html += "<section><h2>Not drawn</h2><ul>";
        for (place, why) in foreign {
            let place = escape(&place.display().to_string());
            add(&mut html, format_args!("<li>{place}: {}</li>", escape(why)));
        }
        html += "</ul></section>\n";
    }
    html + "</main></body></html>\n"
}

fn section(html: &mut String, sweep: &DrawnSweep) {
    let name = escape(&sweep.name);
    let cases = &sweep.cases;
    add(
        html,
        format_args!(
            "<section id=\"{name}\"><h2>{name}</h2><p>{}: {} finished cases, {} discharges.",
            escape(&capital(sweep.what)),
            cases.first_rows().len(),
            cases.rows.len()
        ),
    );
    let shared: Vec<String> = cases.shared().iter().map(|s| markup(s)).collect();
    if !shared.is_empty() {
        add(html, format_args!(" All: {}.", shared.join(", ")));
    }
    *html += "</p>\n";
    let lacks = sweep.lacks();
    if !lacks.is_empty() {
        *html += "<ul>";
        for line in &lacks {
            add(html, format_args!("<li>{}</li>", escape(line)));
        }
        *html += "</ul>\n";
    }
    for shot in &sweep.shots {
        let file = escape(&shot.name);
        let title = markup(&shot.title);
        add(
            html,
            format_args!(
                "<h3>{title}</h3><a href=\"{file}.svg\"><img alt=\"{}\" src=\"{file}.png\"></a>\
                 <p class=\"files\">{} Files: <a href=\"{file}.svg\">SVG</a>, <a href=\"{file}.png\">PNG</a>, \
                 <a href=\"{file}.csv\">numbers drawn</a></p>\n",
                plain(&shot.title),
                markup(&shot.drawn.finding)
            ),
        );
    }
    rows(html, sweep);
    *html += "</section>\n";
}

/// The rows as a table: what is swept, and the results that have a panel of their own.
fn rows(html: &mut String, sweep: &DrawnSweep) {
    let cases = &sweep.cases;
    if cases.rows.is_empty() || cases.rows.len() > MOST_ROWS {
        return;
    }
    let columns = cases.guide.results.iter().flat_map(|q| q.columns);
    let columns: Vec<(&str, &str)> = columns.filter_map(|c| Some((c.name, c.alone?))).collect();
    *html += "<table><tr><td>Case</td>";
    for swept in &cases.swept {
        add(
            html,
            format_args!("<td>{}</td>", markup(swept.setting.label)),
        );
    }
    for (_, label) in &columns {
        add(html, format_args!("<td>{}</td>", markup(label)));
    }
    *html += "</tr>\n";
    for row in &cases.rows {
        add(html, format_args!("<tr><td>{}</td>", escape(row.case())));
        for swept in &cases.swept {
            let value = row.text(swept.setting.column);
            add(html, format_args!("<td>{}</td>", markup(&swept.say(value))));
        }
        for (name, _) in &columns {
            let value = row.number(name).map(|v| significant(v, 4));
            add(html, format_args!("<td>{}</td>", value.unwrap_or_default()));
        }
        *html += "</tr>\n";
    }
    *html += "</table>\n";
}

/// A label of pictures as HTML.
fn markup(label: &str) -> String {
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
    out
}

/// The same without its marks.
fn plain(label: &str) -> String {
    let marks = ['*', '{', '}', '_', '^'];
    escape(&label.replace(marks, ""))
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

fn add(html: &mut String, text: std::fmt::Arguments) {
    // Writing to a string cannot fail.
    let _ = html.write_fmt(text);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_become_html() {
        assert_eq!(
            markup("Time *t*_{99} / *T*_{0} < 1 (10^{−3})"),
            "Time <i>t</i><sub>99</sub> / <i>T</i><sub>0</sub> &lt; 1 (10<sup>−3</sup>)"
        );
        assert_eq!(plain("*t*_{99}"), "t99");
    }
}
