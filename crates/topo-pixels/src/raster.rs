//! Pixels of capsules and of the tubes they make: orthographic, z-buffered, supersampled, shaded in linear light.

use crate::color::{Rgb, from_linear, to_linear};
use crate::tube::{Tube, key_light};
use nalgebra::Vector3;
use resvg::tiny_skia::{Pixmap, PremultipliedColorU8};

/// Subpixels along each side of a pixel.
const SUB: usize = 3;

/// Where the picture looks: centre in view coordinates and pixels per unit of length.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// View coordinates of the middle.
    pub center: [f64; 2],
    /// Pixels per unit of length.
    pub scale: f64,
}

/// What a line of sight meets first.
#[derive(Clone, Copy)]
pub struct Hit {
    /// View coordinate towards the reader.
    pub depth: f64,
    /// Index of the capsule.
    pub piece: u32,
    /// Fraction along its axis.
    pub along: f32,
}

/// What light a surface point gets, each from 0 to 1.
#[derive(Clone, Copy)]
pub struct Light {
    /// Openness to the sky.
    pub sky: f32,
    /// Openness to the key light.
    pub key: f32,
    /// Distance from the nearest thing shown, 1 at the farthest.
    pub behind: f32,
}

/// Thin straight rods of one colour, such as struts between strands.
#[derive(Debug, Clone, Default)]
pub struct Rods {
    /// Ends of each, in view coordinates.
    pub ends: Vec<[Vector3<f64>; 2]>,
    /// Their radius.
    pub radius: f64,
    /// Their colour.
    pub color: Rgb,
}

/// Picture of tubes of one radius with rods on a transparent ground; `None` without a tube or when the window has no pixels.
pub fn draw(tubes: &[Tube], rods: &Rods, window: &Window) -> Option<Pixmap> {
    let linear = |tube: &Tube| tube.colors.iter().map(|c| c.map(to_linear)).collect();
    let colors: Vec<Vec<[f32; 3]>> = tubes.iter().map(linear).collect();
    let depths = tubes.iter().flat_map(|tube| &tube.points).map(|p| p.z);
    let (near, far) = depths.fold((f64::MIN, f64::MAX), |(a, b), z| (a.max(z), b.min(z)));
    let span = (near - far).max(4.0 * tubes.first()?.radius);
    // tube and piece of each capsule
    let all = tubes.iter().enumerate();
    let owners: Vec<(usize, usize)> = all
        .flat_map(|(k, tube)| (0..tube.n_pieces()).map(move |i| (k, i)))
        .collect();
    let pieces = owners.iter().map(|&(k, i)| {
        let tube = &tubes[k];
        (tube.points[i], tube.points[tube.next(i)], tube.radius)
    });
    let pieces = pieces.chain(rods.ends.iter().map(|[a, b]| (*a, *b, rods.radius)));
    let rod_color = rods.color.map(to_linear);
    resolve(window, &cast(pieces, window), |p, hit| {
        let behind = ((near - hit.depth) / span).clamp(0.0, 1.0) as f32;
        let piece = hit.piece as usize;
        if let Some([a, b]) = piece
            .checked_sub(owners.len())
            .and_then(|k| rods.ends.get(k))
        {
            let (axis, from) = (b - a, p - a);
            let normal = from - axis * (from.dot(&axis) / axis.norm_squared().max(1e-12));
            let normal = normal.try_normalize(1e-9).unwrap_or_else(Vector3::z);
            let open = Light {
                sky: 1.0,
                key: 1.0,
                behind,
            };
            return shade(rod_color, &normal, open);
        }
        let (k, piece) = owners[piece];
        let (tube, colors) = (&tubes[k], &colors[k]);
        let (place, normal) = tube.surface(piece, f64::from(hit.along), p);
        let [sky, key] = tube.light(place, &normal);
        let (i, along) = (place.floor() as usize, place.fract() as f32);
        let j = tube.next(i);
        let albedo = std::array::from_fn(|k| colors[i][k] + (colors[j][k] - colors[i][k]) * along);
        shade(albedo, &normal, Light { sky, key, behind })
    })
}

/// Pixels from what each subpixel meets; `color` gives linear light at a surface point.
pub fn resolve(
    window: &Window,
    hits: &[Option<Hit>],
    color: impl Fn(&Vector3<f64>, &Hit) -> [f32; 3],
) -> Option<Pixmap> {
    let mut pixmap = Pixmap::new(window.width, window.height)?;
    let (w, h) = (window.width as usize * SUB, window.height as usize * SUB);
    let scale = window.scale * SUB as f64;
    for (i, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
        let (px, py) = (i % window.width as usize, i / window.width as usize);
        let (mut sum, mut n_hit) = ([0.0_f32; 3], 0_u32);
        for sy in 0..SUB {
            for sx in 0..SUB {
                let Some(hit) = &hits[(py * SUB + sy) * w + px * SUB + sx] else {
                    continue;
                };
                let x = (px * SUB + sx) as f64 + 0.5 - w as f64 / 2.0;
                let y = h as f64 / 2.0 - (py * SUB + sy) as f64 - 0.5;
                let [x, y] = [window.center[0] + x / scale, window.center[1] + y / scale];
                for (s, l) in sum
                    .iter_mut()
                    .zip(color(&Vector3::new(x, y, hit.depth), hit))
                {
                    *s += l;
                }
                n_hit += 1;
            }
        }
        if n_hit > 0 {
            let alpha = n_hit as f32 / (SUB * SUB) as f32;
            let [r, g, b] =
                sum.map(|c| (f32::from(from_linear(c / n_hit as f32)) * alpha).round() as u8);
            let a = (alpha * 255.0).round() as u8;
            let opaque = PremultipliedColorU8::from_rgba(r.min(a), g.min(a), b.min(a), a);
            *pixel = opaque.unwrap_or(PremultipliedColorU8::TRANSPARENT);
        }
    }
    Some(pixmap)
}

/// Linear light that a surface sends to the reader.
pub fn shade(albedo: [f32; 3], normal: &Vector3<f64>, light: Light) -> [f32; 3] {
    let key = key_light();
    let diffuse = normal.dot(&key).max(0.0) as f32 * light.key;
    let half = (key + Vector3::z()).normalize();
    let gloss = (normal.dot(&half).max(0.0) as f32).powi(48) * light.key * 0.22;
    let up = 0.5 + 0.5 * normal.y as f32;
    let ambient = (0.26 + 0.16 * up) * light.sky;
    // Edges fall off a little, so that strands of one colour part where they cross.
    let rim = 0.55 + 0.45 * (normal.z as f32 / 0.45).clamp(0.0, 1.0).sqrt();
    // Distance takes light away, as in a dim room: the depth cue.
    let cue = 1.0 - 0.34 * light.behind;
    albedo.map(|albedo| {
        // Light that bounces between bright walls makes their creases less dark.
        let fill = ambient / (1.0 - 0.6 * albedo * (1.0 - light.sky));
        (albedo * (fill + 0.86 * diffuse) * rim + gloss) * cue
    })
}

/// What each subpixel of the window meets first of capsules (ends, radius).
pub fn cast(
    pieces: impl Iterator<Item = (Vector3<f64>, Vector3<f64>, f64)>,
    window: &Window,
) -> Vec<Option<Hit>> {
    let (w, h) = (window.width as usize * SUB, window.height as usize * SUB);
    let mut hits: Vec<Option<Hit>> = vec![None; w * h];
    let scale = window.scale * SUB as f64;
    let (ox, oy) = (window.center[0], window.center[1]);
    let to_x = |x: f64| (x - ox) * scale + w as f64 / 2.0;
    let to_y = |y: f64| h as f64 / 2.0 - (y - oy) * scale;
    for (i, (a, b, r)) in pieces.enumerate() {
        let clip = |v: f64, n: usize| v.clamp(0.0, n as f64) as usize;
        let x0 = clip(to_x(a.x.min(b.x) - r).floor(), w);
        let x1 = clip(to_x(a.x.max(b.x) + r).ceil(), w);
        let y0 = clip(to_y(a.y.max(b.y) + r).floor(), h);
        let y1 = clip(to_y(a.y.min(b.y) - r).ceil(), h);
        for py in y0..y1 {
            let y = oy + (h as f64 / 2.0 - (py as f64 + 0.5)) / scale;
            for px in x0..x1 {
                let x = ox + (px as f64 + 0.5 - w as f64 / 2.0) / scale;
                let slot = &mut hits[py * w + px];
                let Some((depth, along)) = capsule(&a, &b, r, x, y) else {
                    continue;
                };
                if slot.as_ref().is_some_and(|old| old.depth >= depth) {
                    continue;
                }
                *slot = Some(Hit {
                    depth,
                    piece: i as u32,
                    along: along as f32,
                });
            }
        }
    }
    hits
}

/// Nearest point to the reader of the capsule from `a` to `b` above (x, y): its depth and
/// the fraction along the axis.
fn capsule(a: &Vector3<f64>, b: &Vector3<f64>, r: f64, x: f64, y: f64) -> Option<(f64, f64)> {
    let axis = b - a;
    let length = axis.norm();
    let cap = |c: &Vector3<f64>| {
        let rest = r * r - (x - c.x).powi(2) - (y - c.y).powi(2);
        (rest >= 0.0).then(|| c.z + rest.sqrt())
    };
    if length > 1e-12 {
        let e = axis / length;
        let (wx, wy) = (x - a.x, y - a.y);
        let q = wx * e.x + wy * e.y;
        let aa = 1.0 - e.z * e.z;
        let inside = (q * e.z).powi(2) - aa * (wx * wx + wy * wy - q * q - r * r);
        if aa > 1e-9 && inside >= 0.0 {
            let wz = (q * e.z + inside.sqrt()) / aa;
            let t = q + wz * e.z;
            if (0.0..=length).contains(&t) {
                return Some((a.z + wz, t / length));
            }
        }
    }
    match (cap(a), cap(b)) {
        (Some(za), Some(zb)) if zb > za => Some((zb, 1.0)),
        (Some(za), _) => Some((za, 0.0)),
        (None, Some(zb)) => Some((zb, 1.0)),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Scale;

    fn bar(z: f64, along_x: bool) -> Vec<Vector3<f64>> {
        (0..30)
            .map(|i| {
                let s = i as f64 / 29.0 * 20.0 - 10.0;
                if along_x {
                    Vector3::new(s, 0.0, z)
                } else {
                    Vector3::new(0.0, s, z)
                }
            })
            .collect()
    }

    fn window() -> Window {
        Window {
            width: 60,
            height: 60,
            center: [0.0, 0.0],
            scale: 2.37,
        }
    }

    #[test]
    fn a_tube_covers_its_shadow_and_no_more() {
        let scale = Scale::viridis(0.0, 1.0);
        let tube = Tube::new(&bar(0.0, true), &[0.5; 30], false, 1.0, &scale).unwrap();
        let picture = draw(&[tube], &Rods::default(), &window()).unwrap();
        let covered: f64 = picture
            .pixels()
            .iter()
            .map(|p| f64::from(p.alpha()) / 255.0)
            .sum();
        let area = (20.0 * 2.0 + std::f64::consts::PI) * 2.37 * 2.37;
        assert!(
            (covered / area - 1.0).abs() < 0.02,
            "{covered} against {area}"
        );
    }

    #[test]
    fn the_nearer_strand_hides_the_farther() {
        let scale = Scale::viridis(0.0, 1.0);
        let mut v = bar(-3.0, true);
        v.extend(bar(3.0, false).into_iter().rev());
        let mut values = vec![0.0; 30];
        values.extend([1.0; 30]);
        let tube = Tube::new(&v, &values, false, 1.0, &scale).unwrap();
        let picture = draw(&[tube], &Rods::default(), &window()).unwrap();
        let crossing = picture.pixel(30, 30).unwrap();
        // Yellow (value 1) passes over dark violet (value 0).
        assert!(
            crossing.red() > 120 && crossing.blue() < 120,
            "{crossing:?}"
        );
    }

    #[test]
    fn capsule_depth_is_that_of_a_cylinder_and_of_a_sphere() {
        let (a, b) = (Vector3::new(-1.0, 0.0, 0.0), Vector3::new(1.0, 0.0, 0.0));
        let (z, u) = capsule(&a, &b, 0.5, 0.0, 0.3).unwrap();
        assert!((z - 0.4).abs() < 1e-12 && (u - 0.5).abs() < 1e-12);
        let (z, u) = capsule(&a, &b, 0.5, 1.3, 0.0).unwrap();
        assert!((z - 0.4).abs() < 1e-12 && u == 1.0);
        assert!(capsule(&a, &b, 0.5, 1.6, 0.0).is_none());
    }
}
