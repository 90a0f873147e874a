//! Lines into cells, and cells into numbers.

use std::fmt;

use super::fault::quoted;

/// The cells of a line: between semicolons if there are any, else between commas, else between blanks.
pub(super) fn split<'a>(row: &'a str, cells: &mut Vec<&'a str>) {
    cells.clear();
    let separator = [';', ','].into_iter().find(|c| row.contains(*c));
    match separator {
        None => cells.extend(row.split_whitespace().map(unquoted)),
        Some(c) if !row.contains('"') => cells.extend(row.split(c).map(str::trim)),
        Some(c) => {
            let mut inside = false;
            cells.extend(
                row.split(|own| {
                    inside ^= own == '"';
                    own == c && !inside
                })
                .map(unquoted),
            );
        }
    }
}

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"')
        .and_then(|cell| cell.strip_suffix('"'))
        .unwrap_or(cell)
        .trim()
}

/// Why a cell gives no coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NumberFault {
    NotANumber,
    NotFinite,
    DecimalComma,
    BeyondRange,
}

impl NumberFault {
    /// What is wrong with `cell`, with the remedy.
    pub(super) fn message(self, cell: &str) -> String {
        Message(self, cell).to_string()
    }
}

struct Message<'a>(NumberFault, &'a str);

impl fmt::Display for Message<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cell = quoted(self.1);
        match self.0 {
            NumberFault::NotANumber if self.1.is_empty() => {
                f.write_str("a coordinate is empty; give all three, or leave the line out")
            }
            NumberFault::NotANumber => write!(f, "{cell} is not a number"),
            NumberFault::NotFinite => write!(
                f,
                "{cell} is not finite; a line of three NaN ends a component, otherwise coordinates are finite"
            ),
            NumberFault::DecimalComma => write!(
                f,
                "{cell} seems to have a decimal comma; write decimal points, 1.5 for 1,5"
            ),
            NumberFault::BeyondRange => write!(
                f,
                "{cell} is beyond the range of numbers in double precision; use other units"
            ),
        }
    }
}

/// The number in a cell: decimal, with an exponent after `e`, `d` (as Fortran writes) or none.
pub(super) fn number(cell: &str) -> Result<f64, NumberFault> {
    match cell.parse::<f64>() {
        Ok(x) if x.is_finite() && x != 0.0 => Ok(x),
        Ok(x) if x.is_finite() => {
            // What is written as more than nothing must not become zero.
            let mantissa = cell.split(['e', 'E']).next().unwrap_or("");
            if mantissa.bytes().any(|c| (b'1'..=b'9').contains(&c)) {
                Err(NumberFault::BeyondRange)
            } else {
                Ok(x)
            }
        }
        Ok(_) if cell.bytes().any(|c| c.is_ascii_digit()) => Err(NumberFault::BeyondRange),
        Ok(_) => Err(NumberFault::NotFinite),
        Err(_) => spelt_otherwise(cell),
    }
}

/// Numbers with an exponent after `d`, or with the minus sign of typesetters.
fn spelt_otherwise(cell: &str) -> Result<f64, NumberFault> {
    let plain: String = cell
        .chars()
        .map(|c| match c {
            'd' | 'D' => 'e',
            '\u{2212}' => '-',
            other => other,
        })
        .collect();
    if plain != cell && plain.bytes().any(|c| c.is_ascii_digit()) {
        return number(&plain);
    }
    let is_number = |part: &str| part.parse::<f64>().is_ok();
    let has_decimal_comma = cell.contains(',') && is_number(&cell.replacen(',', ".", 1))
        // A line split at its commas leaves the end of one number and the start of the next.
        || cell.split_whitespace().count() > 1 && cell.split_whitespace().all(is_number);
    Err(if has_decimal_comma {
        NumberFault::DecimalComma
    } else {
        NumberFault::NotANumber
    })
}

/// Whether a cell means a missing number.
pub(super) fn is_missing(cell: &str) -> bool {
    cell.is_empty()
        || cell
            .trim_start_matches(['-', '+'])
            .eq_ignore_ascii_case("nan")
}
