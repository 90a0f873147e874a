//! Colour scales that are perceptually uniform and safe for colour-blind readers.

use kuva::prelude::ColorMap;

/// Opaque sRGB colour.
pub type Rgb = [u8; 3];

/// Ink of text and axes.
pub const INK: &str = "#1b1f24";
/// Quiet ink of secondary text and of lines in the background.
pub const QUIET: &str = "#7a828c";
/// Blue of the first highlighted series (Okabe-Ito).
pub const BLUE: &str = "#0072b2";
/// Vermilion of the second highlighted series (Okabe-Ito).
pub const VERMILION: &str = "#d55e00";
/// Green of the third highlighted series (Okabe-Ito).
pub const GREEN: &str = "#009e73";
/// Purple of the fourth highlighted series (Okabe-Ito).
pub const PURPLE: &str = "#cc79a7";
/// Orange of a fifth series (Okabe-Ito).
pub const ORANGE: &str = "#e69f00";
/// Sky blue of a sixth series (Okabe-Ito).
pub const SKY: &str = "#56b4e9";

/// Colours of lines that stand side by side, in the order in which they are given out.
pub const LINES: [&str; 7] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, INK];

/// Scale from data to the viridis colours.
#[derive(Debug, Clone)]
pub struct Scale {
    min: f64,
    max: f64,
    root: bool,
    table: Vec<Rgb>,
}

impl Scale {
    /// Viridis from `min` to `max`; values outside take the colours of the ends.
    pub fn viridis(min: f64, max: f64) -> Self {
        let max = if max > min { max } else { min + 1.0 };
        let map = ColorMap::Viridis;
        let table = (0..256)
            .map(|i| {
                let (r, g, b) = map.map_rgb(f64::from(i) / 255.0).unwrap_or((0, 0, 0));
                [r, g, b]
            })
            .collect();
        let root = false;
        Self {
            min,
            max,
            root,
            table,
        }
    }

    /// Blue over white to vermilion from `-max` to `max`, even in linear light.
    pub fn diverging(max: f64) -> Self {
        let (low, high) = ([0, 90, 160], [200, 80, 0]);
        let table = (0..256)
            .map(|i| {
                let t = i as f32 / 127.5 - 1.0;
                mix([248; 3], if t < 0.0 { low } else { high }, t.abs())
            })
            .collect();
        Self {
            table,
            ..Self::viridis(-max, max)
        }
    }

    /// Blue to yellow from -1 to 1, even in linear light.
    pub fn blue_to_yellow() -> Self {
        let (low, high): (Rgb, Rgb) = ([30, 70, 170], [250, 220, 60]);
        let table = (0..256).map(|i| mix(low, high, i as f32 / 255.0)).collect();
        Self {
            table,
            ..Self::viridis(-1.0, 1.0)
        }
    }

    /// Viridis from 0 to `max` by the square root: small values keep their differences.
    pub fn viridis_root(max: f64) -> Self {
        Self {
            root: true,
            ..Self::viridis(0.0, max)
        }
    }

    /// Place of a value on the scale, from 0 to 1 within its range.
    pub fn fraction(&self, value: f64) -> f64 {
        let t = (value - self.min) / (self.max - self.min);
        if self.root { t.max(0.0).sqrt() } else { t }
    }

    /// Value at a place on the scale.
    pub fn value(&self, fraction: f64) -> f64 {
        let t = if self.root {
            fraction * fraction
        } else {
            fraction
        };
        self.min + (self.max - self.min) * t
    }

    /// Range of the data.
    pub fn range(&self) -> (f64, f64) {
        (self.min, self.max)
    }

    /// Colour of a value; a value that is not finite is drawn as the lowest one.
    pub fn rgb(&self, value: f64) -> Rgb {
        let t = self.fraction(value).clamp(0.0, 1.0);
        let i = if t.is_finite() {
            (t * 255.0).round() as usize
        } else {
            0
        };
        self.table[i]
    }

    /// The same as a CSS colour.
    pub fn css(&self, value: f64) -> String {
        css(self.rgb(value))
    }
}

/// CSS form of a colour.
pub fn css([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Colour between two, even in linear light.
fn mix(a: Rgb, b: Rgb, t: f32) -> Rgb {
    std::array::from_fn(|k| from_linear(to_linear(a[k]) * (1.0 - t) + to_linear(b[k]) * t))
}

/// Linear light of an sRGB channel in [0, 255].
pub fn to_linear(c: u8) -> f32 {
    let c = f32::from(c) / 255.0;
    if c <= 0.040_45 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// sRGB channel in [0, 255] of linear light.
pub fn from_linear(c: f32) -> u8 {
    let c = c.clamp(0.0, 1.0);
    let s = if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    };
    (s * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_is_dark_below_and_bright_above() {
        let scale = Scale::viridis(1.0, 3.0);
        let luma = |v: f64| scale.rgb(v).iter().map(|&c| u32::from(c)).sum::<u32>();
        assert!(luma(0.0) == luma(1.0) && luma(1.0) < luma(2.0) && luma(2.0) < luma(3.0));
        assert_eq!(scale.rgb(f64::NAN), scale.rgb(1.0));
        assert_eq!(scale.css(3.0).len(), 7);
    }

    #[test]
    fn diverging_scale_is_white_in_the_middle() {
        let scale = Scale::diverging(2.0);
        assert!(scale.rgb(0.0).iter().all(|&c| c > 240));
        assert!(
            scale.rgb(-2.0)[2] > 2 * scale.rgb(-2.0)[0]
                && scale.rgb(2.0)[0] > 2 * scale.rgb(2.0)[2]
        );
    }

    #[test]
    fn root_scale_spreads_small_values() {
        let scale = Scale::viridis_root(4.0);
        assert_eq!(scale.fraction(1.0), 0.5);
        assert_eq!(scale.value(0.5), 1.0);
        assert_eq!(scale.rgb(-1.0), scale.rgb(0.0));
    }

    #[test]
    fn linear_light_round_trips() {
        for c in 0..=255 {
            assert_eq!(from_linear(to_linear(c)), c);
        }
    }
}
