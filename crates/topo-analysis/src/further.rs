//! Columns that only some tables have: energies of terms from outside this workspace.

use std::fmt::Write;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// Name of the field of a row that becomes columns of their own.
pub(crate) const FIELD: &str = "further";

/// Energies by name, in their order. In a table, a row's field `further` of this type becomes one column per name, at its
/// place; skip the field where it is empty. Elsewhere it is one text, such as `trap=0.25;wall=1.5`.
///
/// # Validation
/// `further_energies_are_columns_of_their_name`, `energies_come_back_from_one_cell`
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Further(Vec<(String, f64)>);

impl Further {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.0.iter().map(|(name, energy)| (name.as_str(), *energy))
    }

    /// The one of a name.
    pub fn of(&self, name: &str) -> Option<f64> {
        let mut all = self.iter();
        all.find(|(known, _)| *known == name).map(|(_, x)| x)
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for (name, energy) in self.iter() {
            let separator = if text.is_empty() { "" } else { ";" };
            // the debug form is the shortest that is read back exactly, as everywhere in tables
            let _ = write!(text, "{separator}{name}={energy:?}");
        }
        text
    }

    fn parse(text: &str) -> Option<Self> {
        let entries = text.split(';').filter(|entry| !entry.is_empty());
        let entry = |entry: &str| {
            let (name, energy) = entry.split_once('=')?;
            Some((name.to_owned(), energy.parse().ok()?))
        };
        entries.map(entry).collect::<Option<_>>().map(Self)
    }
}

impl<N: Into<String>> FromIterator<(N, f64)> for Further {
    fn from_iter<I: IntoIterator<Item = (N, f64)>>(all: I) -> Self {
        let named = |(name, energy): (N, f64)| (name.into(), energy);
        Self(all.into_iter().map(named).collect())
    }
}

impl<N: Into<String>> Extend<(N, f64)> for Further {
    fn extend<I: IntoIterator<Item = (N, f64)>>(&mut self, more: I) {
        let named = |(name, x): (N, f64)| (name.into(), x);
        self.0.extend(more.into_iter().map(named));
    }
}

impl Serialize for Further {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.text())
    }
}

impl<'de> Deserialize<'de> for Further {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let text = String::deserialize(from)?;
        let wrong = || D::Error::custom(format!("energies by name are wanted, not \"{text}\""));
        Self::parse(&text).ok_or_else(wrong)
    }
}

/// The table with a column for each name in its column `further`; unchanged without that column.
///
/// A name that the table has already gets `_energy` behind it, as that of the twist has.
pub(crate) fn expanded(table: Vec<u8>) -> csv::Result<Vec<u8>> {
    let mut reader = csv::Reader::from_reader(table.as_slice());
    let header = reader.headers()?.clone();
    let Some(place) = header.iter().position(|column| column == FIELD) else {
        return Ok(table);
    };
    let rows: Vec<csv::StringRecord> = reader.into_records().collect::<Result<_, _>>()?;
    let energies = |row: &csv::StringRecord| Further::parse(&row[place]).unwrap_or_default();
    let mut names: Vec<String> = Vec::new();
    for row in &rows {
        for (name, _) in energies(row).iter() {
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
    }
    let mut columns: Vec<String> = Vec::new();
    for name in &names {
        let mut column = name.clone();
        while header.iter().any(|h| h == column) || columns.contains(&column) {
            column.push_str("_energy");
        }
        columns.push(column);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut write = |row: &csv::StringRecord, cells: Vec<String>| {
        let (before, after) = (row.iter().take(place), row.iter().skip(place + 1));
        let cells = cells.iter().map(String::as_str);
        writer.write_record(before.chain(cells).chain(after))
    };
    write(&header, columns)?;
    for row in &rows {
        let has = energies(row);
        let cell = |name: &String| {
            let energy = has.iter().find(|(own, _)| own == name);
            energy.map_or(String::new(), |(_, e)| format!("{e:?}"))
        };
        write(row, names.iter().map(cell).collect())?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_come_back_from_one_cell() {
        let all: Further = [("trap", 1.0 / 3.0), ("wall", -1e-300)]
            .into_iter()
            .collect();
        assert_eq!(all.text(), "trap=0.3333333333333333;wall=-1e-300");
        assert_eq!(Further::parse(&all.text()), Some(all));
        assert_eq!(Further::parse(""), Some(Further::default()));
        for wrong in ["trap", "trap=", "trap=x"] {
            assert_eq!(Further::parse(wrong), None, "{wrong}");
        }
    }
}
