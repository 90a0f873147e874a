//! What a figure is.

use std::path::Path;

use crate::data::Sweep;
use crate::error::ViewError;
use crate::plot::canvas::Picture;
use topo_lab::Preset;

/// What a figure draws from.
#[derive(Debug, Clone, Copy)]
pub struct Context<'a> {
    /// Folder of the results.
    pub results: &'a Path,
    /// Said on the face.
    pub quality: Preset,
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
    pub(super) draw: fn(&Context) -> Result<Drawn, ViewError>,
}

/// Foot of the elastic figures: quality, and where the runs depart from the published ones.
pub(super) fn face(sweep: &Sweep, quality: Preset) -> Vec<String> {
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
