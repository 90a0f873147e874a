//! Looks of labels.

use super::color::INK;

/// Where a label stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// To the right of it.
    Start,
    /// Across it.
    Middle,
    /// To the left of it.
    End,
}

/// Looks of a label.
#[derive(Debug, Clone, Copy)]
pub struct Style<'a> {
    /// Font size.
    pub size: f64,
    /// Colour.
    pub color: &'a str,
    /// Semibold instead of regular.
    pub bold: bool,
    /// White rim that keeps it legible on lines.
    pub halo: bool,
    /// Turned to read upwards.
    pub upward: bool,
    /// Alignment.
    pub anchor: Anchor,
}

impl Default for Style<'_> {
    fn default() -> Self {
        Self {
            size: 9.5,
            color: INK,
            bold: false,
            halo: false,
            upward: false,
            anchor: Anchor::Start,
        }
    }
}

impl<'a> Style<'a> {
    /// Centred.
    pub fn middle(self) -> Self {
        Self {
            anchor: Anchor::Middle,
            ..self
        }
    }

    /// Ending at its point.
    pub fn end(self) -> Self {
        Self {
            anchor: Anchor::End,
            ..self
        }
    }

    /// Semibold.
    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// With a white rim.
    pub fn halo(self) -> Self {
        Self { halo: true, ..self }
    }

    /// Another size.
    pub fn size(self, size: f64) -> Self {
        Self { size, ..self }
    }

    /// Another colour.
    pub fn color<'b>(self, color: &'b str) -> Style<'b>
    where
        'a: 'b,
    {
        Style { color, ..self }
    }
}
