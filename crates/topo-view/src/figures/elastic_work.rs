//! A knot as a motor: its work on a load, its power and its efficiency, and the load that serves each best.

use super::figure::{Context, Drawn, Figure, face};
use super::series::{KEY_HEIGHT, OTHERS, Table, column_rules, knot_names, line, log_bounds};
use crate::data::{Case, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, INK, ORANGE, QUIET, SKY, VERMILION};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::{MarkerShape, Plot, ScatterPlot};
use topo_analysis::median;
use topo_lab::Preset;

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-work",
    title: "Work on a load",
    caption: "Knots that untie against a dashpot between the two tips of the cut fibre, F = c ṙ per area of the \
              cross-section, r their distance. (a) Efficiency: work on the load over what the charge took \
              (the elastic energy of the fibre tied without twist, and the work of twisting it), against the \
              resistance c in η/h. (b) Largest power on the load, in E_0/T_0. (c) The best efficiency of each knot over \
              the loads tried, and (d) its largest power; the table beside the figure has the dashpot of each. \
              E_0 = E_b h² L, T_0 = 2 L η/(h E_b); \
              discharges are followed until 99 % of the energy is released. A draft has two twists, \
              three loads and half the edges; finer presets five twists and eight loads.",
    claim: "Not in the published work, which discharges knots without a load: what one would be worth as a motor.",
    table: "elastic-work/sweep.csv",
    draw,
};

/// Colours of the twists.
const TWISTS: [(f64, &str); 5] = [
    (-2.0, BLUE),
    (-1.0, SKY),
    (0.0, INK),
    (1.0, ORANGE),
    (2.0, VERMILION),
];

/// Knots whose curves are picked out.
const KNOTS: [(&str, MarkerShape); 2] =
    [("3_1", MarkerShape::Circle), ("7_4", MarkerShape::Square)];

fn color(twist: f64) -> &'static str {
    let found = TWISTS.iter().find(|(t, _)| (t - twist).abs() < 1e-9);
    found.map_or(QUIET, |(_, color)| color)
}

fn points(points: Vec<(f64, f64)>, color: &str, marker: MarkerShape) -> Plot {
    let scatter = ScatterPlot::new().with_data(points);
    Plot::Scatter(scatter.with_color(color).with_marker(marker).with_size(2.5))
}

/// A discharge against a load.
#[derive(Debug, Clone, Copy)]
struct Run {
    dashpot: f64,
    efficiency: f64,
    power: f64,
}

/// A charged state and its discharges, by the resistance of the load.
struct Motor<'a> {
    knot: &'a str,
    twist: f64,
    runs: Vec<Run>,
}

/// A number of a run.
type Measure = fn(&Run) -> f64;

const EFFICIENCY: Measure = |run| run.efficiency;
const POWER: Measure = |run| run.power;

impl<'a> Motor<'a> {
    fn of(case: &'a Case) -> Self {
        let first = case.first();
        let runs = case.cuts.iter().filter_map(|cut| {
            Some(Run {
                dashpot: cut.load_dashpot?,
                efficiency: cut.efficiency?,
                power: cut.peak_power?,
            })
        });
        let mut runs: Vec<Run> = runs.collect();
        runs.sort_by(|a, b| a.dashpot.total_cmp(&b.dashpot));
        Self {
            knot: &first.knot,
            twist: first.twist,
            runs,
        }
    }

    fn best(&self, by: Measure) -> Option<&Run> {
        self.runs.iter().max_by(|a, b| by(a).total_cmp(&by(b)))
    }

    fn marker(&self) -> Option<MarkerShape> {
        let found = KNOTS.iter().find(|(knot, _)| *knot == self.knot);
        found.map(|(_, marker)| *marker)
    }

    /// Its curve over the load: in colour where the knot is picked out.
    fn curve(&self, of: Measure) -> Vec<Plot> {
        let curve: Vec<(f64, f64)> = self.runs.iter().map(|r| (r.dashpot, of(r))).collect();
        match self.marker() {
            Some(marker) => vec![
                line(curve.clone(), color(self.twist), 1.4),
                points(curve, color(self.twist), marker),
            ],
            None => vec![line(curve, OTHERS, 0.7)],
        }
    }
}

/// All states, and what the panels share.
struct Motors<'a> {
    all: Vec<Motor<'a>>,
    knots: Vec<&'a str>,
    twists: Vec<f64>,
}

impl<'a> Motors<'a> {
    fn of(sweep: &'a Sweep) -> Self {
        let all = sweep.cases.iter().map(Motor::of);
        Self {
            all: all.filter(|motor| !motor.runs.is_empty()).collect(),
            knots: sweep.knots(),
            twists: sweep.twists(),
        }
    }

    fn runs(&self) -> impl Iterator<Item = &Run> {
        self.all.iter().flat_map(|motor| &motor.runs)
    }

    fn loads(&self) -> Vec<f64> {
        let mut loads: Vec<f64> = self.runs().map(|run| run.dashpot).collect();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        loads
    }

    /// The best of every state, with the state.
    fn best(&self, by: Measure) -> impl Iterator<Item = (&Motor<'a>, &Run)> {
        let best = move |motor| Some((motor, Motor::best(motor, by)?));
        self.all.iter().filter_map(best)
    }
}

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let folder = context.results.join("elastic-work");
    let sweep = Sweep::of_folder(&folder)?;
    let motors = Motors::of(&sweep);
    if motors.all.is_empty() {
        return Err(ViewError::Table {
            path: folder.join("sweep.csv"),
            reason: "no discharge against a load".to_owned(),
        });
    }
    let mut table = Table::new("panel,knot,twist,x,y,dashpot");
    let mut canvas = Canvas::new(720.0, 566.0, 4.0 * context.detail);
    curves(&motors, &mut canvas, &mut table);
    let range = log_bounds(motors.best(EFFICIENCY).map(|(_, run)| run.efficiency), 1.5);
    let axis = Axis::log("Best efficiency", range);
    columns(
        &motors,
        "c",
        (250.0, axis),
        EFFICIENCY,
        (&mut canvas, &mut table),
    );
    let range = log_bounds(motors.best(POWER).map(|(_, run)| run.power), 1.5);
    let axis = Axis::log("Peak power *T*_{0} / *E*_{0}", range);
    let d = columns(
        &motors,
        "d",
        (382.0, axis),
        POWER,
        (&mut canvas, &mut table),
    );
    knot_names(&d, &motors.knots, &mut canvas);
    canvas.footnote(&feet(&sweep, &motors, context.quality));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: finding(&motors),
    })
}

/// The quality, and which states and loads these are.
fn feet(sweep: &Sweep, motors: &Motors<'_>, quality: Preset) -> Vec<String> {
    let mut feet = face(sweep, quality);
    let left_out = match quality {
        Preset::Draft => "; left out in a draft: θ′*h* = −2, −1, +1, five loads",
        _ => "",
    };
    feet[0] = format!(
        "{quality} quality: {} states on {} loads, *N* = {} edges, one cut a state{left_out}. Published parameters α^{{−1}} = 1.3, γ = 5, *L*/*h* = 50.",
        motors.all.len(),
        motors.loads().len(),
        sweep.cases[0].first().edges,
    );
    feet
}

/// Efficiency and power against the load.
fn curves(motors: &Motors<'_>, canvas: &mut Canvas, table: &mut Table) {
    const SIZE: [f64; 2] = [276.0, 190.0];
    let axis = |label: &str, of: Measure| Axis::log(label, log_bounds(motors.runs().map(of), 1.3));
    let efficiency = axis("Efficiency", EFFICIENCY);
    let power = axis("Peak power *T*_{0} / *E*_{0}", POWER);
    let both: [(&str, f64, Axis, Measure); 2] = [
        ("a", 58.0, efficiency, EFFICIENCY),
        ("b", 430.0, power, POWER),
    ];
    for (letter, left, y, of) in both {
        canvas.letter(left - 50.0, 18.0, letter);
        let panel = Panel {
            at: [left, 12.0],
            size: SIZE,
            x: axis("Dashpot *c* / (η/*h*)", |run| run.dashpot),
            y: y.with_room(KEY_HEIGHT, SIZE[1]),
        };
        // those picked out lie on the others
        let (picked, others): (Vec<&Motor>, Vec<&Motor>) =
            motors.all.iter().partition(|m| m.marker().is_some());
        let mut plots: Vec<Plot> = Vec::new();
        for motor in others.iter().chain(&picked) {
            plots.extend(motor.curve(of));
            for run in &motor.runs {
                table.row(
                    &[letter, motor.knot],
                    &[motor.twist, run.dashpot, of(run), run.dashpot],
                );
            }
        }
        plots.extend(match letter {
            "a" => twist_key(&panel, &motors.twists, canvas),
            _ => knot_key(&panel, &motors.knots, canvas),
        });
        panel.draw(canvas, plots, &[]);
    }
}

/// Samples and names in one line at the top of a panel.
struct Key<'a> {
    panel: &'a Panel,
    left: f64,
    plots: Vec<Plot>,
}

impl<'a> Key<'a> {
    const FROM_TOP: f64 = 11.0;

    fn new(panel: &'a Panel) -> Self {
        Self {
            panel,
            left: 10.0,
            plots: Vec::new(),
        }
    }

    fn add(&mut self, sample: impl Fn(Vec<(f64, f64)>) -> Plot, name: &str, canvas: &mut Canvas) {
        let panel = self.panel;
        let y = panel.y.value(1.0 - Self::FROM_TOP / panel.size[1]);
        let at = |d: f64| (panel.x.value((self.left + d) / panel.size[0]), y);
        self.plots.push(sample(vec![at(0.0), at(12.0)]));
        let corner = [panel.at[0] + self.left + 16.0, panel.at[1] + Self::FROM_TOP];
        let style = Style::default().size(9.5);
        canvas.text(corner[0], corner[1] + 3.2, name, style);
        self.left += 28.0 + 5.0 * name.chars().filter(|c| *c != '*').count() as f64;
    }
}

/// Which colour is which twist.
fn twist_key(panel: &Panel, twists: &[f64], canvas: &mut Canvas) -> Vec<Plot> {
    let mut key = Key::new(panel);
    for (k, twist) in twists.iter().enumerate() {
        let label = text::signed(*twist);
        let name = match k {
            0 => format!("θ′*h* = {label}"),
            _ => label,
        };
        key.add(|at| line(at, color(*twist), 1.8), &name, canvas);
    }
    key.plots
}

/// Which point is which knot.
fn knot_key(panel: &Panel, knots: &[&str], canvas: &mut Canvas) -> Vec<Plot> {
    let mut key = Key::new(panel);
    let is_there = |knot: &str| knots.contains(&knot);
    for (knot, marker) in KNOTS.into_iter().filter(|(knot, _)| is_there(knot)) {
        let sample = move |at: Vec<(f64, f64)>| points(vec![at[1]], INK, marker);
        key.add(sample, &text::knot_name(knot), canvas);
    }
    let picked = |knot: &&&str| KNOTS.iter().any(|(picked, _)| picked == *knot);
    let n_others = knots.len() - knots.iter().filter(picked).count();
    if n_others > 0 {
        let name = format!("{n_others} other knots");
        key.add(|at| line(at, OTHERS, 1.0), &name, canvas);
    }
    key.plots
}

/// The best of every state, knots side by side.
fn columns(
    motors: &Motors<'_>,
    letter: &str,
    (top, y): (f64, Axis),
    by: Measure,
    (canvas, table): (&mut Canvas, &mut Table),
) -> Panel {
    let n = motors.knots.len().max(1);
    let panel = Panel {
        at: [58.0, top],
        size: [648.0, 120.0],
        x: Axis::linear("", (0.0, n as f64), 1.0).bare(),
        y,
    };
    canvas.letter(8.0, top + 6.0, letter);
    let mut plots = column_rules(&panel, n, 0.0);
    let between = 0.7 / motors.twists.len().max(2) as f64;
    let middle = (motors.twists.len() as f64 - 1.0) / 2.0;
    for (motor, run) in motors.best(by) {
        let column = motors.knots.iter().position(|k| *k == motor.knot);
        let place = motors.twists.iter().position(|t| *t == motor.twist);
        let (Some(column), Some(place)) = (column, place) else {
            continue;
        };
        let x = column as f64 + 0.5 + between * (place as f64 - middle);
        table.row(
            &[letter, motor.knot],
            &[motor.twist, x, by(run), run.dashpot],
        );
        let at = vec![(x, by(run))];
        plots.push(points(at, color(motor.twist), MarkerShape::Circle));
    }
    panel.draw(canvas, plots, &[]);
    panel
}

/// What the best and the usual motor is.
fn finding(motors: &Motors<'_>) -> String {
    let first = |by: Measure| {
        let all = motors.best(by);
        all.max_by(|a, b| by(a.1).total_cmp(&by(b.1)))
    };
    let said = |found: Option<(&Motor, &Run)>, by: Measure, what: &str, unit: &str| {
        found.map_or_else(String::new, |(motor, run)| {
            format!(
                "{what} {}{unit}: {} at θ′h = {} on a dashpot of {} η/h.",
                text::significant(by(run), 3),
                text::knot_name(motor.knot),
                text::signed(motor.twist),
                text::significant(run.dashpot, 2),
            )
        })
    };
    let middle = |twist: &f64| {
        let own = motors.best(EFFICIENCY).filter(|(m, _)| m.twist == *twist);
        let middle = median(own.map(|(_, run)| run.efficiency))?;
        let middle = text::significant(middle, 2);
        Some(format!("{middle} at θ′h = {}", text::signed(*twist)))
    };
    let middles: Vec<String> = motors.twists.iter().filter_map(middle).collect();
    format!(
        "{} {} Median over the knots of the best efficiency: {}.",
        said(first(EFFICIENCY), EFFICIENCY, "Best efficiency", ""),
        said(first(POWER), POWER, "Largest power", " E₀/T₀"),
        middles.join(", ")
    )
}
