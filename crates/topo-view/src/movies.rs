//! The moving pictures: one file each, written as animated PNG with a palette.

mod apng;
mod axes;
mod elastic;
mod nematic;
mod stage;

use crate::data;
use crate::error::ViewError;
#[cfg(test)]
pub(crate) use apng::encode;
pub(crate) use apng::still;
use stage::RATE;
pub(crate) use stage::SIZE;
pub use stage::{Clip, Movie, N_FRAMES, Stage};

/// Every movie, in the order of the gallery.
pub const ALL: [Movie; 2] = [elastic::MOVIE, nematic::MOVIE];

/// Draws a movie, writes `figures/NAME.png`, and returns what it shows in numbers.
pub fn draw(movie: Movie, stage: &Stage<'_>) -> Result<String, ViewError> {
    let clip = (movie.clip)(stage)?;
    let bytes = apng::encode(SIZE, RATE, &clip.frames)?;
    let path = stage.results.join(format!("figures/{}.png", movie.name));
    data::write(&path, &bytes)?;
    Ok(clip.finding)
}
