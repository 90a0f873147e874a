//! `topo knot tighten`: tight shapes with their certificates.

use super::table::{self, Row};
use crate::cli::TightenArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use rayon::prelude::*;
use serde_json::json;
use std::path::Path;
use topo_core::{Interrupt, write_atomic_bytes};
use topo_knots::{
    KnotEntry, KnotError, KnotTable, SecondOpinion, TightKnot, TightenSettings, ideal_until,
    parse_braid, read_curve, second_opinion_until, tighten_by_hops_until, write_curve,
};

pub(super) fn run(args: &TightenArgs, knots: &KnotTable) -> Result<(), CliError> {
    super::super::settings::threads(args.jobs)?;
    let stop = interrupt::install();
    let entries = entries(args, knots)?;
    let settings = settings(args);
    let folder = args.out.as_path();
    output::out(folder);
    let cache = folder.join("cache");
    if args.fresh && cache.exists() {
        std::fs::remove_dir_all(&cache).map_err(|source| CliError::File {
            path: cache.clone(),
            source,
        })?;
    }
    let one = |entry: &KnotEntry| -> Result<Option<Row>, CliError> {
        if stop.is_requested() {
            return Ok(None);
        }
        let made = match args.hops {
            0 => ideal_until(entry, &settings, Some(&cache), &stop),
            n => tighten_by_hops_until(entry, n, &settings, &stop),
        };
        let (tight, is_whole) = match made {
            Err(KnotError::Interrupted { best }) => (*best, false),
            made => (made?, true),
        };
        if !is_whole && is_beaten(&tight, folder) {
            note!("{}: the shorter curve of an earlier run stays", tight.name);
            return Ok(None);
        }
        let row = Row::new(entry, &tight, write(entry, &tight, args, folder, &stop)?);
        say!("{}", row.sentence);
        Ok(Some(row))
    };
    let made: Vec<_> = entries.par_iter().with_max_len(1).map(one).collect();
    let made = made.into_iter().collect::<Result<Vec<Option<Row>>, _>>()?;
    let rows: Vec<Row> = made.into_iter().flatten().collect();
    if !rows.is_empty() {
        let path = folder.join("table.md");
        let text = table::markdown(&rows);
        write_atomic_bytes(&path, text.as_bytes()).map_err(KnotError::from)?;
        output::table(&path);
        say!("curves, certificates and table: {}", folder.display());
    }
    interrupt::check(&stop)
}

/// Whether an earlier run has left a shorter curve: one that was cut short does not take its place.
fn is_beaten(tight: &TightKnot, folder: &Path) -> bool {
    let path = folder.join(format!("{}.json", tight.name));
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let earlier: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    earlier["length_over_radius"]
        .as_f64()
        .is_some_and(|length| length < tight.length_over_radius)
}

/// The knots that the arguments ask for.
fn entries(args: &TightenArgs, table: &KnotTable) -> Result<Vec<KnotEntry>, CliError> {
    if let Some(word) = &args.braid {
        return Ok(vec![KnotEntry::of_braid(&letters(word)?, table)?]);
    }
    if let Some(path) = &args.curve {
        let component = read_curve(path)?;
        if component.closed == Some(false) {
            return Err(CliError::Input(format!(
                "{}: the curve is open; only closed curves can be tightened",
                path.display()
            )));
        }
        return Ok(vec![KnotEntry::of_curve(&component.vertices, table)?]);
    }
    if args.names == ["all"] {
        return Ok(table.iter().cloned().collect());
    }
    let entry = |name: &String| Ok(table.get(name)?.into_owned());
    args.names.iter().map(entry).collect()
}

fn letters(word: &str) -> Result<Vec<i32>, CliError> {
    parse_braid(word).map_err(|e| CliError::Argument {
        key: "--braid",
        value: word.to_owned(),
        remedy: e.to_string(),
    })
}

fn settings(args: &TightenArgs) -> TightenSettings {
    TightenSettings {
        n_inversions: args.inversions,
        seed: args.seed,
        ..args.quality.tighten()
    }
}

/// The second method's opinion, where it is asked for; none when interrupted.
fn second(
    tight: &TightKnot,
    args: &TightenArgs,
    stop: &Interrupt,
) -> Result<Option<SecondOpinion>, CliError> {
    if !args.check || stop.is_requested() {
        return Ok(None);
    }
    match second_opinion_until(tight, stop) {
        Err(KnotError::Interrupted { .. }) => Ok(None),
        second => Ok(Some(second?)),
    }
}

/// Writes curve and certificate; returns a line of numbers.
fn write(
    entry: &KnotEntry,
    tight: &TightKnot,
    args: &TightenArgs,
    folder: &Path,
    stop: &Interrupt,
) -> Result<String, CliError> {
    std::fs::create_dir_all(folder).map_err(|source| CliError::File {
        path: folder.to_owned(),
        source,
    })?;
    let path = |extension: &str| folder.join(format!("{}.{extension}", tight.name));
    write_curve(&path(&args.format), &tight.curve)?;
    let length = tight.length_over_radius;
    let excess = table::excess(entry, tight);
    let certificate = &tight.certificate;
    let second = second(tight, args, stop)?;
    let apart = second.as_ref().map(|s| s.length_over_radius / length - 1.0);
    let record = json!({
        "knot": tight.name, "vertices": tight.curve.n_vertices(), "length_over_radius": length,
        "published": entry.length_over_radius, "source": entry.source, "excess_percent": excess,
        "certificate": certificate, "cpu_seconds": tight.cpu_seconds, "factorisations": tight.n_factorisations,
        "second_method": second.as_ref().map(|s| json!({
            "length_over_radius": s.length_over_radius, "relative_difference": apart, "converged": s.converged,
            "start_length_over_radius": s.start_length_over_radius, "evaluations": s.n_evaluations, "cpu_seconds": s.cpu_seconds,
        })),
    });
    let text = format!("{record:#}\n");
    output::one_more("knots", &record);
    write_atomic_bytes(&path("json"), text.as_bytes()).map_err(KnotError::from)?;
    let mut line = format!(
        "{:8} {:5} vertices  L/r {length:9.4}",
        tight.name,
        tight.curve.n_vertices()
    );
    line += &match (entry.length_over_radius, excess) {
        (Some(published), Some(excess)) => format!("  published {published:9.4} ({excess:+.4} %)"),
        _ => "  published   missing           ".to_owned(),
    };
    line += &format!(
        "  Wr {:+.4}  struts {:5}  kinks {:2}  residual {:.4}  {:5.1} CPU s",
        certificate.writhe,
        certificate.n_struts,
        certificate.n_kinks,
        certificate.residual,
        tight.cpu_seconds
    );
    if let (Some(second), Some(apart)) = (&second, apart) {
        line += &format!(
            "  second method {:.4} ({apart:+.1e})",
            second.length_over_radius
        );
    }
    if !certificate.converged && stop.is_requested() {
        line += "  INTERRUPTED: the best curve so far is kept";
        output::warning(format!(
            "{}: interrupted, the best curve so far is kept",
            tight.name
        ));
    } else if !certificate.converged {
        line += "  NOT CONVERGED: the best curve is kept";
        output::warning(format!(
            "{}: not converged, the best curve is kept",
            tight.name
        ));
    }
    Ok(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_and_faults_named() {
        assert_eq!(letters("1 -2, 1 -2").unwrap(), [1, -2, 1, -2]);
        assert_eq!(letters("[1, 1, 1]").unwrap(), [1, 1, 1]);
        let error = letters("1 -2 a").unwrap_err();
        assert!(error.to_string().contains("`a`") && error.exit_code() == 2);
    }
}
