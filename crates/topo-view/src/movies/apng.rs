//! Frames as one animated PNG with a palette, which every browser plays; each holds only what differs from the one before.

use crate::error::ViewError;
use png::{BlendOp, DisposeOp, EncodingError};
use rayon::prelude::*;
use topo_pixels::palette::{N_COLORS, Palette};

/// Size of a movie in pixels.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

/// Bytes before the first chunk of a PNG.
const SIGNATURE: usize = 8;
/// Index of pixels that stay as they are.
const AS_BEFORE: u8 = N_COLORS as u8;

/// A part of a picture: left, top, width and height, and its indices.
struct Patch {
    at: [u32; 2],
    size: [u32; 2],
    indices: Vec<u8>,
}

/// Encodes frames of opaque RGB bytes, shown at `rate` frames a second for ever; the last one rests for two seconds.
pub fn encode(size: Size, rate: u16, frames: &[Vec<u8>]) -> Result<Vec<u8>, ViewError> {
    let palette = Palette::of(frames);
    let frames: Vec<Vec<u8>> = frames
        .par_iter()
        .map(|f| palette.indices(f, size.width as usize))
        .collect();
    write(size, rate, &palette, &frames).map_err(|e| ViewError::Drawing {
        reason: format!("movie: {e}"),
    })
}

/// The first frame of an animated PNG, as a PNG that stands still: the same picture data without the chunks of the animation.
pub fn still(movie: &[u8]) -> Vec<u8> {
    let (signature, mut rest) = movie.split_at(movie.len().min(SIGNATURE));
    let mut still = signature.to_vec();
    // length of the data, type, data, checksum
    while let Some(length) = rest.first_chunk().map(|n| u32::from_be_bytes(*n) as usize) {
        let (chunk, after) = rest.split_at(rest.len().min(length.saturating_add(12)));
        if !matches!(chunk.get(4..8), Some(b"acTL" | b"fcTL" | b"fdAT")) {
            still.extend_from_slice(chunk);
        }
        rest = after;
    }
    still
}

fn write(
    size: Size,
    rate: u16,
    palette: &Palette,
    frames: &[Vec<u8>],
) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width, size.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    let mut alpha = vec![255; N_COLORS];
    alpha.push(0);
    let mut colors = palette.colors.concat();
    colors.resize(3 * (N_COLORS + 1), 255);
    encoder.set_palette(colors);
    encoder.set_trns(alpha);
    encoder.set_compression(png::Compression::High);
    // neighbouring indices of a palette are no neighbours in colour
    encoder.set_filter(png::Filter::NoFilter);
    let n = u32::try_from(frames.len()).unwrap_or(u32::MAX);
    encoder.set_animated(n, 0)?;
    encoder.set_frame_delay(1, rate)?;
    encoder.set_dispose_op(DisposeOp::None)?;
    let mut writer = encoder.write_header()?;
    for (k, frame) in frames.iter().enumerate() {
        if k + 1 == frames.len() {
            writer.set_frame_delay(2, 1)?;
        }
        match k
            .checked_sub(1)
            .map(|before| difference(size, &frames[before], frame))
        {
            None => writer.write_image_data(frame)?,
            Some(patch) => {
                writer.reset_frame_position()?;
                writer.set_frame_dimension(patch.size[0], patch.size[1])?;
                writer.set_frame_position(patch.at[0], patch.at[1])?;
                writer.set_blend_op(BlendOp::Over)?;
                writer.write_image_data(&patch.indices)?;
            }
        }
    }
    writer.finish()?;
    Ok(bytes)
}

/// The smallest rectangle that holds all pixels that changed, at least one pixel; what is the same inside is left as it is.
fn difference(size: Size, before: &[u8], now: &[u8]) -> Patch {
    let width = size.width as usize;
    let [mut left, mut top, mut right, mut bottom] = [width, size.height as usize, 0, 0];
    for (k, (a, b)) in before.iter().zip(now).enumerate() {
        if a != b {
            let (x, y) = (k % width, k / width);
            (left, right) = (left.min(x), right.max(x + 1));
            (top, bottom) = (top.min(y), bottom.max(y + 1));
        }
    }
    if right == 0 {
        (left, top, right, bottom) = (0, 0, 1, 1);
    }
    let mut indices = Vec::with_capacity((right - left) * (bottom - top));
    for y in top..bottom {
        let row = y * width;
        for k in row + left..row + right {
            indices.push(if before[k] == now[k] {
                AS_BEFORE
            } else {
                now[k]
            });
        }
    }
    Patch {
        at: [left as u32, top as u32],
        size: [(right - left) as u32, (bottom - top) as u32],
        indices,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::browser::{Browser, SEND, address};
    use crate::plot::camera;
    use crate::plot::canvas::Canvas;
    use crate::plot::color::Scale;
    use crate::plot::style::Style;
    use crate::plot::tube::Tube;
    use nalgebra::{Rotation3, Vector3};
    use std::f64::consts::TAU;

    const SIZE: Size = Size {
        width: 40,
        height: 30,
    };

    /// A square that moves over a ground with a line of text's worth of other colours.
    fn squares() -> Vec<Vec<u8>> {
        let frame = |k: u32| {
            let color = move |x: u32, y: u32| match (x, y) {
                (_, 0..4) => [10, (6 * x) as u8, 200],
                _ if x.abs_diff(5 + 3 * k) < 3 && y.abs_diff(12) < 4 => [200, 40, 10],
                _ => [255; 3],
            };
            let rows = (0..SIZE.height).flat_map(|y| (0..SIZE.width).map(move |x| (x, y)));
            rows.flat_map(|(x, y)| color(x, y)).collect()
        };
        let mut frames: Vec<Vec<u8>> = (0..6).map(frame).collect();
        // nothing changes at the end
        frames.push(frames[5].clone());
        frames
    }

    /// The frames of an animated PNG, put together as the standard says.
    fn decoded(bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let n = reader.info().animation_control().unwrap().num_frames;
        let mut shown = vec![0; (3 * SIZE.width * SIZE.height) as usize];
        let mut all = Vec::new();
        for _ in 0..n {
            let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut buffer).unwrap();
            let c = *reader.info().frame_control().unwrap();
            for (k, p) in buffer
                .chunks(4)
                .take((c.width * c.height) as usize)
                .enumerate()
            {
                let (x, y) = (
                    c.x_offset + k as u32 % c.width,
                    c.y_offset + k as u32 / c.width,
                );
                if p[3] == 255 {
                    let at = 3 * (y * SIZE.width + x) as usize;
                    shown[at..at + 3].copy_from_slice(&p[..3]);
                }
            }
            all.push(shown.clone());
        }
        all
    }

    #[test]
    fn every_frame_comes_back() {
        let frames = squares();
        let bytes = encode(SIZE, 24, &frames).unwrap();
        assert_eq!(decoded(&bytes), frames);
    }

    #[test]
    fn a_still_is_the_first_frame() {
        let frames = squares();
        let bytes = still(&encode(SIZE, 24, &frames).unwrap());
        let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        assert!(reader.info().animation_control().is_none());
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut buffer).unwrap();
        let opaque: Vec<u8> = buffer.chunks(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        assert_eq!(opaque, frames[0]);
        // a movie that was cut short, and none at all
        assert_eq!(still(&bytes[..bytes.len() - 5]), bytes[..bytes.len() - 5]);
        assert_eq!(still(b"PNG"), b"PNG");
    }

    #[test]
    fn a_movie_of_a_shaded_tube_is_small() {
        let size = Size {
            width: 320,
            height: 240,
        };
        let knot: Vec<Vector3<f64>> = (0..100)
            .map(|i| {
                let a = f64::from(i) / 100.0 * TAU;
                let r = 2.0 + (3.0 * a).cos();
                Vector3::new(
                    r * (2.0 * a).cos(),
                    r * (2.0 * a).sin(),
                    1.2 * (3.0 * a).sin(),
                ) * 2.2
            })
            .collect();
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let frames: Vec<Vec<u8>> = (0..12)
            .map(|k| {
                let turn = Rotation3::from_euler_angles(0.1 * f64::from(k), 0.0, 0.0);
                let view = camera::view(&knot, turn.matrix());
                let tube =
                    Tube::new(&view, &values, true, 1.0, &Scale::viridis(0.0, 99.0)).unwrap();
                let mut canvas = Canvas::new(320.0, 240.0, 1.0);
                canvas
                    .tubes([0.0; 2], [320.0, 240.0], [0.0; 2], 6.0, &[tube])
                    .unwrap();
                canvas.text(8.0, 20.0, &format!("*t* = {k}"), Style::default());
                let pixels = canvas.pixels().unwrap();
                pixels
                    .data()
                    .chunks(4)
                    .flat_map(|p| [p[0], p[1], p[2]])
                    .collect()
            })
            .collect();
        let bytes = encode(size, 12, &frames).unwrap().len() as f64;
        let a_pixel = bytes / (320.0 * 240.0 * 12.0);
        // 4 MB for the frames of a movie
        let movie = super::super::stage::SIZE;
        let most = 4e6 / f64::from(movie.width * movie.height) / super::super::N_FRAMES as f64;
        // the tube fills about as much of the picture as those of the movies, and all of it moves
        assert!(a_pixel < most, "{a_pixel} bytes a pixel, {most} in a movie");
    }

    #[test]
    #[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
    fn browser_an_animated_png_plays() {
        let dir = tempfile::tempdir().unwrap();
        let frames = squares();
        let movie = crate::plot::font::base64(&encode(SIZE, 10, &frames).unwrap());
        // Decodes frame by frame as the page's own pictures are decoded, and says what is where.
        let page = format!(
            "<!DOCTYPE html><script>(async () => {{
            const bytes = Uint8Array.from(atob('{movie}'), (c) => c.charCodeAt(0)), report = {{ reds: [] }};
            const decoder = new ImageDecoder({{ data: bytes, type: 'image/png' }});
            await decoder.tracks.ready; await decoder.completed;
            report.frames = decoder.tracks.selectedTrack.frameCount;
            report.repeats = String(decoder.tracks.selectedTrack.repetitionCount);
            for (let k = 0; k < report.frames; k++) {{
                const image = (await decoder.decode({{ frameIndex: k }})).image;
                const c = new OffscreenCanvas({w}, {h}).getContext('2d');
                c.drawImage(image, 0, 0);
                const p = c.getImageData(0, 0, {w}, {h}).data;
                let sum = 0, n = 0;
                for (let i = 0; i < p.length; i += 4) if (p[i] === 200 && p[i + 1] === 40) {{ sum += i / 4 % {w}; n++; }}
                report.reds.push(sum / n);
            }}
            {SEND}
            }})().catch((e) => {{ const report = {{ error: String(e) }}; {SEND} }});</script>",
            w = SIZE.width,
            h = SIZE.height
        );
        let file = dir.path().join("movie.html");
        std::fs::write(&file, page).unwrap();
        let report = Browser::start().report(&address(&file), [500, 300]);
        assert_eq!(report["frames"], frames.len(), "{report}");
        assert_eq!(report["repeats"], "Infinity", "{report}");
        let places = [5, 8, 11, 14, 17, 20, 20];
        assert_eq!(report["reds"], serde_json::json!(places), "{report}");
    }
}
