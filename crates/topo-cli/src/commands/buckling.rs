//! `topo buckling`: charges near the critical one under other spacings, seeds, tolerances and boundary schemes, as a table.

use std::sync::{Mutex, PoisonError};

use super::settings::threads;
use crate::cli::BucklingArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use topo_analysis::{read_table, write_table};
use topo_lab::{BucklingRow, buckling_cases, buckling_study, with_jobs};
use topo_view::data;
use topo_view::{number, significant};

/// Runs it; gives the tables as Markdown.
///
/// # Errors
/// A radius that is not studied, a folder that cannot be written, or a stop.
pub fn run(args: &BucklingArgs) -> Result<String, CliError> {
    let jobs = threads(args.work.jobs)?;
    let stop = interrupt::install();
    let folder = args.work.out.join("buckling");
    std::fs::create_dir_all(&folder).map_err(|source| CliError::File {
        path: folder.clone(),
        source,
    })?;
    let path = folder.join("buckling.csv");
    let mut rows: Vec<BucklingRow> = if path.exists() && !args.work.fresh {
        read_table(&path)?
    } else {
        Vec::new()
    };
    for &radius in &args.radius {
        let cases = buckling_cases(radius).ok_or_else(|| CliError::Argument {
            key: "--radius",
            value: radius.to_string(),
            remedy: "15, 25 and 52.5 are studied".to_owned(),
        })?;
        let (known, others): (Vec<_>, Vec<_>) = rows.into_iter().partition(|r| r.radius == radius);
        let progress = Progress::start(
            &format!("R = {radius}"),
            cases.len().saturating_sub(known.len()),
        );
        // a charge takes minutes: each is kept as soon as it is there
        let kept = Mutex::new([&others[..], &known[..]].concat());
        let report = |row: &BucklingRow| {
            progress.done(&format!(
                "q = {}, h = {}, {}",
                row.q,
                row.spacing,
                row.boundary.name()
            ));
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.push(row.clone());
            if let Err(error) = write_table(&path, &kept) {
                note!("{error}");
            }
        };
        let found = with_jobs(jobs, || buckling_study(&cases, &known, &stop, &report))??;
        interrupt::check(&stop)?;
        progress.finish();
        rows = [others, found].concat();
        rows.sort_by(|a, b| a.radius.total_cmp(&b.radius));
        write_table(&path, &rows)?;
    }
    output::out(&args.work.out);
    output::table(&path);
    output::data("charges", &rows);
    let text = text(&rows);
    data::write(&folder.join("buckling.md"), text.as_bytes())?;
    say!("{text}");
    Ok(text)
}

/// The rows as Markdown: a table a radius, a line a setting, a column a charge.
fn text(rows: &[BucklingRow]) -> String {
    let mut text = String::new();
    let mut rest = rows;
    while let Some(first) = rest.first() {
        let n = rest.iter().take_while(|r| r.radius == first.radius).count();
        text += &table(&rest[..n]);
        rest = &rest[n..];
    }
    text
}

fn table(rows: &[BucklingRow]) -> String {
    let mut charges: Vec<u32> = rows.iter().map(|r| r.q).collect();
    charges.sort_unstable();
    charges.dedup();
    let heads: Vec<String> = charges.iter().map(|q| format!(" q = {q} |")).collect();
    let mut text = format!(
        "\nR = {}, plates {} apart:\n\n| scheme | h | seed | tolerance |{}\n|---|---|---|---|{}\n",
        rows[0].radius,
        rows[0].thickness,
        heads.concat(),
        "---|".repeat(charges.len())
    );
    let mut settings: Vec<&BucklingRow> = Vec::new();
    let same = |a: &BucklingRow, b: &BucklingRow| {
        a.boundary == b.boundary
            && [a.spacing, a.seed, a.tolerance] == [b.spacing, b.seed, b.tolerance]
    };
    for row in rows {
        if !settings.iter().any(|s| same(s, row)) {
            settings.push(row);
        }
    }
    for setting in settings {
        let cells = charges.iter().map(|q| {
            let row = rows.iter().find(|r| r.q == *q && same(r, setting));
            format!(" {} |", row.map_or(String::new(), cell))
        });
        text += &format!(
            "| {} | {} | {} | {:e} |{}\n",
            setting.boundary.name(),
            setting.spacing,
            setting.seed,
            setting.tolerance,
            cells.collect::<String>()
        );
    }
    text
}

/// F, the order parameter where there is one, and the lowest eigenvalue.
fn cell(row: &BucklingRow) -> String {
    let mut text = number(row.f_charged, 2);
    if row.is_buckled() {
        text += &format!("*, tilt {}", significant(row.order_parameter, 2));
    }
    match row.eigenvalue {
        Some(x) => text += &format!(", λ {}", number(x, 3)),
        None => text += &format!(", {}", row.stop),
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_nematic::Boundary;
    use topo_nematic::record::ChargeStop;

    fn row(radius: f64, q: u32, boundary: Boundary, order: f64) -> BucklingRow {
        BucklingRow {
            results: 6,
            radius,
            thickness: 4.0 * radius,
            q,
            boundary,
            spacing: 1.5,
            nodes: 6.3,
            seed: 0.05,
            tolerance: 1e-8,
            f_charged: 100.0 * f64::from(q),
            order_parameter: order,
            ring_amplitude: None,
            eigenvalue: Some(0.25),
            state: None,
            stop: ChargeStop::Converged,
            steps: 500,
            cpu_seconds: 2.0,
        }
    }

    #[test]
    fn a_line_a_setting_and_a_column_a_charge() {
        let rows = [
            row(15.0, 9, Boundary::CutLink, 1e-6),
            row(15.0, 10, Boundary::CutLink, 0.0301),
            row(15.0, 10, Boundary::NodeMask, 0.05),
            row(25.0, 6, Boundary::CutLink, 0.033),
        ];
        let text = text(&rows);
        let lines: Vec<&str> = text.lines().filter(|l| l.starts_with('|')).collect();
        assert_eq!(lines.len(), 2 + 2 + 2 + 1, "{text}");
        assert_eq!(
            lines[2],
            "| cut-link | 1.5 | 0.05 | 1e-8 | 900, λ 0.25 | 1000*, tilt 0.03, λ 0.25 |"
        );
        assert!(lines[3].contains("|  | 1000*, tilt 0.05"), "{}", lines[3]);
        assert!(text.contains("R = 25, plates 100 apart"));
    }
}
