//! `cargo xtask bench`: the benchmarks and a table of their times.

use super::cargo::{cargo, step};
use crate::cli::BenchArgs;
use topo_cli::CliError;
use topo_cli::say;

pub fn run(args: &BenchArgs) -> Result<(), CliError> {
    let mut command = cargo(&["bench", "--package", "topo-bench", "--"]);
    command.args(args.filter.as_deref());
    let mut table = Summary::default();
    let ok = step("bench", command, |line| table.read(line))?;
    say!("\n{table}");
    if ok {
        Ok(())
    } else {
        Err(CliError::Step("bench failed".to_owned()))
    }
}

/// Name and the three times (low, middle, high) that the harness prints for each.
#[derive(Debug, Default)]
struct Summary {
    rows: Vec<(String, [String; 3])>,
    name: String,
}

impl Summary {
    /// Reads a line; a long name stands on the line before its times.
    fn read(&mut self, line: &str) {
        let Some((before, after)) = line.split_once("time:") else {
            if !line.starts_with(' ') && !line.trim().is_empty() {
                self.name = line.trim().to_owned();
            }
            return;
        };
        if !before.trim().is_empty() {
            self.name = before.trim().to_owned();
        }
        let words: Vec<&str> = after
            .trim()
            .trim_matches(['[', ']'])
            .split_whitespace()
            .collect();
        if let [a, ua, b, ub, c, uc] = words[..] {
            let time = |n: &str, unit: &str| format!("{n} {unit}");
            self.rows
                .push((self.name.clone(), [time(a, ua), time(b, ub), time(c, uc)]));
        }
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let width = self
            .rows
            .iter()
            .map(|r| r.0.len())
            .max()
            .unwrap_or(0)
            .max(9);
        writeln!(
            f,
            "{:width$}  {:>12}  {:>12}  {:>12}",
            "benchmark", "low", "middle", "high"
        )?;
        for (name, [low, middle, high]) in &self.rows {
            writeln!(f, "{name:width$}  {low:>12}  {middle:>12}  {high:>12}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_beside_and_below_their_names() {
        let mut table = Summary::default();
        table.read("energy/200              time:   [2.9012 µs 2.9100 µs 2.9233 µs]");
        table.read("                        change: [-1.0% +0.1% +1.2%] (p = 0.85 > 0.05)");
        table.read("contact/a_name_that_is_too_long");
        table.read("                        time:   [9.0 µs 9.1 µs 9.2 µs]");
        assert_eq!(table.rows.len(), 2);
        assert_eq!(table.rows[1].0, "contact/a_name_that_is_too_long");
        assert!(table.to_string().contains("2.9100 µs"));
    }
}
