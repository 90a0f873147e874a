//! Results against a swept setting: a panel a quantity, or a panel a result where lines are compared.

use super::cases::{Cases, Row, Swept};
use super::groups::{Group, Groups, Look, others};
use super::sheet::{self, Chart, Line, Scaling};
use crate::error::ViewError;
use crate::figures::Drawn;
use crate::figures::series::{Table, bounds};
use crate::guide::{Column, Quantity};

/// Fewest names that are worth an axis where other settings are swept too.
const FEWEST_NAMES: usize = 3;

/// Draws the results against a setting; `None` where nothing was measured, or a line tells it better.
pub fn draw(cases: &Cases, x: &Swept) -> Result<Option<Drawn>, ViewError> {
    let others = others(cases, Some(x));
    if !x.is_numeric && x.values.len() < FEWEST_NAMES && !others.is_empty() {
        return Ok(None);
    }
    let groups = Groups::of(&cases.rows, &others);
    let mut table = Table::new("quantity,line,x,mean,low,high");
    let mut charts = Vec::new();
    let mut missing = Missing::default();
    for quantity in cases.guide.results {
        let mut lines = Lines {
            x,
            table: &mut table,
            missing: &mut missing,
        };
        charts.extend(lines.charts(quantity, &groups.groups));
    }
    if charts.is_empty() {
        return Ok(None);
    }
    let mut notes: Vec<String> = groups.note.into_iter().collect();
    notes.extend(missing.note());
    if charts
        .iter()
        .flat_map(|c| &c.lines)
        .any(|l| !l.bars.is_empty())
    {
        notes.push("Bars: from the smallest to the largest over the discharges of one state, points: their mean.".to_owned());
    }
    Ok(Some(Drawn {
        picture: sheet::draw(&charts, &groups.key, &notes)?,
        csv: table.finish(),
        finding: notes.join(" "),
    }))
}

/// Values that are not there.
#[derive(Default)]
struct Missing {
    n: usize,
    of: usize,
}

impl Missing {
    fn note(&self) -> Option<String> {
        (self.n > 0).then(|| {
            format!(
                "{} of {} values are not there: not reached, or not of this kind of case.",
                self.n, self.of
            )
        })
    }
}

struct Lines<'a> {
    x: &'a Swept,
    table: &'a mut Table,
    missing: &'a mut Missing,
}

impl Lines<'_> {
    /// The panels of a quantity.
    fn charts(&mut self, quantity: &Quantity, groups: &[Group<'_>]) -> Vec<Chart> {
        let y = |label: &str| {
            let scaling = if quantity.log {
                Scaling::Decades
            } else {
                Scaling::Linear
            };
            (label.to_owned(), scaling)
        };
        if let [only] = groups {
            let columns = quantity.columns.iter().enumerate();
            let lines: Vec<Line> = columns
                .filter_map(|(k, c)| self.line(c, only, Look::named(k), c.label, [0, 1]))
                .collect();
            return Vec::from_iter((!lines.is_empty()).then(|| Chart {
                x: self.axis(),
                y: y(quantity.label),
                lines,
            }));
        }
        alone(quantity, groups)
            .into_iter()
            .filter_map(|(column, label)| {
                let n = groups.len();
                let lines: Vec<Line> = groups
                    .iter()
                    .enumerate()
                    .filter_map(|(k, g)| self.line(column, g, g.look.clone(), "", [k, n]))
                    .collect();
                (!lines.is_empty()).then(|| Chart {
                    x: self.axis(),
                    y: y(label),
                    lines,
                })
            })
            .collect()
    }

    fn axis(&self) -> (String, Scaling) {
        let setting = &self.x.setting;
        let scaling = if self.x.is_numeric && self.is_geometric() {
            Scaling::Decades
        } else if self.x.is_numeric {
            Scaling::Linear
        } else {
            Scaling::Names(self.x.values.iter().map(|v| self.x.say(v)).collect())
        };
        (setting.label.to_owned(), scaling)
    }

    /// Whether values are crowded at the lower end of an axis, as those of a geometric series are.
    fn is_geometric(&self) -> bool {
        let values = self.x.values.iter().filter_map(|v| v.parse::<f64>().ok());
        let (low, high) = bounds(values);
        self.x.values.len() > 2 && low > 0.0 && high >= 20.0 * low
    }

    /// The line of a column over the rows of a group, which is the k-th of n; `None` without a value.
    fn line(
        &mut self,
        column: &Column,
        group: &Group<'_>,
        look: Look,
        label: &str,
        [k, n]: [usize; 2],
    ) -> Option<Line> {
        let mut line = Line {
            label: label.to_owned(),
            is_marked: true,
            is_joined: self.x.is_numeric,
            ..Line::new(Vec::new(), look)
        };
        for (place, value) in self.x.values.iter().enumerate() {
            let here = group.rows.iter().filter(|r| self.x.place(r) == Some(place));
            let rows: Vec<&Row> = here.copied().collect();
            if rows.is_empty() {
                continue;
            }
            let x = if self.x.is_numeric {
                let Ok(x) = value.parse() else { continue };
                x
            } else {
                place as f64 + 0.1 + 0.8 * (k as f64 + 0.5) / n as f64
            };
            let values: Vec<f64> = rows.iter().filter_map(|r| r.number(column.name)).collect();
            self.missing.of += rows.len();
            self.missing.n += rows.len() - values.len();
            if values.is_empty() {
                continue;
            }
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            line.points.push((x, mean));
            if high - low > 0.005 * mean.abs() {
                line.bars.push((x, low, high));
            }
            let texts = [column.name, &quoted(&group.label)];
            self.table.row(&texts, &[x, mean, low, high]);
        }
        (!line.points.is_empty()).then_some(line)
    }
}

/// The columns that have a panel of their own: the first and the last that were measured.
fn alone<'a>(quantity: &'a Quantity, groups: &[Group<'_>]) -> Vec<(&'a Column, &'a str)> {
    let is_measured = |column: &Column| {
        let mut rows = groups.iter().flat_map(|g| &g.rows);
        rows.any(|r| r.number(column.name).is_some())
    };
    let all = quantity.columns.iter().filter_map(|c| Some((c, c.alone?)));
    let all: Vec<(&Column, &str)> = all.filter(|(c, _)| is_measured(c)).collect();
    match &all[..] {
        [first, .., last] => vec![*first, *last],
        few => few.to_vec(),
    }
}

/// A text as one cell of a table.
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
