//! The figures: one file each; a new one is a file and a line in [`ALL`].

mod elastic_charging;
mod elastic_configurations;
mod elastic_discharge;
mod knots_table;
mod series;

use crate::data::{self, Sweep};
use crate::error::XtaskError;
use crate::plot::canvas::Picture;
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
pub const ALL: [Figure; 4] = [
    elastic_configurations::FIGURE,
    elastic_charging::FIGURE,
    elastic_discharge::FIGURE,
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

/// The figures that `--only` names, or all.
pub fn chosen(only: &[String]) -> Result<Vec<Figure>, XtaskError> {
    let known = || ALL.map(|f| f.name).join(", ");
    for name in only {
        if !ALL.iter().any(|f| f.name == name) {
            return Err(XtaskError::Argument {
                key: "--only",
                value: name.clone(),
                remedy: format!("no such figure; the figures are {}", known()),
            });
        }
    }
    let wanted = |f: &&Figure| only.is_empty() || only.iter().any(|n| n == f.name);
    Ok(ALL.iter().filter(wanted).copied().collect())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{gallery, provenance, synthetic};

    fn context(results: &Path) -> Context<'_> {
        Context {
            results,
            quality: Quality::Draft,
            detail: 0.15,
        }
    }

    #[test]
    fn every_figure_is_drawn_with_its_files_and_told_in_the_gallery() {
        let dir = tempfile::tempdir().unwrap();
        synthetic::results(dir.path(), 14, &[-2.0, -1.0, 0.0, 1.0, 2.0]);
        let mut done = Vec::new();
        for figure in ALL {
            let d = draw(figure, &context(dir.path())).unwrap();
            assert!(
                !d.finding.is_empty() && d.preview.starts_with(b"\x89PNG"),
                "{}",
                figure.name
            );
            for extension in ["svg", "png", "csv"] {
                let file = dir
                    .path()
                    .join(format!("figures/{}.{extension}", figure.name));
                assert!(std::fs::metadata(file).unwrap().len() > 500);
            }
            let csv =
                std::fs::read_to_string(dir.path().join(format!("figures/{}.csv", figure.name)))
                    .unwrap();
            let n_columns = csv.lines().next().unwrap().split(',').count();
            assert!(csv.lines().all(|l| l.split(',').count() == n_columns));
            let svg =
                std::fs::read_to_string(dir.path().join(format!("figures/{}.svg", figure.name)))
                    .unwrap();
            assert!(
                missing_glyphs(&svg).is_empty(),
                "{:?}",
                missing_glyphs(&svg)
            );
            assert!(
                svg.contains("Draft quality"),
                "{} does not say its quality",
                figure.name
            );
            done.push(d);
        }
        let mut p = provenance::Provenance::collect(&provenance::workspace(), Quality::Draft);
        p.drew(&done);
        p.warn("slow; slow");
        p.write(dir.path()).unwrap();
        gallery::write(dir.path(), &done, Quality::Draft, &p).unwrap();
        let page = std::fs::read_to_string(dir.path().join("index.html")).unwrap();
        for figure in ALL {
            assert!(page.contains(&format!("id=\"{}\"", figure.name)));
        }
        assert!(page.contains("slow (2)") && !page.contains("http://"));
    }

    /// Characters of the labels that the shipped faces draw as their box for the unknown.
    fn missing_glyphs(svg: &str) -> Vec<char> {
        let spans = svg.split("<tspan").skip(1);
        let shown = spans.filter_map(|s| s.split_once('>')?.1.split_once('<').map(|t| t.0));
        let mut chars: Vec<char> = shown
            .flat_map(str::chars)
            .filter(|c| !c.is_ascii())
            .collect();
        chars.sort_unstable();
        chars.dedup();
        let drawn = |c: char| {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="30" height="30"><text x="5" y="20" font-size="16">{c}</text></svg>"#
            );
            crate::plot::render::pixels(&svg, 1.0).unwrap().take()
        };
        let unknown = drawn('\u{e123}');
        chars.retain(|c| drawn(*c) == unknown);
        chars
    }

    #[test]
    fn an_unknown_character_would_be_noticed() {
        assert_eq!(missing_glyphs("<tspan>θ ℰ −</tspan>"), ['ℰ']);
    }

    #[test]
    fn drawing_twice_gives_the_same_bytes() {
        let draw_one = || {
            let dir = tempfile::tempdir().unwrap();
            synthetic::results(dir.path(), 3, &[-1.0, 0.0, 1.0]);
            draw(ALL[0], &context(dir.path())).unwrap().preview
        };
        assert!(draw_one() == draw_one());
    }

    #[test]
    fn one_state_is_enough() {
        let dir = tempfile::tempdir().unwrap();
        synthetic::results(dir.path(), 2, &[0.0]);
        for figure in ALL {
            draw(figure, &context(dir.path())).unwrap();
        }
    }

    #[test]
    fn missing_results_and_unknown_names_are_told() {
        let dir = tempfile::tempdir().unwrap();
        let e = draw(ALL[0], &context(dir.path())).unwrap_err();
        assert!(e.to_string().contains("sweep.csv"));
        let e = chosen(&["elastic-discharging".to_owned()]).unwrap_err();
        assert!(e.to_string().contains("elastic-discharge,") && e.exit_code() == 2);
        assert_eq!(chosen(&["knots-table".to_owned()]).unwrap().len(), 1);
    }

    /// Draws made-up results at full detail into the folder that `TOPO_LOOK` names.
    #[test]
    #[ignore = "for looking at, not for checking"]
    fn look() {
        let Ok(folder) = std::env::var("TOPO_LOOK") else {
            return;
        };
        let twists: Vec<f64> = (0..17).map(|k| -2.0 + 0.25 * k as f64).collect();
        let results = Path::new(&folder);
        if std::env::var_os("TOPO_LOOK_REAL").is_none() {
            synthetic::results(results, 14, &twists);
        }
        let full = Context {
            detail: 1.0,
            ..context(results)
        };
        let done: Vec<Done> = ALL.iter().map(|f| draw(*f, &full).unwrap()).collect();
        let mut p = provenance::Provenance::collect(&provenance::workspace(), Quality::Draft);
        p.drew(&done);
        p.write(results).unwrap();
        gallery::write(results, &done, Quality::Draft, &p).unwrap();
    }
}
