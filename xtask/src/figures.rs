//! The figures: one file each; a new one is a file and a line in [`ALL`].

mod elastic_charging;
mod elastic_configurations;
mod elastic_discharge;
mod knots_table;
pub mod nematic;
pub mod series;
#[cfg(test)]
mod tests;

pub use nematic::profile_scale;

use crate::data::{self, Sweep};
use crate::error::XtaskError;
use crate::movies::{self, Movie};
use crate::plot::canvas::{self, Picture};
use clap::ValueEnum;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// How much is computed, and how it is said on the face of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// 14 knots at 17 twists, one cut each: minutes.
    Draft,
    /// The same with every near-tied cut.
    Standard,
    /// Twice the resolution, all readings of the zero-twist row.
    Paper,
}

impl std::fmt::Display for Quality {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Draft => "Draft",
            Self::Standard => "Standard",
            Self::Paper => "Paper",
        })
    }
}

/// What a figure draws from.
#[derive(Debug, Clone, Copy)]
pub struct Context<'a> {
    /// Folder of the results.
    pub results: &'a Path,
    /// Said on the face.
    pub quality: Quality,
    /// Factor on the pixels of the PNG; 1 for print.
    pub detail: f64,
    /// Whether tight knots are thin tubes with their struts.
    pub struts: bool,
}

/// A figure as drawn.
#[derive(Debug)]
pub struct Drawn {
    /// The picture.
    pub picture: Picture,
    /// The numbers it shows.
    pub csv: String,
    /// What our numbers say, for the gallery.
    pub finding: String,
}

/// An entry of the gallery.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// File stem, and the value of `--only`.
    pub name: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What is drawn.
    pub caption: &'static str,
    /// What the published figure claims.
    pub claim: &'static str,
    /// Table inside the results folder that it mainly shows.
    pub table: &'static str,
    draw: fn(&Context) -> Result<Drawn, XtaskError>,
}

/// Every figure, in the order of the gallery.
pub const ALL: [Figure; 6] = [
    elastic_configurations::FIGURE,
    elastic_charging::FIGURE,
    elastic_discharge::FIGURE,
    nematic::charging::FIGURE,
    nematic::discharge::FIGURE,
    knots_table::FIGURE,
];

/// A figure with its files written.
#[derive(Debug)]
pub struct Done {
    /// Which.
    pub figure: Figure,
    /// PNG bytes at half the size.
    pub preview: Vec<u8>,
    /// What our numbers say.
    pub finding: String,
    /// Seconds it took to draw.
    pub seconds: f64,
}

/// The figures and movies that `--only` names, or all.
pub fn chosen(only: &[String]) -> Result<(Vec<Figure>, Vec<Movie>), XtaskError> {
    let names = || {
        let movies = movies::ALL.iter().map(|m| m.name);
        ALL.iter().map(|f| f.name).chain(movies)
    };
    for name in only {
        if !names().any(|n| n == name) {
            let known: Vec<&str> = names().collect();
            return Err(XtaskError::Argument {
                key: "--only",
                value: name.clone(),
                remedy: format!("no such figure; the figures are {}", known.join(", ")),
            });
        }
    }
    let wanted = |name: &str| only.is_empty() || only.iter().any(|n| n == name);
    let figures = ALL.iter().filter(|f| wanted(f.name));
    let movies = movies::ALL.iter().filter(|m| wanted(m.name));
    Ok((figures.copied().collect(), movies.copied().collect()))
}

/// Draws a figure and writes `figures/NAME.{svg,png,csv}`.
pub fn draw(figure: Figure, context: &Context) -> Result<Done, XtaskError> {
    let start = Instant::now();
    let drawn = (figure.draw)(context)?;
    let file = |extension: &str| {
        context
            .results
            .join("figures")
            .join(format!("{}.{extension}", figure.name))
    };
    data::write(&file("csv"), drawn.csv.as_bytes())?;
    data::write(&file("svg"), drawn.picture.svg.as_bytes())?;
    data::write(&file("png"), &drawn.picture.png)?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done {
        figure,
        preview: drawn.picture.preview,
        finding: drawn.finding,
        seconds,
    })
}

/// A figure that an earlier command drew, for the gallery; `None` if there is none to read.
pub fn kept(figure: Figure, results: &Path, finding: String) -> Option<Done> {
    let png = std::fs::read(results.join(format!("figures/{}.png", figure.name))).ok()?;
    let preview = canvas::preview(&png).ok()?;
    Some(Done {
        figure,
        preview,
        finding,
        seconds: 0.0,
    })
}

/// Foot of the elastic figures: quality, and where the runs depart from the published ones.
fn face(sweep: &Sweep, quality: Quality) -> Vec<String> {
    let first = sweep.cases[0].first();
    let reading = match first.reading.as_str() {
        "shrunk" => "*L* = 50 *h*, contact diameter 2*h* min(1, 50/Rop)",
        "hard" => "*L* = 50 *h*, contact diameter 2*h*",
        "tight" => "*L* = 50 *h*, contact diameter 100 *h*/Rop",
        "own-length" => "*L* = Rop *h*, contact diameter 2*h*",
        other => other,
    };
    let n_cuts: usize = sweep.cases.iter().map(|c| c.cuts.len()).sum();
    let cuts = if n_cuts == sweep.cases.len() {
        "one cut a state, at the largest energy density".to_owned()
    } else {
        format!("{n_cuts} cuts, at every near-tied largest energy density")
    };
    vec![
        format!(
            "{quality} quality: {} states, *N* = {} edges, {cuts}. Published parameters α^{{−1}} = 1.3, γ = 5, *L*/*h* = 50.",
            sweep.cases.len(),
            first.edges
        ),
        format!(
            "Read here as “{}”: {reading}, friction within 2*h*; Rop is a knot’s ropelength in radii.",
            first.reading
        ),
    ]
}
