//! Runs whose settings were picked for an accuracy or a budget: what was picked, and what the error came to.

use std::path::Path;

use crate::duration::duration;
use crate::output;
use topo_analysis::{median, quantile};
use topo_lab::{Choice, ErrorRow, Goal};

/// Says which setting meets a goal.
pub fn report_choice(choice: &Choice) {
    let (p, unit) = (&choice.point, choice.unit);
    if let Some(reason) = &choice.stale {
        output::warning(reason);
        note!("warning: {reason}");
    }
    note!(
        "{}: {} {unit}, tolerance {:e}; measured on {} cases: off by {:.2} % (median), {:.2} % (90th percentile); {} of one processor",
        choice.goal,
        p.resolution,
        p.tolerance,
        p.n_cases,
        100.0 * p.median_error,
        100.0 * p.high_error,
        duration(choice.cpu_seconds),
    );
}

/// Tells what is in the table of errors at `path`.
pub fn report_errors(choice: &Choice, rows: &[ErrorRow], path: &Path) {
    output::table(path);
    say!("estimated errors:");
    for r in rows {
        let time = r
            .result
            .map_or_else(|| "not reached".to_owned(), |t| format!("{t:.4}"));
        let error = r
            .relative_error
            .map_or_else(String::new, |e| format!(" ± {:.2} %", 100.0 * e));
        let cut = r
            .cut
            .map_or_else(String::new, |c| format!(", cut at {c:.4}"));
        say!("  {}{cut}: {} = {time}{error}", r.case, r.quantity);
    }
    let errors = || rows.iter().filter_map(|r| r.relative_error);
    if let (Some(middle), Some(high)) = (median(errors()), quantile(errors(), 0.9)) {
        say!(
            "estimates: median {:.2} %, 90th percentile {:.2} %; {}",
            100.0 * middle,
            100.0 * high,
            path.display()
        );
    }
    if let Goal::Accuracy(asked) = choice.goal {
        let n = errors().filter(|e| *e > asked).count();
        if n > 0 {
            say!(
                "{n} of {} may be off by more than the {:.2} % asked for: ask for less, or look at these one by one",
                rows.len(),
                100.0 * asked
            );
        }
    }
}
