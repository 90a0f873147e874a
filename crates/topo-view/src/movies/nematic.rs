//! A colloid discharging with flow: ring and director in three dimensions, the central plane beside it, on a logarithmic clock.

use super::axes::Axes;
use super::stage::{Clip, Movie, N_FRAMES, Stage};
use crate::data::{DefectLine, Slice};
use crate::error::ViewError;
use crate::figures::nematic::slice::{self, Look};
use crate::figures::nematic::{colloid_at, particle_bar, profile_bar};
use crate::figures::series::log_bounds;
use crate::plot::canvas::Canvas;
use crate::plot::color::Scale;
use crate::plot::panel::Axis;
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
              director (green), velocity (arrows), vorticity ω_y (colour, up to the ω_0 of the moment) and \
              defect line (red); lengths in the radius R of the particle. Below: free energy F in L ξ_N \
              against the time t since the switch in R²/ΓL, with elastic constant L, rotational mobility \
              Γ, nematic correlation length ξ_N, τ_N = ξ_N²/ΓL.",
    claim: "After the anchoring is switched off the ring shrinks onto the particle and vanishes; \
            the reorientation drives a flow that changes direction.",
    battery: "nematic",
    clip,
};

/// Winding shown.
const Q: u32 = 4;
/// The first frames show the charged state.
const N_STILL: usize = 12;
/// Azimuth and height of the eye, in degrees: it stays where it is, so that only what changes moves.
const EYE: [f64; 2] = [-75.0, 20.0];
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
    let frames = stage.frames(|k, canvas| play.draw(canvas, time(k), last))?;
    Ok(Clip {
        frames,
        finding: play.finding(),
    })
}

impl Shot {
    fn new(frame: NematicFrame, radius: f64) -> Self {
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
        let plane = Slice {
            time: frame.time,
            points: frame.plane,
        };
        Self {
            time: frame.time,
            energy: frame.energy,
            ring: ring.filter(|r| r.points.len() > 2),
            lift: lifts.iter().sum::<f64>() / lifts.len().max(1) as f64,
            speed: slice::top_speed(&plane, radius),
            vorticity: slice::top_vorticity(&plane),
            plane,
        }
    }
}

impl Play {
    /// The last shot at or before a time in R²/(Γ L).
    fn at(&self, time: Option<f64>) -> usize {
        let now = time.map(|t| t * self.unit * (1.0 + 1e-9));
        self.shots.iter().rposition(|s| s.time <= now).unwrap_or(0)
    }

    fn draw(&self, canvas: &mut Canvas, time: Option<f64>, last: f64) -> Result<(), ViewError> {
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
        self.draw_space(canvas, shot, &lines)?;
        self.draw_plane(canvas, shot, &lines)?;
        self.draw_energy(canvas, now, time, last);
        Ok(())
    }

    /// Particle, ring and director in three dimensions, with the colours of both.
    fn draw_space(
        &self,
        canvas: &mut Canvas,
        shot: &Shot,
        lines: &[&DefectLine],
    ) -> Result<(), ViewError> {
        let q = shot.time.is_none().then_some(Q);
        let solids = colloid_at(self.radius, q, lines, Some(&shot.plane), EYE);
        let unit = self.unit_of(&shot.plane);
        canvas.solids([0.0, 50.0], [470.0, 450.0], [0.0, 0.0], unit, &solids)?;
        let style = Style::default().middle().size(13.0);
        profile_bar(canvas, [40.0, 524.0], [170.0, 9.0], 12.0);
        canvas.text(125.0, 517.0, "Ring: cross-section", style);
        particle_bar(canvas, [270.0, 524.0], [170.0, 9.0], 12.0);
        canvas.text(355.0, 517.0, "Particle: surface director, *x*", style);
        Ok(())
    }

    /// Units of the canvas per unit of length.
    fn unit_of(&self, plane: &Slice) -> f64 {
        let [half_x, half_z] = plane.half_size();
        (420.0 / (2.0 * half_x)).min(420.0 / (2.0 * half_z))
    }

    /// The plane through the centre, with its scales.
    fn draw_plane(
        &self,
        canvas: &mut Canvas,
        shot: &Shot,
        lines: &[&DefectLine],
    ) -> Result<(), ViewError> {
        let scale = Scale::diverging((slice::SATURATED * shot.vorticity).max(1e-30));
        let [half_x, half_z] = shot.plane.half_size();
        let unit = self.unit_of(&shot.plane);
        let center = [730.0, 66.0 + half_z * unit];
        let look = Look {
            vorticity: &scale,
            speed: (0.6 * shot.speed).max(1e-30),
            radius: self.radius,
            unit,
            center,
        };
        slice::draw(canvas, &shot.plane, lines, &look)?;
        look.ticks(canvas, [half_x, half_z], 12.0);
        let (left, foot) = (center[0] - half_x * unit, center[1] + half_z * unit);
        let style = Style::default().size(13.0);
        if shot.vorticity > 0.0 {
            let most = text::significant(slice::SATURATED * shot.vorticity, 2);
            let label = format!("ω_{{0}} = {most} /τ_{{N}}");
            canvas.text(left, foot + 42.0, &label, style);
            slice::vorticity_bar(canvas, [center[0], foot + 31.0], 130.0, 12.0);
            look.arrow_key(canvas, &shot.plane, [center[0] + 92.0, foot + 42.0], 13.0);
        } else {
            canvas.text(center[0], foot + 42.0, "at rest", style.middle());
        }
        Ok(())
    }

    /// Logarithm of the energy against that of time, with a dot for now.
    fn draw_energy(&self, canvas: &mut Canvas, now: usize, time: Option<f64>, last: f64) {
        let (at, size) = ([92.0, 596.0], [840.0, 84.0]);
        let curve: Vec<(f64, f64)> = self
            .shots
            .iter()
            .map(|s| (s.time.map_or(FIRST, |t| t / self.unit), s.energy.max(1e-9)))
            .collect();
        let (low, high) = log_bounds(curve.iter().map(|p| p.1), 1.0);
        // five decades are seen; a released state has none of its energy left
        let low = low.max(1e-5 * high);
        let ticks: Vec<(f64, String)> = (low.log10().ceil() as i32..=high.log10().floor() as i32)
            .map(|k| 10.0_f64.powi(k))
            .map(|v| (v, text::log_tick(v)))
            .collect();
        let axes = Axes {
            at,
            size,
            time: Axis::log("*t* Γ*L*/*R*^{2}", (FIRST, last)),
            value: Axis::log("*F* / *L*ξ_{N}", (low, high)),
            ticks: &ticks,
            type_size: 13.0,
        };
        axes.draw(canvas, &curve, now, time.unwrap_or(FIRST));
        let energy = text::significant(self.shots[now].energy, 3);
        let label = format!("*F* = {energy} *L*ξ_{{N}}");
        let style = Style::default().end().bold().size(16.0).halo();
        canvas.text(at[0] + size[0], at[1] + 14.0, &label, style);
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
