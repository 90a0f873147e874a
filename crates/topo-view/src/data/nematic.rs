//! The nematic sweep and the files of its cases.

use super::read_csv;
use crate::error::ViewError;
use nalgebra::Vector3;
use std::path::{Path, PathBuf};
use topo_analysis::{LinePoint, NematicRow, NematicSample, SlicePoint};

/// `nematic/sweep.csv`: runs over q, without and with flow.
#[derive(Debug, Clone)]
pub struct NematicSweep {
    /// Folder of the sweep.
    pub folder: PathBuf,
    /// Runs without flow, by q; those with flow where a sweep has only such.
    pub rows: Vec<NematicRow>,
    /// Runs with flow, by q.
    pub flowing: Vec<NematicRow>,
}

impl NematicSweep {
    /// Reads the sweep and keeps the rows of one radius, spacing and boundary scheme: those with the most rows.
    pub fn read(results: &Path) -> Result<Self, ViewError> {
        let folder = results.join("nematic");
        let path = folder.join("sweep.csv");
        let mut all: Vec<NematicRow> = read_csv(&path)?;
        let key = |r: &NematicRow| (r.radius.to_bits(), r.spacing.to_bits(), r.boundary.clone());
        let count = |k: &(u64, u64, String)| all.iter().filter(|r| key(r) == *k).count();
        let Some(main) = all.iter().map(key).max_by_key(count) else {
            return Err(ViewError::Table {
                path,
                reason: "no rows".to_owned(),
            });
        };
        all.retain(|r| key(r) == main);
        all.sort_by_key(|r| r.q);
        let (flowing, still): (Vec<_>, Vec<_>) = all.into_iter().partition(|r| r.flow.is_on());
        let rows = if still.is_empty() {
            flowing.clone()
        } else {
            still
        };
        Ok(Self {
            folder,
            rows,
            flowing,
        })
    }

    /// Folder of a case.
    pub fn case(&self, row: &NematicRow) -> PathBuf {
        self.folder.join(&row.case)
    }

    /// Rings of a case at the times kept; the charged state first, its time `None`.
    pub fn rings(&self, row: &NematicRow) -> Result<Vec<DefectLine>, ViewError> {
        rings(&self.case(row))
    }

    /// Slices of a case at the times kept; the charged state first, its time `None`.
    pub fn slices(&self, row: &NematicRow) -> Result<Vec<Slice>, ViewError> {
        slices(&self.case(row))
    }

    /// Time series of a case.
    pub fn series(&self, row: &NematicRow) -> Result<Vec<NematicSample>, ViewError> {
        read_csv(&self.case(row).join("series.csv"))
    }
}

/// Rings in the folder of a case at the times kept; the charged state first, its time `None`.
pub fn rings(case: &Path) -> Result<Vec<DefectLine>, ViewError> {
    let mut lines: Vec<DefectLine> = Vec::new();
    let mut last = None;
    for p in read_csv::<LinePoint>(&case.join("ring.csv"))? {
        let id = (p.time.map(f64::to_bits), p.line);
        if last != Some(id) {
            last = Some(id);
            lines.push(DefectLine {
                time: p.time,
                closed: p.closed,
                points: Vec::new(),
                angles: Vec::new(),
            });
        }
        if let Some(line) = lines.last_mut() {
            line.points.push(Vector3::new(p.x, p.y, p.z));
            line.angles.push(p.angle);
        }
    }
    Ok(lines)
}

/// Slices in the folder of a case at the times kept; the charged state first, its time `None`.
pub fn slices(case: &Path) -> Result<Vec<Slice>, ViewError> {
    let mut slices: Vec<Slice> = Vec::new();
    for p in read_csv::<SlicePoint>(&case.join("slices.csv"))? {
        if slices.last().is_none_or(|s| s.time != p.time) {
            slices.push(Slice {
                time: p.time,
                points: Vec::new(),
            });
        }
        if let Some(slice) = slices.last_mut() {
            slice.points.push(p);
        }
    }
    Ok(slices)
}

/// A defect line, relative to the particle's centre.
#[derive(Debug, Clone)]
pub struct DefectLine {
    /// Time since the switch; `None` in the charged state.
    pub time: Option<f64>,
    /// Whether it closes on itself.
    pub closed: bool,
    /// Its points.
    pub points: Vec<Vector3<f64>>,
    /// Angle of the profile at each point, in degrees.
    pub angles: Vec<Option<f64>>,
}

/// The vertical plane through the particle's centre at one time.
#[derive(Debug, Clone)]
pub struct Slice {
    /// Time since the switch; `None` in the charged state.
    pub time: Option<f64>,
    /// Its points.
    pub points: Vec<SlicePoint>,
}

impl Slice {
    /// Distance of neighbouring points along x.
    pub fn pitch(&self) -> f64 {
        let first = self.points.first().map_or(0.0, |p| p.x);
        let steps = self.points.iter().map(|p| (p.x - first).abs());
        let least = steps.filter(|d| *d > 1e-9).fold(f64::MAX, f64::min);
        if least < f64::MAX { least } else { 1.0 }
    }

    /// Half the widths along x and z, half a pitch beyond the outermost points.
    pub fn half_size(&self) -> [f64; 2] {
        let half = 0.5 * self.pitch();
        self.points.iter().fold([half; 2], |[x, z], p| {
            [x.max(p.x.abs() + half), z.max(p.z.abs() + half)]
        })
    }

    /// Every `stride`-th point along both directions.
    pub fn thinned(&self, stride: i64) -> impl Iterator<Item = &SlicePoint> {
        self.shifted(stride, 0)
    }

    /// The same, `shift` points further along both.
    pub fn shifted(&self, stride: i64, shift: i64) -> impl Iterator<Item = &SlicePoint> {
        let pitch = self.pitch();
        self.points.iter().filter(move |p| {
            let place = |x: f64| (x / pitch - 0.5).round() as i64 - shift;
            place(p.x).rem_euclid(stride) == 0 && place(p.z).rem_euclid(stride) == 0
        })
    }
}
