//! Charts for figures of one's own, with the axes, fonts and colours of all others.
//!
//! Labels are written in a small markup: `*t*` italic, `_{99}` below, `^{2}` above.

pub use crate::plot::canvas::Picture;
pub use crate::plot::color::Scale;
pub use crate::sweeps::groups::{Key, Look};
pub use crate::sweeps::sheet::{Chart, Line, Scaling, draw};
