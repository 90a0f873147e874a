//! Scenes: what `topo run` does, for Python.

use std::path::PathBuf;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use topo_lab::{
    Battery, Colloid, Elastic, Event, Goal, Options, Scene, SweepSettings, parse_scene, read_scene,
};

use crate::attend::{Leave, Reporter, attend};
use crate::refusal::Refusal;
use crate::values::table;

/// The batteries of the package.
const BATTERIES: [&dyn Battery; 2] = [&Elastic, &Colloid];

/// A dictionary as the text of a scene.
#[pyfunction]
pub fn scene_text(scene: &Bound<'_, PyDict>) -> PyResult<String> {
    let wrong = |e: toml::ser::Error| Refusal::value("scene", scene, &e.to_string()).into();
    toml::to_string(&table(scene, "")?).map_err(wrong)
}

/// What is asked for besides the scene.
#[derive(FromPyObject)]
pub struct Asked {
    path: PathBuf,
    text: Option<String>,
    out: PathBuf,
    jobs: usize,
    fresh: bool,
    fields: bool,
    preset: Option<String>,
    accuracy: Option<f64>,
    budget: Option<String>,
    cuts: Option<String>,
    knots: Option<PathBuf>,
}

impl Asked {
    fn goal(&self) -> Result<Option<Goal>, Refusal> {
        let refused =
            |key, value: String| move |remedy: String| Refusal::value(key, value, &remedy);
        Ok(match (self.accuracy, &self.budget) {
            (Some(_), Some(text)) => {
                let remedy = "accuracy is given too: keep one of them";
                return Err(Refusal::value("budget", text, remedy));
            }
            (Some(error), None) => {
                Some(Goal::accuracy(error).map_err(refused("accuracy", error.to_string()))?)
            }
            (None, Some(text)) => {
                Some(Goal::budget(text).map_err(refused("budget", text.clone()))?)
            }
            (None, None) => None,
        })
    }

    fn scene(&self) -> Result<Box<dyn Scene>, Refusal> {
        let scene = match (&self.text, &self.preset) {
            (None, None) => read_scene(&BATTERIES, &self.path)?,
            (Some(text), None) => parse_scene(&BATTERIES, text, &self.path)?,
            (text, Some(preset)) => {
                let text = match text {
                    Some(text) => text.clone(),
                    None => {
                        // for the message of a file that is none
                        read_scene(&BATTERIES, &self.path)?;
                        std::fs::read_to_string(&self.path).unwrap_or_default()
                    }
                };
                parse_scene(&BATTERIES, &with_preset(&text, preset)?, &self.path)?
            }
        };
        Ok(scene)
    }
}

/// The text of a scene with another preset; lines before it stay where they are.
fn with_preset(text: &str, preset: &str) -> Result<String, Refusal> {
    let wrong = |remedy: &str| Refusal::value("quality", preset, remedy);
    let mut scene: toml::Table = toml::from_str(text).map_err(|e| wrong(e.message()))?;
    if scene.contains_key("nematic") {
        return Err(wrong(
            "a colloid has no presets: give spacing and tolerance, accuracy or budget",
        ));
    }
    let has_budget = scene.contains_key("budget");
    match scene.get_mut("accuracy") {
        None if has_budget => Err(wrong("the scene has a budget: keep one")),
        None => Ok(format!("{text}\n[accuracy]\npreset = \"{preset}\"\n")),
        Some(toml::Value::Table(accuracy)) => {
            accuracy.insert("preset".to_owned(), preset.into());
            toml::to_string(&scene).map_err(|e| wrong(&e.to_string()))
        }
        Some(_) => Err(wrong("the scene has an accuracy: keep one")),
    }
}

/// What a run says, owned.
enum Notice {
    Begin(usize, usize, f64),
    Replaced(Vec<String>, String),
    Knot(String, f64),
    Working(String, String),
    Case(String, usize, String, f64),
}

impl Notice {
    fn of(event: Event<'_>) -> Option<Self> {
        Some(match event {
            Event::Begin {
                n_cases,
                n_reused,
                estimate,
            } => Self::Begin(n_cases, n_reused, estimate.wall_seconds),
            Event::Replaced { names, reason } => Self::Replaced(names.to_vec(), reason.to_owned()),
            Event::Knot {
                name,
                length_over_radius,
            } => Self::Knot(name.to_owned(), length_over_radius),
            Event::Working { name, what } => Self::Working(name.to_owned(), what.to_owned()),
            Event::Case {
                name,
                n_done,
                expected,
                warnings,
            } => Self::Case(name.to_owned(), n_done, warnings.to_owned(), expected),
            _ => return None,
        })
    }

    fn say(self, to: &Bound<'_, PyAny>) -> PyResult<()> {
        match self {
            Self::Begin(n, reused, seconds) => to.call1(("begin", n, reused, seconds)),
            Self::Replaced(names, reason) => to.call1(("replaced", names, reason)),
            Self::Knot(name, length) => to.call1(("knot", name, length)),
            Self::Working(name, what) => to.call1(("working", name, what)),
            Self::Case(name, n, warnings, expected) => {
                to.call1(("case", name, n, warnings, expected))
            }
        }
        .map(drop)
    }
}

/// What a run came to.
#[derive(Debug, Clone, Default, IntoPyObject)]
pub struct Ran {
    folder: PathBuf,
    lines: Vec<String>,
    warnings: Vec<String>,
    /// Cases and reasons.
    failed: Vec<(String, String)>,
    n_computed: usize,
    n_reused: usize,
    seconds: f64,
}

/// Runs a scene as `topo run` does; `listener` is called with what happens.
#[pyfunction]
pub fn run(py: Python<'_>, asked: Asked, listener: Option<Bound<'_, PyAny>>) -> PyResult<Ran> {
    let settings = SweepSettings {
        jobs: asked.jobs,
        fresh: asked.fresh,
        keep_fields: asked.fields,
        ..SweepSettings::new(&asked.out)
    };
    let out = asked.out.display().to_string();
    let interrupt = settings.interrupt.clone();
    let listen =
        |_: Python<'_>, notice: Notice| listener.as_ref().map_or(Ok(()), |to| notice.say(to));
    let work = move |reporter: &Reporter<Notice, Ran>| worked(&asked, &settings, reporter);
    let ran = attend(py, &interrupt, Leave::WhenKept, listen, work);
    ran.map_err(|error| stopped(py, error, &out))
}

fn worked(
    asked: &Asked,
    settings: &SweepSettings,
    reporter: &Reporter<Notice, Ran>,
) -> Result<Ran, Refusal> {
    let options = Options {
        cuts: asked.cuts.as_deref(),
        knots: asked.knots.as_deref(),
        fields: asked.fields,
        goal: asked.goal()?,
    };
    let progress = |event: Event<'_>| {
        if let Some(notice) = Notice::of(event) {
            reporter.report(notice);
        }
    };
    let mut scene = asked.scene()?;
    scene.change(&options)?;
    let mut experiment = scene.experiment()?;
    let choice = experiment.choose(settings.jobs)?;
    let folder = experiment.results(&settings.out);
    let swept = experiment.sweep(settings, &progress)?;
    let mut ran = Ran {
        lines: swept.lines(),
        warnings: swept.warnings(),
        n_computed: swept.n_computed(),
        n_reused: swept.n_reused(),
        seconds: swept.wall_seconds(),
        ..Ran::default()
    };
    let mut failed = swept.failed().to_vec();
    if let Some(choice) = choice.filter(|_| !swept.is_interrupted()) {
        ran.warnings.extend(choice.stale.clone());
        if let Some(checked) = swept.check(&choice, settings, &progress)? {
            if !checked.is_interrupted {
                checked.write(&folder)?;
            }
            failed.extend(checked.failed);
        }
    }
    ran.failed = failed.into_iter().map(|f| (f.case, f.reason)).collect();
    ran.folder = folder;
    Ok(ran)
}

/// Ctrl-C says what is kept.
fn stopped(py: Python<'_>, error: PyErr, out: &str) -> PyErr {
    if !error.is_instance_of::<PyKeyboardInterrupt>(py) {
        return error;
    }
    PyKeyboardInterrupt::new_err(format!(
        "finished cases are kept below {out}: the same call goes on from them, topobatteries.load reads them"
    ))
}
