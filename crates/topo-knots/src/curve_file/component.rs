//! One component of a file, and one frame.

use crate::V;

/// How many times the longest edge the gap between the ends may measure for a curve of which nothing says how to be closed.
const LONGEST_CLOSING: f64 = 2.0;

/// One component of a file: its vertices, and whether it is closed where the file says so.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveComponent {
    /// Vertices in order; a last one that repeats the first is left out and makes the component closed.
    pub vertices: Vec<V>,
    /// Whether the curve is closed; `None` where the file does not tell.
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

    /// Whether the curve is closed: what the file tells, else whether its ends are no farther apart than twice the longest edge.
    ///
    /// The closing edge of a closed polygon is an edge as the others are; one that is longer than all of them by far was never there.
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
