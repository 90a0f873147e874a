//! An SVG as browsers show it against our PNG of it.

use super::canvas::Canvas;
use super::font;
use super::panel::{Axis, Panel};
use super::style::Style;
use crate::browser::{Browser, address};
use resvg::tiny_skia::Pixmap;

const SIZE: [u32; 2] = [420, 150];
const ZOOM: u32 = 2;

fn labels() -> super::canvas::Picture {
    let mut canvas = Canvas::new(f64::from(SIZE[0]), f64::from(SIZE[1]), f64::from(ZOOM));
    let label = "Free energy *F* / *L*ξ_{N}, charged states of 7_{4}";
    canvas.text(10.0, 20.0, label, Style::default().size(13.0));
    canvas.text(
        10.0,
        42.0,
        "Rate *R*^{2}/Γ*L*: trefoil θ′*h* = −2",
        Style::default().bold().size(13.0),
    );
    let panel = Panel {
        at: [60.0, 56.0],
        size: [330.0, 54.0],
        x: Axis::log("Time *t* / *T*_{0}", (0.01, 100.0)),
        y: Axis::linear("*E*", (0.0, 1.0), 0.5),
    };
    panel.draw(&mut canvas, Vec::new(), &[]);
    canvas.finish().unwrap()
}

/// How dark the pixels are, each the mean of five by five: edges that are smoothed otherwise count little.
fn darkness(picture: &Pixmap) -> Vec<f64> {
    let (w, h) = (picture.width() as usize, picture.height() as usize);
    let dark: Vec<f64> = picture
        .pixels()
        .iter()
        .map(|p| {
            1.0 - f64::from(u32::from(p.red()) + u32::from(p.green()) + u32::from(p.blue())) / 765.0
        })
        .collect();
    let mut out = Vec::with_capacity(w * h);
    for y in 2..h - 2 {
        for x in 2..w - 2 {
            let rows = (y - 2..=y + 2).flat_map(|j| (x - 2..=x + 2).map(move |i| j * w + i));
            out.push(rows.map(|k| dark[k]).sum::<f64>() / 25.0);
        }
    }
    out
}

/// Ink that is elsewhere in one of two pictures, as a share of all: 0 for the same, about 1 where nothing agrees.
fn displaced(a: &Pixmap, b: &Pixmap) -> f64 {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let (a, b) = (darkness(a), darkness(b));
    let apart: f64 = a.iter().zip(&b).map(|(p, q)| (p - q).abs()).sum();
    apart / (a.iter().sum::<f64>() + b.iter().sum::<f64>())
}

#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_an_svg_has_the_letters_of_its_png() {
    let picture = labels();
    let png = Pixmap::decode_png(&picture.png).unwrap();
    let (browser, dir) = (Browser::start(), tempfile::tempdir().unwrap());
    let shown = |svg: &str| {
        let file = dir.path().join("labels.svg");
        std::fs::write(&file, svg).unwrap();
        displaced(&browser.screenshot(&address(&file), SIZE, ZOOM, 1000), &png)
    };
    let ours = shown(&picture.svg);
    assert!(ours < 0.05, "{ours}");
    // a name that ends in a number, unquoted, is no list of families: browsers take Times
    let unquoted = picture
        .svg
        .replacen(&font::list(), &font::list().replace('\'', ""), 1);
    assert_ne!(unquoted, picture.svg);
    let times = shown(&unquoted);
    assert!(times > 0.15, "{times}");
    // and without the faces in the file they take Arial or what stands for it
    let (head, rest) = picture.svg.split_once("<style>").unwrap();
    let bare = shown(&format!("{head}{}", rest.split_once("</style>").unwrap().1));
    assert!(bare > 0.15, "{bare}");
}
