//! A fibre: charged, and over its discharges.

use super::about::About;
use super::files::{Files, Wanted, damaged, table};
use super::npz::Archive;
use super::vtk::{self, Array};
use crate::error::ViewError;
use nalgebra::Vector3;
use serde::Deserialize;
use std::path::Path;
use topo_rod::Tube;

/// A vertex of `charged.csv` or `snapshots.csv`.
#[derive(Debug, Clone, Copy, Deserialize)]
struct Vertex {
    /// Of a link: counted from 1.
    #[serde(default)]
    component: usize,
    #[serde(default)]
    cut: Option<f64>,
    #[serde(default)]
    time: Option<f64>,
    s: f64,
    x: f64,
    y: f64,
    z: f64,
    energy_density: f64,
    /// Not in snapshots of early versions.
    #[serde(default)]
    twist: Option<f64>,
}

/// The fibre at one time, with what its vertices tell.
struct Shape {
    closed: bool,
    time: f64,
    points: Vec<Vector3<f64>>,
    s: Vec<f64>,
    energy_density: Vec<f64>,
    twist: Option<Vec<f64>>,
    tangent: Vec<Vector3<f64>>,
    curvature: Vec<f64>,
    stretch: Vec<f64>,
}

/// Writes the files of a case.
///
/// Two strands touch at the distance `contact_diameter`, which the reading of L/h sets: the tube to draw has half of it as
/// its radius, not the radius h = 1 that sets the stiffness.
pub fn write(
    case: &Path,
    tube: &Tube,
    about: About,
    wanted: &Wanted,
    files: &mut Files<'_>,
) -> Result<(), ViewError> {
    let about = about
        .with("tube_radius", 0.5 * tube.contact_diameter)
        .with("contact_diameter", tube.contact_diameter)
        .with("friction_range", tube.friction_range)
        .with("length", tube.length)
        .with("start_length", tube.start_length)
        .with("units.energy_density", "E_b h^2")
        .with("units.curvature", "1/h")
        .with("units.twist", "1/h");
    let charged: Vec<Vertex> = table(case, "charged.csv")?;
    if charged.iter().any(|v| v.component > 1) {
        return Err(ViewError::Table {
            path: case.join("charged.csv"),
            reason: "it is a link: only shapes of one component are exported".to_owned(),
        });
    }
    let charged = Shape::new(&charged, true, case)?;
    let vertices: Vec<Vertex> = table(case, "snapshots.csv")?;
    let mut cuts: Vec<(f64, Vec<Shape>)> = Vec::new();
    for group in vertices.chunk_by(|a, b| a.cut == b.cut && a.time == b.time) {
        let shape = Shape::new(group, false, case)?;
        let at = group[0].cut.unwrap_or(0.0);
        match cuts.last_mut() {
            Some((cut, shapes)) if *cut == at => shapes.push(shape),
            _ => cuts.push((at, vec![shape])),
        }
    }
    if wanted.vtk {
        charged.write_vtk(&about.at(None), &files.place("charged.vtp"))?;
        for (k, (cut, shapes)) in cuts.iter().enumerate() {
            let name = format!("discharge-{}", k + 1);
            let mut times = Vec::new();
            for (i, shape) in shapes.iter().enumerate() {
                let file = format!("{name}-{i:02}.vtp");
                let about = about.at(Some(shape.time)).with("cut", *cut);
                shape.write_vtk(&about, &files.place(&file))?;
                times.push((shape.time, file));
            }
            files.series(&name, &times)?;
        }
    }
    if wanted.npz {
        let mut archive = Archive::new(&about)?;
        add(&mut archive, "charged", std::slice::from_ref(&charged))?;
        for (k, (cut, shapes)) in cuts.iter().enumerate() {
            let name = format!("discharge{}", k + 1);
            archive.add(&format!("{name}_cut"), &[], vec![*cut])?;
            let times = shapes.iter().map(|s| s.time).collect();
            archive.add(&format!("{name}_time"), &[shapes.len()], times)?;
            add(&mut archive, &name, shapes)?;
        }
        archive.write(&files.place("fibre.npz"))?;
    }
    Ok(())
}

/// Adds shapes of the same number of vertices; one closed shape has no index of time.
fn add(archive: &mut Archive, name: &str, shapes: &[Shape]) -> Result<(), ViewError> {
    let Some(first) = shapes.first() else {
        return Ok(());
    };
    let n = first.points.len();
    let lead: Vec<usize> = if first.closed {
        vec![n]
    } else {
        vec![shapes.len(), n]
    };
    archive.add(&format!("{name}_closed"), &[], vec![first.closed])?;
    let mut put = |what: &str, of: &dyn Fn(&Shape) -> Vec<f64>| {
        let values: Vec<f64> = shapes.iter().flat_map(of).collect();
        let mut shape = lead.clone();
        if values.len() > shapes.len() * n {
            shape.push(3);
        }
        archive.add(&format!("{name}_{what}"), &shape, values)
    };
    let flat = |v: &[Vector3<f64>]| v.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    put("points", &|s| flat(&s.points))?;
    put("tangent", &|s| flat(&s.tangent))?;
    put("s", &|s| s.s.clone())?;
    put("curvature", &|s| s.curvature.clone())?;
    put("stretch", &|s| s.stretch.clone())?;
    put("energy_density", &|s| s.energy_density.clone())?;
    if shapes.iter().all(|s| s.twist.is_some()) {
        put("twist", &|s| s.twist.clone().unwrap_or_default())?;
    }
    Ok(())
}

impl Shape {
    fn new(vertices: &[Vertex], closed: bool, case: &Path) -> Result<Self, ViewError> {
        let n = vertices.len();
        if n < 4 {
            let name = if closed {
                "charged.csv"
            } else {
                "snapshots.csv"
            };
            let reason = format!("a shape of {n} vertices, at least 4 are needed");
            return Err(damaged(case, name, &reason));
        }
        let points: Vec<Vector3<f64>> = vertices
            .iter()
            .map(|v| Vector3::new(v.x, v.y, v.z))
            .collect();
        let rest = vertices[1].s - vertices[0].s;
        // edge i goes from vertex i to the next
        let edges: Vec<Vector3<f64>> = (0..if closed { n } else { n - 1 })
            .map(|i| points[(i + 1) % n] - points[i])
            .collect();
        let (mut tangent, mut curvature, mut stretch) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..n {
            let before = if closed {
                Some(edges[(i + n - 1) % n])
            } else {
                i.checked_sub(1).map(|k| edges[k])
            };
            let after = edges.get(i).copied();
            let (a, b) = match (before, after) {
                (Some(a), Some(b)) => (a, b),
                (Some(a), None) | (None, Some(a)) => (a, a),
                (None, None) => (Vector3::x(), Vector3::x()),
            };
            let (ta, tb) = (a.normalize(), b.normalize());
            tangent.push((ta + tb).normalize());
            let length = 0.5 * (a.norm() + b.norm());
            // 2 tan(φ/2) over the length of the two half edges, φ the angle between them
            curvature.push(2.0 * ta.cross(&tb).norm() / (1.0 + ta.dot(&tb)) / length);
            stretch.push(length / rest - 1.0);
        }
        let of = |f: fn(&Vertex) -> f64| vertices.iter().map(f).collect::<Vec<f64>>();
        Ok(Self {
            closed,
            time: vertices[0].time.unwrap_or(0.0),
            s: of(|v| v.s),
            energy_density: of(|v| v.energy_density),
            twist: vertices.iter().map(|v| v.twist).collect(),
            points,
            tangent,
            curvature,
            stretch,
        })
    }

    fn write_vtk(&self, about: &About, path: &Path) -> Result<(), ViewError> {
        let scalars = |name, values: &[f64]| Array::scalars(name, values.iter().copied());
        let mut arrays = vec![
            scalars("s", &self.s),
            Array::vectors("tangent", self.tangent.iter().copied()),
            scalars("curvature", &self.curvature),
            scalars("stretch", &self.stretch),
            scalars("energy_density", &self.energy_density),
        ];
        arrays.extend(self.twist.as_ref().map(|t| scalars("twist", t)));
        vtk::line(path, about, &self.points, self.closed, &arrays)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn arc(n: usize, closed: bool) -> Shape {
        let vertex = |i: usize| {
            let a = i as f64 / n as f64 * TAU;
            Vertex {
                component: 0,
                cut: None,
                time: None,
                s: i as f64 * TAU * 4.0 / n as f64,
                x: 5.0 * a.cos(),
                y: 5.0 * a.sin(),
                z: 0.0,
                energy_density: 1.0,
                twist: None,
            }
        };
        let count = if closed { n } else { n / 2 };
        let vertices: Vec<Vertex> = (0..count).map(vertex).collect();
        Shape::new(&vertices, closed, Path::new("here")).unwrap()
    }

    #[test]
    fn a_stretched_circle_has_its_curvature_tangent_and_stretch() {
        for closed in [true, false] {
            let c = arc(200, closed);
            for i in 1..c.points.len() - 1 {
                assert!((c.curvature[i] - 0.2).abs() < 1e-4);
                assert!((c.stretch[i] - 0.25).abs() < 1e-3);
                assert!(c.tangent[i].dot(&c.points[i]).abs() < 1e-9);
            }
            assert_eq!(c.curvature[0] < 1e-9, !closed);
            assert!(c.twist.is_none());
        }
    }
}
