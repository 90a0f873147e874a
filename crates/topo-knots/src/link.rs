//! Links: their table, their invariants, and their names from coordinates.

mod entry;
mod file;
mod identify;
mod invariants;
mod open;
mod table;

pub use entry::LinkEntry;
pub use identify::{LinkPart, LinkType, identify_link};
pub use invariants::{LinkInvariants, LinkJones};
pub use open::identify_open_link;
pub use table::LinkTable;
