//! Curves and time series of a case.

use super::read_csv;
use crate::error::ViewError;
use nalgebra::Vector3;
use serde::Deserialize;
use std::path::Path;

/// Fewest vertices of a curve.
const LEAST: usize = 3;

/// A vertex of `charged.csv` or `snapshots.csv`, or of the `x,y,z` of a knot: lengths in h, density in E_b h^2.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
struct Vertex {
    /// Of a link: counted from 1.
    #[serde(default)]
    component: Option<usize>,
    #[serde(default)]
    cut: Option<f64>,
    #[serde(default)]
    time: Option<f64>,
    #[serde(default)]
    s: f64,
    x: f64,
    y: f64,
    z: f64,
    #[serde(default)]
    energy_density: f64,
    /// Not in snapshots of early versions.
    #[serde(default)]
    twist: Option<f64>,
}

impl Vertex {
    fn component(&self) -> usize {
        self.component.unwrap_or(1)
    }
}

/// A curve with its arc length and energy density: a knot, or a component of a link.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    /// Which component it is, counted from 1.
    pub component: usize,
    /// Whether the last vertex joins the first.
    pub closed: bool,
    /// Arc length of the vertices.
    pub s: Vec<f64>,
    /// Vertices.
    pub points: Vec<Vector3<f64>>,
    /// Energy density at the vertices.
    pub density: Vec<f64>,
    /// Twist at the vertices, where the table has it.
    pub twist: Option<Vec<f64>>,
}

impl Curve {
    /// Reads a table with one closed curve: `charged.csv` of a knot's case, or a knot's `x,y,z`.
    ///
    /// # Errors
    /// A table that cannot be read, or that holds no curve or several.
    pub fn read(path: &Path) -> Result<Self, ViewError> {
        let mut all = Self::read_all(path)?;
        if all.len() > 1 {
            let reason = format!("it is a link of {} components: a knot is needed", all.len());
            return Err(unusable(path, reason));
        }
        Ok(all.swap_remove(0))
    }

    /// Reads the curves of a table of whole shapes: one, or the components of a link in their order. One is open whose ends are farther
    /// apart than two of its edges.
    ///
    /// # Errors
    /// A table that cannot be read, or a curve of too few vertices.
    pub fn read_all(path: &Path) -> Result<Vec<Self>, ViewError> {
        let all: Vec<Vertex> = read_csv(path)?;
        if all.is_empty() {
            return Err(unusable(path, "no vertices".to_owned()));
        }
        curves(path, &all, are_joined)
    }

    fn new(vertices: &[Vertex], closed: bool) -> Self {
        let of = |f: fn(&Vertex) -> f64| vertices.iter().map(f).collect::<Vec<f64>>();
        let points = vertices.iter().map(|v| Vector3::new(v.x, v.y, v.z));
        Self {
            component: vertices.first().map_or(1, Vertex::component),
            closed,
            s: of(|v| v.s),
            points: points.collect(),
            density: of(|v| v.energy_density),
            twist: vertices.iter().map(|v| v.twist).collect(),
        }
    }
}

/// Whether the last of these vertices is followed by the first.
fn are_joined(of: &[Vertex]) -> bool {
    let apart = |a: &Vertex, b: &Vertex| (a.x - b.x).hypot(a.y - b.y).hypot(a.z - b.z);
    let longest = of.windows(2).map(|edge| apart(&edge[0], &edge[1]));
    apart(&of[0], &of[of.len() - 1]) <= 2.0 * longest.fold(0.0, f64::max)
}

fn unusable(path: &Path, reason: String) -> ViewError {
    ViewError::Table {
        path: path.to_owned(),
        reason,
    }
}

/// The curves of one shape, of which `is_closed` says how each ends.
fn curves(
    path: &Path,
    vertices: &[Vertex],
    is_closed: impl Fn(&[Vertex]) -> bool,
) -> Result<Vec<Curve>, ViewError> {
    let components = vertices.chunk_by(|a, b| a.component() == b.component());
    let curve = |of: &[Vertex]| match of.len() {
        n if n < LEAST => {
            let reason = format!("a curve of {n} vertices, at least {LEAST} are needed");
            Err(unusable(path, reason))
        }
        _ => Ok(Curve::new(of, is_closed(of))),
    };
    components.map(curve).collect()
}

/// The vertices of curves, one after the other.
pub fn points_of(curves: &[Curve]) -> Vec<Vector3<f64>> {
    curves.iter().flat_map(|c| &c.points).copied().collect()
}

/// A cut fibre at a time of its discharge.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Place of the cut.
    pub cut: f64,
    /// Time in T0.
    pub time: f64,
    /// Its curves: of a link those that are not cut are closed.
    pub curves: Vec<Curve>,
}

/// Reads `snapshots.csv` of a case, in order of the file.
///
/// A component that is cut has one vertex more than in `charged.csv`, its last one where its first one was. That tells open components
/// of a link from closed ones; a fibre alone is cut, and one that was open is two then.
///
/// # Errors
/// Tables that cannot be read or do not belong together, or a curve of too few vertices.
pub fn snapshots(case: &Path) -> Result<Vec<Snapshot>, ViewError> {
    let path = case.join("snapshots.csv");
    let vertices: Vec<Vertex> = read_csv(&path)?;
    let whole = match vertices.iter().all(|v| v.component.is_none()) {
        true => Vec::new(),
        false => Curve::read_all(&case.join("charged.csv"))?,
    };
    let is_closed = |of: &[Vertex]| {
        let charged = whole.iter().find(|c| c.component == of[0].component());
        charged.is_some_and(|c| c.points.len() == of.len())
    };
    let shot = |of: &[Vertex]| {
        let curves = curves(&path, of, is_closed)?;
        let n = match &whole[..] {
            [open] if !open.closed => 2,
            several => several.len().max(1),
        };
        if curves.len() != n {
            let found = curves.len();
            let reason = format!("a shape of {found} components, charged.csv has {n}");
            return Err(unusable(&path, reason));
        }
        Ok(Snapshot {
            cut: of[0].cut.unwrap_or(0.0),
            time: of[0].time.unwrap_or(0.0),
            curves,
        })
    };
    let shots = vertices.chunk_by(|a, b| a.cut == b.cut && a.time == b.time);
    shots.map(shot).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// A fibre that was open is known from a ring by its ends, and is two once it is cut.
    #[test]
    fn open_fibres_are_two_when_they_are_cut() {
        let folder = tempfile::tempdir().unwrap();
        let row = |k: usize| format!("{},{k},0,{}", 0.5 * k as f64, (k % 2) as f64);
        let rows = |of: &mut dyn Iterator<Item = String>| of.collect::<Vec<_>>().join("\n");
        let open = rows(&mut (0..9).map(row));
        let charged = folder.path().join("charged.csv");
        fs::write(&charged, format!("s,x,y,z\n{open}\n")).unwrap();
        assert!(!Curve::read(&charged).unwrap().closed);
        let half = |c: usize, of: std::ops::Range<usize>| {
            rows(&mut of.map(|k| format!("{c},0.5,1.0,{}", row(k))))
        };
        let path = folder.path().join("snapshots.csv");
        let [one, two] = [half(1, 0..5), half(2, 4..9)];
        fs::write(&path, format!("component,cut,time,s,x,y,z\n{one}\n{two}\n")).unwrap();
        let shots = snapshots(folder.path()).unwrap();
        let found: Vec<_> = shots[0]
            .curves
            .iter()
            .map(|c| (c.points.len(), c.closed))
            .collect();
        assert_eq!(found, [(5, false), (5, false)]);
        let ring = (0..8).map(|k| {
            let u = std::f64::consts::TAU * f64::from(k) / 8.0;
            format!("{},{},{},0", f64::from(k), u.cos(), u.sin())
        });
        fs::write(
            &charged,
            format!("s,x,y,z\n{}\n", rows(&mut ring.into_iter())),
        )
        .unwrap();
        assert!(Curve::read(&charged).unwrap().closed);
        let message = snapshots(folder.path()).unwrap_err().to_string();
        assert!(
            message.contains("a shape of 2 components, charged.csv has 1"),
            "{message}"
        );
    }
}
