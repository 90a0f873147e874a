//! `topo figures`: compute what is missing, draw, and write the gallery.

use super::settings::threads;
use crate::cli::FiguresArgs;
use crate::compute;
use crate::error::CliError;
use crate::interrupt;
use crate::progress::Progress;
use std::path::Path;
use std::time::Instant;
use topo_knots::KnotTable;
use topo_view::data::{NematicSweep, Sweep};
use topo_view::figures::{self, Context, Done};
use topo_view::movies::{self, Movie};
use topo_view::provenance::{self, Provenance};
use topo_view::{gallery, reproduction, scenes};

pub fn run(args: &FiguresArgs, workspace: Option<&Path>) -> Result<(), CliError> {
    let (chosen, movies) = figures::chosen(&args.only)?;
    let jobs = threads(args.work.jobs)?;
    let interrupt = interrupt::install();
    let results = args.work.out.as_path();
    let mut record = Provenance::collect(workspace, args.quality);

    let table = KnotTable::builtin_and(args.knots.as_deref())?;
    let order = compute::Order {
        results,
        quality: args.quality,
        jobs,
        fresh: args.work.fresh,
        shard: args.shard,
        as_is: args.as_is,
        elastic: chosen.iter().any(|f| f.table.starts_with("elastic/")),
        nematic: chosen.iter().any(|f| f.table.starts_with("nematic/")),
        knots: chosen.iter().any(|f| f.table.starts_with("knots/")),
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

    let context = Context {
        results,
        quality: args.quality,
        detail: 1.0,
        struts: args.struts,
    };
    let progress = Progress::start("drawing", chosen.len());
    let mut done: Vec<Done> = Vec::new();
    for &figure in &chosen {
        interrupt::check(&interrupt)?;
        done.push(figures::draw(figure, &context)?);
        progress.done(figure.name);
    }
    progress.finish();
    let n_drawn = done.len();
    let mut shown_movies: Vec<(Movie, String)> = Vec::new();
    for &movie in &movies {
        let progress = Progress::start(movie.name, movies::N_FRAMES);
        let start = Instant::now();
        let stage = movies::Stage {
            results,
            quality: args.quality,
            interrupt: &interrupt,
            drawn: &|| progress.done("frame"),
        };
        let finding = movies::draw(movie, &stage)?;
        progress.finish();
        say!("{}: {finding}", movie.name);
        record
            .wall_seconds
            .insert(movie.name.to_owned(), start.elapsed().as_secs_f64());
        shown_movies.push((movie, finding));
    }
    let mut earlier = provenance::earlier_findings(results);
    // The gallery keeps what earlier commands drew.
    for figure in figures::ALL {
        if done.iter().all(|d| d.figure.name != figure.name)
            && let Some(finding) = earlier.remove(figure.name)
        {
            done.extend(figures::kept(figure, results, finding));
        }
    }
    for movie in movies::ALL {
        let there = results.join(format!("figures/{}.png", movie.name)).exists();
        if shown_movies.iter().all(|(m, _)| m.name != movie.name)
            && let Some(finding) = earlier.remove(movie.name).filter(|_| there)
        {
            shown_movies.push((movie, finding));
        }
    }
    let place = |d: &Done| figures::ALL.iter().position(|f| f.name == d.figure.name);
    let mut shown: Vec<&Done> = done.iter().collect();
    shown.sort_by_key(|d| place(d));
    record.drew(&done);
    for (movie, finding) in &shown_movies {
        record
            .findings
            .insert(movie.name.to_owned(), finding.clone());
    }
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
    record.write(results)?;
    let claims = reproduction::findings(results)?;
    reproduction::write(results, args.quality, &claims)?;
    scenes::write(results, args.quality)?;
    let page = gallery::Page {
        done: &shown,
        movies: &shown_movies,
        claims: &claims,
        quality: args.quality,
        provenance: &record,
    };
    gallery::write(results, &page)?;
    for d in &done[..n_drawn] {
        say!("{}: {}", d.figure.name, d.finding);
    }
    say!("gallery: {}", results.join("index.html").display());
    failures.into_result()
}
