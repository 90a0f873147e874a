//! Rows that make one line, and how lines are distinguished: by colours and dashes in a legend, or by a colour bar where there are many.

use super::cases::{Cases, Row, Swept};
use crate::figures::series::{bounds, step, ticks};
use crate::plot::color::{LINES, Scale};

/// Dashes by which lines of one colour differ.
const DASHES: [&str; 3] = ["", "5 2.5", "1.5 2"];
/// Most lines that a legend names.
pub const MOST_NAMED: usize = LINES.len() * DASHES.len();
/// Most lines that differ in numbers and are named all the same.
const MOST_NUMBERED: usize = 12;

/// Looks of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// Its colour.
    pub color: String,
    /// Its dashes, as SVG writes them; empty: none.
    pub dash: &'static str,
}

impl Look {
    /// The looks of the k-th line of a legend.
    pub fn named(k: usize) -> Self {
        Self {
            color: LINES[k % LINES.len()].to_owned(),
            dash: DASHES[k / LINES.len() % DASHES.len()],
        }
    }
}

/// Rows that make one line.
#[derive(Debug)]
pub struct Group<'a> {
    /// Its rows.
    pub rows: Vec<&'a Row>,
    /// What tells it from the others.
    pub label: String,
    /// Its looks.
    pub look: Look,
}

/// What tells the reader which line is which.
#[derive(Debug)]
pub enum Key {
    /// There is one line.
    None,
    /// Each has a name.
    Legend(Vec<(Look, String)>),
    /// Colours stand for numbers.
    Bar {
        /// From numbers to colours.
        scale: Scale,
        /// Numbers beside it.
        ticks: Vec<f64>,
        /// What the numbers are.
        label: &'static str,
    },
}

/// Rows gathered by settings, with looks, their key, and what the key leaves open.
#[derive(Debug)]
pub struct Groups<'a> {
    /// The lines.
    pub groups: Vec<Group<'a>>,
    /// Which is which.
    pub key: Key,
    /// What is not shown, or not distinguished.
    pub note: Option<String>,
}

impl<'a> Groups<'a> {
    /// Gathers the rows that agree in all of these settings.
    pub fn of(rows: impl IntoIterator<Item = &'a Row>, by: &[&Swept]) -> Self {
        let mut found: Vec<(Vec<Option<usize>>, Vec<&'a Row>)> = Vec::new();
        for row in rows {
            let key: Vec<Option<usize>> = by.iter().map(|s| s.place(row)).collect();
            match found.iter_mut().find(|(k, _)| *k == key) {
                Some((_, rows)) => rows.push(row),
                None => found.push((key, vec![row])),
            }
        }
        found.sort_by(|a, b| a.0.cmp(&b.0));
        let words = |row: &Row| -> String {
            let words = by.iter().map(|s| s.say(row.text(s.setting.column)));
            words.collect::<Vec<_>>().join(", ")
        };
        let groups: Vec<Group<'a>> = found
            .into_iter()
            .enumerate()
            .map(|(k, (_, rows))| Group {
                label: words(rows[0]),
                rows,
                look: Look::named(k),
            })
            .collect();
        Self::with_looks(groups, by)
    }

    fn with_looks(mut groups: Vec<Group<'a>>, by: &[&Swept]) -> Self {
        let n = groups.len();
        let numeric = by
            .iter()
            .filter(|s| s.is_numeric)
            .max_by_key(|s| s.values.len());
        if n < 2 {
            return Self {
                groups,
                key: Key::None,
                note: None,
            };
        }
        if let Some(colored) = numeric.filter(|_| n > MOST_NUMBERED) {
            return Self::by_color(groups, by, colored);
        }
        let note = (n > MOST_NAMED).then(|| {
            let kept = evenly(n, MOST_NAMED);
            let mut k = 0;
            groups.retain(|_| {
                k += 1;
                kept.contains(&(k - 1))
            });
            format!("{MOST_NAMED} of {n} lines are shown, picked evenly; all are in the numbers beside the picture.")
        });
        for (k, group) in groups.iter_mut().enumerate() {
            group.look = Look::named(k);
        }
        let legend = groups.iter().map(|g| (g.look.clone(), g.label.clone()));
        let key = Key::Legend(legend.collect());
        Self { groups, key, note }
    }

    fn by_color(mut groups: Vec<Group<'a>>, by: &[&Swept], colored: &Swept) -> Self {
        let column = colored.setting.column;
        let numbers = || colored.values.iter().filter_map(|v| v.parse::<f64>().ok());
        let (low, high) = bounds(numbers());
        let scale = Scale::viridis(low, high);
        for group in &mut groups {
            let value = group.rows[0].number(column).unwrap_or(low);
            group.look = Look {
                color: scale.css(value),
                dash: "",
            };
        }
        let others: Vec<&str> = by
            .iter()
            .filter(|s| s.setting.column != column)
            .map(|s| s.setting.label)
            .collect();
        let note = (!others.is_empty())
            .then(|| format!("Lines of one colour differ in: {}.", others.join(", ")));
        let key = Key::Bar {
            ticks: ticks(low, high, whole_step(numbers(), low, high, 4.0)),
            scale,
            label: colored.setting.label,
        };
        Self { groups, key, note }
    }
}

/// The step of an axis over values: whole where all of them are.
pub fn whole_step(values: impl IntoIterator<Item = f64>, low: f64, high: f64, n: f64) -> f64 {
    let step = step(high - low, n);
    if values.into_iter().all(|v| v.fract() == 0.0) {
        step.max(1.0)
    } else {
        step
    }
}

/// So many of `n` places, evenly, with both ends.
pub fn evenly(n: usize, most: usize) -> Vec<usize> {
    if n <= most {
        return (0..n).collect();
    }
    (0..most).map(|k| k * (n - 1) / (most - 1).max(1)).collect()
}

/// The swept settings but one.
pub fn others<'a>(cases: &'a Cases, but: Option<&Swept>) -> Vec<&'a Swept> {
    let is_other = |s: &&Swept| but.is_none_or(|b| b.setting.column != s.setting.column);
    cases.swept.iter().filter(is_other).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_of_a_legend_all_differ() {
        let looks: Vec<Look> = (0..MOST_NAMED).map(Look::named).collect();
        for (k, look) in looks.iter().enumerate() {
            assert!(looks[..k].iter().all(|other| other != look), "{k}");
        }
    }

    #[test]
    fn picks_are_even_and_have_both_ends() {
        assert_eq!(evenly(3, 9), [0, 1, 2]);
        assert_eq!(evenly(238, 4), [0, 79, 158, 237]);
        assert_eq!(evenly(5, 1), [0]);
    }
}
