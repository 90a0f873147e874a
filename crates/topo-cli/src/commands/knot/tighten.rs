//! `topo knot tighten`: tight shapes with their certificates.

use super::subject::{Subject, Tight};
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
    CurveComponent, KnotEntry, KnotError, KnotTable, LinkEntry, LinkTable, SecondOpinion,
    TightenSettings, n_components, parse_braid, read_components, write_curves,
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
    let one = |subject: &Subject| -> Result<Option<Row>, CliError> {
        if stop.is_requested() {
            return Ok(None);
        }
        let (tight, is_whole) = subject.tighten(args.hops, &settings, &cache, &stop)?;
        if !is_whole && is_beaten(&tight, folder) {
            note!(
                "{}: the shorter curve of an earlier run stays",
                tight.facts().name
            );
            return Ok(None);
        }
        let sentence = write(subject, &tight, args, folder, &stop)?;
        let row = Row::new(subject, &tight.facts(), sentence);
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
fn is_beaten(tight: &Tight, folder: &Path) -> bool {
    let tight = tight.facts();
    let path = folder.join(format!("{}.json", tight.name));
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let earlier: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    earlier["length_over_radius"]
        .as_f64()
        .is_some_and(|length| length < tight.length_over_radius)
}

/// The knots and links that the arguments ask for.
fn entries(args: &TightenArgs, table: &KnotTable) -> Result<Vec<Subject>, CliError> {
    let links = LinkTable::builtin();
    if let Some(word) = &args.braid {
        let word = letters(word)?;
        return Ok(vec![match n_components(&word)? {
            1 => KnotEntry::of_braid(&word, table)?.into(),
            _ => LinkEntry::of_braid(&word, links)?.into(),
        }]);
    }
    if let Some(path) = &args.curve {
        let of_file = |e: KnotError| CliError::Input(format!("{}: {e}", path.display()));
        let components = read_components(path)?;
        return Ok(vec![match &components[..] {
            [only] => of_curve(path, only, table)?,
            several => of_curves(several).map_err(of_file)?,
        }]);
    }
    if args.names == ["all"] {
        return Ok(table.iter().cloned().map(Subject::from).collect());
    }
    if args.links == ["all"] {
        return Ok(links.iter().cloned().map(Subject::from).collect());
    }
    let knot = |name: &String| Ok(table.get(name)?.into_owned().into());
    let link = |name: &String| Ok(links.get(name)?.into_owned().into());
    let knots = args.names.iter().map(knot);
    knots.chain(args.links.iter().map(link)).collect()
}

fn of_curve(
    path: &Path,
    component: &CurveComponent,
    table: &KnotTable,
) -> Result<Subject, CliError> {
    if component.closed == Some(false) {
        return Err(CliError::Input(format!(
            "{}: the curve is open; only closed curves can be tightened",
            path.display()
        )));
    }
    Ok(KnotEntry::of_curve(&component.vertices, table)?.into())
}

fn of_curves(components: &[CurveComponent]) -> Result<Subject, KnotError> {
    if let Some(k) = components.iter().position(|c| !c.is_closed()) {
        return Err(KnotError::OpenComponent {
            component: k + 1,
            gap: components[k].gap_over_longest_edge(),
        });
    }
    let vertices: Vec<_> = components.iter().map(|c| c.vertices.clone()).collect();
    Ok(LinkEntry::of_curves(&vertices, LinkTable::builtin())?.into())
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
    tight: &Tight,
    args: &TightenArgs,
    stop: &Interrupt,
) -> Result<Option<SecondOpinion<()>>, CliError> {
    if !args.check || stop.is_requested() {
        return Ok(None);
    }
    match tight.second(stop) {
        Err(KnotError::Interrupted { .. } | KnotError::InterruptedLink { .. }) => Ok(None),
        second => Ok(Some(second?)),
    }
}

/// Writes curves and certificate; returns a line of numbers.
fn write(
    subject: &Subject,
    tight: &Tight,
    args: &TightenArgs,
    folder: &Path,
    stop: &Interrupt,
) -> Result<String, CliError> {
    std::fs::create_dir_all(folder).map_err(|source| CliError::File {
        path: folder.to_owned(),
        source,
    })?;
    let facts = tight.facts();
    let path = |extension: &str| folder.join(format!("{}.{extension}", facts.name));
    write_curves(&path(&args.format), facts.curves)?;
    let length = facts.length_over_radius;
    let (published, source) = subject.published();
    let [list, key] = subject.keys();
    let second = second(tight, args, stop)?;
    let apart = second.as_ref().map(|s| s.length_over_radius / length - 1.0);
    let sizes: Vec<usize> = facts.curves.iter().map(|c| c.n_vertices()).collect();
    let n_vertices: usize = sizes.iter().sum();
    let certificate = tight
        .certificate()
        .map_err(|e| CliError::Step(e.to_string()))?;
    let mut record = json!({
        key: facts.name, "vertices": n_vertices, "length_over_radius": length,
        "published": published, "source": source, "excess_percent": table::excess(published, length),
        "certificate": certificate, "cpu_seconds": facts.cpu_seconds, "factorisations": facts.n_factorisations,
        "second_method": second.as_ref().map(|s| json!({
            "length_over_radius": s.length_over_radius, "relative_difference": apart, "converged": s.converged,
            "start_length_over_radius": s.start_length_over_radius, "evaluations": s.n_evaluations, "cpu_seconds": s.cpu_seconds,
        })),
    });
    if sizes.len() > 1 {
        record["vertices_of_components"] = json!(sizes);
    }
    let text = format!("{record:#}\n");
    output::one_more(list, &record);
    write_atomic_bytes(&path("json"), text.as_bytes()).map_err(KnotError::from)?;
    let mut line = format!("{:8} {n_vertices:5} vertices  L/r {length:9.4}", facts.name);
    line += &match (published, table::excess(published, length)) {
        (Some(published), Some(excess)) => format!("  published {published:9.4} ({excess:+.4} %)"),
        _ => "  published   missing           ".to_owned(),
    };
    line += &format!(
        "  Wr {:+.4}  struts {:5}  kinks {:2}  residual {:.4}  {:5.1} CPU s",
        facts.writhe, facts.n_struts, facts.n_kinks, facts.residual, facts.cpu_seconds
    );
    if let (Some(second), Some(apart)) = (&second, apart) {
        line += &format!(
            "  second method {:.4} ({apart:+.1e})",
            second.length_over_radius
        );
    }
    if !facts.converged {
        line += &mark(facts.name, stop);
    }
    Ok(line)
}

/// Why the best curve is not the last word, with a warning.
fn mark(name: &str, stop: &Interrupt) -> String {
    let (loud, quiet) = match stop.is_requested() {
        true => (
            "INTERRUPTED: the best curve so far is kept",
            "interrupted, the best curve so far is kept",
        ),
        false => (
            "NOT CONVERGED: the best curve is kept",
            "not converged, the best curve is kept",
        ),
    };
    output::warning(format!("{name}: {quiet}"));
    format!("  {loud}")
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

    #[test]
    fn open_components_are_refused() {
        let component = |n: usize, closed| CurveComponent {
            vertices: (0..n).map(|k| topo_knots::V::x() * k as f64).collect(),
            closed,
            repeats_first: false,
        };
        let refused = |components: &[CurveComponent]| match of_curves(components) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        };
        let open = refused(&[component(9, Some(true)), component(9, None)]);
        assert!(
            open.contains("component 2 is open: its ends are 8.000 times"),
            "{open}"
        );
        let short = refused(&[component(2, Some(true)), component(9, Some(true))]);
        assert!(
            short.contains("component 1: ") && short.contains("at least 3"),
            "{short}"
        );
    }
}
