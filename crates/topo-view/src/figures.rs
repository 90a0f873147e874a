//! The figures: one file each; a new one is a file and a line in [`ALL`].

mod beside;
mod elastic_breaking;
mod elastic_charging;
mod elastic_configurations;
mod elastic_discharge;
mod elastic_work;
mod figure;
mod knots_table;
mod links_table;
pub(crate) mod nematic;
pub(crate) mod series;
pub(crate) mod shapes;
#[cfg(test)]
mod tests;
mod tight;

pub use figure::{Context, Drawn, Figure};
pub(crate) use nematic::profile_scale;

use crate::data;
use crate::error::ViewError;
use crate::movies::{self, Movie};
use crate::plot::canvas;
use std::path::Path;
use std::time::Instant;

/// Every figure, in the order of the gallery.
pub const ALL: [Figure; 9] = [
    elastic_configurations::FIGURE,
    elastic_charging::FIGURE,
    elastic_discharge::FIGURE,
    elastic_breaking::FIGURE,
    elastic_work::FIGURE,
    nematic::charging::FIGURE,
    nematic::discharge::FIGURE,
    knots_table::FIGURE,
    links_table::FIGURE,
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
pub fn chosen(only: &[String]) -> Result<(Vec<Figure>, Vec<Movie>), ViewError> {
    let names = || {
        let movies = movies::ALL.iter().map(|m| m.name);
        ALL.iter().map(|f| f.name).chain(movies)
    };
    for name in only {
        if !names().any(|n| n == name) {
            let known: Vec<&str> = names().collect();
            return Err(ViewError::Argument {
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
pub fn draw(figure: Figure, context: &Context) -> Result<Done, ViewError> {
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
