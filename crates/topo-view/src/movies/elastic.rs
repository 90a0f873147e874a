//! Four knots untying side by side, each from its charged state to a released fibre, on a logarithmic clock.

use super::axes::Axes;
use super::stage::{Clip, Movie, N_FRAMES, Stage};
use crate::error::ViewError;
use crate::plot::camera;
use crate::plot::canvas::Canvas;
use crate::plot::color::Scale;
use crate::plot::panel::Axis;
use crate::plot::style::Style;
use crate::plot::text;
use crate::plot::tube::Tube;
use nalgebra::Vector3;
use topo_knots::KnotTable;
use topo_lab::{ElasticScene, ShapeFrame, discharge_frames, tight_shapes};

pub const MOVIE: Movie = Movie {
    name: "movie-elastic",
    title: "Knots untying",
    caption: "Four charged knots after the cut, coloured by energy density w up to the w_0 of each, with \
              their elastic energy E; time t runs logarithmically, the same for all. T_0 = 2 L η/(h E_b) \
              and E_0 = E_b h² L, with length L, radius h, viscosity η and bending modulus E_b of the \
              fibre; θ′h: angle of twist per radius.",
    claim: "The relaxation dynamics depend strongly on knot type and twist.",
    battery: "elastic",
    clip,
};

/// Knot and twist of each quarter.
const SHOWN: [(&str, f64); 4] = [("3_1", 0.0), ("7_4", 0.0), ("3_1", 2.0), ("7_4", 2.0)];
/// The first frames show the charged state.
const N_STILL: usize = 12;
/// Left, top, width and height that a fibre has in its quarter: below the labels and above the energy.
const ROOM: [f64; 4] = [0.0, 42.0, 480.0, 204.0];
/// Width and height that it fills there at most.
const FILLED: [f64; 2] = [440.0, 196.0];
/// First time shown after the cut, in T_0.
const FIRST: f64 = 0.01;

struct Actor {
    label: String,
    /// End of its colour scale.
    high: String,
    frames: Vec<ShapeFrame>,
    views: Vec<Vec<Vector3<f64>>>,
    scale: Scale,
}

fn clip(stage: &Stage<'_>) -> Result<Clip, ViewError> {
    let scene = ElasticScene::published(stage.quality);
    let table = KnotTable::builtin();
    let names = ["3_1".to_owned(), "7_4".to_owned()];
    let shapes = tight_shapes(
        &names,
        &table,
        &scene.tighten,
        stage.results,
        stage.interrupt,
        &|_| {},
    )?;
    let mut actors = Vec::new();
    for (knot, twist) in SHOWN {
        let frames = discharge_frames(&scene, knot, twist, 40.0, &shapes, &table, stage.interrupt)?;
        crate::error::check(stage.interrupt)?;
        actors.push(Actor::new(knot, twist, frames)?);
    }
    let last = actors
        .iter()
        .filter_map(|a| a.frames.last()?.time)
        .fold(10.0 * FIRST, f64::max);
    let time = |k: usize| {
        let part = k.saturating_sub(N_STILL) as f64 / (N_FRAMES - 1 - N_STILL) as f64;
        (k >= N_STILL).then(|| FIRST * (last / FIRST).powf(part))
    };
    let frames = stage.frames(|k, canvas| {
        let now = time(k);
        let label = now.map_or("charged, closed".to_owned(), |t| {
            format!("*t* = {} *T*_{{0}}", text::number(t, 3))
        });
        canvas.text(
            480.0,
            26.0,
            &label,
            Style::default().middle().bold().size(20.0),
        );
        color_key(canvas);
        for (q, actor) in actors.iter().enumerate() {
            let corner = [480.0 * (q % 2) as f64, 36.0 + 342.0 * (q / 2) as f64];
            actor.draw(canvas, corner, now, last)?;
        }
        Ok(())
    })?;
    let finding = actors
        .iter()
        .map(Actor::finding)
        .collect::<Vec<_>>()
        .join(" ");
    Ok(Clip { frames, finding })
}

/// The colour bar that all share, each with its own w_0.
fn color_key(canvas: &mut Canvas) {
    let ticks = [(0.0, "0"), (0.25, "*w*_{0}/4"), (1.0, "*w*_{0}")];
    canvas.flat_bar(
        [760.0, 8.0],
        [170.0, 10.0],
        &Scale::viridis_root(1.0),
        &ticks,
        12.0,
    );
    let style = Style::default().end().size(13.0);
    canvas.text(750.0, 18.0, "Energy density *w*", style);
}

impl Actor {
    fn new(knot: &str, twist: f64, frames: Vec<ShapeFrame>) -> Result<Self, ViewError> {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else {
            return Err(ViewError::Drawing {
                reason: format!("no frame of {knot}"),
            });
        };
        // seen from where both the knot and the released fibre are wide
        let turn = camera::flattest_of(&[&first.vertices, &last.vertices]);
        let views = frames
            .iter()
            .map(|f| camera::view(&f.vertices, &turn))
            .collect();
        let mut density: Vec<f64> = first.density.clone();
        density.sort_by(f64::total_cmp);
        let high = density[density.len() * 97 / 100].max(1e-12);
        Ok(Self {
            label: format!("{}, θ′*h* = {}", text::knot_name(knot), text::signed(twist)),
            high: format!(
                "*w*_{{0}} = {} *E*_{{b}}*h*^{{2}}",
                text::significant(high, 2)
            ),
            frames,
            views,
            scale: Scale::viridis_root(high),
        })
    }

    /// The last frame at or before a time.
    fn at(&self, time: Option<f64>) -> usize {
        let before = |f: &ShapeFrame| f.time <= time;
        self.frames.iter().rposition(before).unwrap_or(0)
    }

    fn draw(
        &self,
        canvas: &mut Canvas,
        corner: [f64; 2],
        time: Option<f64>,
        last: f64,
    ) -> Result<(), ViewError> {
        let k = self.at(time);
        let (frame, view) = (&self.frames[k], &self.views[k]);
        // the eye only moves away, and never jumps
        let unit = (0..=k)
            .map(|i| {
                let [x0, y0, x1, y1] = camera::extent(&self.views[i]);
                (FILLED[0] / (x1 - x0 + 3.0)).min(FILLED[1] / (y1 - y0 + 3.0))
            })
            .fold(14.0, f64::min);
        let [x0, y0, x1, y1] = camera::extent(view);
        let tube = Tube::new(view, &frame.density, frame.time.is_none(), 1.0, &self.scale)
            .ok_or_else(|| ViewError::Drawing {
                reason: format!("{} is no curve", self.label),
            })?;
        let middle = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
        let [left, top, width, height] = ROOM;
        let place = [corner[0] + left, corner[1] + top];
        canvas.tubes(place, [width, height], middle, unit, &[tube])?;
        let style = Style::default().bold().halo().size(16.0);
        canvas.text(corner[0] + 16.0, corner[1] + 18.0, &self.label, style);
        let style = Style::default().halo().size(13.0);
        canvas.text(corner[0] + 16.0, corner[1] + 36.0, &self.high, style);
        self.draw_energy(
            canvas,
            [corner[0] + 58.0, corner[1] + 250.0],
            (k, time),
            last,
        );
        Ok(())
    }

    /// Energy against the logarithm of time, with a dot for now.
    fn draw_energy(
        &self,
        canvas: &mut Canvas,
        at: [f64; 2],
        (now, time): (usize, Option<f64>),
        last: f64,
    ) {
        let size = [400.0, 52.0];
        let top = self.frames[0].energy.max(1e-12);
        let ticks = [0.0, top].map(|e| (e, text::significant(e, 2)));
        let axes = Axes {
            at,
            size,
            time: Axis::log("*t* / *T*_{0}", (FIRST, last)),
            value: Axis::linear("*E* / *E*_{0}", (0.0, top), top),
            ticks: &ticks,
            type_size: 12.0,
        };
        let curve: Vec<(f64, f64)> = self
            .frames
            .iter()
            .map(|f| (f.time.unwrap_or(FIRST), f.energy))
            .collect();
        axes.draw(canvas, &curve, now, time.unwrap_or(FIRST).min(last));
        let label = format!(
            "*E*/*E*_{{0}} = {}",
            text::number(self.frames[now].energy, 3)
        );
        let style = Style::default().end().size(13.0).halo();
        canvas.text(at[0] + size[0], at[1] + 12.0, &label, style);
    }

    fn finding(&self) -> String {
        let (first, last) = (self.frames.first(), self.frames.last());
        let (energy, time) = (
            first.map_or(0.0, |f| f.energy),
            last.and_then(|f| f.time).unwrap_or(0.0),
        );
        format!(
            "{}: {} E₀, released to 0.1 % in {} T₀.",
            self.label.replace('*', ""),
            text::number(energy, 3),
            text::number(time, 3)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fibre along points, charged and released alike.
    fn actor(points: impl Fn(f64) -> [f64; 2]) -> Actor {
        let point = |i: i32| points(f64::from(i) / 99.0);
        let frame = |time| ShapeFrame {
            time,
            vertices: (0..100)
                .map(|i| Vector3::new(point(i)[0], point(i)[1], 0.0))
                .collect(),
            density: vec![0.5; 100],
            energy: 1.0,
        };
        Actor::new("7_4", 2.0, vec![frame(None), frame(Some(1.0))]).unwrap()
    }

    /// The picture where the labels of the first quarter stand.
    fn labels(actor: &Actor) -> Vec<u8> {
        let mut canvas = Canvas::new(480.0, 342.0, 1.0);
        actor.draw(&mut canvas, [0.0; 2], Some(1.0), 1.0).unwrap();
        let pixels = canvas.pixels().unwrap();
        let rows = pixels.data().chunks(4 * 480).take(41);
        rows.flat_map(|row| row[..4 * 160].to_vec()).collect()
    }

    #[test]
    fn a_wide_and_high_fibre_keeps_clear_of_the_labels() {
        let straight = actor(|s| [40.0 * s, 0.0]);
        // three sides of a rectangle and most of the fourth
        let corners = actor(|s| match s {
            s if s < 0.3 => [40.0 * s / 0.3, 0.0],
            s if s < 0.5 => [40.0, 20.0 * (s - 0.3) / 0.2],
            s if s < 0.8 => [40.0 * (0.8 - s) / 0.3, 20.0],
            s => [0.0, 20.0 - 18.0 * (s - 0.8) / 0.2],
        });
        let expected = labels(&straight);
        assert!(expected.chunks(4).any(|p| p[0] < 100));
        assert!(labels(&corners) == expected);
    }
}
