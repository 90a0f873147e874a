//! Curves and knots: measures, names and tight shapes.

use std::path::PathBuf;
use std::sync::LazyLock;

use nalgebra::Vector3;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use topo_core::{Polyline, thickness};
use topo_knots::{
    KnotEntry, KnotTable, KnotType, TightKnot, TightenSettings, ideal, identify_open,
    read_components,
};

use crate::attend::quietly;
use crate::refusal::Refusal;

/// The knots that are always there.
static BUILTIN: LazyLock<KnotTable> = LazyLock::new(KnotTable::builtin);

/// The table of knots with those of a folder.
fn with_table<R>(
    folder: Option<&PathBuf>,
    use_it: impl FnOnce(&KnotTable) -> Result<R, Refusal>,
) -> Result<R, Refusal> {
    match folder {
        None => use_it(&BUILTIN),
        Some(folder) => use_it(&KnotTable::builtin_and(Some(folder))?),
    }
}

/// Vertices as rows of an array, handed over without a copy.
pub fn rows<'py>(
    py: Python<'py>,
    vertices: impl ExactSizeIterator<Item = Vector3<f64>>,
) -> Bound<'py, PyArray2<f64>> {
    let n = vertices.len();
    let flat: Vec<f64> = vertices.flat_map(|v| [v.x, v.y, v.z]).collect();
    // the lengths agree: three numbers a vertex
    Array2::from_shape_vec((n, 3), flat)
        .unwrap_or_default()
        .into_pyarray(py)
}

/// The rows of an array of shape (n, 3) as vertices.
pub fn vertices(points: &PyReadonlyArray2<'_, f64>) -> Vec<Vector3<f64>> {
    let points = points.as_array();
    points
        .rows()
        .into_iter()
        .map(|r| Vector3::new(r[0], r[1], r[2]))
        .collect()
}

/// The curve through the rows of an array.
pub fn polyline(points: &PyReadonlyArray2<'_, f64>, closed: bool) -> Result<Polyline, Refusal> {
    Ok(Polyline::new(vertices(points), closed)?)
}

/// Refuses what is no curve.
#[pyfunction]
pub fn check(points: PyReadonlyArray2<'_, f64>, closed: bool) -> PyResult<()> {
    polyline(&points, closed)?;
    Ok(())
}

/// Length, writhe, average crossing number, thickness and length over thickness of a curve.
#[pyfunction]
pub fn measure(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    closed: bool,
) -> PyResult<(f64, f64, f64, f64, f64)> {
    let curve = polyline(&points, closed)?;
    Ok(py.detach(|| {
        let thickness = thickness(&curve);
        let (writhe, crossings) = (curve.writhe(), curve.average_crossing_number());
        (
            curve.length(),
            writhe,
            crossings,
            thickness.tau,
            curve.ropelength(),
        )
    }))
}

/// The curve with equal edges.
#[pyfunction]
pub fn resampled<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'_, f64>,
    closed: bool,
    n_edges: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let curve = polyline(&points, closed)?;
    let even = curve.resampled(n_edges).map_err(Refusal::from)?;
    Ok(rows(py, even.vertices().iter().copied()))
}

/// The curves of a file: vertices, and whether they are closed.
#[pyfunction]
pub fn read_curves<'py>(
    py: Python<'py>,
    path: PathBuf,
) -> PyResult<Vec<(Bound<'py, PyArray2<f64>>, bool)>> {
    let curves = read_components(&path).map_err(Refusal::from)?;
    let one =
        |c: &topo_knots::CurveComponent| (rows(py, c.vertices.iter().copied()), c.is_closed());
    Ok(curves.iter().map(one).collect())
}

/// The knot type of a curve.
#[derive(Debug, Clone, Default, IntoPyObject)]
pub struct Named {
    name: Option<String>,
    candidates: Vec<String>,
    certain: bool,
    handedness: String,
    crossings: usize,
    determinant: u64,
    signature: i64,
    alexander: String,
    jones: Option<String>,
    description: String,
    /// Shares of the closures of an open curve.
    closures: Vec<(String, f64)>,
}

fn named(kind: &KnotType) -> Named {
    Named {
        name: kind.name().map(ToString::to_string),
        candidates: kind.candidates().map(ToString::to_string).collect(),
        certain: kind.is_certain(),
        handedness: format!("{:?}", kind.handedness).to_lowercase(),
        crossings: kind.n_crossings,
        determinant: kind.invariants.determinant,
        signature: i64::from(kind.invariants.signature),
        alexander: kind.invariants.alexander_text(),
        jones: kind.jones.as_ref().map(topo_knots::Jones::text),
        description: kind.describe(),
        closures: Vec::new(),
    }
}

/// Names a curve.
#[pyfunction]
pub fn identify(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    closed: bool,
    closures: usize,
    seed: u64,
    folder: Option<PathBuf>,
) -> PyResult<Named> {
    let curve = vertices(&points);
    quietly(py, move |_| {
        with_table(folder.as_ref(), |table| {
            if closed {
                return Ok(named(&topo_knots::identify(&curve, table)?));
            }
            let open = identify_open(&curve, closures, seed, table)?;
            let mut first = open.types.first().map(named).unwrap_or_default();
            let is_sure = open
                .distribution
                .first()
                .is_some_and(|(_, share)| *share > 0.5);
            first.name = first.name.filter(|_| is_sure);
            first.certain &= open.distribution.len() == 1;
            first.closures = open.distribution;
            Ok(first)
        })
    })
}

/// What the table says of a knot.
#[pyfunction]
pub fn knot<'py>(
    py: Python<'py>,
    name: &str,
    folder: Option<PathBuf>,
) -> PyResult<Bound<'py, PyDict>> {
    let entry = with_table(folder.as_ref(), |table| Ok(table.get(name)?.into_owned()))?;
    let said = PyDict::new(py);
    said.set_item("name", &entry.name)?;
    said.set_item("crossing_number", entry.crossing_number)?;
    said.set_item("braid", &entry.braid)?;
    said.set_item(
        "amphichiral",
        entry.chirality == topo_knots::Chirality::Amphichiral,
    )?;
    said.set_item("determinant", entry.invariants.determinant)?;
    said.set_item("signature", entry.invariants.signature)?;
    said.set_item("alexander", entry.invariants.alexander_text())?;
    said.set_item("length_over_radius", entry.length_over_radius)?;
    Ok(said)
}

/// Names of the prime knots up to a number of crossings, and of those of a folder.
#[pyfunction]
pub fn knots(crossings: u32, folder: Option<PathBuf>) -> PyResult<Vec<String>> {
    Ok(with_table(folder.as_ref(), |table| {
        let named = |k: &KnotEntry| k.name.clone();
        let mut names: Vec<String> = table.primes_up_to(crossings).map(named).collect();
        let own = table.iter().filter(|k| BUILTIN.get(&k.name).is_err());
        names.extend(own.map(named));
        Ok(names)
    })?)
}

/// The tight shape of a knot.
#[pyfunction]
pub fn tight<'py>(
    py: Python<'py>,
    name: String,
    quality: &str,
    folder: Option<PathBuf>,
    cache: Option<PathBuf>,
) -> PyResult<Bound<'py, PyDict>> {
    let settings = match quality {
        "draft" => TightenSettings::draft(),
        "standard" => TightenSettings::standard(),
        "paper" => TightenSettings::fine(),
        _ => Err(Refusal::value(
            "quality",
            quality,
            "give draft, standard or paper",
        ))?,
    };
    let found = quietly(py, move |_| {
        with_table(folder.as_ref(), |table| {
            let shape = ideal(&*table.get(&name)?, &settings, cache.as_deref())?;
            Ok((shape.centreline()?, shape))
        })
    });
    let (
        centreline,
        TightKnot {
            name,
            curve,
            length_over_radius,
            certificate,
            ..
        },
    ) = found?;
    let said = PyDict::new(py);
    said.set_item("name", name)?;
    said.set_item("points", rows(py, curve.vertices().iter().copied()))?;
    said.set_item(
        "centreline",
        rows(py, centreline.vertices().iter().copied()),
    )?;
    said.set_item("length_over_radius", length_over_radius)?;
    said.set_item("thickness", certificate.tau())?;
    said.set_item("writhe", certificate.writhe)?;
    said.set_item("n_struts", certificate.n_struts)?;
    said.set_item("n_kinks", certificate.n_kinks)?;
    said.set_item("residual", certificate.residual)?;
    said.set_item("converged", certificate.converged)?;
    Ok(said)
}
