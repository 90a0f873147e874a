//! Curves and time series of a case.

use super::read_csv;
use crate::error::ViewError;
use nalgebra::Vector3;
use serde::Deserialize;
use std::path::Path;

/// A vertex of `charged.csv` or `snapshots.csv`: lengths in h, density in E_b h^2.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
struct Vertex {
    /// Of a link: counted from 1.
    #[serde(default)]
    component: usize,
    #[serde(default)]
    cut: f64,
    #[serde(default)]
    time: f64,
    #[serde(default)]
    s: f64,
    x: f64,
    y: f64,
    z: f64,
    #[serde(default)]
    energy_density: f64,
}

/// The vertices of a table; those of a link are refused, as pictures would join its components.
fn vertices(path: &Path) -> Result<Vec<Vertex>, ViewError> {
    let all: Vec<Vertex> = read_csv(path)?;
    if all.iter().any(|v| v.component > 1) {
        return Err(ViewError::Table {
            path: path.to_owned(),
            reason: "it is a link: only shapes of one component are drawn".to_owned(),
        });
    }
    Ok(all)
}

/// A curve with its arc length and energy density.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    /// Arc length of the vertices.
    pub s: Vec<f64>,
    /// Vertices.
    pub points: Vec<Vector3<f64>>,
    /// Energy density at the vertices.
    pub density: Vec<f64>,
}

impl Curve {
    /// Reads `charged.csv` of a case, or a knot's `x,y,z`.
    pub fn read(path: &Path) -> Result<Self, ViewError> {
        let mut curve = Self::default();
        for v in vertices(path)? {
            curve.push(&v);
        }
        if curve.points.len() < 3 {
            let reason = format!("{} vertices, at least 3 are needed", curve.points.len());
            return Err(ViewError::Table {
                path: path.to_owned(),
                reason,
            });
        }
        Ok(curve)
    }

    fn push(&mut self, v: &Vertex) {
        self.s.push(v.s);
        self.points.push(Vector3::new(v.x, v.y, v.z));
        self.density.push(v.energy_density);
    }
}

/// An open curve at a time of a discharge.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Place of the cut.
    pub cut: f64,
    /// Time in T0.
    pub time: f64,
    /// The curve.
    pub curve: Curve,
}

/// Reads `snapshots.csv`, in order of the file.
pub fn snapshots(path: &Path) -> Result<Vec<Snapshot>, ViewError> {
    let mut shots: Vec<Snapshot> = Vec::new();
    for v in vertices(path)? {
        match shots.last_mut() {
            Some(s) if s.cut == v.cut && s.time == v.time => s.curve.push(&v),
            _ => {
                let mut curve = Curve::default();
                curve.push(&v);
                shots.push(Snapshot {
                    cut: v.cut,
                    time: v.time,
                    curve,
                });
            }
        }
    }
    shots.retain(|s| s.curve.points.len() >= 3);
    Ok(shots)
}

/// A row of `series.csv` as far as figures need it.
#[derive(Debug, Clone, Deserialize)]
pub struct Moment {
    /// Place of the cut.
    pub cut: f64,
    /// Time in T0.
    pub time: f64,
    /// Elastic energy in E0.
    pub energy: f64,
    /// Most probable knot type of the closed-up curve, empty where it was not determined.
    pub knot: Option<String>,
}

/// Reads `series.csv`.
pub fn series(path: &Path) -> Result<Vec<Moment>, ViewError> {
    read_csv(path)
}
