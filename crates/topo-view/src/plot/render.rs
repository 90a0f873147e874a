//! An SVG as PNG pixels.

use super::font;
use crate::error::ViewError;
use resvg::{tiny_skia, usvg};

/// Pixels of an SVG at `zoom` pixels per unit, with the shipped fonts only.
pub fn pixels(svg: &str, zoom: f32) -> Result<tiny_skia::Pixmap, ViewError> {
    let mut options = usvg::Options {
        font_family: font::FAMILY.to_owned(),
        ..Default::default()
    };
    options.fontdb = font::database();
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| ViewError::Drawing {
        reason: e.to_string(),
    })?;
    let size = tree.size();
    let side = |s: f32| (s * zoom).round().max(1.0) as u32;
    let mut pixmap =
        tiny_skia::Pixmap::new(side(size.width()), side(size.height())).ok_or_else(|| {
            ViewError::Drawing {
                reason: "picture without pixels".to_owned(),
            }
        })?;
    let transform = tiny_skia::Transform::from_scale(zoom, zoom);
    resvg::render(&tree, transform, &mut pixmap.as_mut());
    Ok(pixmap)
}

/// The same at half the size, each pixel the mean of four.
pub fn halved(full: &tiny_skia::Pixmap) -> Result<tiny_skia::Pixmap, ViewError> {
    let (w, h) = ((full.width() / 2).max(1), (full.height() / 2).max(1));
    let mut small = tiny_skia::Pixmap::new(w, h).ok_or_else(|| ViewError::Drawing {
        reason: "picture without pixels".to_owned(),
    })?;
    let bytes = full.data();
    let row = full.width() as usize * 4;
    for (i, byte) in small.data_mut().iter_mut().enumerate() {
        let (x, y) = (i / 4 % w as usize * 2, i / 4 / w as usize * 2);
        let at = |dx: usize, dy: usize| {
            let (x, y) = (
                (x + dx).min(full.width() as usize - 1),
                (y + dy).min(full.height() as usize - 1),
            );
            u32::from(bytes[y * row + x * 4 + i % 4])
        };
        *byte = ((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4) as u8;
    }
    Ok(small)
}

/// PNG bytes of pixels.
pub fn png(pixmap: &tiny_skia::Pixmap) -> Result<Vec<u8>, ViewError> {
    pixmap.encode_png().map_err(|e| ViewError::Drawing {
        reason: e.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dark_pixels(text: &str, style: &str) -> usize {
        let svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="120" height="30"><rect width="120" height="30" fill="#fff"/><text x="5" y="20" font-size="16" {style}>{text}</text></svg>"##
        );
        let picture = pixels(&svg, 2.0).unwrap();
        picture.pixels().iter().filter(|p| p.red() < 128).count()
    }

    #[test]
    fn a_label_changes_pixels() {
        assert_eq!(dark_pixels("", ""), 0);
        let family = format!(r#"font-family="{}""#, font::FAMILY);
        assert!(dark_pixels("7₄ θ′h = −2", &family) > 200);
        assert!(dark_pixels("E", &format!(r#"{family} font-style="italic""#)) > 20);
        // A family that is not shipped falls back to the one that is.
        assert!(dark_pixels("twist", r#"font-family="No Such Face""#) > 100);
    }

    #[test]
    fn a_greek_letter_after_a_latin_one_stays_greek() {
        let drawn = |text: &str| {
            let svg = format!(
                r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="30"><text x="5" y="20" font-size="16">{text}</text></svg>"##
            );
            pixels(&svg, 1.0).unwrap().take()
        };
        assert!(drawn("RΓ") != drawn("RƔ") && drawn("Rγ") != drawn("Rɣ"));
    }

    #[test]
    fn broken_svg_is_an_error() {
        assert!(pixels("<svg", 1.0).is_err());
    }
}
