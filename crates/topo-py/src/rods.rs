//! The elastic battery: charge, cut, discharge.

use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use topo_analysis::{DischargeTimes, ELASTIC_SHARES};
use topo_core::{DischargeCurve, Interrupt, StopReason};
use topo_lab::{ElasticScene, Preset, perturbed};
use topo_rod::{CutSite, Guards, PhaseReport, RodError, RodSample, RodState, RunHooks, RunRecord};

use crate::attend::{Checkpoint, Leave, Reporter, attend, hooks, timed};
use crate::curves::{polyline, rows};
use crate::refusal::Refusal;
use crate::values::settings;

/// Area of the cross-section, in h².
const AREA: f64 = std::f64::consts::PI;

/// A tied fibre.
#[pyclass(frozen)]
pub struct RodBattery {
    battery: topo_rod::RodBattery,
    scene: ElasticScene,
}

fn preset(name: &str) -> Result<Preset, Refusal> {
    let all = [
        Preset::Draft,
        Preset::Standard,
        Preset::Paper,
        Preset::Reference,
    ];
    let remedy = "give draft, standard, paper or reference";
    let named = all.into_iter().find(|preset| preset.name() == name);
    named.ok_or_else(|| Refusal::value("quality", name, remedy))
}

#[pymethods]
impl RodBattery {
    /// `rod` and `accuracy` say what differs from the settings of the preset, by the names of their fields.
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        quality: &str,
        rod: &Bound<'_, PyDict>,
        accuracy: &Bound<'_, PyDict>,
        imperfection: f64,
        seed: u64,
    ) -> PyResult<Self> {
        let scene = ElasticScene::published(preset(quality)?);
        let rod = settings(&scene.rod, rod)?;
        let accuracy = settings(&scene.accuracy, accuracy)?;
        let curve = polyline(&points, true)?;
        let made = topo_rod::RodBattery::new(&rod, &accuracy, Guards::default(), &curve);
        let mut battery = made.map_err(Refusal::from)?;
        if imperfection > 0.0 {
            let start = battery.centreline();
            let size = imperfection * start.length() / battery.tube().start_length;
            let moved = perturbed(start, size, seed).map_err(Refusal::from)?;
            battery = battery.disturbed(&moved).map_err(Refusal::from)?;
        }
        Ok(Self { battery, scene })
    }

    #[getter]
    fn ropelength(&self) -> f64 {
        self.battery.ropelength()
    }

    /// Length, contact diameter, friction range and length of the start curve, in h.
    #[getter]
    fn tube(&self) -> [f64; 4] {
        let tube = self.battery.tube();
        [
            tube.length,
            tube.contact_diameter,
            tube.friction_range,
            tube.start_length,
        ]
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        rows(py, self.battery.start().vertices().iter().copied())
    }

    /// Lets the closed rod relax.
    fn charge(
        &self,
        py: Python<'_>,
        given: &Bound<'_, PyDict>,
        observer: Option<Bound<'_, PyAny>>,
        checkpoint: Checkpoint,
    ) -> PyResult<ChargedRod> {
        let settings = settings(&self.scene.charge, given)?;
        let battery = self.battery.clone();
        let work = move |hooks: &mut RunHooks<'_>| battery.charge(&settings, hooks);
        let (charged, wall_seconds) = phase(py, "charge", observer, checkpoint, work)?;
        let scene = self.scene.clone();
        Ok(ChargedRod {
            charged,
            wall_seconds,
            scene,
        })
    }
}

/// A charged fibre.
#[pyclass(frozen)]
pub struct ChargedRod {
    charged: topo_rod::ChargedRod,
    /// What charging it took.
    wall_seconds: f64,
    scene: ElasticScene,
}

#[pymethods]
impl ChargedRod {
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        rows(py, self.charged.state().vertices().iter().copied())
    }

    /// θ'h at the vertices.
    #[getter]
    fn twist<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        twist(self.charged.state()).into_pyarray(py)
    }

    /// In E_b h².
    #[getter]
    fn energy_density<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let density = self.charged.density().iter().map(|w| w * AREA);
        density.collect::<Vec<_>>().into_pyarray(py)
    }

    /// Places s/L of the local maxima of the smoothed density within `share` of the largest, largest first.
    fn cut_candidates(&self, share: f64) -> Vec<f64> {
        let candidates = self.charged.cut_candidates(share);
        candidates.iter().map(|c| c.at).collect()
    }

    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = record(py, self.charged.record(), self.charged.battery())?;
        dict.set_item("wall_seconds", self.wall_seconds)?;
        Ok(dict)
    }

    fn cut(&self, at: Option<f64>) -> PyResult<CutRod> {
        let site = at.map_or(CutSite::MaximumEnergyDensity, CutSite::At);
        let cut = self.charged.cut(site).map_err(Refusal::from)?;
        let scene = self.scene.clone();
        Ok(CutRod { cut, scene })
    }
}

/// A fibre that has just been cut.
#[pyclass(frozen)]
pub struct CutRod {
    cut: topo_rod::CutRod,
    scene: ElasticScene,
}

#[pymethods]
impl CutRod {
    /// Place s/L.
    #[getter]
    fn at(&self) -> f64 {
        self.cut.at
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        rows(py, self.cut.state.vertices().iter().copied())
    }

    /// Lets the open rod go.
    fn discharge<'py>(
        &self,
        py: Python<'py>,
        given: &Bound<'_, PyDict>,
        observer: Option<Bound<'_, PyAny>>,
        checkpoint: Checkpoint,
    ) -> PyResult<Bound<'py, PyDict>> {
        let settings = settings(&self.scene.discharge, given)?;
        let cut = self.cut.clone();
        let work = move |hooks: &mut RunHooks<'_>| cut.discharge(&settings, hooks);
        let (run, wall_seconds) = phase(py, "discharge", observer, checkpoint, work)?;
        let dict = record(py, &run.record, self.cut.charged.battery())?;
        dict.set_item("wall_seconds", wall_seconds)?;
        dict.set_item("at", run.at)?;
        dict.set_item("removed", run.removed)?;
        dict.set_item("start", run.start)?;
        dict.set_item("after_cut", run.after_cut)?;
        dict.set_item("parted", run.parted)?;
        let parts = run.record.report.own.parts.elastic();
        let times = times(&run.record.curve, &parts, run.start);
        dict.set_item(
            "times",
            ELASTIC_SHARES.map(|share| (share, times.at(share).map(|t| t.value))),
        )?;
        Ok(dict)
    }
}

/// Runs a phase and gives the seconds it took; an observer sees copies of its samples.
fn phase<T: Send + 'static>(
    py: Python<'_>,
    name: &'static str,
    observer: Option<Bound<'_, PyAny>>,
    checkpoint: Checkpoint,
    work: impl FnOnce(&mut RunHooks<'_>) -> Result<T, RodError> + Send + 'static,
) -> PyResult<(T, f64)> {
    let interrupt = Interrupt::new();
    let (token, wants) = (interrupt.clone(), observer.is_some());
    let leave = match checkpoint {
        Some(_) => Leave::WhenKept,
        None => Leave::AtOnce,
    };
    let work = move |reporter: &Reporter<Box<RodSample>, (T, f64)>| {
        let mut see = |s: &RodSample| reporter.report(Box::new(s.clone()));
        let hooks: RunHooks<'_> = hooks(&token, &checkpoint);
        let mut hooks = if wants {
            hooks.with_samples(&mut see)
        } else {
            hooks
        };
        Ok(timed(|| work(&mut hooks))?)
    };
    let listen = |py: Python<'_>, sample: Box<RodSample>| match &observer {
        Some(to) => to.call1((seen(py, name, &sample)?,)).map(drop),
        None => Ok(()),
    };
    attend(py, &interrupt, leave, listen, work)
}

/// A sample as an observer sees it.
fn seen<'py>(py: Python<'py>, phase: &str, s: &RodSample) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("phase", phase)?;
    dict.set_item("time", s.time)?;
    for (name, of) in COLUMNS {
        dict.set_item(name, of(s))?;
    }
    dict.set_item("points", rows(py, s.state.vertices().iter().copied()))?;
    Ok(dict)
}

/// A number of a sample, by its name.
type Column = (&'static str, fn(&RodSample) -> f64);

/// Those besides its time.
const COLUMNS: [Column; 6] = [
    ("energy", RodSample::elastic),
    ("writhe", |s| s.writhe),
    ("total_twist", |s| s.total_twist),
    ("n_contacts", |s| s.n_contacts as f64),
    ("min_distance", |s| s.min_distance.unwrap_or(f64::NAN)),
    ("end_to_end", |s| s.end_to_end),
];

fn times(curve: &DischargeCurve, parts: &[&str], start: f64) -> DischargeTimes {
    DischargeTimes::of(curve, parts, start, &ELASTIC_SHARES)
}

/// First time at which an energy has fallen by a share of `start − end`; none if it never has.
#[pyfunction]
pub fn release_time(
    time: PyReadonlyArray1<'_, f64>,
    energy: PyReadonlyArray1<'_, f64>,
    start: f64,
    end: f64,
    share: f64,
) -> PyResult<Option<f64>> {
    if !(share > 0.0 && share < 1.0) {
        let remedy = "a share released lies between 0 and 1, such as 0.99";
        Err(Refusal::value("share", share, remedy))?;
    }
    let mut curve = DischargeCurve::new(["energy"], Vec::<String>::new());
    for (t, e) in time.as_array().iter().zip(energy.as_array()) {
        let wrong = |e: topo_core::DischargeError| Refusal::value("energy", t, &e.to_string());
        curve.push(*t, &[*e], &[]).map_err(wrong)?;
    }
    let times = DischargeTimes::between(&curve, &["energy"], [start, end], &[share]);
    Ok(times.at(share).map(|t| t.value))
}

fn twist(state: &RodState) -> Vec<f64> {
    let l0 = state.rest_length();
    state.twists().iter().map(|t| t / l0).collect()
}

/// A curve of energies: time, parts and channels.
pub fn curve<'py>(
    py: Python<'py>,
    curve: &DischargeCurve,
    dict: &Bound<'py, PyDict>,
) -> PyResult<()> {
    let array = |values: &[f64]| PyArray1::from_slice(py, values);
    let named = |names: &[String], series: &[Vec<f64>]| -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (name, values) in names.iter().zip(series) {
            all.set_item(name, array(values))?;
        }
        Ok(all)
    };
    dict.set_item("time", array(curve.time()))?;
    dict.set_item("parts", named(curve.parts(), curve.stored())?)?;
    dict.set_item("dissipated", named(curve.channels(), curve.dissipated())?)
}

/// How a phase ended.
pub fn stop(dict: &Bound<'_, PyDict>, stop: &StopReason) -> PyResult<()> {
    dict.set_item("stop", stop.to_string())?;
    dict.set_item("finished", stop.is_success())
}

fn record<'py>(
    py: Python<'py>,
    record: &RunRecord,
    battery: &topo_rod::RodBattery,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    curve(py, &record.curve, &dict)?;
    let parts = record.report.own.parts.elastic();
    let columns: Vec<&[f64]> = parts
        .iter()
        .filter_map(|p| record.curve.series(p))
        .collect();
    let sum = |i: usize| columns.iter().map(|c| c[i]).sum::<f64>();
    let energy: Vec<f64> = (0..record.curve.len()).map(sum).collect();
    dict.set_item("energy", energy.into_pyarray(py))?;
    dict.set_item("samples", samples(py, &record.samples, battery)?)?;
    let PhaseReport {
        n_steps,
        rejections,
        ledger_residual,
        cpu_seconds,
        own,
        ..
    } = &record.report;
    stop(&dict, &record.report.stop)?;
    dict.set_item("n_steps", n_steps)?;
    dict.set_item("n_rejected", rejections.total())?;
    dict.set_item("ledger_residual", ledger_residual)?;
    dict.set_item("cpu_seconds", cpu_seconds)?;
    dict.set_item("min_distance_over_contact", own.min_distance_over_contact)?;
    dict.set_item("link_drift", own.link_drift)?;
    Ok(dict)
}

/// The rod at output times: numbers, and arrays whose first index is time.
fn samples<'py>(
    py: Python<'py>,
    samples: &[RodSample],
    battery: &topo_rod::RodBattery,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let column = |name: &str, of: &dyn Fn(&RodSample) -> f64| {
        dict.set_item(
            name,
            samples.iter().map(of).collect::<Vec<_>>().into_pyarray(py),
        )
    };
    column("time", &|s| s.time)?;
    for (name, of) in COLUMNS {
        column(name, &of)?;
    }
    let n = samples.first().map_or(0, |s| s.state.n_vertices());
    let states = || samples.iter().map(|s| &s.state);
    let points = states().flat_map(|s| s.vertices().iter().flat_map(|x| [x.x, x.y, x.z]));
    let points = Array3::from_shape_vec((samples.len(), n, 3), points.collect());
    dict.set_item("points", points.unwrap_or_default().into_pyarray(py))?;
    let flat = |values: Vec<f64>| Array2::from_shape_vec((samples.len(), n), values);
    let twists = flat(states().flat_map(twist).collect());
    dict.set_item("twist", twists.unwrap_or_default().into_pyarray(py))?;
    let density = |s| battery.energy_density(s).into_iter().map(|w| w * AREA);
    let density = flat(states().flat_map(density).collect());
    dict.set_item(
        "energy_density",
        density.unwrap_or_default().into_pyarray(py),
    )?;
    Ok(dict)
}
