//! VTK XML files; the only file that names the crate which writes them.

use crate::data;
use crate::error::XtaskError;
use nalgebra::Vector3;
use std::fmt::Write as _;
use std::path::Path;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, Extent, IOBuffer, ImageDataPiece,
    Piece, PolyDataPiece, UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};

/// Numbers at the points of a file.
pub struct Array {
    name: &'static str,
    n_components: u32,
    values: IOBuffer,
}

impl Array {
    /// One number a point.
    pub fn scalars(name: &'static str, values: Vec<f64>) -> Self {
        Self::new(name, 1, IOBuffer::F64(values))
    }

    /// Three numbers a point.
    pub fn vectors(name: &'static str, values: impl Iterator<Item = Vector3<f64>>) -> Self {
        Self::new(name, 3, IOBuffer::F64(flat(values)))
    }

    /// So many numbers a point, to single precision.
    pub fn single(name: &'static str, n_components: u32, values: Vec<f32>) -> Self {
        Self::new(name, n_components, IOBuffer::F32(values))
    }

    /// One small whole number a point.
    pub fn bytes(name: &'static str, values: Vec<u8>) -> Self {
        Self::new(name, 1, IOBuffer::U8(values))
    }

    fn new(name: &'static str, n_components: u32, values: IOBuffer) -> Self {
        Self {
            name,
            n_components,
            values,
        }
    }
}

/// Writes one line through all points as `.vtp`.
pub fn line(
    path: &Path,
    points: &[Vector3<f64>],
    closed: bool,
    arrays: Vec<Array>,
) -> Result<(), XtaskError> {
    let mut connectivity: Vec<u64> = (0..points.len() as u64).collect();
    if closed {
        connectivity.push(0);
    }
    let offsets = vec![connectivity.len() as u64];
    write(
        path,
        DataSet::inline(PolyDataPiece {
            points: IOBuffer::F64(flat(points.iter().copied())),
            lines: Some(VertexNumbers::XML {
                connectivity,
                offsets,
            }),
            data: attributes(arrays),
            ..PolyDataPiece::default()
        }),
    )
}

/// Writes cells of N corners each, segments or triangles, as `.vtu`.
pub fn cells<const N: usize>(
    path: &Path,
    points: &[Vector3<f64>],
    corners: &[[u64; N]],
    arrays: Vec<Array>,
) -> Result<(), XtaskError> {
    let kind = if N == 2 {
        CellType::Line
    } else {
        CellType::Triangle
    };
    let n = corners.len();
    write(
        path,
        DataSet::inline(UnstructuredGridPiece {
            points: IOBuffer::F64(flat(points.iter().copied())),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: corners.as_flattened().to_vec(),
                    offsets: (1..=n).map(|k| (N * k) as u64).collect(),
                },
                types: vec![kind; n],
            },
            data: attributes(arrays),
        }),
    )
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
pub fn image(path: &Path, lattice: &Lattice, arrays: Vec<Array>) -> Result<(), XtaskError> {
    let range = |n: usize| 0..=i32::try_from(n).unwrap_or(i32::MAX) - 1;
    let extent = Extent::Ranges(lattice.n_points.map(range));
    write(
        path,
        DataSet::ImageData {
            extent: extent.clone(),
            origin: lattice.origin.map(|x| x as f32),
            spacing: [lattice.spacing as f32; 3],
            meta: None,
            pieces: vec![Piece::Inline(Box::new(ImageDataPiece {
                extent,
                data: attributes(arrays),
            }))],
        },
    )
}

/// Writes the collection `.pvd` that tells ParaView and PyVista the times of files beside it.
pub fn series(path: &Path, files: &[(f64, String)]) -> Result<(), XtaskError> {
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

fn flat(points: impl Iterator<Item = Vector3<f64>>) -> Vec<f64> {
    points.flat_map(|p| [p.x, p.y, p.z]).collect()
}

fn attributes(arrays: Vec<Array>) -> Attributes {
    let point = arrays
        .into_iter()
        .map(|a| Attribute::generic(a.name, a.n_components).with_data(a.values))
        .collect();
    Attributes {
        point,
        cell: Vec::new(),
    }
}

fn write(path: &Path, data: DataSet) -> Result<(), XtaskError> {
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data,
    };
    let mut bytes = Vec::new();
    file.write_xml(&mut bytes)
        .map_err(|e| XtaskError::Drawing {
            reason: format!("{}: {e}", path.display()),
        })?;
    data::write(path, &bytes)
}
