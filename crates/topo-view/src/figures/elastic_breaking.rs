//! What "the point of maximum stress" means, and what that does to the discharge of the untwisted knots.

use super::figure::{Context, Drawn, Figure, face};
use super::series::{KEY_HEIGHT, Table, bounds, column_rules, knot_names, line, log_bounds, step};
use crate::data::{Cut, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, GREEN, INK, VERMILION};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use crate::reproduction::{ByCriterion, SLOW, words};
use kuva::prelude::{MarkerShape, Plot, ScatterPlot};
use topo_analysis::median;
use topo_rod::Criterion;

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-breaking",
    title: "Where it breaks",
    caption: "Untwisted knots, each cut where one of four measures is largest, averaged over π h of the fibre: \
              its elastic energy density, its curvature κ, the tension σ = γ(|x′| − 1) + hκ in E_b on \
              the outer side of its bend, and the von Mises stress of that tension and the shear of its \
              twist, (σ² + 3τ²)^½ with τ = (α/2)hθ′. Grey bars span the cuts at energy densities \
              within 3 % of the largest. (a) t99, the time in which 99 % of the \
              energy before the cut is released. (b) The same over the median of the knots; above the \
              dashed line a knot is called slow.",
    claim: "Knots are cut at the point of maximum stress; 3₁ and 7₄ are then slow without twist.",
    table: "elastic-breaking/sweep.csv",
    draw,
};

/// Looks of a criterion.
struct Looks {
    criterion: Criterion,
    color: &'static str,
    marker: MarkerShape,
}

const LOOKS: [Looks; 4] = [
    Looks::new(Criterion::Energy, BLUE, MarkerShape::Circle),
    Looks::new(Criterion::Curvature, VERMILION, MarkerShape::Square),
    Looks::new(Criterion::Tension, GREEN, MarkerShape::Triangle),
    Looks::new(Criterion::VonMises, INK, MarkerShape::Diamond),
];

impl Looks {
    const fn new(criterion: Criterion, color: &'static str, marker: MarkerShape) -> Self {
        Self {
            criterion,
            color,
            marker,
        }
    }

    fn of(criterion: Criterion) -> &'static Self {
        let found = LOOKS.iter().find(|looks| looks.criterion == criterion);
        found.unwrap_or(&LOOKS[0])
    }

    fn points(&self, points: Vec<(f64, f64)>) -> Plot {
        let scatter = ScatterPlot::new().with_data(points);
        let scatter = scatter.with_color(self.color).with_marker(self.marker);
        Plot::Scatter(scatter.with_size(2.7))
    }

    /// Where its points stand in the column of a knot, from 0 to 1.
    fn place(&self) -> f64 {
        let k = LOOKS.iter().position(|l| l.criterion == self.criterion);
        0.2 + 0.2 * k.unwrap_or(0) as f64
    }
}

/// t99 of the untwisted knots by criterion, and over the near ties of the energy density.
struct Times<'a> {
    knots: Vec<&'a str>,
    /// Times of the knots by criterion, where there are any.
    by: Vec<(Criterion, Vec<Option<f64>>)>,
    /// Shortest and longest over the near ties, where more than one was cut.
    ties: Vec<Option<[f64; 2]>>,
}

impl<'a> Times<'a> {
    fn of(criteria: &'a [ByCriterion]) -> Self {
        let knots: Vec<&str> = match criteria.first() {
            Some(first) => first.sweep.knots(),
            None => Vec::new(),
        };
        let of = |c: &ByCriterion| {
            let time = |knot: &&str| c.sweep.at(knot, 0.0)?.first().t99;
            (c.criterion, knots.iter().map(time).collect())
        };
        // the largest energy density and its near ties are the cuts of one criterion
        let energy = criteria.iter().find(|c| c.criterion == Criterion::Energy);
        let tied = |knot: &&str| {
            let case = energy?.sweep.at(knot, 0.0)?;
            if case.cuts.len() < 2 {
                return None;
            }
            let [_, low, high] = case.spread(|cut| cut.t99)?;
            Some([low, high])
        };
        Self {
            by: criteria.iter().map(of).collect(),
            ties: knots.iter().map(tied).collect(),
            knots,
        }
    }

    fn median(times: &[Option<f64>]) -> f64 {
        median(times.iter().flatten().copied()).unwrap_or(1.0)
    }

    /// Median over the knots of the cuts at the largest energy density.
    fn usual(&self) -> f64 {
        let energy = self.by.iter().find(|(c, _)| *c == Criterion::Energy);
        energy.map_or(1.0, |(_, times)| Self::median(times))
    }

    /// Over the median of the knots cut alike.
    fn relative(&self) -> Self {
        let over = |(criterion, times): &(Criterion, Vec<Option<f64>>)| {
            let middle = Self::median(times);
            let over = times.iter().map(|t| t.map(|t| t / middle));
            (*criterion, over.collect())
        };
        let usual = self.usual();
        Self {
            knots: self.knots.clone(),
            by: self.by.iter().map(over).collect(),
            ties: self
                .ties
                .iter()
                .map(|t| t.map(|t| t.map(|t| t / usual)))
                .collect(),
        }
    }

    fn all(&self) -> impl Iterator<Item = f64> + '_ {
        let times = self.by.iter().flat_map(|(_, times)| times).flatten();
        times
            .copied()
            .chain(self.ties.iter().flatten().flatten().copied())
    }
}

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = Sweep::read(context.results)?;
    let cut = Sweep::of_folder(&context.results.join("elastic-breaking"))?;
    let criteria = ByCriterion::of(&cut);
    let times = Times::of(&criteria);
    let relative = times.relative();
    let mut table = Table::new("panel,knot,criterion,x,y,low,high");
    let mut canvas = Canvas::new(720.0, 458.0, 4.0 * context.detail);
    let range = log_bounds(times.all(), 1.2);
    let absolute = Axis::log("Discharge time *t*_{99} / *T*_{0}", range);
    canvas.letter(8.0, 18.0, "a");
    let a = panel(&times, 12.0, absolute.with_room(KEY_HEIGHT, HEIGHT));
    let key = legend(&a, &times, &mut canvas);
    columns(
        &a,
        &times,
        "a",
        (key, KEY_HEIGHT),
        (&mut canvas, &mut table),
    );
    canvas.letter(8.0, 224.0, "b");
    let top = bounds(relative.all()).1.max(1.2 * SLOW);
    let axis = Axis::linear(
        "*t*_{99} / median over the knots",
        (0.0, 1.08 * top),
        step(top, 4.0),
    );
    let b = panel(&relative, 218.0, axis);
    let n = relative.knots.len() as f64;
    // dashes, as lines have none
    let dash = |k: usize| {
        let at = [0.0, 0.6].map(|part| (n * (k as f64 + part) / 60.0, SLOW));
        line(at.to_vec(), "#7a828c", 0.9)
    };
    let slow = (0..60).map(dash).collect();
    columns(&b, &relative, "b", (slow, 0.0), (&mut canvas, &mut table));
    knot_names(&b, &relative.knots, &mut canvas);
    canvas.footnote(&feet(&sweep, &cut, context));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: finding(&times, &criteria, &cut),
    })
}

/// The quality, what differs from the published parameters, and which cuts these are.
fn feet(sweep: &Sweep, cut: &Sweep, context: &Context) -> Vec<String> {
    let mut feet = face(sweep, context.quality);
    let n: usize = cut.cases.iter().map(|case| case.cuts.len()).sum();
    feet[0] = format!(
        "{} quality: {} untwisted knots, *N* = {} edges, {n} cuts. Published parameters α^{{−1}} = 1.3, γ = 5, *L*/*h* = 50.",
        context.quality,
        cut.cases.len(),
        cut.cases[0].first().edges
    );
    feet
}

const HEIGHT: f64 = 184.0;
const WIDTH: f64 = 648.0;

fn panel(times: &Times<'_>, top: f64, y: Axis) -> Panel {
    Panel {
        at: [58.0, top],
        size: [WIDTH, HEIGHT],
        x: Axis::linear("", (0.0, times.knots.len().max(1) as f64), 1.0).bare(),
        y,
    }
}

/// The points of each knot side by side, near ties behind them.
fn columns(
    panel: &Panel,
    times: &Times<'_>,
    letter: &str,
    (more, room): (Vec<Plot>, f64),
    (canvas, table): (&mut Canvas, &mut Table),
) {
    let mut plots = column_rules(panel, times.knots.len(), room);
    for (k, (knot, tied)) in times.knots.iter().zip(&times.ties).enumerate() {
        if let Some([low, high]) = *tied {
            let x = k as f64 + 0.5;
            plots.push(line(vec![(x, low), (x, high)], TIES, 36.0));
            table.row(&[letter, knot, "near-ties"], &[x, f64::NAN, low, high]);
        }
    }
    plots.extend(more);
    for (criterion, by) in &times.by {
        let looks = Looks::of(*criterion);
        let place = |k: usize| k as f64 + looks.place();
        let known = by.iter().enumerate().filter_map(|(k, t)| Some((k, (*t)?)));
        let known: Vec<(usize, f64)> = known.collect();
        for (k, t) in &known {
            let texts = [letter, times.knots[*k], criterion.name()];
            table.row(&texts, &[place(*k), *t, *t, *t]);
        }
        plots.push(looks.points(known.into_iter().map(|(k, t)| (place(k), t)).collect()));
    }
    panel.draw(canvas, plots, &[]);
}

/// Grey of the near ties.
const TIES: &str = "#dfe2e6";

/// Which point is which criterion, in one line at the top of a panel.
fn legend(panel: &Panel, times: &Times<'_>, canvas: &mut Canvas) -> Vec<Plot> {
    const FROM_TOP: f64 = 11.0;
    let y = panel.y.value(1.0 - FROM_TOP / panel.size[1]);
    let mut left = 12.0;
    let mut plots = Vec::new();
    let mut sample = |plot: Box<dyn Fn(f64) -> Plot>, name: &str, canvas: &mut Canvas| {
        plots.push(plot(panel.x.value(left / panel.size[0])));
        let at = [panel.at[0] + left + 8.0, panel.at[1] + FROM_TOP + 3.2];
        canvas.text(at[0], at[1], name, Style::default().size(9.5));
        left += 30.0 + 5.0 * name.chars().count() as f64;
    };
    for (criterion, _) in &times.by {
        let looks = Looks::of(*criterion);
        let name = format!("largest {}", words(*criterion));
        sample(Box::new(move |x| looks.points(vec![(x, y)])), &name, canvas);
    }
    if times.ties.iter().any(Option::is_some) {
        let size = panel.size;
        let half = 5.0 / size[0] * (panel.x.range.1 - panel.x.range.0);
        let bar = move |x: f64| line(vec![(x - half, y), (x + half, y)], TIES, 9.0);
        sample(Box::new(bar), "near-tied energy densities", canvas);
    }
    plots
}

/// How far the criteria agree, and which knots are slow by which.
fn finding(times: &Times<'_>, criteria: &[ByCriterion], cut: &Sweep) -> String {
    let of = |k: usize| times.by.iter().filter_map(move |(_, by)| by[k]);
    let spread = |k: usize| {
        let (low, high) = bounds(of(k));
        high / low
    };
    let agree = |cut: &Cut| cut.cut_by.split(';').count() == LOOKS.len();
    let agreeing = cut.cases.iter().filter(|case| case.cuts.iter().any(agree));
    let agreeing = agreeing.count();
    let widest = (0..times.knots.len()).max_by(|a, b| spread(*a).total_cmp(&spread(*b)));
    let widest = widest.map_or_else(String::new, |k| {
        format!(
            "; t99 depends on the criterion by a factor {} at most ({})",
            text::number(spread(k), 2),
            text::knot_name(times.knots[k])
        )
    });
    let relative = times.relative();
    let slow = criteria.iter().zip(&relative.by).map(|(c, (_, by))| {
        let named = relative.knots.iter().zip(by);
        let mut named: Vec<(&str, f64)> = named
            .filter_map(|(knot, t)| Some((*knot, (*t).filter(|t| *t > SLOW)?)))
            .collect();
        named.sort_by(|a, b| b.1.total_cmp(&a.1));
        let list = named
            .iter()
            .map(|(knot, t)| format!("{} {}", text::knot_name(knot), text::number(*t, 1)));
        let list: Vec<String> = list.collect();
        let list = if list.is_empty() {
            "none".to_owned()
        } else {
            list.join(", ")
        };
        format!("{}: {list}", words(c.criterion))
    });
    let ties = times.ties.iter().flatten().map(|[low, high]| high / low);
    let ties = text::number(ties.fold(1.0, f64::max), 2);
    format!(
        "All criteria cut at one vertex in {agreeing} of {} untwisted knots{widest}, on which of the near-tied energy densities by {ties}. Slower than {SLOW} times the median, cut at the largest {}.",
        cut.cases.len(),
        slow.collect::<Vec<_>>().join("; ")
    )
}
