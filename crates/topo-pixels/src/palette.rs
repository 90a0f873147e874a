//! A palette for all frames of a movie: one byte a pixel instead of three.

use rayon::prelude::*;

/// Colours of a palette; the index after the last one is free for "as before".
pub const N_COLORS: usize = 255;

/// Bits kept of a channel while colours are counted.
const BITS: usize = 6;
const N_BINS: usize = 1 << (3 * BITS);

/// Colour of the ground of every frame.
const GROUND: Rgb = [255; 3];

/// Largest shift of a channel by dithering: about half a step of the palette in a shaded surface.
const DITHER: f32 = 2.5;

type Rgb = [u8; 3];

/// Colours that stand for those of all frames.
pub struct Palette {
    /// At most [`N_COLORS`].
    pub colors: Vec<Rgb>,
    /// Index of the colour that stands for a bin.
    nearest: Vec<u8>,
}

/// Colours that fall into one bin: how many, and their sum.
#[derive(Clone, Copy, Default)]
struct Bin {
    count: f64,
    sum: [f64; 3],
}

fn bin_of(color: &[u8]) -> usize {
    color[..3]
        .iter()
        .fold(0, |all, c| (all << BITS) | usize::from(c >> (8 - BITS)))
}

impl Palette {
    /// Palette of frames of RGB bytes: boxes of colours are cut at their means, where they vary most (Wan, Prusinkiewicz and Wong
    /// 1990, Color Res. Appl. 15, 52), until there are enough.
    pub fn of(frames: &[Vec<u8>]) -> Self {
        let mut bins = vec![Bin::default(); N_BINS];
        for pixel in frames.iter().flat_map(|f| f.chunks_exact(3)) {
            let bin = &mut bins[bin_of(pixel)];
            bin.count += 1.0;
            for (s, c) in bin.sum.iter_mut().zip(pixel) {
                *s += f64::from(*c);
            }
        }
        let used: Vec<usize> = (0..N_BINS).filter(|k| bins[*k].count > 0.0).collect();
        // wide flat grounds must not take all the colours from shaded things
        for k in &used {
            let weight = bins[*k].count.sqrt().sqrt();
            bins[*k].sum = bins[*k].mean().map(|m| m * weight);
            bins[*k].count = weight;
        }
        // the ground stays as it is, whatever is near it in colour
        let shaded: Vec<usize> = used.into_iter().filter(|k| *k != bin_of(&GROUND)).collect();
        let mut boxes = vec![Box::of(shaded, &bins)];
        while boxes.len() + 1 < N_COLORS {
            let worst =
                (0..boxes.len()).max_by(|a, b| boxes[*a].spread.total_cmp(&boxes[*b].spread));
            let Some(cut) = worst.and_then(|k| boxes[k].halves(&bins).map(|h| (k, h))) else {
                break;
            };
            let (k, [low, high]) = cut;
            boxes[k] = low;
            boxes.push(high);
        }
        let means = boxes.iter().map(|b| b.mean.map(|m| m.round() as u8));
        let colors: Vec<Rgb> = [GROUND].into_iter().chain(means).collect();
        let nearest = (0..N_BINS)
            .into_par_iter()
            .map(|k| nearest_of(&colors, bins[k].color(k)))
            .collect();
        Self { colors, nearest }
    }

    /// Indices of the colours of a frame `width` pixels wide, dithered by a pattern that stays in place from frame to frame.
    pub fn indices(&self, frame: &[u8], width: usize) -> Vec<u8> {
        let pixels = frame.chunks_exact(3).enumerate();
        let index = |(k, p): (usize, &[u8])| {
            let shift = dither(k % width, k / width);
            let c: Rgb = std::array::from_fn(|i| (f32::from(p[i]) + shift).clamp(0.0, 255.0) as u8);
            self.nearest[bin_of(&c)]
        };
        pixels.map(index).collect()
    }
}

/// What is added to a pixel so that the mean over its neighbours is nearer to what it should be (Bayer 1973: ordered dithering).
fn dither(x: usize, y: usize) -> f32 {
    const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    DITHER * (f32::from(ORDER[y % 4][x % 4]) / 7.5 - 1.0)
}

/// Index of the palette's colour nearest to one.
fn nearest_of(colors: &[Rgb], color: [f64; 3]) -> u8 {
    let far = |c: &Rgb| {
        (0..3)
            .map(|i| (f64::from(c[i]) - color[i]).powi(2))
            .sum::<f64>()
    };
    let best = (0..colors.len()).min_by(|a, b| far(&colors[*a]).total_cmp(&far(&colors[*b])));
    best.unwrap_or(0) as u8
}

impl Bin {
    /// The mean colour, or the middle of bin `k` where nothing fell into it.
    fn color(&self, k: usize) -> [f64; 3] {
        if self.count > 0.0 {
            return self.mean();
        }
        let side = f64::from(1 << (8 - BITS));
        let channel = |i: usize| (k >> (BITS * (2 - i))) % (1 << BITS);
        std::array::from_fn(|i| (channel(i) as f64 + 0.5) * side)
    }

    fn mean(&self) -> [f64; 3] {
        self.sum.map(|s| s / self.count.max(1e-300))
    }
}

/// Bins that one colour stands for.
struct Box {
    bins: Vec<usize>,
    mean: [f64; 3],
    /// Channel in which they vary most.
    channel: usize,
    /// Sum of squared distances from the mean in that channel.
    spread: f64,
}

impl Box {
    fn of(bins: Vec<usize>, all: &[Bin]) -> Self {
        let mut sum = Bin::default();
        for k in &bins {
            sum.count += all[*k].count;
            for (s, c) in sum.sum.iter_mut().zip(all[*k].sum) {
                *s += c;
            }
        }
        let mean = sum.mean();
        let mut spread = [0.0; 3];
        for k in &bins {
            let color = all[*k].mean();
            for i in 0..3 {
                spread[i] += all[*k].count * (color[i] - mean[i]).powi(2);
            }
        }
        let channel = (0..3)
            .max_by(|a, b| spread[*a].total_cmp(&spread[*b]))
            .unwrap_or(0);
        Self {
            bins,
            mean,
            channel,
            spread: spread[channel],
        }
    }

    /// Both sides of the mean; `None` where all colours are alike.
    fn halves(&self, all: &[Bin]) -> Option<[Self; 2]> {
        let below = |k: &usize| all[*k].mean()[self.channel] < self.mean[self.channel];
        let (low, high): (Vec<usize>, Vec<usize>) = self.bins.iter().copied().partition(below);
        (!low.is_empty() && !high.is_empty()).then(|| [Self::of(low, all), Self::of(high, all)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let frame: Vec<u8> = [[255, 255, 255], [200, 30, 40], [10, 20, 30]].concat();
        let palette = Palette::of(&[frame.clone(), frame.clone()]);
        let indices = palette.indices(&frame, 3);
        let back: Vec<u8> = indices
            .iter()
            .flat_map(|k| palette.colors[usize::from(*k)])
            .collect();
        assert_eq!(back, frame);
    }

    #[test]
    fn many_colours_are_met_closely() {
        // 64 x 64 colours on a sheet in colour space, and a large white ground
        let sheet = (0..64_u32).flat_map(|a| {
            (0..64_u32).map(move |b| [(4 * a) as u8, (2 * a + b) as u8, (3 * b) as u8])
        });
        let mut frame: Vec<u8> = sheet.flatten().collect();
        frame.extend([255; 300_000]);
        let palette = Palette::of(std::slice::from_ref(&frame));
        assert!(palette.colors.len() <= N_COLORS && palette.colors.contains(&[255; 3]));
        let mut worst = 0;
        for (p, k) in frame.chunks_exact(3).zip(palette.indices(&frame, 64)) {
            let c = palette.colors[usize::from(k)];
            worst = worst.max((0..3).map(|i| p[i].abs_diff(c[i])).max().unwrap());
        }
        assert!(worst <= 20, "{worst}");
    }
}
