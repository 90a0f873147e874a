//! Several values of a key: a list or a range in a scene file stands for a case each.

use std::fmt;

use serde::Serialize;
use topo_nematic::anchoring::PlateDirector;
use topo_nematic::{Anchoring, Boundary, SurfacePattern};
use topo_rod::{FrictionRange, Reading};

use super::document::{Document, Found};
use super::numbers::{MOST_CASES, Numbers, checked_numbers, is_range, repeated};
use crate::LabError;

/// A value that a key of a scene may have.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum AxisValue {
    /// A number.
    Number(f64),
    /// A whole number.
    Whole(u64),
    /// How L/h is read.
    Reading(Reading),
    /// Where friction reaches.
    FrictionRange(FrictionRange),
    /// How anchoring is put on the grid.
    Boundary(Boundary),
    /// What a particle's surface prefers.
    Pattern(SurfacePattern),
    /// How strongly a surface anchors.
    Anchoring(Anchoring),
    /// What a plate prefers.
    Director(PlateDirector),
}

impl fmt::Display for AxisValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) => write!(f, "{x}"),
            Self::Whole(n) => write!(f, "{n}"),
            other => match other.written() {
                Some(value) => write!(f, "{value}"),
                None => Ok(()),
            },
        }
    }
}

impl AxisValue {
    /// The value as scene files write it; none for whole numbers beyond those of TOML.
    pub(crate) fn written(&self) -> Option<toml::Value> {
        toml::Value::try_from(self).ok()
    }
}

/// A key with several values, which the cases of a scene run through.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Axis {
    key: &'static str,
    values: Vec<AxisValue>,
}

impl Axis {
    /// A key whose values are these numbers, all different.
    pub(crate) fn of_numbers(key: &'static str, numbers: &[f64]) -> Self {
        let values = numbers.iter().copied().map(AxisValue::Number).collect();
        Self { key, values }
    }

    /// The key, with its table.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Its values, all different.
    pub fn values(&self) -> &[AxisValue] {
        &self.values
    }
}

/// How a value of a case is read and written.
pub(crate) enum Access<C> {
    Number(fn(&C) -> Option<f64>, fn(&mut C, f64)),
    Whole(fn(&C) -> Option<u64>, fn(&mut C, u64)),
    Choice(fn(&C) -> Option<AxisValue>, fn(&mut C, &AxisValue)),
}

/// A key of a scene that may have several values.
pub(crate) struct SweptKey<C> {
    pub key: &'static str,
    pub access: Access<C>,
}

impl<C> SweptKey<C> {
    /// The value in a case, if the case has one.
    pub fn read(&self, case: &C) -> Option<AxisValue> {
        match &self.access {
            Access::Number(read, _) => read(case).map(AxisValue::Number),
            Access::Whole(read, _) => read(case).map(AxisValue::Whole),
            Access::Choice(read, _) => read(case),
        }
    }

    fn write(&self, case: &mut C, value: &AxisValue) {
        match (&self.access, value) {
            (Access::Number(_, write), AxisValue::Number(x)) => write(case, *x),
            (Access::Whole(_, write), AxisValue::Whole(n)) => write(case, *n),
            (Access::Choice(_, write), value) => write(case, value),
            _ => {}
        }
    }
}

/// All combinations of the axes' values, those of the last axis running fastest.
pub(crate) fn product<C: Clone>(keys: &[SweptKey<C>], axes: &[Axis], case: C) -> Vec<C> {
    let mut cases = vec![case];
    for axis in axes {
        let Some(key) = keys.iter().find(|k| k.key == axis.key) else {
            continue;
        };
        cases = cases
            .iter()
            .flat_map(|case| {
                axis.values.iter().map(move |value| {
                    let mut case = case.clone();
                    key.write(&mut case, value);
                    case
                })
            })
            .collect();
    }
    cases
}

/// Puts the values of all axes into the table of a scene that holds one of each.
pub(crate) fn put_axes<'a>(axes: impl Iterator<Item = &'a Axis>, file: &mut toml::Table) {
    for axis in axes {
        let list = axis.values.iter().filter_map(AxisValue::written).collect();
        let mut tables = &mut *file;
        let Some((path, name)) = axis.key.rsplit_once('.') else {
            continue;
        };
        for part in path.split('.') {
            let inner = tables
                .entry(part)
                .or_insert_with(|| toml::Value::Table(toml::Table::new()));
            if !inner.is_table() {
                *inner = toml::Value::Table(toml::Table::new());
            }
            match inner {
                toml::Value::Table(inner) => tables = inner,
                _ => return,
            }
        }
        tables.insert(name.to_owned(), toml::Value::Array(list));
    }
}

/// Takes a dotted key out of the table of a scene.
pub(crate) fn remove(key: &str, file: &mut toml::Table) {
    match key.split_once('.') {
        None => {
            file.remove(key);
        }
        Some((table, rest)) => {
            if let Some(toml::Value::Table(inner)) = file.get_mut(table) {
                remove(rest, inner);
            }
        }
    }
}

/// The number of cases that knots, twists or windings and the axes make.
///
/// # Errors
/// More than [`MOST_CASES`], with the keys and how many values each has.
pub(crate) fn check_count(
    document: &Document<'_>,
    outer: &[(&str, usize)],
    axes: &[Axis],
) -> Result<(), LabError> {
    let inner = axes.iter().map(|a| (a.key, a.values.len()));
    let all: Vec<(&str, usize)> = outer.iter().copied().chain(inner).collect();
    let n = all
        .iter()
        .fold(1_u128, |n, (_, count)| n.saturating_mul(*count as u128));
    if n <= MOST_CASES as u128 {
        return Ok(());
    }
    let many = all.iter().filter(|(_, count)| *count > 1);
    let many: Vec<String> = many
        .map(|(key, count)| format!("{key} ({count})"))
        .collect();
    let largest = all.iter().max_by_key(|(_, count)| *count);
    Err(document.wrong(
        largest.map_or("", |(key, _)| key),
        format!("{n} cases"),
        format!(
            "the product of {} is too large: at most {MOST_CASES} cases are run, give fewer values",
            many.join(", ")
        ),
    ))
}

/// An axis as the file has it.
struct Raw<'a, C> {
    key: &'a SweptKey<C>,
    place: std::ops::Range<usize>,
    /// Its values as a file would write one of them.
    texts: Vec<String>,
    /// Its values, as far as they can be known without reading the rest.
    values: Vec<AxisValue>,
}

/// The axes of a scene, in the order of `keys`, and the text with the first value of each in the place of all.
///
/// `parse` reads the case of a text without axes. Lines stay what they are.
///
/// # Errors
/// Values that are no list or range of what the key takes, or the same value twice.
pub(crate) fn axes<C>(
    document: &Document<'_>,
    keys: &[SweptKey<C>],
    parse: impl Fn(&str) -> Result<C, LabError>,
) -> Result<(String, Vec<Axis>), LabError> {
    let mut raw = Vec::new();
    for key in keys {
        if let Some(found) = document.find(key.key) {
            raw.extend(raw_axis(document, key, &found)?);
        }
    }
    let firsts = vec![0; raw.len()];
    let plain = with(document.text(), &raw, &firsts);
    let mut axes = Vec::new();
    for (k, axis) in raw.iter().enumerate() {
        let mut values = axis.values.clone();
        if values.is_empty() {
            for i in 0..axis.texts.len() {
                let mut chosen = firsts.clone();
                chosen[k] = i;
                let case = parse(&with(document.text(), &raw, &chosen))?;
                values.extend(axis.key.read(&case));
            }
        }
        if let Some(twice) = repeated_setting(&values) {
            return Err(repeated(document, axis.key.key, twice));
        }
        if values.len() > 1 {
            axes.push(Axis {
                key: axis.key.key,
                values,
            });
        }
    }
    Ok((plain, axes))
}

fn repeated_setting(values: &[AxisValue]) -> Option<&AxisValue> {
    let number = |s: &AxisValue| match s {
        AxisValue::Number(x) => Some(*x + 0.0),
        _ => None,
    };
    let mut order: Vec<&AxisValue> = values.iter().collect();
    if values.iter().all(|s| number(s).is_some()) {
        order.sort_by(|a, b| {
            number(a)
                .partial_cmp(&number(b))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        return order.windows(2).find(|w| w[0] == w[1]).map(|w| w[1]);
    }
    let earlier = |k: usize| values[..k].contains(&values[k]);
    (0..values.len()).find(|k| earlier(*k)).map(|k| &values[k])
}

/// Most entries of a list of choices.
const MOST_CHOICES: usize = 1000;

/// `values` as whole numbers; those of a list as they are written, so that none is rounded.
fn whole_numbers(
    document: &Document<'_>,
    key: &str,
    found: &Found<'_>,
    values: &[f64],
) -> Result<Vec<u64>, LabError> {
    let wrong =
        |x: &dyn fmt::Display| document.wrong(key, x, "whole numbers, zero or above, are needed");
    match found.parsed {
        toml::Value::Array(list) => list
            .iter()
            .map(|v| {
                let whole = v.as_integer().and_then(|n| u64::try_from(n).ok());
                whole.ok_or_else(|| wrong(v))
            })
            .collect(),
        _ => values
            .iter()
            .map(|x| match x.fract() == 0.0 && (0.0..9e15).contains(x) {
                true => Ok(*x as u64),
                false => Err(wrong(x)),
            })
            .collect(),
    }
}

fn raw_axis<'a, C>(
    document: &Document<'_>,
    key: &'a SweptKey<C>,
    found: &Found<'_>,
) -> Result<Option<Raw<'a, C>>, LabError> {
    let raw = |texts, values| {
        Ok(Some(Raw {
            key,
            place: found.value.clone(),
            texts,
            values,
        }))
    };
    let is_list = found.parsed.is_array();
    if let Access::Choice(..) = key.access {
        if !is_list {
            return Ok(None);
        }
        let texts: Vec<String> = found
            .elements
            .iter()
            .filter_map(|e| document.text().get(e.clone()).map(str::to_owned))
            .collect();
        if texts.is_empty() || texts.len() > MOST_CHOICES {
            let remedy = format!("give 1 to {MOST_CHOICES} values, or leave the key out");
            return Err(document.wrong(key.key, document.written(key.key), remedy));
        }
        return raw(texts, Vec::new());
    }
    if !is_list && !is_range(found.parsed) {
        return Ok(None);
    }
    let numbers = Numbers::of(document, key.key, found.parsed)?;
    let values = checked_numbers(document, key.key, &numbers)?;
    if let Access::Number(..) = key.access {
        let texts = values.iter().take(1).map(|x| format!("{x:?}")).collect();
        return raw(texts, values.into_iter().map(AxisValue::Number).collect());
    }
    let whole = whole_numbers(document, key.key, found, &values)?;
    let texts = whole.iter().take(1).map(u64::to_string).collect();
    raw(texts, whole.into_iter().map(AxisValue::Whole).collect())
}

/// The text with one value in the place of each axis.
fn with<C>(text: &str, raw: &[Raw<'_, C>], chosen: &[usize]) -> String {
    let mut places: Vec<usize> = (0..raw.len()).collect();
    places.sort_by_key(|k| raw[*k].place.start);
    let (mut made, mut end) = (String::with_capacity(text.len()), 0);
    for k in places {
        let Raw { place, texts, .. } = &raw[k];
        let value = texts.get(chosen[k]).map_or("", String::as_str);
        made.push_str(text.get(end..place.start).unwrap_or_default());
        made.push_str(value);
        // as many lines as before, so that messages name the right one
        let lines = |s: &str| s.matches('\n').count();
        let before = lines(text.get(place.clone()).unwrap_or_default());
        made.extend(std::iter::repeat_n(
            '\n',
            before.saturating_sub(lines(value)),
        ));
        end = place.end;
    }
    made.push_str(text.get(end..).unwrap_or_default());
    made
}
