//! One component of a file, and one frame.

use crate::V;

/// Largest gap between the ends, in longest edges, of a curve that counts as closed although the file does not say so.
const LONGEST_CLOSING: f64 = 2.0;

/// One component of a file: its vertices, and whether it is closed where the file says so.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveComponent {
    /// Vertices in order; a last one that repeats the first is left out and makes the component closed.
    pub vertices: Vec<V>,
    /// Whether the curve is closed; `None` where the file does not say.
    pub closed: Option<bool>,
    /// Whether the file repeats the first vertex at the end.
    pub repeats_first: bool,
}

impl CurveComponent {
    pub(crate) fn new(vertices: Vec<V>, closed: Option<bool>) -> Self {
        Self {
            vertices,
            closed,
            repeats_first: false,
        }
    }

    /// Length of the gap between the ends over the longest edge: near 1 where the file leaves out the closing edge of a closed curve.
    pub fn gap_over_longest_edge(&self) -> f64 {
        // Scaled first: squares of coordinates may overflow.
        let size = self.vertices.iter().map(V::amax).fold(0.0, f64::max);
        let unit = if size > 0.0 { size } else { 1.0 };
        let distance = |a: &V, b: &V| (a / unit - b / unit).norm();
        let edges = self.vertices.windows(2);
        let longest = edges.map(|e| distance(&e[0], &e[1])).fold(0.0, f64::max);
        match (self.vertices.first(), self.vertices.last()) {
            (Some(first), Some(last)) if longest > 0.0 => distance(first, last) / longest,
            _ => 0.0,
        }
    }

    /// Whether the curve is closed: as the file says, else whether its ends are at most twice the longest edge apart.
    ///
    /// The closing edge of a closed polygon is about as long as the others. One that is much longer than all of them is no edge
    /// of the curve.
    ///
    /// # Validation
    /// `far_ends_make_an_open_curve`.
    pub fn is_closed(&self) -> bool {
        self.closed
            .unwrap_or_else(|| self.gap_over_longest_edge() <= LONGEST_CLOSING)
    }

    /// The vertices as those of an open curve, with the closing edge if the file gives it by repeating the first vertex.
    pub fn open_vertices(&self) -> Vec<V> {
        let again = self.vertices.first().filter(|_| self.repeats_first);
        self.vertices.iter().chain(again).copied().collect()
    }
}

/// The curves of one frame.
pub(super) struct FrameOf {
    pub label: Option<String>,
    pub components: Vec<CurveComponent>,
}
