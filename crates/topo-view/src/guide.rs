//! The columns of a battery's tables: which a scene sets, which it measures, with symbols and units as axes carry them.
//!
//! Labels are in the small markup of pictures: `*t*` is italic, `_{0}` a subscript, `^{2}` a superscript.

/// What pictures must know of a battery's tables.
#[derive(Debug, Clone, Copy)]
pub struct Guide {
    /// Columns of `sweep.csv` that a scene sets, those that tell most first.
    pub settings: &'static [Setting],
    /// Columns of `sweep.csv` that are measured, panel by panel.
    pub results: &'static [Quantity],
    /// The discharge curve.
    pub curve: Curve,
    /// Columns of the table of the curve that are drawn where there is one case only, panel by panel.
    pub parts: &'static [Quantity],
}

/// A column that a scene sets.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    /// Its name in the table.
    pub column: &'static str,
    /// As legends write it before a value.
    pub symbol: &'static str,
    /// As axes write it, with its unit.
    pub label: &'static str,
    /// What its values are.
    pub kind: Kind,
    /// Whether it may follow from the other settings: then it counts as swept only where it takes the same values for each of them.
    pub follows: bool,
}

/// What the values of a setting are.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Numbers on an axis.
    Number,
    /// Names, and how they are written.
    Name(fn(&str) -> String),
}

impl Setting {
    /// A number.
    pub const fn number(column: &'static str, symbol: &'static str, label: &'static str) -> Self {
        Self {
            column,
            symbol,
            label,
            kind: Kind::Number,
            follows: false,
        }
    }

    /// A name; `words` writes it so that it is understood without a symbol.
    pub const fn name(
        column: &'static str,
        label: &'static str,
        words: fn(&str) -> String,
    ) -> Self {
        Self {
            column,
            symbol: "",
            label,
            kind: Kind::Name(words),
            follows: false,
        }
    }

    /// The same, which may follow from the other settings.
    pub const fn following(self) -> Self {
        Self {
            follows: true,
            ..self
        }
    }
}

/// Columns of one unit, drawn into one panel.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Axis label with its unit.
    pub label: &'static str,
    /// Its columns.
    pub columns: &'static [Column],
    /// Whether its values may span decades.
    pub log: bool,
}

/// A column that is measured.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its name in the table.
    pub name: &'static str,
    /// Beside its line.
    pub label: &'static str,
    /// As the axis of a panel of its own writes it; none where it has no such panel.
    pub alone: Option<&'static str>,
}

/// A column that shares its panel.
pub const fn column(name: &'static str, label: &'static str) -> Column {
    Column {
        name,
        label,
        alone: None,
    }
}

/// A column that has a panel of its own where several lines are compared.
pub const fn result(name: &'static str, label: &'static str, alone: &'static str) -> Column {
    Column {
        name,
        label,
        alone: Some(alone),
    }
}

/// The curve of a discharge: stored energy against time, in the folder of each case.
#[derive(Debug, Clone, Copy)]
pub struct Curve {
    /// Its table.
    pub file: &'static str,
    /// Column of the time.
    pub time: &'static str,
    /// Axis label of the time with its unit.
    pub time_label: &'static str,
    /// Column of the stored energy.
    pub energy: &'static str,
    /// Column of `sweep.csv` with the energy of which everything is stored.
    pub full: &'static str,
    /// Column of `sweep.csv` with the energy of which nothing is stored; zero where left out.
    pub empty: Option<&'static str>,
    /// Column, of both tables, that tells several discharges of one case apart.
    pub of: Option<&'static str>,
}

/// A name as it stands in the table.
pub fn name(value: &str) -> String {
    value.to_owned()
}
