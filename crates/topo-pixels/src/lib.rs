//! Curves, spheres and rods as shaded pixels, without a display.
//!
//! Reading order: [`color`] (scales), [`camera`] (how a curve is turned to the reader), `smooth` (a polygon made smooth),
//! [`tube`] (its surface with baked light), [`raster`] (its pixels), [`solids`] (spheres, rods and lines in one picture),
//! [`palette`] (the colours that a movie is reduced to).
//!
//! A separate crate, so that these loops are compiled for speed and the figures around them are not. Lengths are in the unit of
//! the curve that is drawn; pixels are those of the [`Window`](raster::Window).

pub mod camera;
pub mod color;
pub mod palette;
pub mod raster;
mod smooth;
pub mod solids;
pub mod tube;
