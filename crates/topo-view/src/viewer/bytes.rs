//! Numbers of the viewer as text.

use nalgebra::Vector3;

use crate::plot::font::base64;

/// Coordinates as 16-bit fractions of `scale`, little-endian, base64.
pub(super) fn shorts(values: impl Iterator<Item = f64>, scale: f64) -> String {
    let bytes: Vec<u8> = values
        .flat_map(|v| ((v / scale * 32767.0).round().clamp(-32767.0, 32767.0) as i16).to_le_bytes())
        .collect();
    base64(&bytes)
}

/// Places on a colour scale as bytes, base64.
pub(super) fn shades(fractions: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = fractions
        .map(|f| (f.clamp(0.0, 1.0) * 255.0).round() as u8)
        .collect();
    base64(&bytes)
}

pub(super) fn coordinates(points: &[Vector3<f64>]) -> impl Iterator<Item = f64> {
    points.iter().flat_map(|p| [p.x, p.y, p.z])
}

pub(super) fn reach(points: &[Vector3<f64>]) -> f64 {
    points.iter().map(|p| p.norm()).fold(1e-9, f64::max)
}
