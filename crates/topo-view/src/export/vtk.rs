//! VTK XML files, in the encoding that all its readers know: numbers as base64, in place.
//!
//! Written here because no crate says how many points an empty piece has or writes field data, and VTK refuses the one and
//! needs the other.

use super::about::{About, Fact};
use crate::data;
use crate::error::ViewError;
use crate::plot::font::base64;
use nalgebra::Vector3;
use std::fmt::Write as _;
use std::path::Path;

/// Numbers at the points of a file, or of its cells.
pub struct Array {
    name: &'static str,
    n_components: usize,
    /// Name of the kind of number.
    kind: &'static str,
    /// Little-endian, behind their count of bytes.
    bytes: Vec<u8>,
}

impl Array {
    /// One number a point.
    pub fn scalars(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, 1, "Float64", values.into_iter().map(f64::to_le_bytes))
    }

    /// Three numbers a point.
    pub fn vectors(name: &'static str, values: impl IntoIterator<Item = Vector3<f64>>) -> Self {
        let flat = values.into_iter().flat_map(|p| [p.x, p.y, p.z]);
        Self::new(name, 3, "Float64", flat.map(f64::to_le_bytes))
    }

    /// So many numbers a point, to single precision.
    pub fn single(name: &'static str, n_components: usize, values: &[f32]) -> Self {
        let bytes = values.iter().map(|x| x.to_le_bytes());
        Self::new(name, n_components, "Float32", bytes)
    }

    /// One small whole number a point.
    pub fn bytes(name: &'static str, values: &[u8]) -> Self {
        Self::new(name, 1, "UInt8", values.iter().map(|x| [*x]))
    }

    /// One whole number a point.
    pub fn indices(name: &'static str, values: impl IntoIterator<Item = i64>) -> Self {
        Self::new(name, 1, "Int64", values.into_iter().map(i64::to_le_bytes))
    }

    fn new<const N: usize>(
        name: &'static str,
        n_components: usize,
        kind: &'static str,
        values: impl Iterator<Item = [u8; N]>,
    ) -> Self {
        let mut bytes = vec![0; 8];
        bytes.extend(values.flatten());
        let count = (bytes.len() - 8) as u64;
        bytes[..8].copy_from_slice(&count.to_le_bytes());
        Self {
            name,
            n_components,
            kind,
            bytes,
        }
    }
}

/// Writes one line through all points as `.vtp`; a closed one ends at the point it began with.
pub fn line(
    path: &Path,
    about: &About,
    points: &[Vector3<f64>],
    closed: bool,
    arrays: &[Array],
) -> Result<(), ViewError> {
    lines(
        path,
        about,
        points,
        &[(points.len(), closed)],
        [arrays, &[]],
    )
}

/// Writes lines as `.vtp`: `curves` says how many of the points each goes through, and whether it is closed. The arrays are those of
/// points and those of lines.
pub fn lines(
    path: &Path,
    about: &About,
    points: &[Vector3<f64>],
    curves: &[(usize, bool)],
    [at_points, of_lines]: [&[Array]; 2],
) -> Result<(), ViewError> {
    let (mut connectivity, mut offsets, mut first) = (Vec::new(), Vec::new(), 0);
    for &(n, closed) in curves {
        connectivity.extend(first..first + n as i64);
        connectivity.extend(closed.then_some(first));
        offsets.push(connectivity.len() as i64);
        first += n as i64;
    }
    let mut file = File::new("PolyData", "", about);
    file.open(&format!(
        "Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
        points.len(),
        curves.len()
    ));
    file.block("PointData", at_points);
    if !of_lines.is_empty() {
        file.block("CellData", of_lines);
    }
    let points = Array::vectors("Points", points.iter().copied());
    file.block("Points", &[points]);
    let connectivity = Array::indices("connectivity", connectivity);
    file.block("Lines", &[connectivity, Array::indices("offsets", offsets)]);
    file.write(path)
}

/// Writes cells of N corners each, segments or triangles, as `.vtu`; there may be none.
pub fn cells<const N: usize>(
    path: &Path,
    about: &About,
    points: &[Vector3<f64>],
    corners: &[[u64; N]],
    arrays: &[Array],
) -> Result<(), ViewError> {
    // VTK_LINE, VTK_TRIANGLE
    let kind = if N == 2 { 3 } else { 5 };
    let mut file = File::new("UnstructuredGrid", "", about);
    file.open(&format!(
        "Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"",
        points.len(),
        corners.len()
    ));
    file.block("PointData", arrays);
    let points = Array::vectors("Points", points.iter().copied());
    file.block("Points", &[points]);
    let ends = (1..=corners.len()).map(|k| (N * k) as i64);
    file.block(
        "Cells",
        &[
            Array::indices(
                "connectivity",
                corners.as_flattened().iter().map(|c| *c as i64),
            ),
            Array::indices("offsets", ends),
            Array::bytes("types", &vec![kind; corners.len()]),
        ],
    );
    file.write(path)
}

/// A regular grid of points, x running fastest.
#[derive(Debug, Clone, Copy)]
pub struct Lattice {
    /// Points along x, y, z.
    pub n_points: [usize; 3],
    /// The first point.
    pub origin: [f64; 3],
    /// Distance of neighbours.
    pub spacing: f64,
}

/// Writes numbers on a lattice as `.vti`.
pub fn image(
    path: &Path,
    about: &About,
    lattice: &Lattice,
    arrays: &[Array],
) -> Result<(), ViewError> {
    let last = lattice.n_points.map(|n| n.saturating_sub(1));
    let extent = format!("0 {} 0 {} 0 {}", last[0], last[1], last[2]);
    let ([x, y, z], h) = (lattice.origin, lattice.spacing);
    let place = format!(" WholeExtent=\"{extent}\" Origin=\"{x} {y} {z}\" Spacing=\"{h} {h} {h}\"");
    let mut file = File::new("ImageData", &place, about);
    file.open(&format!("Piece Extent=\"{extent}\""));
    file.block("PointData", arrays);
    file.write(path)
}

/// Writes the collection `.pvd` that tells ParaView and PyVista the times of files beside it.
pub fn series(path: &Path, files: &[(f64, String)]) -> Result<(), ViewError> {
    let mut text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n".to_owned();
    for (time, file) in files {
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{file}\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    data::write(path, text.as_bytes())
}

/// A file in the making.
struct File {
    text: String,
    /// Names of what is to be closed, the innermost last.
    open: Vec<String>,
}

impl File {
    /// The beginning, up to the only piece.
    fn new(kind: &str, attributes: &str, about: &About) -> Self {
        let mut file = Self {
            text: "<?xml version=\"1.0\"?>\n".to_owned(),
            open: Vec::new(),
        };
        file.open(&format!(
            "VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\""
        ));
        file.open(&format!("{kind}{attributes}"));
        file.open("FieldData");
        for (name, fact) in about.facts() {
            file.fact(&escaped(name), fact);
        }
        file.close();
        file
    }

    fn open(&mut self, tag: &str) {
        let _ = writeln!(self.text, "<{tag}>");
        let name = tag.split(' ').next().unwrap_or(tag);
        self.open.push(name.to_owned());
    }

    fn close(&mut self) {
        let name = self.open.pop().unwrap_or_default();
        let _ = writeln!(self.text, "</{name}>");
    }

    /// Field data: numbers as one tuple, words as the codes of their bytes and a zero.
    fn fact(&mut self, name: &str, fact: &Fact) {
        let _ = match fact {
            Fact::Numbers(values) => {
                let values: Vec<String> = values.iter().map(|x| format!("{x:?}")).collect();
                writeln!(
                    self.text,
                    "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>",
                    values.len(),
                    values.join(" ")
                )
            }
            Fact::Words(words) => {
                let codes: Vec<String> = words.bytes().map(|b| b.to_string()).collect();
                writeln!(
                    self.text,
                    "<Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{} 0</Array>",
                    codes.join(" ")
                )
            }
        };
    }

    fn block(&mut self, name: &str, arrays: &[Array]) {
        self.open(name);
        for a in arrays {
            let _ = writeln!(
                self.text,
                "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>",
                a.kind,
                a.name,
                a.n_components,
                base64(&a.bytes)
            );
        }
        self.close();
    }

    fn write(mut self, path: &Path) -> Result<(), ViewError> {
        while !self.open.is_empty() {
            self.close();
        }
        data::write(path, self.text.as_bytes())
    }
}

fn escaped(name: &str) -> String {
    name.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}
