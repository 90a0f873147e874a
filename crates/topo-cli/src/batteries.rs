//! The batteries of this program.

use topo_lab::{Colloid, Elastic};
use topo_view::Shown;

/// Batteries that a program knows.
pub type Batteries<'a> = [&'a dyn Shown];

/// The batteries of the program `topo`; one more is a line here, or a list of its own for [`main_with`](crate::main_with).
pub const BATTERIES: [&dyn Shown; 2] = [&Elastic, &Colloid];
