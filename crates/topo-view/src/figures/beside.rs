//! Names beside the markers of a panel, clear of markers, lines and of each other.

use super::series::line_path;
use crate::plot::canvas::Canvas;
use crate::plot::color::QUIET;
use crate::plot::style::Style;

/// A marker with its name, on the canvas.
#[derive(Debug, Clone)]
pub struct Named {
    /// Middle of the marker.
    pub at: [f64; 2],
    /// The name.
    pub name: String,
}

/// Font size of the names, and half the height of their boxes.
const SIZE: f64 = 8.5;
const HALF: f64 = 4.5;
/// Half the side of the box that a marker keeps clear.
const MARKER: f64 = 4.0;
/// Distances tried, nearest first; from the second on a thin line leads to the marker.
const REACHES: [f64; 4] = [9.0, 16.0, 24.0, 34.0];
/// Directions tried at each.
const N_DIRECTIONS: usize = 16;

/// Left, top, right and bottom.
type Rect = [f64; 4];

fn overlap(a: &Rect, b: &Rect) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn around([x, y]: [f64; 2], half_width: f64, half_height: f64) -> Rect {
    [
        x - half_width,
        y - half_height,
        x + half_width,
        y + half_height,
    ]
}

/// Middles of the names: as near to their markers as boxes, `lines` and `inside` let them; `None` where there is no room at all.
fn places(named: &[Named], lines: &[[[f64; 2]; 2]], inside: &Rect) -> Vec<Option<[f64; 2]>> {
    let mut taken: Vec<Rect> = named.iter().map(|n| around(n.at, MARKER, MARKER)).collect();
    for [a, b] in lines {
        for k in 0..=40 {
            let t = f64::from(k) / 40.0;
            let p = [0, 1].map(|i| a[i] + (b[i] - a[i]) * t);
            taken.push(around(p, 0.8, 0.8));
        }
    }
    let mut found = Vec::new();
    for n in named {
        let half = 0.27 * SIZE * n.name.chars().count() as f64 + 1.0;
        let candidates = REACHES.iter().flat_map(|reach| {
            (0..N_DIRECTIONS).map(move |k| {
                let angle = std::f64::consts::TAU * k as f64 / N_DIRECTIONS as f64;
                [n.at[0] + reach * angle.cos(), n.at[1] - reach * angle.sin()]
            })
        });
        let fits = |p: &[f64; 2]| {
            let own = around(*p, half, HALF);
            let is_inside = own[0] > inside[0]
                && own[1] > inside[1]
                && own[2] < inside[2]
                && own[3] < inside[3];
            is_inside && !taken.iter().any(|t| overlap(t, &own))
        };
        let place = candidates.into_iter().find(fits);
        taken.extend(place.map(|p| around(p, half, HALF)));
        found.push(place);
    }
    found
}

/// Writes the names, with a thin line to markers that stand apart from theirs.
pub fn draw(canvas: &mut Canvas, named: &[Named], lines: &[[[f64; 2]; 2]], inside: Rect) {
    for (n, place) in named.iter().zip(places(named, lines, &inside)) {
        let Some([x, y]) = place else { continue };
        let away = [x - n.at[0], y - n.at[1]];
        let reach = away[0].hypot(away[1]);
        if reach > REACHES[0] + 1.0 {
            let ends =
                [MARKER, reach - HALF - 1.0].map(|d| [0, 1].map(|i| n.at[i] + away[i] * d / reach));
            line_path(canvas, &ends, QUIET, 0.6);
        }
        canvas.text(
            x,
            y + 0.35 * SIZE,
            &n.name,
            Style::default().middle().size(SIZE),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_clear_of_everything() {
        // five markers in a row, closer than their names are wide, on a line
        let named: Vec<Named> = (0..5)
            .map(|k| Named {
                at: [40.0 + 7.0 * f64::from(k), 50.0],
                name: (8 + k).to_string(),
            })
            .collect();
        let line = [[10.0, 50.0], [68.0, 50.0]];
        let inside = [0.0, 0.0, 100.0, 100.0];
        let found: Vec<[f64; 2]> = places(&named, &[line], &inside)
            .into_iter()
            .flatten()
            .collect();
        assert_eq!(found.len(), 5);
        for (i, p) in found.iter().enumerate() {
            assert!((p[1] - 50.0).abs() > HALF, "{p:?} on the line");
            for q in &found[..i] {
                assert!(
                    (p[0] - q[0]).abs() > 5.0 || (p[1] - q[1]).abs() > 8.0,
                    "{p:?} on {q:?}"
                );
            }
            for n in &named {
                assert!((p[0] - n.at[0]).abs() > MARKER || (p[1] - n.at[1]).abs() > MARKER + 3.0);
            }
        }
        // a corner without room: no name rather than one on top of something
        let corner = Named {
            at: [2.0, 2.0],
            name: "12".to_owned(),
        };
        assert_eq!(places(&[corner], &[], &[0.0, 0.0, 6.0, 6.0]), [None]);
    }
}
