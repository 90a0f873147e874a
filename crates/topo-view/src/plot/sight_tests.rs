//! Colours of lines as colour-blind readers see them.

use crate::figures::series;
use crate::plot::color::{BLUE, LINES, to_linear};

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
    let times = |m: &[[f64; 3]; 3], v: [f64; 3]| m.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2]);
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
    let knots = series::CHOSEN.map(|c| c.color);
    let mut all = knots.to_vec();
    all.push(series::OTHERS);
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
