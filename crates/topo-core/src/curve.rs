//! Curves in space: the polyline, its writhe, its thickness, smoothing and resampling.

mod polyline;
mod resample;
mod segment;
mod spline;
mod thickness;
mod writhe;

pub use polyline::Polyline;
pub use segment::closest_points;
pub use thickness::{
    Thickness, distance_between, thickness, thickness_brute_force, thickness_of_all,
    thickness_of_all_brute_force, vertex_radius, windowed_half_distance,
};
pub use writhe::{average_crossing_number, linking, writhe};
