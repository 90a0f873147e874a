//! A row of a table.

use serde::Serialize;
use serde::de::DeserializeOwned;
use topo_analysis::Warnings;

/// A row of a sweep's table, one column a field.
pub trait Row: Serialize + DeserializeOwned + Clone + Send + Sync {
    /// Processor seconds that it took.
    fn cpu_seconds(&self) -> f64;

    /// What is doubtful about it.
    fn warnings(&self) -> &Warnings;

    /// The row with the settings of another: finished cases of earlier programs may lack some.
    fn with_settings_of(self, _blank: &Self) -> Self {
        self
    }
}
