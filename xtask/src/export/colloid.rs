//! A colloid: its defect lines, the particle, the plane through its centre, and the whole field where that was kept.

use super::npz::Archive;
use super::vtk::{self, Array, Lattice};
use super::{Files, Wanted};
use crate::data::read_csv;
use crate::error::XtaskError;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use topo_analysis::{FieldSnapshot, LinePoint, SlicePoint};
use topo_nematic::{NematicParameters, matrix, order_and_director};

/// Points of the particle's surface around the axis; half as many from pole to pole.
const N_AROUND: usize = 96;

/// Writes the files of a case.
pub fn write(
    case: &Path,
    parameters: &NematicParameters,
    wanted: &Wanted,
    files: &mut Files<'_>,
) -> Result<(), XtaskError> {
    let lines: Vec<LinePoint> = read_csv(&case.join("lines.csv"))?;
    let ring: Vec<LinePoint> = read_csv(&case.join("ring.csv"))?;
    let slices: Vec<SlicePoint> = read_csv(&case.join("slices.csv"))?;
    let groups: Vec<&[SlicePoint]> = slices.chunk_by(|a, b| a.time == b.time).collect();
    let times: Vec<Option<f64>> = groups.iter().map(|g| g[0].time).collect();
    if wanted.vtk {
        if parameters.particle {
            particle(parameters, &files.place("particle.vtu"))?;
        }
        write_lines("lines", &lines, &times, files)?;
        write_lines("ring", &ring, &times, files)?;
        let mut series = Vec::new();
        for (k, group) in groups.iter().enumerate() {
            let name = numbered("plane", times[k], k, "vti");
            let (lattice, arrays) = plane(group);
            vtk::image(&files.place(&name), &lattice, arrays)?;
            series.extend(times[k].map(|t| (t, name)));
        }
        vtk::series(&files.place("plane.pvd"), &series)?;
    }
    if wanted.npz {
        archive(&lines, &ring, &groups)?.write(&files.place("colloid.npz"))?;
    }
    let fields = FieldSnapshot::files(case)?;
    if fields.is_empty() {
        let text = "no whole fields were kept: run the scene with --fields to have Q, director and velocity in all of the cell";
        if wanted.nemaktis.is_some() && !wanted.vtk && !wanted.npz {
            return Err(XtaskError::Input(format!("{}: {text}", case.display())));
        }
        files.notes.push(text.to_owned());
    }
    let order = parameters.material.order();
    let mut series = Vec::new();
    for (k, path) in fields.iter().enumerate() {
        let field = FieldSnapshot::read(path)?;
        let derived = Derived::of(&field);
        if wanted.vtk {
            let name = numbered("field", field.time, k, "vti");
            derived.write_vtk(&field, &files.place(&name))?;
            series.extend(field.time.map(|t| (t, name)));
        }
        if wanted.npz {
            let place = files.place(&numbered("field", field.time, k, "npz"));
            derived.write_npz(&field, &place)?;
        }
        if let Some(unit) = wanted.nemaktis {
            let place = files.place(&numbered("nemaktis", field.time, k, "vti"));
            derived.write_nemaktis(&field, order, unit, &place)?;
        }
    }
    if !series.is_empty() {
        vtk::series(&files.place("field.pvd"), &series)?;
    }
    Ok(())
}

/// Name of the k-th file; the first is the charged state.
fn numbered(what: &str, time: Option<f64>, k: usize, extension: &str) -> String {
    match time {
        None => format!("{what}-charged.{extension}"),
        Some(_) => format!("{what}-{k:02}.{extension}"),
    }
}

/// The particle's surface with the director it prefers while charged.
fn particle(parameters: &NematicParameters, path: &Path) -> Result<(), XtaskError> {
    let rows = N_AROUND / 2;
    let mut directions = Vec::new();
    for i in 0..=rows {
        let polar = PI * i as f64 / rows as f64;
        for j in 0..N_AROUND {
            let azimuth = TAU * j as f64 / N_AROUND as f64;
            let (s, c) = polar.sin_cos();
            directions.push(Vector3::new(s * azimuth.cos(), s * azimuth.sin(), c));
        }
    }
    let mut corners = Vec::new();
    for i in 0..rows {
        for j in 0..N_AROUND {
            let at = |i: usize, j: usize| (i * N_AROUND + j % N_AROUND) as u64;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            // at the poles one of the two has no area
            if i + 1 < rows {
                corners.push([a, b, c]);
            }
            if i > 0 {
                corners.push([a, c, d]);
            }
        }
    }
    let director = directions
        .iter()
        .map(|d| Vector3::from(parameters.pattern.director([d.x, d.y, d.z])));
    let director = Array::vectors("director", director);
    let points: Vec<Vector3<f64>> = directions.iter().map(|d| d * parameters.radius).collect();
    vtk::cells(path, &points, &corners, vec![director])
}

/// Lines at each time, also where there are none any more.
fn write_lines(
    what: &str,
    points: &[LinePoint],
    times: &[Option<f64>],
    files: &mut Files<'_>,
) -> Result<(), XtaskError> {
    let mut series = Vec::new();
    for (k, time) in times.iter().enumerate() {
        let here: Vec<&LinePoint> = points.iter().filter(|p| p.time == *time).collect();
        let mut segments = Vec::new();
        let mut first = 0;
        for line in here.chunk_by(|a, b| a.line == b.line) {
            let n = line.len() as u64;
            segments.extend((1..n).map(|i| [first + i - 1, first + i]));
            if line[0].closed && n > 2 {
                segments.push([first + n - 1, first]);
            }
            first += n;
        }
        let places: Vec<Vector3<f64>> = here.iter().map(|p| Vector3::new(p.x, p.y, p.z)).collect();
        let angle = here.iter().map(|p| p.angle.unwrap_or(f64::NAN)).collect();
        let line = here.iter().map(|p| p.line as f64).collect();
        let name = numbered(what, *time, k, "vtu");
        let arrays = vec![Array::scalars("angle", angle), Array::scalars("line", line)];
        vtk::cells(&files.place(&name), &places, &segments, arrays)?;
        series.extend(time.map(|t| (t, name)));
    }
    vtk::series(&files.place(&format!("{what}.pvd")), &series)
}

/// Columns and rows of a plane, its points being x fastest.
fn sides(group: &[SlicePoint]) -> [usize; 2] {
    let columns = group
        .iter()
        .position(|p| p.z != group[0].z)
        .unwrap_or(group.len());
    [columns, group.len() / columns.max(1)]
}

fn plane(group: &[SlicePoint]) -> (Lattice, Vec<Array>) {
    let [columns, rows] = sides(group);
    let lattice = Lattice {
        n_points: [columns, 1, rows],
        origin: [group[0].x, 0.0, group[0].z],
        spacing: group.get(1).map_or(1.0, |p| p.x - group[0].x),
    };
    let mut arrays = vec![
        Array::scalars("order", group.iter().map(|p| p.order).collect()),
        Array::vectors("director", group.iter().map(director)),
    ];
    if group.iter().any(|p| p.ux.is_some()) {
        let velocity = group
            .iter()
            .map(|p| Vector3::new(p.ux.unwrap_or(0.0), 0.0, p.uz.unwrap_or(0.0)));
        let vorticity = group.iter().map(|p| p.vorticity.unwrap_or(0.0)).collect();
        arrays.push(Array::vectors("velocity_in_plane", velocity));
        arrays.push(Array::scalars("vorticity_y", vorticity));
    }
    (lattice, arrays)
}

fn director(p: &SlicePoint) -> Vector3<f64> {
    Vector3::new(p.nx, p.ny, p.nz)
}

/// Lines and planes of all times; the time of the charged state is NaN.
fn archive(
    lines: &[LinePoint],
    ring: &[LinePoint],
    groups: &[&[SlicePoint]],
) -> Result<Archive, XtaskError> {
    let mut archive = Archive::new();
    for (what, points) in [("lines", lines), ("ring", ring)] {
        let n = points.len();
        let mut put = |name: &str, of: fn(&LinePoint) -> f64| {
            let values = points.iter().map(of).collect();
            archive.add(&format!("{what}_{name}"), &[n], values)
        };
        put("time", |p| p.time.unwrap_or(f64::NAN))?;
        put("line", |p| p.line as f64)?;
        put("angle", |p| p.angle.unwrap_or(f64::NAN))?;
        let places = points.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        archive.add(&format!("{what}_points"), &[n, 3], places)?;
    }
    let Some(first) = groups.first() else {
        return Ok(archive);
    };
    let [columns, rows] = sides(first);
    let n = groups.len();
    let times = groups.iter().map(|g| g[0].time.unwrap_or(f64::NAN));
    archive.add("plane_time", &[n], times.collect())?;
    archive.add(
        "plane_x",
        &[columns],
        first[..columns].iter().map(|p| p.x).collect(),
    )?;
    let heights = first.iter().step_by(columns).map(|p| p.z);
    archive.add("plane_z", &[rows], heights.collect())?;
    let all = || groups.iter().flat_map(|g| g.iter());
    let lead = [n, rows, columns];
    archive.add("plane_order", &lead, all().map(|p| p.order).collect())?;
    let vector = [n, rows, columns, 3];
    let directors = all().flat_map(|p| [p.nx, p.ny, p.nz]);
    archive.add("plane_director", &vector, directors.collect())?;
    if all().any(|p| p.ux.is_some()) {
        let velocity = all().flat_map(|p| [p.ux.unwrap_or(f64::NAN), p.uz.unwrap_or(f64::NAN)]);
        archive.add("plane_velocity", &[n, rows, columns, 2], velocity.collect())?;
        let vorticity = all().map(|p| p.vorticity.unwrap_or(f64::NAN));
        archive.add("plane_vorticity", &lead, vorticity.collect())?;
    }
    Ok(archive)
}

/// What follows from a field: zero inside the particle.
struct Derived {
    lattice: Lattice,
    order: Vec<f32>,
    director: Vec<f32>,
    /// All nine components, row by row.
    tensor: Vec<f32>,
    fluid: Vec<u8>,
    /// Point by point; none without flow.
    velocity: Option<Vec<f32>>,
}

impl Derived {
    fn of(field: &FieldSnapshot) -> Self {
        let n = field.fluid.len();
        let mut derived = Self {
            lattice: Lattice {
                n_points: field.cells,
                origin: field.origin,
                spacing: field.spacing,
            },
            order: Vec::with_capacity(n),
            director: Vec::with_capacity(3 * n),
            tensor: Vec::with_capacity(9 * n),
            fluid: field.fluid.iter().map(|f| u8::from(*f)).collect(),
            velocity: field.velocity.as_ref().map(|u| {
                (0..n)
                    .flat_map(|i| [u[i], u[n + i], u[2 * n + i]])
                    .collect()
            }),
        };
        for i in 0..n {
            if field.fluid[i] {
                let q = field.tensor(i);
                let (order, d) = order_and_director(&q);
                derived.order.push(order as f32);
                derived.director.extend(d.map(|x| x as f32));
                derived.tensor.extend(matrix(&q).iter().map(|x| *x as f32));
            } else {
                derived.order.push(0.0);
                derived.director.extend([0.0; 3]);
                derived.tensor.extend([0.0; 9]);
            }
        }
        derived
    }

    fn write_vtk(&self, field: &FieldSnapshot, path: &Path) -> Result<(), XtaskError> {
        debug_assert_eq!(field.fluid.len(), self.order.len());
        let mut arrays = vec![
            Array::single("order", 1, self.order.clone()),
            Array::single("director", 3, self.director.clone()),
            Array::single("Q", 9, self.tensor.clone()),
            Array::bytes("fluid", self.fluid.clone()),
        ];
        arrays.extend(
            self.velocity
                .clone()
                .map(|u| Array::single("velocity", 3, u)),
        );
        vtk::image(path, &self.lattice, arrays)
    }

    fn write_npz(&self, field: &FieldSnapshot, path: &Path) -> Result<(), XtaskError> {
        let [nx, ny, nz] = field.cells;
        let mut archive = Archive::new();
        archive.add("time", &[], vec![field.time.unwrap_or(f64::NAN)])?;
        archive.add("origin", &[3], field.origin.to_vec())?;
        archive.add("spacing", &[], vec![field.spacing])?;
        archive.add("order", &[nz, ny, nx], self.order.clone())?;
        archive.add("director", &[nz, ny, nx, 3], self.director.clone())?;
        archive.add("Q", &[nz, ny, nx, 3, 3], self.tensor.clone())?;
        archive.add("fluid", &[nz, ny, nx], self.fluid.clone())?;
        if let Some(u) = &self.velocity {
            archive.add("velocity", &[nz, ny, nx, 3], u.clone())?;
        }
        archive.write(path)
    }

    /// What nemaktis reads: `n`, `Q` over the equilibrium order as xx, yy, zz, xy, xz, yz, and `domain_mask`, positive in the
    /// nematic and negative in the particle; lengths in micrometres.
    fn write_nemaktis(
        &self,
        field: &FieldSnapshot,
        order: f64,
        unit: f64,
        path: &Path,
    ) -> Result<(), XtaskError> {
        let n = field.fluid.len();
        let (mut director, mut q) = (self.director.clone(), Vec::with_capacity(6 * n));
        for (i, m) in self.tensor.chunks_exact(9).enumerate() {
            let scale = (1.0 / order) as f32;
            if field.fluid[i] {
                q.extend([m[0], m[4], m[8], m[1], m[2], m[5]].map(|x| scale * x));
            } else {
                // not used, but a director has to be there
                director[3 * i + 2] = 1.0;
                q.extend([-0.5, -0.5, 1.0, 0.0, 0.0, 0.0]);
            }
        }
        let mask = field.fluid.iter().map(|f| if *f { 1.0 } else { -1.0 });
        let lattice = Lattice {
            origin: field.origin.map(|x| x * unit),
            spacing: field.spacing * unit,
            ..self.lattice
        };
        let arrays = vec![
            Array::single("n", 3, director),
            Array::single("Q", 6, q),
            Array::single("domain_mask", 1, mask.collect()),
        ];
        vtk::image(path, &lattice, arrays)
    }
}
