//! One SVG picture made of panels, tubes and labels.

use super::color::{INK, QUIET, Scale};
use super::font;
use super::raster::{self, Rods, Window};
use super::render;
use super::solids::Solids;
use super::style::{Anchor, Style};
use super::text;
use super::tube::Tube;
use crate::error::ViewError;
use std::fmt::Write;

/// A picture in the making; one unit is a CSS pixel, 720 units fill a text width.
#[derive(Debug)]
pub struct Canvas {
    width: f64,
    height: f64,
    /// Pixels of the PNG per unit.
    zoom: f64,
    body: String,
    n_clips: usize,
}

impl Canvas {
    /// White canvas.
    pub fn new(width: f64, height: f64, zoom: f64) -> Self {
        Self {
            width,
            height,
            zoom,
            body: String::new(),
            n_clips: 0,
        }
    }

    /// Pixels of the PNG per unit.
    pub fn zoom(&self) -> f64 {
        self.zoom
    }

    /// Label in the markup of [`text`], its baseline at (x, y).
    pub fn text(&mut self, x: f64, y: f64, label: &str, style: Style) {
        let anchor = match style.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let weight = if style.bold {
            r#" font-weight="600""#
        } else {
            ""
        };
        let turn = if style.upward {
            format!(r#" transform="rotate(-90 {x:.2} {y:.2})""#)
        } else {
            String::new()
        };
        let spans = text::spans(label, style.size);
        let place = format!(r#"x="{x:.2}" y="{y:.2}" font-size="{:.2}""#, style.size);
        let looks = format!(r#"text-anchor="{anchor}"{weight}{turn}>{spans}</text>"#);
        if style.halo {
            // below all of the label: the rim of a subscript would cover what it belongs to
            let rim =
                r##"fill="#ffffff" stroke="#ffffff" stroke-width="3" stroke-linejoin="round""##;
            self.raw(&format!("<text {place} {rim} {looks}"));
        }
        self.raw(&format!(r#"<text {place} fill="{}" {looks}"#, style.color));
    }

    /// Letter of a panel, bold, at its top left.
    pub fn letter(&mut self, x: f64, y: f64, letter: &str) {
        self.text(x, y, letter, Style::default().bold().size(13.0));
    }

    /// Line between two points.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], color: &str, width: f64) {
        self.raw(&format!(
            r#"<line x1="{:.2}" y1="{:.2}" x2="{:.2}" y2="{:.2}" stroke="{color}" stroke-width="{width}"/>"#,
            from[0], from[1], to[0], to[1]
        ));
    }

    /// Filled rectangle.
    pub fn rect(&mut self, at: [f64; 2], size: [f64; 2], fill: &str) {
        self.raw(&format!(
            r#"<rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" fill="{fill}"/>"#,
            at[0], at[1], size[0], size[1]
        ));
    }

    /// A finished fragment, shifted to (x, y); its clip paths are renumbered, so that the
    /// same picture is the same file whatever else was drawn before.
    pub fn fragment(&mut self, x: f64, y: f64, svg: &str) {
        let inner = match (svg.find('>'), svg.rfind("</svg>")) {
            (Some(open), Some(close)) if open < close => &svg[open + 1..close],
            _ => svg,
        };
        const STEM: &str = "kuva-clip-";
        let mut seen: Vec<&str> = Vec::new();
        let mut parts = inner.split(STEM);
        let mut body = parts.next().unwrap_or("").to_owned();
        for part in parts {
            let end = part
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(part.len());
            let id = &part[..end];
            let k = seen.iter().position(|s| *s == id).unwrap_or_else(|| {
                seen.push(id);
                seen.len() - 1
            });
            let _ = write!(body, "clip-{}{}", self.n_clips + k, &part[end..]);
        }
        self.n_clips += seen.len();
        self.raw(&format!(
            r#"<g transform="translate({x:.2} {y:.2})">{body}</g>"#
        ));
    }

    /// Tubes centred on `center` (view coordinates) in the box at `at` of `size`, at `scale`
    /// units of the canvas per unit of length.
    pub fn tubes(
        &mut self,
        at: [f64; 2],
        size: [f64; 2],
        center: [f64; 2],
        scale: f64,
        tubes: &[Tube],
    ) -> Result<(), ViewError> {
        let image = tubes_png(size, center, scale, self.zoom, tubes)?;
        self.image(at, size, &image);
        Ok(())
    }

    /// Solids centred on `center` (view coordinates) in the box at `at` of `size`, at `scale` units of the canvas per unit of
    /// length.
    pub fn solids(
        &mut self,
        at: [f64; 2],
        size: [f64; 2],
        center: [f64; 2],
        scale: f64,
        solids: &Solids<'_>,
    ) -> Result<(), ViewError> {
        let window = window(size, center, scale, self.zoom);
        let pixmap = solids.draw(&window).ok_or_else(|| ViewError::Drawing {
            reason: "solids without pixels".to_owned(),
        })?;
        let image = render::png(&pixmap)?;
        self.image(at, size, &image);
        Ok(())
    }

    /// PNG bytes in the box at `at` of `size`.
    pub fn image(&mut self, at: [f64; 2], size: [f64; 2], png: &[u8]) {
        self.raw(&format!(
            r#"<image x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" href="data:image/png;base64,{}"/>"#,
            at[0],
            at[1],
            size[0],
            size[1],
            font::base64(png)
        ));
    }

    /// Upright colour bar with its ticks and label to its right.
    pub fn color_bar(
        &mut self,
        at: [f64; 2],
        size: [f64; 2],
        scale: &Scale,
        ticks: &[f64],
        label: &str,
    ) {
        const N: usize = 64;
        let dy = size[1] / N as f64;
        for i in 0..N {
            let v = scale.value((i as f64 + 0.5) / N as f64);
            let y = at[1] + size[1] - (i + 1) as f64 * dy;
            // An overlap of a pixel hides the seams between the steps.
            let height = (dy + 1.0).min(at[1] + size[1] - y);
            self.rect([at[0], y], [size[0], height], &scale.css(v));
        }
        for &tick in ticks {
            let y = at[1] + size[1] * (1.0 - scale.fraction(tick));
            let right = at[0] + size[0];
            self.line([right, y], [right + 3.0, y], INK, 0.7);
            self.text(
                right + 5.0,
                y + 3.0,
                &text::number(tick, 3),
                Style::default().size(8.5),
            );
        }
        let style = Style {
            upward: true,
            ..Style::default().middle()
        };
        self.text(at[0] + size[0] + 31.0, at[1] + size[1] / 2.0, label, style);
    }

    /// Flat colour bar with ticks, values and their labels, below in type of a size.
    pub fn flat_bar(
        &mut self,
        at: [f64; 2],
        size: [f64; 2],
        scale: &Scale,
        ticks: &[(f64, &str)],
        type_size: f64,
    ) {
        const N: usize = 64;
        let dx = size[0] / N as f64;
        for k in 0..N {
            let v = scale.value((k as f64 + 0.5) / N as f64);
            let x = at[0] + dx * k as f64;
            // An overlap of a pixel hides the seams between the steps.
            let width = (dx + 1.0).min(at[0] + size[0] - x);
            self.rect([x, at[1]], [width, size[1]], &scale.css(v));
        }
        let foot = at[1] + size[1];
        for (value, label) in ticks {
            let x = at[0] + size[0] * scale.fraction(*value);
            self.line([x, foot], [x, foot + 0.25 * type_size], INK, 0.7);
            let style = Style::default().middle().size(type_size);
            self.text(x, foot + 1.15 * type_size, label, style);
        }
    }

    /// The note at the foot: quality and where the run departs from the published one.
    pub fn footnote(&mut self, lines: &[String]) {
        let mut y = self.height - 5.0 - 10.5 * (lines.len().saturating_sub(1)) as f64;
        for line in lines {
            self.text(10.0, y, line, Style::default().size(8.0).color(QUIET));
            y += 10.5;
        }
    }

    /// SVG element as it is.
    pub fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// The SVG text with something between its head and what was drawn.
    fn svg(&self, before: &str) -> String {
        let Self {
            width,
            height,
            body,
            ..
        } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{}\">\n\
             {before}<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n",
            font::list()
        )
    }

    /// The pixels alone.
    pub fn pixels(&self) -> Result<resvg::tiny_skia::Pixmap, ViewError> {
        render::pixels(&self.svg(""), self.zoom as f32)
    }

    /// The SVG with its fonts, and the PNG.
    pub fn finish(self) -> Result<Picture, ViewError> {
        let pixels = self.pixels()?;
        let preview = render::png(&render::halved(&pixels)?)?;
        let png = render::png(&pixels)?;
        let svg = self.svg(&format!("<style>{}</style>", font::style()));
        Ok(Picture { svg, png, preview })
    }
}

/// PNG of tubes, drawn at the pixels of the final picture.
pub fn tubes_png(
    size: [f64; 2],
    center: [f64; 2],
    scale: f64,
    zoom: f64,
    tubes: &[Tube],
) -> Result<Vec<u8>, ViewError> {
    tubes_and_rods_png(size, center, scale, zoom, tubes, &Rods::default())
}

/// The same with thin rods, such as struts.
pub fn tubes_and_rods_png(
    size: [f64; 2],
    center: [f64; 2],
    scale: f64,
    zoom: f64,
    tubes: &[Tube],
    rods: &Rods,
) -> Result<Vec<u8>, ViewError> {
    let pixmap =
        raster::draw(tubes, rods, &window(size, center, scale, zoom)).ok_or_else(|| {
            ViewError::Drawing {
                reason: "tube without pixels".to_owned(),
            }
        })?;
    render::png(&pixmap)
}

fn window(size: [f64; 2], center: [f64; 2], scale: f64, zoom: f64) -> Window {
    let side = |s: f64| (s * zoom).round().clamp(1.0, 8000.0) as u32;
    Window {
        width: side(size[0]),
        height: side(size[1]),
        center,
        scale: scale * zoom,
    }
}

/// Preview of a PNG, at half its size.
pub fn preview(png: &[u8]) -> Result<Vec<u8>, ViewError> {
    let pixels = resvg::tiny_skia::Pixmap::decode_png(png).map_err(|e| ViewError::Drawing {
        reason: e.to_string(),
    })?;
    render::png(&render::halved(&pixels)?)
}

/// A finished picture.
#[derive(Debug)]
pub struct Picture {
    /// SVG text.
    pub svg: String,
    /// PNG bytes.
    pub png: Vec<u8>,
    /// PNG bytes at half the size, for pages.
    pub preview: Vec<u8>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fragments_are_renumbered_in_order() {
        let mut canvas = Canvas::new(100.0, 50.0, 1.0);
        canvas.fragment(
            1.0,
            2.0,
            r#"<svg><g id="kuva-clip-17"/><g id="kuva-clip-40"/></svg>"#,
        );
        canvas.fragment(0.0, 0.0, r#"<svg><g id="kuva-clip-41"/></svg>"#);
        let svg = canvas.finish().unwrap().svg;
        for k in 0..3 {
            assert_eq!(svg.matches(&format!("\"clip-{k}\"")).count(), 1);
        }
        assert!(!svg.contains("kuva-clip"));
    }
}
