//! A fibre: charged, and over its discharges; of a link, all its components.

use super::about::About;
use super::files::{Files, Wanted, as_damage};
use super::npz::Archive;
use super::vtk::{self, Array};
use crate::data::{Curve, snapshots};
use crate::error::ViewError;
use nalgebra::Vector3;
use std::path::Path;
use topo_rod::Tube;

/// The fibre at one time.
struct Shape {
    /// `None`: charged.
    time: Option<f64>,
    components: Vec<Component>,
}

/// A component with what its vertices tell.
struct Component {
    curve: Curve,
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
    let charged = Curve::read_all(&case.join("charged.csv"))
        .map(|curves| Shape::new(None, curves))
        .map_err(|e| as_damage(case, "charged.csv", e))?;
    let shots = snapshots(case).map_err(|e| as_damage(case, "snapshots.csv", e))?;
    let mut cuts: Vec<(f64, Vec<Shape>)> = Vec::new();
    for shot in shots {
        let shape = Shape::new(Some(shot.time), shot.curves);
        match cuts.last_mut() {
            Some((cut, shapes)) if *cut == shot.cut => shapes.push(shape),
            _ => cuts.push((shot.cut, vec![shape])),
        }
    }
    if wanted.vtk {
        charged.write_vtk(&about.at(None), &files.place("charged.vtp"))?;
        for (k, (cut, shapes)) in cuts.iter().enumerate() {
            let name = format!("discharge-{}", k + 1);
            let mut times = Vec::new();
            for (i, shape) in shapes.iter().enumerate() {
                let file = format!("{name}-{i:02}.vtp");
                let about = about.at(shape.time).with("cut", *cut);
                shape.write_vtk(&about, &files.place(&file))?;
                times.push((shape.time.unwrap_or(0.0), file));
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
            let times = shapes.iter().map(|s| s.time.unwrap_or(0.0)).collect();
            archive.add(&format!("{name}_time"), &[shapes.len()], times)?;
            add(&mut archive, &name, shapes)?;
        }
        archive.write(&files.place("fibre.npz"))?;
    }
    Ok(())
}

/// Adds shapes of the same numbers of vertices; the charged one has no index of time.
fn add(archive: &mut Archive, name: &str, shapes: &[Shape]) -> Result<(), ViewError> {
    let Some(first) = shapes.first() else {
        return Ok(());
    };
    let n: usize = first.curves().map(|c| c.points.len()).sum();
    let lead: Vec<usize> = match first.time {
        None => vec![n],
        Some(_) => vec![shapes.len(), n],
    };
    let closed: Vec<bool> = first.curves().map(|c| c.closed).collect();
    if first.is_link() {
        archive.add(&format!("{name}_closed"), &[closed.len()], closed)?;
        archive.add(&format!("{name}_component"), &[n], first.component())?;
    } else {
        archive.add(&format!("{name}_closed"), &[], closed)?;
    }
    let mut put = |what: &str, of: &dyn Fn(&Component) -> Vec<f64>| {
        let components = shapes.iter().flat_map(|s| &s.components);
        let values: Vec<f64> = components.flat_map(of).collect();
        let mut shape = lead.clone();
        if values.len() > shapes.len() * n {
            shape.push(3);
        }
        archive.add(&format!("{name}_{what}"), &shape, values)
    };
    let flat = |v: &[Vector3<f64>]| v.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    put("points", &|c| flat(&c.curve.points))?;
    put("tangent", &|c| flat(&c.tangent))?;
    put("s", &|c| c.curve.s.clone())?;
    put("curvature", &|c| c.curvature.clone())?;
    put("stretch", &|c| c.stretch.clone())?;
    put("energy_density", &|c| c.curve.density.clone())?;
    if shapes.iter().all(Shape::has_twist) {
        put("twist", &|c| c.curve.twist.clone().unwrap_or_default())?;
    }
    Ok(())
}

impl Shape {
    fn new(time: Option<f64>, curves: Vec<Curve>) -> Self {
        let components = curves.into_iter().map(Component::new).collect();
        Self { time, components }
    }

    fn curves(&self) -> impl Iterator<Item = &Curve> {
        self.components.iter().map(|c| &c.curve)
    }

    fn is_link(&self) -> bool {
        self.components.len() > 1
    }

    fn has_twist(&self) -> bool {
        self.curves().all(|curve| curve.twist.is_some())
    }

    /// Component of each vertex, counted from 1.
    fn component(&self) -> Vec<i64> {
        let of = |c: &Curve| vec![c.component as i64; c.points.len()];
        self.curves().flat_map(of).collect()
    }

    fn write_vtk(&self, about: &About, path: &Path) -> Result<(), ViewError> {
        let scalars = |name, of: fn(&Component) -> &[f64]| {
            Array::scalars(name, self.components.iter().flat_map(of).copied())
        };
        let tangents = self.components.iter().flat_map(|c| &c.tangent).copied();
        let mut at_points = vec![
            scalars("s", |c| &c.curve.s),
            Array::vectors("tangent", tangents),
            scalars("curvature", |c| &c.curvature),
            scalars("stretch", |c| &c.stretch),
            scalars("energy_density", |c| &c.curve.density),
        ];
        if self.has_twist() {
            at_points.push(scalars("twist", |c| {
                c.curve.twist.as_deref().unwrap_or_default()
            }));
        }
        let mut of_lines = Vec::new();
        if self.is_link() {
            at_points.push(Array::indices("component", self.component()));
            let numbers = self.curves().map(|c| c.component as i64);
            of_lines.push(Array::indices("component", numbers));
        }
        let curves: Vec<(usize, bool)> =
            self.curves().map(|c| (c.points.len(), c.closed)).collect();
        let points: Vec<_> = self.curves().flat_map(|c| &c.points).copied().collect();
        vtk::lines(path, about, &points, &curves, [&at_points, &of_lines])
    }
}

impl Component {
    fn new(curve: Curve) -> Self {
        let (points, n) = (&curve.points, curve.points.len());
        let rest = curve.s[1] - curve.s[0];
        // edge i goes from vertex i to the next
        let edges: Vec<Vector3<f64>> = (0..if curve.closed { n } else { n - 1 })
            .map(|i| points[(i + 1) % n] - points[i])
            .collect();
        let (mut tangent, mut curvature, mut stretch) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..n {
            let before = if curve.closed {
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
        Self {
            curve,
            tangent,
            curvature,
            stretch,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn arc(n: usize, closed: bool) -> Component {
        let count = if closed { n } else { n / 2 };
        let point = |i: usize| {
            let a = i as f64 / n as f64 * TAU;
            Vector3::new(5.0 * a.cos(), 5.0 * a.sin(), 0.0)
        };
        let s = (0..count).map(|i| i as f64 * TAU * 4.0 / n as f64);
        Component::new(Curve {
            component: 1,
            closed,
            s: s.collect(),
            points: (0..count).map(point).collect(),
            density: vec![1.0; count],
            twist: None,
        })
    }

    #[test]
    fn a_stretched_circle_has_its_curvature_tangent_and_stretch() {
        for closed in [true, false] {
            let c = arc(200, closed);
            let points = &c.curve.points;
            for i in 1..points.len() - 1 {
                assert!((c.curvature[i] - 0.2).abs() < 1e-4);
                assert!((c.stretch[i] - 0.25).abs() < 1e-3);
                assert!(c.tangent[i].dot(&points[i]).abs() < 1e-9);
            }
            assert_eq!(c.curvature[0] < 1e-9, !closed);
        }
    }
}
