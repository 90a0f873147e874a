//! Warnings about a run, as in tables.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One warning about a run. In tables it is a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Warning {
    /// The charged rod has another knot type than it was tied with.
    Retied {
        /// The type that it has.
        found: String,
    },
    /// The charge did not finish.
    ChargeStopped {
        /// Why.
        reason: String,
    },
    /// Anything else.
    Other(String),
}

const RETIED: &str = "the charged rod is tied as ";
const CHARGE_STOPPED: &str = "charge stopped: ";

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Retied { found } => write!(f, "{RETIED}{found}"),
            Self::ChargeStopped { reason } => write!(f, "{CHARGE_STOPPED}{reason}"),
            Self::Other(text) => f.write_str(text),
        }
    }
}

impl From<&str> for Warning {
    fn from(text: &str) -> Self {
        if let Some(found) = text.strip_prefix(RETIED) {
            Self::Retied {
                found: found.to_owned(),
            }
        } else if let Some(reason) = text.strip_prefix(CHARGE_STOPPED) {
            Self::ChargeStopped {
                reason: reason.to_owned(),
            }
        } else {
            Self::Other(text.to_owned())
        }
    }
}

impl From<String> for Warning {
    fn from(text: String) -> Self {
        Self::from(text.as_str())
    }
}

/// Warnings of a run; one cell of a table, where `;` separates them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Warnings(Vec<Warning>);

impl Warnings {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All of them, in the order in which they arose.
    pub fn iter(&self) -> std::slice::Iter<'_, Warning> {
        self.0.iter()
    }

    /// Adds one. A `;` in its text becomes a comma.
    pub fn push(&mut self, warning: impl Into<Warning>) {
        let text = warning.into().to_string();
        self.0.push(Warning::from(text.replace(';', ",")));
    }
}

impl fmt::Display for Warnings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, warning) in self.0.iter().enumerate() {
            let separator = if k == 0 { "" } else { ";" };
            write!(f, "{separator}{warning}")?;
        }
        Ok(())
    }
}

impl From<&str> for Warnings {
    fn from(cell: &str) -> Self {
        let texts = cell.split(';').map(str::trim).filter(|t| !t.is_empty());
        Self(texts.map(Warning::from).collect())
    }
}

impl<'a> IntoIterator for &'a Warnings {
    type Item = &'a Warning;
    type IntoIter = std::slice::Iter<'a, Warning>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl FromIterator<Warning> for Warnings {
    fn from_iter<I: IntoIterator<Item = Warning>>(warnings: I) -> Self {
        Self(warnings.into_iter().collect())
    }
}

impl Serialize for Warnings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Warnings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let cell = String::deserialize(deserializer)?;
        Ok(Self::from(cell.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_read_as_they_were_written() {
        let mut warnings = Warnings::default();
        assert!(warnings.is_empty());
        warnings.push("the charged rod is tied as 3_1");
        warnings.push(Warning::ChargeStopped {
            reason: "step too small; contact".to_owned(),
        });
        warnings.push("strands overlap deeply");
        let cell = warnings.to_string();
        assert_eq!(
            cell,
            "the charged rod is tied as 3_1;charge stopped: step too small, contact;strands overlap deeply"
        );
        assert_eq!(Warnings::from(cell.as_str()), warnings);
        let kinds: Vec<&Warning> = warnings.iter().collect();
        assert!(matches!(kinds[0], Warning::Retied { found } if found == "3_1"));
        assert!(matches!(kinds[1], Warning::ChargeStopped { .. }));
        assert!(matches!(kinds[2], Warning::Other(_)));
    }
}
