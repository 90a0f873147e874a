//! The moving pictures: one file each, written as animated PNG.

mod apng;
mod elastic;
mod nematic;

use crate::data;
use crate::error::XtaskError;
use crate::figures::Quality;
use crate::plot::canvas::Canvas;
use crate::progress::Progress;
use apng::Size;
use rayon::prelude::*;
use std::path::Path;
use topo_core::Interrupt;

/// Pixels of a frame.
const SIZE: Size = Size {
    width: 960,
    height: 720,
};
/// Frames of each movie.
pub const N_FRAMES: usize = 144;
/// Frames a second.
const RATE: u16 = 18;

/// Where and how a movie is made.
pub struct Stage<'a> {
    /// Folder of the results.
    pub results: &'a Path,
    /// How much is computed.
    pub quality: Quality,
    /// Asks to stop.
    pub interrupt: &'a Interrupt,
    /// Told after each frame.
    pub progress: &'a Progress,
}

/// Frames as drawn.
pub struct Clip {
    /// RGB bytes of each.
    frames: Vec<Vec<u8>>,
    /// What it shows in numbers.
    finding: String,
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
    clip: fn(&Stage<'_>) -> Result<Clip, XtaskError>,
}

/// Every movie, in the order of the gallery.
pub const ALL: [Movie; 2] = [elastic::MOVIE, nematic::MOVIE];

/// Draws a movie, writes `figures/NAME.png`, and returns what it shows in numbers.
pub fn draw(movie: Movie, stage: &Stage<'_>) -> Result<String, XtaskError> {
    let clip = (movie.clip)(stage)?;
    let bytes = apng::encode(SIZE, RATE, &clip.frames)?;
    let path = stage.results.join(format!("figures/{}.png", movie.name));
    data::write(&path, &bytes)?;
    Ok(clip.finding)
}

impl Stage<'_> {
    /// Draws the frames in parallel; `paint` gets the number of the frame and a white canvas of 960 x 720 units.
    fn frames(
        &self,
        paint: impl Fn(usize, &mut Canvas) -> Result<(), XtaskError> + Sync,
    ) -> Result<Vec<Vec<u8>>, XtaskError> {
        (0..N_FRAMES)
            .into_par_iter()
            .with_max_len(1)
            .map(|k| {
                crate::interrupt::check(self.interrupt)?;
                let mut canvas = Canvas::new(f64::from(SIZE.width), f64::from(SIZE.height), 1.0);
                paint(k, &mut canvas)?;
                let pixels = canvas.pixels()?;
                self.progress.done("frame");
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
