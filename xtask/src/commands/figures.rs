//! `cargo xtask figures`: compute what is missing, draw, and write the gallery.

use crate::cli::FiguresArgs;
use crate::compute;
use crate::data::Sweep;
use crate::error::XtaskError;
use crate::figures::{self, Context, Done};
use crate::gallery;
use crate::interrupt;
use crate::progress::Progress;
use crate::provenance::{Provenance, workspace};

pub fn run(args: &FiguresArgs) -> Result<(), XtaskError> {
    let chosen = figures::chosen(&args.only)?;
    let jobs = super::threads(args.work.jobs)?;
    let interrupt = interrupt::install();
    let results = args.work.out.as_path();
    let mut provenance = Provenance::collect(&workspace(), args.quality);

    let order = compute::Order {
        results,
        quality: args.quality,
        jobs,
        fresh: args.work.fresh,
        elastic: chosen.iter().any(|f| f.table.starts_with("elastic/")),
        knots: chosen.iter().any(|f| f.table.starts_with("knots/")),
    };
    compute::tables(&order, &interrupt, &mut provenance)?;

    let context = Context {
        results,
        quality: args.quality,
        detail: 1.0,
    };
    let progress = Progress::start("drawing", chosen.len());
    let mut done: Vec<Done> = Vec::new();
    for figure in chosen {
        interrupt::check(&interrupt)?;
        done.push(figures::draw(figure, &context)?);
        progress.done(figure.name);
    }
    progress.finish();
    provenance.drew(&done);
    if order.elastic {
        for case in &Sweep::read(results)?.cases {
            case.cuts.iter().for_each(|c| provenance.warn(&c.warnings));
        }
    }
    provenance.write(results)?;
    gallery::write(results, &done, args.quality, &provenance)?;
    for d in &done {
        println!("{}: {}", d.figure.name, d.finding);
    }
    println!("gallery: {}", results.join("index.html").display());
    Ok(())
}
