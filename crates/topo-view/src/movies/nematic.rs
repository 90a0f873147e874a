//! A colloid discharging with flow: ring and director in three dimensions, the central plane beside it, on a logarithmic clock.

use super::stage::{Clip, Movie, N_FRAMES, Stage};
use crate::data::{DefectLine, Slice};
use crate::error::ViewError;
use crate::figures::nematic::slice::{self, Look};
use crate::figures::nematic::{colloid_at, profile_bar};
use crate::figures::series::line_path;
use crate::plot::canvas::Canvas;
use crate::plot::color::{INK, QUIET, Scale, VERMILION};
use crate::plot::style::Style;
use crate::plot::text;
use nalgebra::Vector3;
use topo_lab::Preset;
use topo_lab::{NematicFrame, NematicScene, nematic_frames};

pub const MOVIE: Movie = Movie {
    name: "movie-nematic",
    title: "A colloid discharging",
    caption: "Left: the particle, its defect ring coloured by cross-section from +½ (dark) to −½ \
              (bright), and the director in the plane through the centre. Right: that plane with \
              director (green), velocity (arrows) and vorticity (colour), each scaled to its \
              present maximum. Below: free energy; time runs logarithmically.",
    claim: "After the anchoring is switched off the ring shrinks onto the particle and vanishes; \
            the reorientation drives a flow that changes direction.",
    battery: "nematic",
    clip,
};

/// Winding shown.
const Q: u32 = 4;
/// The first frames show the charged state.
const N_STILL: usize = 12;
/// First time shown after the switch, in R²/(Γ L).
const FIRST: f64 = 1e-4;

/// Everything that frames are drawn from.
struct Play {
    radius: f64,
    /// R²/(Γ L) in τ_N.
    unit: f64,
    shots: Vec<Shot>,
}

struct Shot {
    time: Option<f64>,
    energy: f64,
    ring: Option<DefectLine>,
    plane: Slice,
    speed: f64,
    vorticity: f64,
    /// Mean vertical velocity above the particle.
    lift: f64,
}

fn clip(stage: &Stage<'_>) -> Result<Clip, ViewError> {
    // the published size would take longer than everything else in the gallery
    let quality = match stage.quality {
        Preset::Paper => Preset::Standard,
        other => other,
    };
    let mut scene = NematicScene::published(quality);
    // the discharge is seen at its steps: more of them for smooth motion
    scene.accuracy.tolerance *= 0.25;
    let frames = nematic_frames(&scene, Q, 36.0, stage.interrupt)?;
    crate::error::check(stage.interrupt)?;
    let radius = scene.nematic.radius;
    let material = &scene.nematic.material;
    let play = Play {
        radius,
        unit: radius.powi(2) / (material.rotational_mobility * material.elastic_constant),
        shots: frames.into_iter().map(|f| Shot::new(f, radius)).collect(),
    };
    let last = play
        .shots
        .last()
        .and_then(|s| s.time)
        .map_or(10.0 * FIRST, |t| t / play.unit);
    let time = |k: usize| {
        let part = k.saturating_sub(N_STILL) as f64 / (N_FRAMES - 1 - N_STILL) as f64;
        (k >= N_STILL).then(|| FIRST * (last / FIRST).powf(part))
    };
    let frames = stage.frames(|k, canvas| play.draw(canvas, k, time(k), last))?;
    Ok(Clip {
        frames,
        finding: play.finding(),
    })
}

impl Shot {
    fn new(frame: NematicFrame, radius: f64) -> Self {
        let outside = frame.plane.iter().filter(|p| p.x.hypot(p.z) > radius);
        let speeds = outside.filter_map(|p| Some(p.ux?.hypot(p.uz?)));
        let speed = speeds.fold(0.0, f64::max);
        let turns = frame.plane.iter().filter_map(|p| p.vorticity);
        let vorticity = turns.map(f64::abs).fold(0.0, f64::max);
        let above = frame
            .plane
            .iter()
            .filter(|p| p.z > radius && p.x.abs() < radius);
        let lifts: Vec<f64> = above.filter_map(|p| p.uz).collect();
        let ring = frame.ring.first().map(|first| DefectLine {
            time: frame.time,
            closed: first.closed,
            points: frame
                .ring
                .iter()
                .map(|p| Vector3::new(p.x, p.y, p.z))
                .collect(),
            angles: frame.ring.iter().map(|p| p.angle).collect(),
        });
        Self {
            time: frame.time,
            energy: frame.energy,
            ring: ring.filter(|r| r.points.len() > 2),
            lift: lifts.iter().sum::<f64>() / lifts.len().max(1) as f64,
            plane: Slice {
                time: frame.time,
                points: frame.plane,
            },
            speed,
            vorticity,
        }
    }
}

impl Play {
    /// The last shot at or before a time in R²/(Γ L).
    fn at(&self, time: Option<f64>) -> usize {
        let now = time.map(|t| t * self.unit * (1.0 + 1e-9));
        self.shots.iter().rposition(|s| s.time <= now).unwrap_or(0)
    }

    fn draw(
        &self,
        canvas: &mut Canvas,
        frame: usize,
        time: Option<f64>,
        last: f64,
    ) -> Result<(), ViewError> {
        let now = self.at(time);
        let shot = &self.shots[now];
        let label = time.map_or("charged".to_owned(), |t| {
            format!("*t* = {} *R*^{{2}}/Γ*L*", text::significant(t, 2))
        });
        let bold = Style::default().bold();
        canvas.text(480.0, 34.0, &label, bold.middle().size(22.0));
        let label = format!("*q* = {Q}, *R* = {} ξ_{{N}}", self.radius);
        canvas.text(20.0, 34.0, &label, bold.size(18.0));

        let lines: Vec<&DefectLine> = shot.ring.iter().collect();
        // half a turn of the eye while it plays
        let azimuth = -90.0 + 40.0 * (frame as f64 / (N_FRAMES - 1) as f64 - 0.5);
        let q = time.is_none().then_some(Q);
        let [half_x, half_z] = shot.plane.half_size();
        let solids = colloid_at(self.radius, q, &lines, Some(&shot.plane), [azimuth, 20.0]);
        let unit = (470.0 / (2.0 * half_x)).min(440.0 / (2.0 * half_z));
        canvas.solids([0.0, 60.0], [480.0, 470.0], [0.0, 0.0], unit, &solids)?;
        profile_bar(canvas, [150.0, 540.0], [180.0, 9.0], 13.0);

        let scale = Scale::diverging((0.7 * shot.vorticity).max(1e-30));
        let look = Look {
            vorticity: &scale,
            speed: (0.6 * shot.speed).max(1e-30),
            radius: self.radius,
            unit: unit * 0.98,
            center: [720.0, 295.0],
        };
        slice::draw(canvas, &shot.plane, &lines, &look)?;
        let label = if shot.speed > 0.0 {
            format!(
                "largest |*u*| {} ξ_{{N}}/τ_{{N}}, |ω| {} /τ_{{N}}",
                text::significant(shot.speed, 2),
                text::significant(shot.vorticity, 2)
            )
        } else {
            "at rest".to_owned()
        };
        let style = Style::default().middle().size(14.0).color(INK);
        canvas.text(720.0, 548.0, &label, style);
        self.energy(canvas, now, time, last);
        Ok(())
    }

    /// Logarithm of the energy against that of time, with a dot for now.
    fn energy(&self, canvas: &mut Canvas, now: usize, time: Option<f64>, last: f64) {
        let (at, size) = ([70.0, 582.0], [860.0, 90.0]);
        let energy = |s: &Shot| s.energy.max(1e-9).ln();
        let top = self.shots.iter().map(energy).fold(f64::MIN, f64::max);
        let bottom = self.shots.iter().map(energy).fold(f64::MAX, f64::min);
        let across = |t: f64| at[0] + size[0] * (t.max(FIRST) / FIRST).ln() / (last / FIRST).ln();
        let place = |s: &Shot| {
            let t = s.time.map_or(FIRST, |t| t / self.unit);
            [
                across(t),
                at[1] + size[1] * (top - energy(s)) / (top - bottom).max(1e-9),
            ]
        };
        let foot = at[1] + size[1] + 4.0;
        canvas.line([at[0], foot], [at[0] + size[0], foot], QUIET, 1.0);
        let mut decade = FIRST;
        while decade <= last * 1.001 {
            let x = across(decade);
            canvas.line([x, foot], [x, foot + 5.0], QUIET, 1.0);
            let style = Style::default().middle().size(13.0);
            canvas.text(x, foot + 19.0, &text::log_tick(decade), style);
            decade *= 10.0;
        }
        let style = Style::default().middle().size(13.0);
        let middle = at[0] + 0.5 * size[0];
        canvas.text(middle, foot + 33.0, "*t* Γ*L*/*R*^{2}", style);
        let style = Style {
            upward: true,
            ..Style::default().middle().size(13.0)
        };
        canvas.text(at[0] - 14.0, at[1] + 0.5 * size[1], "log *F*", style);
        let path: Vec<[f64; 2]> = self.shots.iter().map(place).collect();
        line_path(canvas, &path, QUIET, 1.2);
        line_path(canvas, &path[..=now], INK, 2.4);
        let x = time.map_or(at[0], across);
        let y = path[now][1];
        canvas.raw(&format!(
            r#"<circle cx="{x:.2}" cy="{y:.2}" r="5" fill="{VERMILION}"/>"#
        ));
        let shot = &self.shots[now];
        let label = format!("*F* = {} *L*ξ_{{N}}", text::significant(shot.energy, 3));
        let style = Style::default().end().bold().size(16.0).halo();
        canvas.text(at[0] + size[0], at[1] + 12.0, &label, style);
    }

    fn finding(&self) -> String {
        let after = self.shots.iter().filter(|s| s.time.is_some());
        let gone = after.clone().find(|s| s.ring.is_none());
        let lifts: Vec<f64> = after.map(|s| s.lift).filter(|l| *l != 0.0).collect();
        let swaps = lifts.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
        let first = self.shots.first().map_or(0.0, |s| s.energy);
        let fate = gone.and_then(|s| s.time).map_or_else(
            || "the ring is still there at the end".to_owned(),
            |t| {
                format!(
                    "the ring is gone at {} R²/ΓL",
                    text::significant(t / self.unit, 2)
                )
            },
        );
        format!(
            "q = {Q} at R = {} ξ_N: {} Lξ_N charged; {fate}; the vertical velocity above the particle changes its sign {}.",
            self.radius,
            text::significant(first, 4),
            text::times(swaps)
        )
    }
}
