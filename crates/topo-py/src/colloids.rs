//! The nematic battery: charge, switch, discharge.

use numpy::ndarray::{Array, Array2, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use topo_analysis::{DischargeTimes, NEMATIC_SHARES};
use topo_core::{Interrupt, Phase, Progress};
use topo_nematic::flow::FlowCoupling;
use topo_nematic::record::NematicSample;
use topo_nematic::ring::ring_line;
use topo_nematic::{
    ChargeSettings, ChargedNematic, DischargeSettings, EnergyParts, FlowParameters,
    NematicAccuracy, NematicBattery, NematicParameters, NematicState, RunHooks, SwitchSettings,
    Threads,
};

use crate::attend::{Checkpoint, Leave, Reporter, attend, hooks, timed};
use crate::refusal::Refusal;
use crate::rods::{curve, stop};
use crate::values::settings;

/// A colloid between plates.
#[pyclass(frozen)]
pub struct ColloidBattery(NematicBattery);

/// What a run says: how far it is, or the nematic at an output time.
enum Notice {
    Progress(Progress),
    Sample(Box<(NematicSample, Option<Points>)>),
}

type Points = Vec<[f64; 3]>;

impl Notice {
    fn say(self, py: Python<'_>, to: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let Some(to) = to else { return Ok(()) };
        let dict = match self {
            Self::Progress(p) => progress(py, &p)?,
            Self::Sample(seen) => {
                let dict = sample(py, &seen.0)?;
                dict.set_item("phase", "discharge")?;
                dict.set_item("ring", seen.1.map(|line| points(py, &line)))?;
                dict
            }
        };
        to.call1((dict,)).map(drop)
    }
}

fn progress<'py>(py: Python<'py>, p: &Progress) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let phase = match p.phase {
        Phase::Charge => "charge",
        Phase::FinalState => "final state",
        Phase::Discharge => "discharge",
    };
    dict.set_item("phase", phase)?;
    dict.set_item("step", p.step)?;
    dict.set_item("time", p.time)?;
    dict.set_item("energy", p.energy)?;
    dict.set_item("rms_field", p.rms_field)?;
    Ok(dict)
}

#[pymethods]
impl ColloidBattery {
    #[new]
    fn new(nematic: &Bound<'_, PyDict>, accuracy: &Bound<'_, PyDict>) -> PyResult<Self> {
        let parameters = settings(&NematicParameters::default(), nematic)?;
        let accuracy = NematicAccuracy {
            // results are the same to the bit
            threads: Threads::All,
            ..settings(&NematicAccuracy::default(), accuracy)?
        };
        let made = NematicBattery::new(&parameters, &accuracy).map_err(Refusal::from)?;
        Ok(Self(made))
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings().to_vec()
    }

    #[getter]
    fn cells(&self) -> [usize; 3] {
        self.0.grid().cells()
    }

    /// R²/(Γ L), in τ_N.
    #[getter]
    fn diffusion_time(&self) -> f64 {
        self.0.diffusion_time()
    }

    /// Lets the nematic relax with the pattern on the particle.
    fn charge(
        &self,
        py: Python<'_>,
        given: &Bound<'_, PyDict>,
        observer: Option<Bound<'_, PyAny>>,
        checkpoint: Checkpoint,
    ) -> PyResult<ChargedColloid> {
        let settings: ChargeSettings = settings(&ChargeSettings::default(), given)?;
        let (interrupt, battery) = (Interrupt::new(), self.0.clone());
        let (token, wants) = (interrupt.clone(), observer.is_some());
        let work = move |reporter: &Reporter<Notice, ChargedNematic>| {
            let mut see = |p: &Progress| reporter.report(Notice::Progress(*p));
            let hooks: RunHooks<'_> = hooks(&token, &checkpoint);
            let mut hooks = if wants {
                hooks.with_progress(&mut see)
            } else {
                hooks
            };
            Ok(battery.charge(&settings, &mut hooks)?)
        };
        let listen = |py: Python<'_>, notice: Notice| notice.say(py, observer.as_ref());
        Ok(ChargedColloid(attend(
            py,
            &interrupt,
            Leave::WhenKept,
            listen,
            work,
        )?))
    }
}

/// A charged colloid.
#[pyclass(frozen)]
pub struct ChargedColloid(ChargedNematic);

#[pymethods]
impl ChargedColloid {
    /// How it was charged.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let report = self.0.report();
        let dict = PyDict::new(py);
        dict.set_item("stop", report.stop.to_string())?;
        dict.set_item("finished", report.is_converged())?;
        dict.set_item("n_steps", report.n_steps)?;
        dict.set_item("rms_field", report.rms_field)?;
        dict.set_item("energy", report.energy.total())?;
        dict.set_item("parts", parts(py, &report.energy)?)?;
        dict.set_item("order_parameter", report.order.magnitude())?;
        dict.set_item("azimuth", report.order.azimuth())?;
        let minimum = report.minimum.as_ref();
        dict.set_item("state", minimum.map(|m| m.state.name()))?;
        dict.set_item("lowest_eigenvalue", minimum.map(|m| m.lowest_eigenvalue))?;
        Ok(dict)
    }

    /// Mean radius, height, strongest mode and its amplitude of the ring, and its line.
    fn ring<'py>(&self, py: Python<'py>, threshold: f64) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(ring) = self.0.ring(threshold) else {
            return Ok(None);
        };
        let dict = PyDict::new(py);
        dict.set_item("radius", ring.radius)?;
        dict.set_item("height", ring.height)?;
        dict.set_item("mode", ring.mode())?;
        dict.set_item("amplitude", ring.amplitude())?;
        dict.set_item("modes", PyArray1::from_slice(py, &ring.modes))?;
        let line = ring_line(self.0.state(), threshold).unwrap_or_default();
        dict.set_item("points", points(py, &line))?;
        Ok(Some(dict))
    }

    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        fields(py, self.0.state())
    }

    fn switch(&self, given: &Bound<'_, PyDict>) -> PyResult<SwitchedColloid> {
        let settings: SwitchSettings = settings(&SwitchSettings::default(), given)?;
        Ok(SwitchedColloid(
            self.0.switch(&settings).map_err(Refusal::from)?,
        ))
    }
}

/// A colloid whose anchoring has just been switched.
#[pyclass(frozen)]
pub struct SwitchedColloid(topo_nematic::SwitchedNematic);

/// Rings at output times.
type Rings = Vec<(f64, Points)>;

#[pymethods]
impl SwitchedColloid {
    /// Energies after the switch and removed by it.
    #[getter]
    fn energies(&self) -> [f64; 2] {
        [self.0.start(), self.0.removed()]
    }

    /// Lets the nematic go.
    fn discharge<'py>(
        &self,
        py: Python<'py>,
        given: &Bound<'_, PyDict>,
        flow: bool,
        observer: Option<Bound<'_, PyAny>>,
        checkpoint: Checkpoint,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut settings: DischargeSettings = settings(&DischargeSettings::default(), given)?;
        settings.flow = flow.then(FlowParameters::default);
        let (interrupt, switched) = (Interrupt::new(), self.0.clone());
        let (token, wants) = (interrupt.clone(), observer.is_some());
        let work = move |reporter: &Reporter<Notice, ((topo_nematic::Discharge, f64), Rings)>| {
            let mut rings: Rings = Vec::new();
            let mut see = |s: &NematicSample, state: &NematicState, _: Option<&FlowCoupling>| {
                let line = ring_line(state, settings.ring_threshold);
                if wants {
                    reporter.report(Notice::Sample(Box::new((s.clone(), line.clone()))));
                }
                rings.extend(line.map(|line| (s.time, line)));
            };
            let hooks: RunHooks<'_> = hooks(&token, &checkpoint);
            let mut hooks = hooks.with_samples(&mut see);
            let run = timed(|| switched.discharge(&settings, &mut hooks))?;
            Ok((run, rings))
        };
        let listen = |py: Python<'_>, notice: Notice| notice.say(py, observer.as_ref());
        let ((run, wall_seconds), rings) = attend(py, &interrupt, Leave::WhenKept, listen, work)?;
        let dict = discharged(py, &run, &rings)?;
        dict.set_item("wall_seconds", wall_seconds)?;
        Ok(dict)
    }
}

fn discharged<'py>(
    py: Python<'py>,
    run: &topo_nematic::Discharge,
    rings: &Rings,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let (record, report) = (&run.record, &run.record.report);
    curve(py, &record.curve, &dict)?;
    let energy: Vec<f64> = (0..record.curve.len())
        .map(|i| record.curve.stored_total(i))
        .collect();
    dict.set_item("energy", energy.into_pyarray(py))?;
    let seen: PyResult<Vec<_>> = record.samples.iter().map(|s| sample(py, s)).collect();
    dict.set_item("samples", seen?)?;
    let rings: Vec<_> = rings
        .iter()
        .map(|(t, line)| (*t, points(py, line)))
        .collect();
    dict.set_item("rings", rings)?;
    dict.set_item("removed", run.removed)?;
    dict.set_item("start", run.start)?;
    dict.set_item("final", run.final_state.energy)?;
    dict.set_item("final_source", run.final_state.source.name())?;
    dict.set_item("stored", run.stored)?;
    stop(&dict, &report.stop)?;
    dict.set_item("n_steps", report.n_steps)?;
    dict.set_item("n_rejected", report.rejections.total())?;
    dict.set_item("ledger_residual", report.ledger_residual)?;
    dict.set_item("cpu_seconds", report.cpu_seconds)?;
    dict.set_item("max_speed", report.own.flow.as_ref().map(|f| f.max_speed))?;
    let ends = [run.start, run.final_state.energy];
    let times = DischargeTimes::between(&record.curve, &EnergyParts::NAMES, ends, &NEMATIC_SHARES);
    dict.set_item(
        "times",
        NEMATIC_SHARES.map(|share| (share, times.at(share).map(|t| t.value))),
    )?;
    dict.set_item("fields", fields(py, &run.state)?)?;
    Ok(dict)
}

fn parts<'py>(py: Python<'py>, energy: &EnergyParts) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in EnergyParts::NAMES.iter().zip(energy.as_array()) {
        dict.set_item(name, value)?;
    }
    Ok(dict)
}

fn sample<'py>(py: Python<'py>, s: &NematicSample) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("time", s.time)?;
    dict.set_item("energy", s.energy.total())?;
    dict.set_item("order_parameter", s.order.magnitude())?;
    dict.set_item("ring_radius", s.ring.as_ref().map(|r| r.radius))?;
    dict.set_item("max_speed", s.max_speed)?;
    dict.set_item("flow_correlation", s.flow_correlation)?;
    Ok(dict)
}

fn points<'py>(py: Python<'py>, line: &[[f64; 3]]) -> Bound<'py, PyArray2<f64>> {
    let flat: Vec<f64> = line.iter().flatten().copied().collect();
    Array2::from_shape_vec((line.len(), 3), flat)
        .unwrap_or_default()
        .into_pyarray(py)
}

/// Order, director, tensor and fluid of every cell, z first and x last, and where the first cell lies.
fn fields<'py>(py: Python<'py>, state: &NematicState) -> PyResult<Bound<'py, PyDict>> {
    let grid = state.grid();
    let [nx, ny, nz] = grid.cells();
    let wrong = |e: numpy::ndarray::ShapeError| PyRuntimeError::new_err(e.to_string());
    let (order, director, fluid) = py.detach(|| {
        let mut fluid = Vec::with_capacity(grid.n_cells());
        for k in 0..nz {
            for j in 0..ny {
                fluid.extend((0..nx).map(|i| state.is_fluid([i, j, k])));
            }
        }
        let director: Vec<f64> = state.director_field().into_iter().flatten().collect();
        (state.order_field(), director, fluid)
    });
    let dict = PyDict::new(py);
    let shape = (nz, ny, nx);
    let order = Array3::from_shape_vec(shape, order).map_err(wrong)?;
    dict.set_item("order", order.into_pyarray(py))?;
    let director = Array::from_shape_vec((nz, ny, nx, 3), director).map_err(wrong)?;
    dict.set_item("director", director.into_pyarray(py))?;
    let tensor = Array::from_shape_vec((5, nz, ny, nx), state.q_tensor().to_vec());
    dict.set_item("q_tensor", tensor.map_err(wrong)?.into_pyarray(py))?;
    let fluid = Array3::from_shape_vec(shape, fluid).map_err(wrong)?;
    dict.set_item("fluid", fluid.into_pyarray(py))?;
    let centre = state.particle().map_or([0.0; 3], |p| p.centre());
    let first = grid.centre([0, 0, 0]);
    dict.set_item("origin", [0, 1, 2].map(|a| first[a] - centre[a]))?;
    dict.set_item("spacing", grid.spacing())?;
    Ok(dict)
}
