//! `topo cost`: what each term of a scene costs in time and bytes, measured with it and without it.

use crate::cli::CostArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use topo_analysis::write_table;
use topo_lab::{TermCost, term_costs};
use topo_view::data;

/// Runs it; gives the table as Markdown.
///
/// # Errors
/// A run that is refused, a folder that cannot be written, or a stop.
pub fn run(args: &CostArgs) -> Result<String, CliError> {
    let stop = interrupt::install();
    let report = |row: &TermCost| {
        note!(
            "{} {}, with: {}: {:.2} s",
            row.system,
            row.term,
            row.with,
            row.cpu_seconds
        );
    };
    let rows = term_costs(args.quality, &stop, &report)?;
    let folder = args.out.join("cost");
    std::fs::create_dir_all(&folder).map_err(|source| CliError::File {
        path: folder.clone(),
        source,
    })?;
    let table = folder.join("cost.csv");
    write_table(&table, &rows)?;
    output::out(&args.out);
    output::table(&table);
    output::data("terms", &rows);
    let text = text(&rows);
    data::write(&folder.join("cost.md"), text.as_bytes())?;
    say!("{text}");
    if stop.is_requested() {
        return Err(CliError::Interrupted);
    }
    Ok(text)
}

/// The table as Markdown.
fn text(rows: &[TermCost]) -> String {
    let mut text = "| | term | with | what | CPU s | ratio | calls | µs a call | ratio | kB | the term's kB | its calls |\n|---|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
    let kilobytes = |n: u64| format!("{:.1}", n as f64 / 1e3);
    for row in rows {
        text += &format!(
            "| {} | {} | {} | {} | {:.2} | {:.2} | {} | {:.1} | {:.2} | {} | {} | {} |\n",
            row.system,
            row.term,
            row.with,
            row.quantity,
            row.cpu_seconds,
            row.ratio,
            row.calls,
            row.microseconds_per_call,
            row.ratio_per_call,
            kilobytes(row.peak_bytes),
            kilobytes(row.term_bytes),
            row.term_calls,
        );
    }
    let n_runs = rows.iter().map(|row| row.n_runs).min().unwrap_or(0);
    text + &format!("\nMedians of {n_runs} runs each, on one thread.\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_tells_time_and_bytes() {
        let row = TermCost {
            system: "rod".to_owned(),
            term: "friction".to_owned(),
            with: "yes".to_owned(),
            quantity: "eta_f/eta = 0.1".to_owned(),
            n_runs: 3,
            cpu_seconds: 1.25,
            ratio: 1.5,
            calls: 1000,
            microseconds_per_call: 1250.0,
            ratio_per_call: 1.4,
            peak_bytes: 123_456,
            term_bytes: 3456,
            term_calls: 1100,
        };
        let text = text(&[row]);
        let line = "| rod | friction | yes | eta_f/eta = 0.1 | 1.25 | 1.50 | 1000 | 1250.0 | 1.40 | 123.5 | 3.5 | 1100 |";
        assert!(
            text.contains(line) && text.contains("Medians of 3"),
            "{text}"
        );
    }
}
