//! A sweep of any battery as pictures, drawn by what its [`Guide`](crate::guide::Guide) says of its tables.
//!
//! Reading order: `cases` (what a folder holds, and which settings are swept in it) → `groups` (which rows make one line, and how
//! lines are distinguished) → `sheet` (panels with a key) → `against` (results against settings), `curves` (discharge curves),
//! `parts` (one case alone).

pub(crate) mod against;
pub(crate) mod cases;
pub(crate) mod curves;
pub(crate) mod groups;
pub(crate) mod parts;
pub(crate) mod picture;
pub(crate) mod sheet;

pub use cases::{Cases, Row, Swept};
pub use picture::OwnPicture;
