//! Start curves from files: a polygon in any format for curves, or a Fourier series as comma-separated numbers under a header.

use std::f64::consts::TAU;
use std::path::Path;

use serde::Serialize;
use topo_core::Polyline;

use crate::curve_file::{only, parse_components};
use crate::{CurveFormat, KnotError, V};

/// Vertices of a sampled Fourier curve per harmonic.
const PER_HARMONIC: usize = 24;

/// A closed curve to start tightening from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub enum StartCurve {
    /// Vertices of a closed polygon.
    Polygon(Vec<V>),
    /// Cosine and sine coefficients of each harmonic, from the first on.
    Fourier(Vec<(V, V)>),
}

impl StartCurve {
    /// Reads a closed polygon from the text of a curve file.
    pub(crate) fn polygon(path: &Path, text: &str) -> Result<Self, KnotError> {
        let components = parse_components(path, text, CurveFormat::of(path)?)?;
        Ok(Self::Polygon(only(path, components)?.vertices))
    }

    /// Reads a Fourier series: header `ax,bx,ay,by,az,bz`, then a harmonic a line, a for cosine, b for sine.
    pub(crate) fn fourier(path: &Path, text: &str) -> Result<Self, KnotError> {
        let rows = numbers(path, text, "ax,bx,ay,by,az,bz", 6)?;
        let pair = |r: &Vec<f64>| (V::new(r[0], r[2], r[4]), V::new(r[1], r[3], r[5]));
        Ok(Self::Fourier(rows.iter().map(pair).collect()))
    }

    /// The mirror image in the plane z = 0.
    pub(crate) fn mirror(&self) -> Self {
        let flip = |x: &V| V::new(x.x, x.y, -x.z);
        match self {
            Self::Polygon(vertices) => Self::Polygon(vertices.iter().map(flip).collect()),
            Self::Fourier(terms) => {
                Self::Fourier(terms.iter().map(|(a, b)| (flip(a), flip(b))).collect())
            }
        }
    }

    /// The curve.
    ///
    /// # Errors
    /// [`KnotError::Curve`] if the vertices do not make a closed polygon.
    pub fn curve(&self) -> Result<Polyline, KnotError> {
        let vertices = match self {
            Self::Polygon(vertices) => vertices.clone(),
            Self::Fourier(terms) => {
                let n = (PER_HARMONIC * terms.len()).max(64);
                (0..n)
                    .map(|i| {
                        let mut x = V::zeros();
                        for (k, (a, b)) in terms.iter().enumerate() {
                            let (sin, cos) = (TAU * ((k + 1) * i) as f64 / n as f64).sin_cos();
                            x += a * cos + b * sin;
                        }
                        x
                    })
                    .collect()
            }
        };
        Ok(Polyline::new(vertices, true)?)
    }
}

fn numbers(path: &Path, text: &str, header: &str, n: usize) -> Result<Vec<Vec<f64>>, KnotError> {
    let fault = |problem: String| KnotError::Table {
        path: path.to_owned(),
        problem,
    };
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    if lines
        .next()
        .is_none_or(|(_, line)| line.replace(' ', "") != header)
    {
        return Err(fault(format!(
            "the first line must be the header `{header}`"
        )));
    }
    lines
        .map(|(k, line)| {
            let row: Vec<f64> = line
                .split(',')
                .map(|cell| match cell.trim().parse::<f64>() {
                    Ok(value) if value.is_finite() => Ok(value),
                    _ => Err(fault(format!(
                        "line {}: `{}` is not a number",
                        k + 1,
                        cell.trim()
                    ))),
                })
                .collect::<Result<_, _>>()?;
            if row.len() == n {
                Ok(row)
            } else {
                Err(fault(format!(
                    "line {}: {} columns instead of {n}",
                    k + 1,
                    row.len()
                )))
            }
        })
        .collect()
}
