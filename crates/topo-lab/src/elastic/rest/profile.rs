//! A quantity along a closed fibre, from a file.

use serde_json::{Value, json};

/// Share of a value by which roundings of a file may make it miss.
const ROUNDING: f64 = 1e-9;
/// Fewest rows.
const LEAST: usize = 2;

/// `N` numbers along a closed component, at rising places s/L from 0 to 1, linear in between.
#[derive(Debug, Clone, PartialEq)]
pub struct RestProfile<const N: usize> {
    s: Vec<f64>,
    values: Vec<[f64; N]>,
}

impl<const N: usize> RestProfile<N> {
    /// Reads a table with a header: `s`, then `columns`, in any order; lines that begin with `#` are remarks.
    ///
    /// # Errors
    /// What is wrong, with the line and what would be right: a column that is unknown, missing or there twice, a cell that is no finite
    /// number, places that do not rise from 0 to 1, an end that is not as the beginning, too few rows.
    ///
    /// # Validation
    /// `profiles_say_what_is_wrong_with_them`, `a_profile_is_linear_between_its_rows`
    pub fn parse(text: &str, columns: [&str; N]) -> Result<Self, String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = text.lines().map(str::trim).enumerate();
        let mut lines = lines.filter(|(_, l)| !l.is_empty() && !l.starts_with('#'));
        let header = format!("s,{}", columns.join(","));
        let (_, first) = lines.next().ok_or_else(|| {
            format!("it is empty: write a header {header} and at least {LEAST} rows")
        })?;
        let places = places(first, columns, &header)?;
        let (mut s, mut values): (Vec<f64>, Vec<[f64; N]>) = (Vec::new(), Vec::new());
        for (k, line) in lines {
            let wrong = |what: String| format!("line {}: {what}", k + 1);
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            if cells.len() != N + 1 {
                let found = cells.len();
                return Err(wrong(format!("{found} cells, {header} are {}", N + 1)));
            }
            let number = |place: usize| -> Result<f64, String> {
                let x = cells[place].parse::<f64>().ok().filter(|x| x.is_finite());
                x.ok_or_else(|| wrong(format!("\"{}\" is no finite number", cells[place])))
            };
            let at = number(places.0)?;
            if let Some(before) = s.last().filter(|before| at <= **before) {
                return Err(wrong(format!(
                    "s = {at} is not above {before} of the row before: sort the rows by s, each once"
                )));
            }
            let mut row = [0.0; N];
            for (value, place) in row.iter_mut().zip(places.1) {
                *value = number(place)?;
            }
            s.push(at);
            values.push(row);
        }
        Self { s, values }.checked(columns)
    }

    fn checked(self, columns: [&str; N]) -> Result<Self, String> {
        let n = self.s.len();
        if n < LEAST {
            return Err(format!(
                "{n} rows: at least {LEAST} are needed, at s = 0 and s = 1"
            ));
        }
        let (first, last) = (self.s[0], self.s[n - 1]);
        if first.abs() > ROUNDING || (last - 1.0).abs() > ROUNDING {
            return Err(format!(
                "s goes from {first} to {last}: it is s/L, and must go from 0 to 1"
            ));
        }
        for (k, name) in columns.iter().enumerate() {
            let (a, b) = (self.values[0][k], self.values[n - 1][k]);
            if (a - b).abs() > ROUNDING * a.abs().max(b.abs()).max(1.0) {
                return Err(format!(
                    "{name} is {a} at s = 0 and {b} at s = 1: the fibre is closed, its two ends are one place; give them one value"
                ));
            }
        }
        Ok(self)
    }

    /// The values at s/L: linear between rows, and beyond the ends those of the ends.
    pub fn at(&self, s: f64) -> [f64; N] {
        let after = self.s.partition_point(|x| *x <= s);
        let (last, k) = (self.s.len() - 1, after.saturating_sub(1));
        if after == 0 || k == last {
            return self.values[k];
        }
        let share = (s - self.s[k]) / (self.s[k + 1] - self.s[k]);
        let (a, b) = (&self.values[k], &self.values[k + 1]);
        // where both are one it is that, to the bit
        std::array::from_fn(|i| match a[i] == b[i] {
            true => a[i],
            false => a[i] * (1.0 - share) + b[i] * share,
        })
    }

    /// The values of the rows.
    pub(super) fn values(&self) -> impl Iterator<Item = [f64; N]> + '_ {
        self.values.iter().copied()
    }

    /// All numbers.
    pub(super) fn json(&self) -> Value {
        let rows = self.s.iter().zip(&self.values);
        rows.map(|(s, values)| json!([s, values.to_vec()]))
            .collect()
    }
}

/// Places of `s` and of the columns in a header.
fn places<const N: usize>(
    line: &str,
    columns: [&str; N],
    header: &str,
) -> Result<(usize, [usize; N]), String> {
    let names: Vec<&str> = line
        .split(',')
        .map(|n| n.trim().trim_matches('"'))
        .collect();
    let known = |name: &&str| *name == "s" || columns.contains(name);
    if let Some(unknown) = names.iter().find(|name| !known(name)) {
        return Err(format!(
            "the column \"{unknown}\" is not known: the header is {header}"
        ));
    }
    let place = |wanted: &str| match names.iter().filter(|name| **name == wanted).count() {
        0 => Err(format!(
            "the column {wanted} is missing: the header is {header}"
        )),
        1 => Ok(names.iter().position(|name| *name == wanted).unwrap_or(0)),
        n => Err(format!(
            "the column {wanted} is there {n} times: the header is {header}"
        )),
    };
    let mut found = [0; N];
    for (found, name) in found.iter_mut().zip(columns) {
        *found = place(name)?;
    }
    Ok((place("s")?, found))
}
