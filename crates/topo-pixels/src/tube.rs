//! A curve as a tube: smooth centreline, colour along it, and light baked onto its surface.
//!
//! Light is computed on a grid over the surface (arc times angle), not in pixels, so that it
//! is smooth, free of noise and costs the same at every resolution. Ambient occlusion sums
//! the solid angle of the tube's pieces above the horizon of a surface point,
//!
//! ```math
//! o(p) = \frac{2 r}{\pi} \int \frac{\max(0, n \cdot \omega)}{|c(s) - p|^2} ds,
//! ```
//!
//! and the shadow of the key light is the smallest clearance of the ray towards it.

use crate::color::{Rgb, Scale};
use crate::smooth::{curvatures, frames, smooth, tangents};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Angles of the baked grid around the tube.
const N_ANGLES: usize = 24;
/// Spacing of the smooth centreline in tube radii.
const SPACING: f64 = 0.16;
/// Smooth points per row of the baked grid and per piece that occludes.
const STRIDE: usize = 3;

/// Direction towards the key light, in view coordinates (x right, y up, z to the reader).
pub fn key_light() -> Vector3<f64> {
    Vector3::new(-0.45, 0.62, 0.95).normalize()
}

/// A polygon to be drawn as a tube, in view coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Strand<'a> {
    /// Its vertices.
    pub vertices: &'a [Vector3<f64>],
    /// What colours it, one value per vertex.
    pub values: &'a [f64],
    /// Whether the last vertex joins the first.
    pub closed: bool,
}

/// One tube in view coordinates, ready to be rasterised.
#[derive(Debug, Clone)]
pub struct Tube {
    /// Smooth centreline.
    pub points: Vec<Vector3<f64>>,
    /// Unit tangents at the points.
    pub tangents: Vec<Vector3<f64>>,
    /// First normals of a frame carried along without turning; the seam's angle is spread.
    pub frames: Vec<Vector3<f64>>,
    /// Curvature vectors (derivative of the tangent by arc length) at the points.
    pub curvatures: Vec<Vector3<f64>>,
    /// Colour at the points.
    pub colors: Vec<Rgb>,
    /// Whether the last point joins the first.
    pub closed: bool,
    /// Radius.
    pub radius: f64,
    light: Vec<[f32; 2]>,
}

impl Tube {
    /// Tube around `vertices` (view coordinates) with one value per vertex.
    ///
    /// Returns `None` for fewer than two vertices or coordinates that are not finite.
    pub fn new(
        vertices: &[Vector3<f64>],
        values: &[f64],
        closed: bool,
        radius: f64,
        scale: &Scale,
    ) -> Option<Self> {
        let strand = Strand {
            vertices,
            values,
            closed,
        };
        Self::all(&[strand], radius, scale)?.pop()
    }

    /// Tubes of one radius around several strands, each in the light that the others leave it.
    ///
    /// Returns `None` where [`new`](Self::new) does for one of them.
    pub fn all(strands: &[Strand<'_>], radius: f64, scale: &Scale) -> Option<Vec<Self>> {
        let of = |strand: &Strand<'_>| Self::unlit(strand, radius, scale);
        let mut tubes = strands.iter().map(of).collect::<Option<Vec<_>>>()?;
        let pieces = |tube: &Self| tube.points.iter().step_by(STRIDE).copied().collect();
        let pieces: Vec<Vec<Vector3<f64>>> = tubes.iter().map(pieces).collect();
        let pieces = pieces.concat();
        for tube in &mut tubes {
            tube.bake(&pieces);
        }
        Some(tubes)
    }

    fn unlit(strand: &Strand<'_>, radius: f64, scale: &Scale) -> Option<Self> {
        let Strand {
            vertices,
            values,
            closed,
        } = *strand;
        let finite = vertices.iter().all(|v| v.iter().all(|c| c.is_finite()));
        if vertices.len() < 2 || vertices.len() != values.len() || !finite || radius <= 0.0 {
            return None;
        }
        let (points, colors) = smooth(vertices, values, closed, radius * SPACING, scale);
        let tangents = tangents(&points, closed);
        let curvatures = curvatures(&points, &tangents, closed);
        let frames = frames(&tangents, closed);
        Some(Self {
            points,
            tangents,
            frames,
            curvatures,
            colors,
            closed,
            radius,
            light: Vec::new(),
        })
    }

    /// Number of pieces between neighbouring points.
    pub fn n_pieces(&self) -> usize {
        if self.closed {
            self.points.len()
        } else {
            self.points.len() - 1
        }
    }

    /// Index of the point after `i`.
    pub fn next(&self, i: usize) -> usize {
        if i + 1 == self.points.len() { 0 } else { i + 1 }
    }

    /// Place along the smooth centreline (in points, fraction included) and unit normal for
    /// a point `p` found on the capsule of piece `i` at fraction `u`.
    ///
    /// A chain of capsules is faceted; the foot of `p` on the osculating circle of the nearer
    /// point is not.
    pub fn surface(&self, i: usize, u: f64, p: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let j = self.next(i);
        let near = if u < 0.5 { i } else { j };
        let (tangent, curvature) = (self.tangents[near], self.curvatures[near]);
        let out = p - self.points[near];
        let tip = !self.closed && (near == 0 || near + 1 == self.points.len());
        let spacing = (self.points[j] - self.points[i]).norm().max(1e-12);
        let reach = out.dot(&tangent) / (1.0 - out.dot(&curvature)).max(0.3);
        if tip {
            let normal = out.try_normalize(1e-12).unwrap_or_else(Vector3::z);
            return (near.min(self.n_pieces() - 1) as f64, normal);
        }
        let reach = reach.clamp(-spacing, spacing);
        let foot = tangent * reach + curvature * (0.5 * reach * reach);
        let along = (tangent + curvature * reach).normalize();
        let across = out - foot;
        let across = across - along * along.dot(&across);
        let normal = across.try_normalize(1e-12).unwrap_or_else(Vector3::z);
        let n = self.points.len() as f64;
        let place = near as f64 + reach / spacing;
        let place = if self.closed {
            place.rem_euclid(n)
        } else {
            place.clamp(0.0, n - 1.0)
        };
        // Rounding may land on the end itself, which has no piece after it.
        (place.min(self.n_pieces() as f64 - 1e-6).max(0.0), normal)
    }

    /// Openness to the sky and to the key light, both in [0, 1], at a place along the
    /// centreline (in points) where the surface normal is `normal`.
    pub fn light(&self, place: f64, normal: &Vector3<f64>) -> [f32; 2] {
        let (i, u) = (place.floor() as usize, place.fract());
        let j = self.next(i);
        let tangent = (self.tangents[i] * (1.0 - u) + self.tangents[j] * u).normalize();
        let first = self.frames[i] * (1.0 - u) + self.frames[j] * u;
        let second = tangent.cross(&first);
        let angle = normal
            .dot(&second)
            .atan2(normal.dot(&first))
            .rem_euclid(TAU);
        let row = place / STRIDE as f64;
        let n_rows = self.light.len() / N_ANGLES;
        let r0 = (row.floor() as usize).min(n_rows - 1);
        let r1 = if r0 + 1 < n_rows {
            r0 + 1
        } else if self.closed {
            0
        } else {
            r0
        };
        let column = angle / TAU * N_ANGLES as f64;
        let c0 = column.floor() as usize % N_ANGLES;
        let c1 = (c0 + 1) % N_ANGLES;
        let (fr, fc) = (
            (row - r0 as f64).clamp(0.0, 1.0) as f32,
            column.fract() as f32,
        );
        let at = |r: usize, c: usize| self.light[r * N_ANGLES + c];
        let (a, b, c, d) = (at(r0, c0), at(r0, c1), at(r1, c0), at(r1, c1));
        std::array::from_fn(|k| {
            let low = a[k] + (b[k] - a[k]) * fc;
            let high = c[k] + (d[k] - c[k]) * fc;
            low + (high - low) * fr
        })
    }

    /// Computes the light on the surface, between `pieces` of all tubes of the picture.
    fn bake(&mut self, pieces: &[Vector3<f64>]) {
        let spacing = STRIDE as f64 * SPACING * self.radius;
        let weight = 2.0 * self.radius * spacing / std::f64::consts::PI;
        let light = key_light();
        let mut baked = Vec::with_capacity(self.points.len().div_ceil(STRIDE) * N_ANGLES);
        for row in (0..self.points.len()).step_by(STRIDE) {
            let second = self.tangents[row].cross(&self.frames[row]);
            for k in 0..N_ANGLES {
                let (sin, cos) = (k as f64 / N_ANGLES as f64 * TAU).sin_cos();
                let normal = self.frames[row] * cos + second * sin;
                let p = self.points[row] + normal * self.radius;
                baked.push(openness(&p, &normal, &light, pieces, weight, self.radius));
            }
        }
        self.light = baked;
    }
}

fn openness(
    p: &Vector3<f64>,
    normal: &Vector3<f64>,
    light: &Vector3<f64>,
    pieces: &[Vector3<f64>],
    weight: f64,
    radius: f64,
) -> [f32; 2] {
    let (mut occlusion, mut lit) = (0.0, 1.0_f64);
    for c in pieces {
        let d = c - p;
        let d2 = d.norm_squared().max(radius * radius);
        let above = d.dot(normal);
        if above > 0.0 {
            occlusion += weight * above / (d2 * d2.sqrt());
        }
        let along = d.dot(light);
        if along > 0.0 {
            let clearance = (d.norm_squared() - along * along).max(0.0).sqrt();
            // The penumbra widens with the distance to what casts the shadow.
            let blur = 0.12 * radius + 0.10 * along;
            let open = ((clearance - radius) / (2.0 * blur) + 1.0).clamp(0.0, 1.0);
            lit = lit.min(open * open * (3.0 - 2.0 * open));
        }
    }
    [(-1.25 * occlusion).exp() as f32, lit as f32]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(n: usize, radius: f64) -> Vec<Vector3<f64>> {
        (0..n)
            .map(|i| {
                let (s, c) = (i as f64 / n as f64 * TAU).sin_cos();
                Vector3::new(c, s, 0.0) * radius
            })
            .collect()
    }

    #[test]
    fn inside_of_a_ring_is_darker_than_its_outside() {
        let scale = Scale::viridis(0.0, 1.0);
        let v = circle(80, 3.0);
        let tube = Tube::new(&v, &[0.5; 80], true, 1.0, &scale).unwrap();
        let outward = tube.points[7].normalize();
        assert!(tube.light(7.0, &outward)[0] > 0.98);
        assert!(tube.light(7.0, &-outward)[0] < 0.85);
    }

    #[test]
    fn a_bar_above_casts_a_shadow() {
        let scale = Scale::viridis(0.0, 1.0);
        let light = key_light();
        // An open U whose second arm lies between the first and the light.
        let far = light * 4.0;
        let mut v: Vec<_> = (0..40)
            .map(|i| Vector3::new(0.0, 0.0, i as f64 * 0.5 - 10.0))
            .collect();
        let turn = Vector3::new(0.62, 0.45, 0.0).normalize();
        v = v.iter().map(|p| turn * p.z).collect();
        v.extend((0..40).map(|i| turn * (10.0 - i as f64 * 0.5) + far));
        let tube = Tube::new(&v, &[0.5; 80], false, 1.0, &scale).unwrap();
        let middle = tube.points.iter().position(|p| p.norm() < 0.2).unwrap();
        let tangent = tube.tangents[middle];
        let towards = (light - tangent * tangent.dot(&light)).normalize();
        assert!(tube.light(middle as f64, &towards)[1] < 0.1);
        let last = tube.points.len() - tube.points.len() / 8;
        assert!(tube.light(last as f64, &towards)[1] > 0.9);
    }

    #[test]
    fn a_ring_in_a_ring_is_darker_than_alone() {
        let scale = Scale::viridis(0.0, 1.0);
        let (inner, outer) = (circle(80, 3.0), circle(80, 5.2));
        let strand = |vertices| Strand {
            vertices,
            values: &[0.5; 80],
            closed: true,
        };
        let both = Tube::all(&[strand(&inner), strand(&outer)], 1.0, &scale).unwrap();
        let alone = Tube::new(&inner, &[0.5; 80], true, 1.0, &scale).unwrap();
        let outward = alone.points[7].normalize();
        let sky = |tube: &Tube| tube.light(7.0, &outward)[0];
        assert!(sky(&both[0]) < 0.8 * sky(&alone), "{}", sky(&both[0]));
        assert_eq!(both[0].points, alone.points);
    }

    #[test]
    fn normals_are_those_of_the_smooth_tube() {
        let scale = Scale::viridis(0.0, 1.0);
        let tube = Tube::new(&circle(80, 2.0), &[0.5; 80], true, 1.0, &scale).unwrap();
        let n = tube.points.len() as f64;
        for k in 0..40 {
            // Points on the outside of a torus, a fraction of a piece apart.
            let place = 20.0 + 0.1 * k as f64;
            let (s, c) = (place / n * TAU).sin_cos();
            let outward = Vector3::new(c, s, 0.0);
            let (found, normal) = tube.surface(place as usize, place.fract(), &(outward * 3.0));
            assert!((normal - outward).norm() < 2e-3, "{place}: {normal:?}");
            assert!((found - place).abs() < 0.02, "{place}: {found}");
        }
    }

    #[test]
    fn bad_curves_are_refused() {
        let scale = Scale::viridis(0.0, 1.0);
        assert!(Tube::new(&circle(1, 1.0), &[0.0], true, 1.0, &scale).is_none());
        let mut v = circle(8, 1.0);
        v[3].x = f64::NAN;
        assert!(Tube::new(&v, &[0.0; 8], true, 1.0, &scale).is_none());
    }
}
