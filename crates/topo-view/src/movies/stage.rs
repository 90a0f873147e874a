//! What a movie is, and where its frames are drawn.

use std::path::Path;

use rayon::prelude::*;
use topo_core::Interrupt;

use super::apng::Size;
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use topo_lab::Preset;

/// Pixels of a frame.
pub(crate) const SIZE: Size = Size {
    width: 960,
    height: 720,
};
/// Frames of each movie.
pub const N_FRAMES: usize = 144;
/// Frames a second.
pub(crate) const RATE: u16 = 18;

/// Where and how a movie is made.
pub struct Stage<'a> {
    /// Folder of the results.
    pub results: &'a Path,
    /// How much is computed.
    pub quality: Preset,
    /// Asks to stop.
    pub interrupt: &'a Interrupt,
    /// Called after each frame.
    pub drawn: &'a (dyn Fn() + Sync),
}

/// Frames as drawn.
pub struct Clip {
    /// RGB bytes of each.
    pub(crate) frames: Vec<Vec<u8>>,
    /// What it shows in numbers.
    pub(crate) finding: String,
}

/// An entry of the gallery that moves.
#[derive(Debug, Clone, Copy)]
pub struct Movie {
    /// File stem, and the value of `--only`.
    pub name: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What is shown.
    pub caption: &'static str,
    /// What the published movie or figure claims.
    pub claim: &'static str,
    /// Which battery.
    pub battery: &'static str,
    pub(crate) clip: fn(&Stage<'_>) -> Result<Clip, ViewError>,
}

impl Stage<'_> {
    /// Draws the frames in parallel; `paint` gets the number of the frame and a white canvas of 960 x 720 units.
    pub(super) fn frames(
        &self,
        paint: impl Fn(usize, &mut Canvas) -> Result<(), ViewError> + Sync,
    ) -> Result<Vec<Vec<u8>>, ViewError> {
        (0..N_FRAMES)
            .into_par_iter()
            .with_max_len(1)
            .map(|k| {
                crate::error::check(self.interrupt)?;
                let mut canvas = Canvas::new(f64::from(SIZE.width), f64::from(SIZE.height), 1.0);
                paint(k, &mut canvas)?;
                let pixels = canvas.pixels()?;
                (self.drawn)();
                // white lies below everything, so that alpha is full
                Ok(pixels
                    .data()
                    .chunks(4)
                    .flat_map(|p| [p[0], p[1], p[2]])
                    .collect())
            })
            .collect()
    }
}
