//! Curves in space: the polyline, its writhe, smoothing and resampling.

mod polyline;
mod resample;
mod spline;
mod writhe;

pub use polyline::Polyline;
pub use writhe::{average_crossing_number, writhe};
