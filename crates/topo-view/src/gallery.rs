//! `index.html`: every figure with its caption, the published claim and what our numbers say.

use crate::data;
use crate::error::ViewError;
use crate::figures::Done;
use crate::movies::Movie;
use crate::plot::font;
use crate::plot::text::escape;
use crate::provenance::Provenance;
use crate::reproduction::{self, Finding};
use crate::viewer;
use std::fmt::Write;
use std::path::Path;
use topo_lab::Preset;

/// Looks of pages.
pub(crate) const STYLE: &str = "
:root{color-scheme:light dark;--ink:#1b1f24;--quiet:#5d6670;--line:#dde1e6;--ground:#fff;--card:#f7f8fa;--link:#0060a0}
@media(prefers-color-scheme:dark){:root{--ink:#e8eaed;--quiet:#a0a8b2;--line:#343a42;--ground:#15181c;--card:#1d2127;--link:#7cc0f5}}
*{box-sizing:border-box}body{margin:0;background:var(--ground);color:var(--ink);font:17px/1.5 'Source Sans 3',system-ui,sans-serif}
main{max-width:60rem;margin:0 auto;padding:1.5rem 1rem 4rem}h1{font-size:1.9rem;line-height:1.2;margin:.5rem 0}h2{font-size:1.35rem;margin:0 0 .6rem}
nav{display:flex;flex-wrap:wrap;gap:.3rem 1rem;margin:1rem 0 2rem}a{color:var(--link)}section{border-top:1px solid var(--line);padding:1.6rem 0}
img{display:block;width:100%;height:auto;background:#fff;border:1px solid var(--line);border-radius:6px}
dl{background:var(--card);border-radius:6px;padding:.8rem 1rem;margin:1rem 0}dt{font-weight:600}dd{margin:0 0 .6rem}dd:last-child{margin:0}
.claims li{margin:0 0 1rem}.claims p{margin:.1rem 0}.claims b{border-radius:4px;padding:0 .4rem;font-weight:600;border:1px solid var(--line)}.confirmed{background:#cfe8ff;color:#123}.partly{background:#fff0c2;color:#321}.not-confirmed{background:#ffd9cf;color:#311}
.files{color:var(--quiet)}table{border-collapse:collapse;display:block;overflow-x:auto}td{padding:.15rem .8rem .15rem 0;vertical-align:top;overflow-wrap:anywhere}td:first-child{white-space:nowrap;color:var(--quiet)}
";

/// Writes `index.html` into the results folder: one file that opens from disk.
pub fn write(results: &Path, shown: &Page<'_>) -> Result<(), ViewError> {
    let view = viewer::sections(results)?;
    data::write(
        &results.join("index.html"),
        page(results, shown, &view).as_bytes(),
    )
}

/// What the page shows.
#[derive(Clone, Copy)]
pub struct Page<'a> {
    /// Figures, in order.
    pub done: &'a [&'a Done],
    /// Movies with what they show.
    pub movies: &'a [(Movie, String)],
    /// Claims with what was found.
    pub claims: &'a [Finding],
    /// How much was computed.
    pub quality: Preset,
    /// Where it comes from.
    pub provenance: &'a Provenance,
}

/// Link to the scene of a battery's table, where it was written.
fn scene_link(results: &Path, table: &str) -> String {
    let battery = table.split('/').next().unwrap_or("");
    let file = format!("scenes/{battery}.toml");
    if results.join(&file).exists() {
        format!(", <a href=\"{file}\">scene</a>")
    } else {
        String::new()
    }
}

fn page(results: &Path, shown: &Page<'_>, view: &str) -> String {
    let Page {
        done,
        movies,
        claims,
        quality,
        provenance,
    } = *shown;
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
         <title>Topological batteries: figures</title><style>{}{STYLE}{}</style></head><body><main>\n\
         <h1>Topological batteries: figures</h1>\n\
         <p>Knotted elastic fibres store energy when they are twisted and fused, and give it back when \
         they are cut; nematic colloids store it in a patterned anchoring and give it back when that is \
         switched off. {quality} quality; every number below is read from the tables beside this page.</p>\n<nav>",
        font::style(),
        viewer::STYLE
    );
    for (battery, label) in [("elastic", "Knots in 3D"), ("nematic", "Colloids in 3D")] {
        if view.contains(&format!("id=\"view-{battery}\"")) {
            add(
                &mut html,
                format_args!("<a href=\"#view-{battery}\">{label}</a> "),
            );
        }
    }
    if !claims.is_empty() {
        html.push_str("<a href=\"#claims\">Claim by claim</a> ");
    }
    for d in done {
        add(
            &mut html,
            format_args!(
                "<a href=\"#{0}\">{1}</a> ",
                d.figure.name,
                escape(d.figure.title)
            ),
        );
    }
    for (m, _) in movies {
        add(
            &mut html,
            format_args!("<a href=\"#{0}\">{1}</a> ", m.name, escape(m.title)),
        );
    }
    html.push_str("<a href=\"#provenance\">Provenance</a></nav>\n");
    for d in done {
        let f = &d.figure;
        add(
            &mut html,
            format_args!(
                "<section id=\"{name}\"><h2>{title}</h2>\
                 <a href=\"figures/{name}.svg\"><img alt=\"{alt}\" src=\"data:image/png;base64,{png}\"></a>\
                 <p>{caption}</p><dl><dt>Published claim</dt><dd>{claim}</dd><dt>Found here</dt><dd>{finding}</dd></dl>\
                 <p class=\"files\">Files: <a href=\"figures/{name}.svg\">SVG</a>, <a href=\"figures/{name}.png\">PNG</a>, \
                 <a href=\"figures/{name}.csv\">numbers drawn</a>, <a href=\"{table}\">{table}</a>{scene}</p></section>\n",
                name = f.name,
                title = escape(f.title),
                alt = escape(f.caption),
                png = font::base64(&d.preview),
                caption = escape(f.caption),
                claim = escape(f.claim),
                finding = escape(&d.finding),
                table = f.table,
                scene = scene_link(results, f.table),
            ),
        );
    }
    for (m, finding) in movies {
        add(
            &mut html,
            format_args!(
                "<section id=\"{name}\"><h2>{title}</h2><img alt=\"{alt}\" loading=\"lazy\" src=\"figures/{name}.png\">\
                 <p>{caption}</p><dl><dt>Published claim</dt><dd>{claim}</dd><dt>Found here</dt><dd>{finding}</dd></dl>\
                 <p class=\"files\">File: <a href=\"figures/{name}.png\">animated PNG</a>{scene}</p></section>\n",
                name = m.name,
                title = escape(m.title),
                alt = escape(m.caption),
                caption = escape(m.caption),
                claim = escape(m.claim),
                finding = escape(finding),
                scene = scene_link(results, m.battery),
            ),
        );
    }
    html.push_str(&reproduction::section(claims));
    html.push_str(view);
    html.push_str("<section id=\"provenance\"><h2>Provenance</h2><table>");
    for (key, value) in provenance.rows() {
        add(
            &mut html,
            format_args!(
                "<tr><td>{}</td><td>{}</td></tr>",
                escape(key),
                escape(&value)
            ),
        );
    }
    html.push_str("</table><p class=\"files\">All of it: <a href=\"provenance.json\">provenance.json</a></p></section>\n</main></body></html>\n");
    html
}

fn add(html: &mut String, text: std::fmt::Arguments) {
    // Writing to a string cannot fail.
    let _ = html.write_fmt(text);
}
