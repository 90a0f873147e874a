//! The batteries of this program.

use topo_lab::{Battery, Colloid, Elastic};

/// Batteries that a program knows.
pub type Batteries<'a> = [&'a dyn Battery];

/// The batteries of the program `topo`; one more is a line here, or a list of its own for [`main_with`](crate::main_with).
pub const BATTERIES: [&dyn Battery; 2] = [&Elastic, &Colloid];
