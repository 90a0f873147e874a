//! `topo knot tighten`: tight shapes with their certificates.

use super::table::{self, Row};
use crate::cli::TightenArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use rayon::prelude::*;
use serde_json::json;
use std::path::Path;
use topo_core::write_atomic_bytes;
use topo_knots::{
    KnotEntry, KnotError, KnotTable, TightKnot, TightenSettings, ideal, parse_braid, read_curve,
    second_opinion, tighten_by_hops, write_curve,
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
    let made: Vec<Result<Row, CliError>> = entries
        .par_iter()
        .with_max_len(1)
        .map(|entry| {
            interrupt::check(&stop)?;
            let tight = match args.hops {
                0 => ideal(entry, &settings, Some(&cache))?,
                n => tighten_by_hops(entry, n, &settings)?,
            };
            let row = Row::new(entry, &tight, write(entry, &tight, args, folder)?);
            say!("{}", row.told);
            Ok(row)
        })
        .collect();
    let rows = made.into_iter().collect::<Result<Vec<Row>, _>>()?;
    let text = table::markdown(&rows);
    let path = folder.join("table.md");
    write_atomic_bytes(&path, text.as_bytes()).map_err(KnotError::from)?;
    output::table(&path);
    say!("curves, certificates and table: {}", folder.display());
    Ok(())
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

/// Writes curve and certificate; returns a line of numbers.
fn write(
    entry: &KnotEntry,
    tight: &TightKnot,
    args: &TightenArgs,
    folder: &Path,
) -> Result<String, CliError> {
    let path = |extension: &str| folder.join(format!("{}.{extension}", tight.name));
    write_curve(&path(&args.format), &tight.curve)?;
    let length = tight.length_over_radius;
    let excess = table::excess(entry, tight);
    let certificate = &tight.certificate;
    let second = args.check.then(|| second_opinion(tight)).transpose()?;
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
    if !certificate.converged {
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
