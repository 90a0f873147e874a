//! Solids made of capsules: spheres, rods and lines, in one picture that hides what lies behind.

use crate::camera;
use crate::color::{Rgb, to_linear};
use crate::raster::{Light, Window, cast, resolve, shade};
use crate::tube::key_light;
use nalgebra::{Matrix3, Vector3};
use resvg::tiny_skia::Pixmap;

/// A rod with round ends; a sphere when its ends agree.
#[derive(Debug, Clone, Copy)]
pub struct Capsule {
    /// Ends of the axis.
    pub ends: [Vector3<f64>; 2],
    /// Radius.
    pub radius: f64,
    /// Colour.
    pub color: Rgb,
}

/// Capsules to be drawn together; in the picture x is to the right, y up, z to the reader.
#[derive(Default)]
pub struct Solids<'a> {
    capsules: Vec<Capsule>,
    /// Paint of a capsule by its normal before turning.
    paint: Option<(usize, Paint<'a>)>,
    rotation: Option<Matrix3<f64>>,
}

/// Colour by the direction of the surface normal.
type Paint<'a> = Box<dyn Fn(&Vector3<f64>) -> Rgb + 'a>;

impl<'a> Solids<'a> {
    /// Adds a sphere coloured by the direction from its centre; one may be in a picture.
    pub fn painted_sphere(
        &mut self,
        center: Vector3<f64>,
        radius: f64,
        paint: impl Fn(&Vector3<f64>) -> Rgb + 'a,
    ) {
        self.paint = Some((self.capsules.len(), Box::new(paint)));
        self.sphere(center, radius, [0; 3]);
    }

    /// Adds a sphere.
    pub fn sphere(&mut self, center: Vector3<f64>, radius: f64, color: Rgb) {
        self.rod([center, center], radius, color);
    }

    /// Adds a rod.
    pub fn rod(&mut self, ends: [Vector3<f64>; 2], radius: f64, color: Rgb) {
        self.capsules.push(Capsule {
            ends,
            radius,
            color,
        });
    }

    /// Adds a line through points, a colour each.
    pub fn line(&mut self, points: &[Vector3<f64>], colors: &[Rgb], closed: bool, radius: f64) {
        for i in 1..points.len() {
            self.rod([points[i - 1], points[i]], radius, colors[i]);
        }
        if closed && points.len() > 2 {
            self.rod([points[points.len() - 1], points[0]], radius, colors[0]);
        }
    }

    /// The same solids turned about the origin.
    pub fn turned(mut self, rotation: &Matrix3<f64>) -> Self {
        for c in &mut self.capsules {
            c.ends = c.ends.map(|p| rotation * p);
        }
        self.rotation = Some(rotation * self.rotation.unwrap_or_else(Matrix3::identity));
        self
    }

    /// Left, bottom, right and top of everything.
    pub fn extent(&self) -> [f64; 4] {
        let points: Vec<Vector3<f64>> = self
            .capsules
            .iter()
            .flat_map(|c| {
                let out = Vector3::new(c.radius, c.radius, 0.0);
                c.ends
                    .iter()
                    .flat_map(move |p| [p - out, p + out])
                    .collect::<Vec<_>>()
            })
            .collect();
        camera::extent(&points)
    }

    /// Picture on a transparent ground; `None` when the window has no pixels.
    ///
    /// The largest capsules, up to eight of about the same radius, take sky and key light from the others.
    pub fn draw(&self, window: &Window) -> Option<Pixmap> {
        let depth = |c: &Capsule| c.ends[0].z.max(c.ends[1].z) + c.radius;
        let near = self.capsules.iter().map(depth).fold(f64::MIN, f64::max);
        let far = self.capsules.iter().map(depth).fold(f64::MAX, f64::min);
        let span = (near - far).max(1e-9);
        let mut order: Vec<usize> = (0..self.capsules.len()).collect();
        order.sort_by(|&a, &b| self.capsules[b].radius.total_cmp(&self.capsules[a].radius));
        // what is much smaller than the largest thing throws no shadow worth drawing
        let widest = order.first().map_or(0.0, |&k| self.capsules[k].radius);
        order.retain(|&k| self.capsules[k].radius > 0.5 * widest);
        order.truncate(8);
        let key = key_light();
        let pieces = self
            .capsules
            .iter()
            .map(|c| (c.ends[0], c.ends[1], c.radius));
        let hits = cast(pieces, window);
        resolve(window, &hits, |p, hit| {
            let c = &self.capsules[hit.piece as usize];
            let axis = c.ends[0] + (c.ends[1] - c.ends[0]) * f64::from(hit.along);
            let normal = (p - axis).try_normalize(1e-12).unwrap_or_else(Vector3::z);
            let (mut sky, mut lit) = (1.0_f64, 1.0_f64);
            for &k in order.iter().filter(|&&k| k != hit.piece as usize) {
                let other = &self.capsules[k];
                let d = (other.ends[0] + other.ends[1]) * 0.5 - p;
                let (d2, r) = (d.norm_squared(), other.radius);
                let above = d.dot(&normal) / d2.sqrt().max(1e-12);
                sky *= 1.0 - 0.85 * above.max(0.0) * (r * r / d2.max(r * r));
                let along = d.dot(&key);
                if along > 0.0 {
                    let clearance = (d2 - along * along).max(0.0).sqrt();
                    let blur = 0.15 * r + 0.1 * along;
                    let open = ((clearance - r) / blur + 0.5).clamp(0.0, 1.0);
                    lit = lit.min(open * open * (3.0 - 2.0 * open));
                }
            }
            let light = Light {
                sky: sky as f32,
                key: lit as f32,
                behind: ((near - hit.depth) / span).clamp(0.0, 1.0) as f32,
            };
            let color = match &self.paint {
                Some((k, paint)) if *k == hit.piece as usize => {
                    paint(&self.rotation.map_or(normal, |r| r.tr_mul(&normal)))
                }
                _ => c.color,
            };
            shade(color.map(to_linear), &normal, light)
        })
    }
}

/// View from above the x axis: `azimuth` turns about z, `height` lifts the eye (both in degrees); z points up in the picture.
pub fn view(azimuth: f64, height: f64) -> Matrix3<f64> {
    let (sa, ca) = azimuth.to_radians().sin_cos();
    let (sh, ch) = height.to_radians().sin_cos();
    // rows: right, up, towards the reader
    Matrix3::new(-sa, ca, 0.0, -sh * ca, -sh * sa, ch, ch * ca, ch * sa, sh)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window {
        width: 80,
        height: 80,
        center: [0.0, 0.0],
        scale: 10.0,
    };

    #[test]
    fn a_sphere_covers_its_disc_and_hides_what_is_behind() {
        let mut solids = Solids::default();
        solids.sphere(Vector3::zeros(), 3.0, [200, 200, 200]);
        solids.rod(
            [Vector3::new(-3.5, 0.0, -1.0), Vector3::new(3.5, 0.0, -1.0)],
            0.2,
            [255, 0, 0],
        );
        let picture = solids.draw(&WINDOW).unwrap();
        let red = |x: u32| {
            let p = picture.pixel(x, 40).unwrap();
            p.red() > p.green().saturating_add(30)
        };
        assert!(red(6) && !red(40) && red(73));
        let mut one = Solids::default();
        one.sphere(Vector3::zeros(), 3.0, [200, 200, 200]);
        let covered: f64 = one
            .draw(&WINDOW)
            .unwrap()
            .pixels()
            .iter()
            .map(|p| f64::from(p.alpha()) / 255.0)
            .sum();
        assert!((covered / (std::f64::consts::PI * 900.0) - 1.0).abs() < 0.01);
        assert_eq!(one.extent(), [-3.0, -3.0, 3.0, 3.0]);
    }

    #[test]
    fn the_view_keeps_z_up_and_right_handed() {
        let view = view(30.0, 20.0);
        assert!((view.determinant() - 1.0).abs() < 1e-12);
        let up = view * Vector3::z();
        assert!(up.x.abs() < 1e-12 && up.y > 0.9 && up.z > 0.0);
    }
}
