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

    /// Linear light as people without one kind of cones see it, rows of red, green, blue (Machado, Oliveira and Fernandes 2009,
    /// doi:10.1109/TVCG.2009.113, severity 1): normal sight, without M cones, without L cones, without S cones.
    const SIGHTS: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ],
    ];

    /// CIELAB coordinates (D65) of a CSS colour under a sight.
    fn lab(color: &str, sight: &[[f64; 3]; 3]) -> [f64; 3] {
        let channel = |k: usize| u8::from_str_radix(&color[1 + 2 * k..3 + 2 * k], 16).unwrap();
        let light = [0, 1, 2].map(|k| f64::from(to_linear(channel(k))));
        let times =
            |m: &[[f64; 3]; 3], v: [f64; 3]| m.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2]);
        let seen = times(sight, light).map(|c| c.clamp(0.0, 1.0));
        let xyz = times(
            &[
                [0.4124564, 0.3575761, 0.1804375],
                [0.2126729, 0.7151522, 0.0721750],
                [0.0193339, 0.1191920, 0.9503041],
            ],
            seen,
        );
        let f = |t: f64| {
            if t > 0.008856 {
                t.cbrt()
            } else {
                7.787 * t + 16.0 / 116.0
            }
        };
        let [x, y, z] = [f(xyz[0] / 0.95047), f(xyz[1]), f(xyz[2] / 1.08883)];
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// Smallest distance in CIELAB of two colours of a list, over all sights.
    fn closest(colors: &[&str]) -> f64 {
        let mut least = f64::MAX;
        for sight in &SIGHTS {
            for (k, a) in colors.iter().enumerate() {
                for b in &colors[..k] {
                    let (a, b) = (lab(a, sight), lab(b, sight));
                    least = least.min((a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2]));
                }
            }
        }
        least
    }

    #[test]
    fn lines_differ_for_colour_blind_readers() {
        // 2.3 is just noticeable side by side (Mahy et al. 1994, Color Res. Appl. 19, 105); thin lines apart need several times that
        assert!(closest(&LINES) > 15.0, "{}", closest(&LINES));
        let knots = crate::figures::series::CHOSEN.map(|c| c.color);
        let mut all = knots.to_vec();
        all.push(crate::figures::series::OTHERS);
        assert!(closest(&all) > 20.0, "{}", closest(&all));
        // the purple of before is BLUE without L cones
        assert!(closest(&[BLUE, "#aa4499"]) < 10.0);
    }

    #[test]
    fn lab_is_that_of_the_standard() {
        // sRGB red and white: Lindbloom's calculator, D65
        let red = lab("#ff0000", &SIGHTS[0]);
        assert!(
            (red[0] - 53.24).abs() < 0.05
                && (red[1] - 80.09).abs() < 0.1
                && (red[2] - 67.20).abs() < 0.1,
            "{red:?}"
        );
        let white = lab("#ffffff", &SIGHTS[0]);
        assert!((white[0] - 100.0).abs() < 0.01 && white[1].abs() < 0.05 && white[2].abs() < 0.05);
    }

    #[test]
    fn linear_light_round_trips() {
        for c in 0..=255 {
            assert_eq!(from_linear(to_linear(c)), c);
        }
    }
}
