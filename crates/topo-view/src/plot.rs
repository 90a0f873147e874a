//! Drawing, offline and without a display: panels of axes, labels, and their composition with the pixels of `topo-pixels`.
//!
//! Reading order: [`text`] (labels with sub- and superscripts), [`panel`] (axes), [`style`] and [`canvas`] (one SVG of all
//! these), [`render`] (the SVG as PNG with the shipped fonts).

pub mod canvas;
pub mod font;
pub mod panel;
pub mod render;
#[cfg(test)]
mod sight_tests;
pub mod style;
#[cfg(test)]
mod tests;
pub mod text;

pub use topo_pixels::{camera, color, raster, solids, tube};
