//! `topo figures`: compute what is missing, draw, and write the gallery.

use super::settings::threads;
use crate::cli::FiguresArgs;
use crate::compute;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use serde_json::json;
use std::path::Path;
use std::time::Instant;
use topo_core::Interrupt;
use topo_knots::KnotTable;
use topo_view::data::{NematicSweep, Sweep};
use topo_view::figures::{self, Context, Done, Figure};
use topo_view::movies::{self, Movie};
use topo_view::provenance::{self, Provenance};
use topo_view::{gallery, reproduction, scenes};

pub fn run(args: &FiguresArgs, workspace: Option<&Path>) -> Result<(), CliError> {
    let (chosen, movies) = figures::chosen(&args.only)?;
    let jobs = threads(args.work.jobs)?;
    let interrupt = interrupt::install();
    let results = args.work.out.as_path();
    output::out(results);
    if args.as_is {
        are_there(results, &chosen, &movies)?;
    }
    let mut record = Provenance::collect(workspace, args.quality);

    let table = KnotTable::builtin_and(args.knots.as_deref())?;
    let order = compute::Order {
        results,
        quality: args.quality,
        jobs,
        fresh: args.work.fresh,
        shard: args.shard,
        as_is: args.as_is,
        elastic: chosen.iter().any(|f| f.table.starts_with("elastic")),
        nematic: chosen.iter().any(|f| f.table.starts_with("nematic/")),
        knots: chosen.iter().any(|f| f.table == "knots/table.csv"),
        links: chosen.iter().any(|f| f.table == "knots/links.csv"),
        table: &table,
        figures: &chosen,
        movies: &movies,
    };
    let failures = compute::tables(&order, &interrupt, &mut record)?;
    if let Some(shard) = args.shard {
        say!(
            "part {shard} is computed; put the case folders of all parts below one folder and run \
             the command without --shard to draw"
        );
        return failures.into_result();
    }

    let mut drawn = Drawn {
        figures: draw_figures(args, &chosen, &interrupt)?,
        movies: draw_movies(args, &movies, &interrupt, &mut record)?,
    };
    let n_drawn = drawn.figures.len();
    drawn.keep_earlier(results);
    if order.elastic {
        for case in &Sweep::read(results)?.cases {
            case.cuts.iter().for_each(|c| record.warn(&c.warnings));
        }
    }
    if order.nematic {
        let sweep = NematicSweep::read(results)?;
        let rows = sweep.rows.iter().chain(&sweep.flowing);
        rows.for_each(|r| record.warn(&r.warnings));
    }
    drawn.write_pages(args, &mut record)?;
    show(results, &drawn.figures[..n_drawn], &record);
    failures.into_result()
}

/// Prints what was found, the warnings, and where the page is.
fn show(results: &Path, drawn: &[Done], record: &Provenance) {
    for d in drawn {
        let name = d.figure.name;
        output::table(&results.join(format!("figures/{name}.csv")));
        output::one_more("figures", json!({ "name": name, "finding": d.finding }));
        say!("{name}: {}", d.finding);
    }
    for (warning, n) in &record.warnings {
        output::warning(format!("{warning} ({n})"));
    }
    let page = results.join("index.html");
    output::data("page", page.display().to_string());
    say!("gallery: {}", page.display());
}

/// Refuses to draw what has neither a table nor a finished case, before anything is done.
fn are_there(results: &Path, figures: &[Figure], movies: &[Movie]) -> Result<(), CliError> {
    let tables = figures.iter().map(|f| (f.name, f.table.to_owned()));
    let of_movies = movies
        .iter()
        .map(|m| (m.name, format!("{}/sweep.csv", m.battery)));
    let (there, lacking): (Vec<_>, Vec<_>) = tables
        .chain(of_movies)
        .partition(|(_, table)| is_there(&results.join(table)));
    if lacking.is_empty() {
        return Ok(());
    }
    let mut missing: Vec<String> = lacking
        .iter()
        .map(|(_, table)| results.join(table).display().to_string())
        .collect();
    missing.dedup();
    let others = match &there[..] {
        [] => String::new(),
        some => {
            let names: Vec<String> = some.iter().map(|(n, _)| format!("--only {n}")).collect();
            format!(", or draw what is there with {}", names.join(" "))
        }
    };
    Err(CliError::Argument {
        key: "--as-is",
        value: "given".to_owned(),
        remedy: format!(
            "not there, and nothing is computed: {}; leave --as-is out to compute it, name the folder by --out{others}",
            missing.join(", ")
        ),
    })
}

/// Whether there is a table, or a finished case of which it can be made.
fn is_there(table: &Path) -> bool {
    let cases = || {
        table
            .parent()
            .and_then(|folder| std::fs::read_dir(folder).ok())
    };
    let mut cases = cases().into_iter().flatten().flatten();
    table.exists() || cases.any(|case| case.path().join("run.json").exists())
}

fn draw_figures(
    args: &FiguresArgs,
    chosen: &[Figure],
    interrupt: &Interrupt,
) -> Result<Vec<Done>, CliError> {
    let context = Context {
        results: &args.work.out,
        quality: args.quality,
        detail: 1.0,
        struts: args.struts,
    };
    let progress = Progress::start("drawing", chosen.len());
    let mut done = Vec::new();
    for &figure in chosen {
        interrupt::check(interrupt)?;
        done.push(figures::draw(figure, &context)?);
        progress.done(figure.name);
    }
    progress.finish();
    Ok(done)
}

/// Movies with what each shows.
fn draw_movies(
    args: &FiguresArgs,
    chosen: &[Movie],
    interrupt: &Interrupt,
    record: &mut Provenance,
) -> Result<Vec<(Movie, String)>, CliError> {
    let mut done = Vec::new();
    for &movie in chosen {
        let progress = Progress::start(movie.name, movies::N_FRAMES);
        let start = Instant::now();
        let stage = movies::Stage {
            results: &args.work.out,
            quality: args.quality,
            interrupt,
            drawn: &|| progress.done("frame"),
        };
        let finding = movies::draw(movie, &stage)?;
        progress.finish();
        let name = movie.name;
        output::one_more("movies", json!({ "name": name, "finding": finding }));
        say!("{name}: {finding}");
        let seconds = start.elapsed().as_secs_f64();
        record.wall_seconds.insert(movie.name.to_owned(), seconds);
        done.push((movie, finding));
    }
    Ok(done)
}

/// What the gallery shows.
struct Drawn {
    figures: Vec<Done>,
    movies: Vec<(Movie, String)>,
}

impl Drawn {
    /// Adds what earlier commands drew.
    fn keep_earlier(&mut self, results: &Path) {
        let mut earlier = provenance::earlier_findings(results);
        for figure in figures::ALL {
            if self.figures.iter().all(|d| d.figure.name != figure.name)
                && let Some(finding) = earlier.remove(figure.name)
            {
                self.figures.extend(figures::kept(figure, results, finding));
            }
        }
        for movie in movies::ALL {
            let there = results.join(format!("figures/{}.png", movie.name)).exists();
            if self.movies.iter().all(|(m, _)| m.name != movie.name)
                && let Some(finding) = earlier.remove(movie.name).filter(|_| there)
            {
                self.movies.push((movie, finding));
            }
        }
    }

    /// Writes provenance, report, scenes and gallery.
    fn write_pages(&self, args: &FiguresArgs, record: &mut Provenance) -> Result<(), CliError> {
        let results = args.work.out.as_path();
        let place = |d: &Done| figures::ALL.iter().position(|f| f.name == d.figure.name);
        let mut shown: Vec<&Done> = self.figures.iter().collect();
        shown.sort_by_key(|d| place(d));
        record.drew(&self.figures);
        for (movie, finding) in &self.movies {
            let name = movie.name.to_owned();
            record.findings.insert(name, finding.clone());
        }
        record.write(results)?;
        let claims = reproduction::findings(results)?;
        reproduction::write(results, args.quality, &claims)?;
        scenes::write(results, args.quality)?;
        let page = gallery::Page {
            done: &shown,
            movies: &self.movies,
            claims: &claims,
            quality: args.quality,
            provenance: record,
        };
        Ok(gallery::write(results, &page)?)
    }
}
