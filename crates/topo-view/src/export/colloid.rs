//! A colloid: its defect lines, the particle, the plane through its centre, and the whole field where that was kept.

use super::about::About;
use super::field::Derived;
use super::files::{Files, Wanted, table};
use super::npz::Archive;
use super::vtk::{self, Array, Lattice};
use crate::error::ViewError;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use topo_analysis::{LinePoint, SlicePoint};
use topo_lab::FieldSnapshot;
use topo_nematic::NematicParameters;

/// Points of the particle's surface around the axis; half as many from pole to pole.
const N_AROUND: usize = 96;

/// Writes the files of a case.
pub fn write(
    case: &Path,
    parameters: &NematicParameters,
    about: About,
    wanted: &Wanted,
    files: &mut Files<'_>,
) -> Result<(), ViewError> {
    let about = about
        .with("units.velocity", "xi_N/tau_N")
        .with("units.vorticity", "1/tau_N")
        .with("units.angle", "degree");
    let lines: Vec<LinePoint> = table(case, "lines.csv")?;
    let ring: Vec<LinePoint> = table(case, "ring.csv")?;
    let slices: Vec<SlicePoint> = table(case, "slices.csv")?;
    let groups: Vec<&[SlicePoint]> = slices.chunk_by(|a, b| a.time == b.time).collect();
    let times: Vec<Option<f64>> = groups.iter().map(|g| g[0].time).collect();
    if wanted.vtk {
        if parameters.particle {
            particle(parameters, &about, &files.place("particle.vtu"))?;
        }
        write_lines("lines", &lines, &times, &about, files)?;
        write_lines("ring", &ring, &times, &about, files)?;
        let mut series = Vec::new();
        for (k, group) in groups.iter().enumerate() {
            let name = numbered("plane", times[k], k, "vti");
            let (lattice, arrays) = plane(group);
            vtk::image(&files.place(&name), &about.at(times[k]), &lattice, &arrays)?;
            series.extend(times[k].map(|t| (t, name)));
        }
        files.series("plane", &series)?;
    }
    if wanted.npz {
        let place = files.place("colloid.npz");
        archive(&about, &lines, &ring, &groups)?.write(&place)?;
    }
    let fields = FieldSnapshot::files(case)?;
    if fields.is_empty() {
        let text = "no whole fields were kept: run the scene with --fields to have Q, director and velocity in all of the cell";
        if wanted.nemaktis.is_some() && !wanted.vtk && !wanted.npz {
            return Err(ViewError::Case {
                path: case.to_owned(),
                reason: text.to_string(),
            });
        }
        files.notes.push(text.to_owned());
    }
    write_fields(&fields, &about, parameters.material.order(), wanted, files)
}

/// Writes the whole fields, each in the formats asked for.
fn write_fields(
    fields: &[PathBuf],
    about: &About,
    order: f64,
    wanted: &Wanted,
    files: &mut Files<'_>,
) -> Result<(), ViewError> {
    let mut series = Vec::new();
    for (k, path) in fields.iter().enumerate() {
        let field = FieldSnapshot::read(path)?;
        let derived = Derived::of(&field);
        let about = about.at(field.time);
        if wanted.vtk {
            let name = numbered("field", field.time, k, "vti");
            derived.write_vtk(&about, &files.place(&name))?;
            series.extend(field.time.map(|t| (t, name)));
        }
        if wanted.npz {
            let place = files.place(&numbered("field", field.time, k, "npz"));
            derived.write_npz(&about, &field, &place)?;
        }
        if let Some(unit) = wanted.nemaktis {
            let place = files.place(&numbered("nemaktis", field.time, k, "vti"));
            derived.write_nemaktis(&about, order, unit, &place)?;
        }
    }
    files.series("field", &series)
}

/// Name of the k-th file; the first is the charged state.
fn numbered(what: &str, time: Option<f64>, k: usize, extension: &str) -> String {
    match time {
        None => format!("{what}-charged.{extension}"),
        Some(_) => format!("{what}-{k:02}.{extension}"),
    }
}

/// The particle's surface with the director it prefers while charged.
fn particle(parameters: &NematicParameters, about: &About, path: &Path) -> Result<(), ViewError> {
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
    vtk::cells(path, about, &points, &corners, &[director])
}

/// Lines at each time, also where there are none any more.
fn write_lines(
    what: &str,
    points: &[LinePoint],
    times: &[Option<f64>],
    about: &About,
    files: &mut Files<'_>,
) -> Result<(), ViewError> {
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
        let angle = here.iter().map(|p| p.angle.unwrap_or(f64::NAN));
        let line = here.iter().map(|p| p.line as f64);
        let name = numbered(what, *time, k, "vtu");
        let arrays = [Array::scalars("angle", angle), Array::scalars("line", line)];
        let about = about.at(*time);
        vtk::cells(&files.place(&name), &about, &places, &segments, &arrays)?;
        series.extend(time.map(|t| (t, name)));
    }
    files.series(what, &series)
}

/// Columns and rows of a plane, its points being x fastest.
fn sides(group: &[SlicePoint]) -> [usize; 2] {
    let columns = group
        .iter()
        .position(|p| p.z != group[0].z)
        .unwrap_or(group.len());
    [columns, group.len() / columns.max(1)]
}

/// Distance of neighbouring points: along x, or along z where there is one column.
fn spacing(group: &[SlicePoint]) -> f64 {
    let first = &group[0];
    let along = |p: &SlicePoint| (p.x - first.x).max(p.z - first.z);
    group.get(1).map_or(1.0, along)
}

fn plane(group: &[SlicePoint]) -> (Lattice, Vec<Array>) {
    let [columns, rows] = sides(group);
    let lattice = Lattice {
        n_points: [columns, 1, rows],
        origin: [group[0].x, 0.0, group[0].z],
        spacing: spacing(group),
    };
    let mut arrays = vec![
        Array::scalars("order", group.iter().map(|p| p.order)),
        Array::vectors("director", group.iter().map(director)),
    ];
    if group.iter().any(|p| p.ux.is_some()) {
        let velocity = group
            .iter()
            .map(|p| Vector3::new(p.ux.unwrap_or(0.0), 0.0, p.uz.unwrap_or(0.0)));
        let vorticity = group.iter().map(|p| p.vorticity.unwrap_or(0.0));
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
    about: &About,
    lines: &[LinePoint],
    ring: &[LinePoint],
    groups: &[&[SlicePoint]],
) -> Result<Archive, ViewError> {
    let mut archive = Archive::new(about)?;
    for (what, points) in [("lines", lines), ("ring", ring)] {
        let n = points.len();
        let mut put = |name: &str, of: fn(&LinePoint) -> f64| {
            let values = points.iter().map(of).collect();
            archive.add(&format!("{what}_{name}"), &[n], values)
        };
        put("time", |p| p.time.unwrap_or(f64::NAN))?;
        put("line", |p| p.line as f64)?;
        put("angle", |p| p.angle.unwrap_or(f64::NAN))?;
        let closed: Vec<bool> = points.iter().map(|p| p.closed).collect();
        archive.add(&format!("{what}_closed"), &[n], closed)?;
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
