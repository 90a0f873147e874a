//! `index.html`: every figure with its caption, the published claim and what our numbers say.

use crate::data;
use crate::error::ViewError;
use crate::figures::Done;
use crate::movies::{self, Movie};
use crate::plot::font;
use crate::provenance::Provenance;
use crate::reproduction::{self, Finding};
use crate::viewer;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::path::Path;
use topo_lab::Preset;

/// Looks of pages.
const STYLE: &str = "
:root{color-scheme:light dark;--ink:#1b1f24;--quiet:#5d6670;--line:#dde1e6;--ground:#fff;--card:#f7f8fa;--link:#0060a0}
@media(prefers-color-scheme:dark){:root{--ink:#e8eaed;--quiet:#a0a8b2;--line:#343a42;--ground:#15181c;--card:#1d2127;--link:#7cc0f5}}
*{box-sizing:border-box}body{margin:0;background:var(--ground);color:var(--ink);font:17px/1.5 'Source Sans 3',system-ui,sans-serif}
main{max-width:60rem;margin:0 auto;padding:1.5rem 1rem 4rem}h1{font-size:1.9rem;line-height:1.2;margin:.5rem 0}h2{font-size:1.35rem;margin:0 0 .6rem}
nav{display:flex;flex-wrap:wrap;gap:.3rem 1rem;margin:1rem 0 2rem}a{color:var(--link)}section{border-top:1px solid var(--line);padding:1.6rem 0}
img{display:block;width:100%;height:auto;background:#fff;border:1px solid var(--line);border-radius:6px}
dl{background:var(--card);border-radius:6px;padding:.8rem 1rem;margin:1rem 0}dt{font-weight:600}dd{margin:0 0 .6rem}dd:last-child{margin:0}
.claims li{margin:0 0 1rem}.claims p{margin:.1rem 0}.claims b{border-radius:4px;padding:0 .4rem;font-weight:600;border:1px solid var(--line)}.confirmed{background:#cfe8ff;color:#123}.partly{background:#fff0c2;color:#321}.not-confirmed{background:#ffd9cf;color:#311}
.movie img{cursor:pointer}.movie button{font:inherit;color:inherit;background:var(--ground);border:1px solid var(--line);border-radius:5px;padding:.25rem .9rem;margin:.6rem 0;cursor:pointer}
.files{color:var(--quiet)}table{border-collapse:collapse;display:block;overflow-x:auto}td{padding:.15rem .8rem .15rem 0;vertical-align:top;overflow-wrap:anywhere}td:first-child{white-space:nowrap;color:var(--quiet)}
";

/// A movie is loaded when it is to be played: before and after it stands still at its first frame.
const MOVIES: &str = "
for (const box of document.querySelectorAll('.movie')) {
  const image = box.querySelector('img'), button = box.querySelector('button'), still = image.src;
  const turn = () => {
    const plays = button.textContent === 'Stop';
    image.src = plays ? still : box.dataset.movie;
    button.textContent = plays ? 'Play' : 'Stop';
  };
  for (const part of [image, button]) part.addEventListener('click', turn);
}
";

/// Writes `index.html` into the results folder: it opens from disk, small, and loads pictures and shapes beside it as they are seen.
pub fn write(results: &Path, shown: &Page<'_>) -> Result<(), ViewError> {
    let view = viewer::sections(results)?;
    for d in shown.done {
        let file = format!("figures/preview/{}.png", d.figure.name);
        data::write(&results.join(file), &d.preview)?;
    }
    for (m, _) in shown.movies {
        let movie = results.join(format!("figures/{}.png", m.name));
        let bytes = std::fs::read(&movie).map_err(|source| ViewError::File {
            path: movie,
            source,
        })?;
        let file = format!("figures/preview/{}.png", m.name);
        data::write(&results.join(file), &movies::still(&bytes))?;
    }
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

/// The file of the scene of a battery's table, where it was written.
fn scene_of(results: &Path, table: &str) -> Option<String> {
    let battery = table.split('/').next().unwrap_or("");
    let file = format!("scenes/{battery}.toml");
    results.join(&file).exists().then_some(file)
}

/// A page with title and style of all pages; `style` is added.
pub(crate) fn document(title: &str, style: &str, content: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width,initial-scale=1";
                title { (title) }
                style { (PreEscaped(font::style())) (PreEscaped(STYLE)) (PreEscaped(style)) }
            }
            body { main { h1 { (title) } (content) } }
        }
    };
    page.into_string() + "\n"
}

fn page(results: &Path, shown: &Page<'_>, view: &str) -> String {
    let content = html! {
        p {
            "Knotted elastic fibres store energy when they are twisted and fused, and give it back when they are cut; nematic colloids \
             store it in a patterned anchoring and give it back when that is switched off. " (shown.quality) " quality; every number \
             below is read from the tables beside this page."
        }
        (links(shown, view))
        @for d in shown.done { (figure(results, d)) }
        @for (m, finding) in shown.movies { (movie(results, m, finding)) }
        @if !shown.movies.is_empty() { script { (PreEscaped(MOVIES)) } }
        (reproduction::section(shown.claims))
        (PreEscaped(view))
        section id="provenance" {
            h2 { "Provenance" }
            table {
                @for (key, value) in shown.provenance.rows() { tr { td { (key) } td { (value) } } }
            }
            p.files { "All of it: " a href="provenance.json" { "provenance.json" } }
        }
    };
    document("Topological batteries: figures", viewer::STYLE, &content)
}

/// Links to the parts of the page.
fn links(shown: &Page<'_>, view: &str) -> Markup {
    let views = [
        ("view-elastic", "Knots in 3D"),
        ("view-nematic", "Colloids in 3D"),
    ];
    let there = |(id, _): &&(&str, &str)| view.contains(&format!("id=\"{id}\""));
    html! {
        nav {
            @for (id, label) in views.iter().filter(there) { a href={ "#" (id) } { (label) } " " }
            @if !shown.claims.is_empty() { a href="#claims" { "Claim by claim" } " " }
            @for d in shown.done { a href={ "#" (d.figure.name) } { (d.figure.title) } " " }
            @for (m, _) in shown.movies { a href={ "#" (m.name) } { (m.title) } " " }
            a href="#provenance" { "Provenance" }
        }
    }
}

/// Width and height of a PNG, from its header.
fn png_size(png: &[u8]) -> [u32; 2] {
    let number = |at: usize| {
        let bytes = png.get(at..at + 4).and_then(|b| b.try_into().ok());
        bytes.map_or(0, u32::from_be_bytes)
    };
    [number(16), number(20)]
}

fn figure(results: &Path, done: &Done) -> Markup {
    let f = &done.figure;
    // the page keeps their places free, so that pictures further down are loaded when they are reached
    let [width, height] = png_size(&done.preview);
    html! {
        section id=(f.name) {
            h2 { (f.title) }
            a href={ "figures/" (f.name) ".svg" } {
                img alt=(f.caption) loading="lazy" width=(width) height=(height) src={ "figures/preview/" (f.name) ".png" };
            }
            (said(f.caption, f.claim, &done.finding))
            p.files {
                "Files: " a href={ "figures/" (f.name) ".svg" } { "SVG" } ", "
                a href={ "figures/" (f.name) ".png" } { "PNG" } ", "
                a href={ "figures/" (f.name) ".csv" } { "numbers drawn" } ", "
                a href=(f.table) { (f.table) }
                (scene_link(results, f.table))
            }
        }
    }
}

fn movie(results: &Path, movie: &Movie, finding: &str) -> Markup {
    let file = format!("figures/{}.png", movie.name);
    html! {
        section id=(movie.name) {
            h2 { (movie.title) }
            div.movie data-movie=(file) {
                img alt=(movie.caption) loading="lazy" width=(movies::SIZE.width) height=(movies::SIZE.height) src={ "figures/preview/" (movie.name) ".png" };
                button type="button" { "Play" }
            }
            (said(movie.caption, movie.claim, finding))
            p.files {
                "File: " a href=(file) { "animated PNG" }
                (scene_link(results, movie.battery))
            }
        }
    }
}

fn scene_link(results: &Path, table: &str) -> Markup {
    html! {
        @if let Some(scene) = scene_of(results, table) { ", " a href=(scene) { "scene" } }
    }
}

fn said(caption: &str, claim: &str, finding: &str) -> Markup {
    html! {
        p { (caption) }
        dl {
            dt { "Published claim" }
            dd { (claim) }
            dt { "Found here" }
            dd { (finding) }
        }
    }
}

#[cfg(test)]
mod tests;
