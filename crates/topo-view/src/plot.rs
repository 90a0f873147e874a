//! Drawing, offline and without a display: shaded tubes, panels of axes, and their composition.
//!
//! Reading order: [`color`] (scales), [`camera`] (how a curve is turned to the reader),
//! [`smooth`] (a polygon made smooth), [`tube`] (its surface with baked light), [`raster`] (its pixels), [`solids`] (spheres, rods and lines in one picture),
//! [`text`] (labels with sub- and superscripts), [`panel`] (axes), [`style`] and [`canvas`] (one SVG of all
//! these), [`render`] (the SVG as PNG with the shipped fonts).

pub mod camera;
pub mod canvas;
pub mod color;
pub mod font;
pub mod panel;
pub mod raster;
pub mod render;
pub mod smooth;
pub mod solids;
pub mod style;
#[cfg(test)]
mod tests;
pub mod text;
pub mod tube;
