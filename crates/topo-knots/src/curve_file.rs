//! Curves from and to files: comma-separated values, plain XYZ, and Geomview's VECT, the format of Ridgerunner and KnotPlot.

use std::fmt::Write as _;
use std::path::Path;

use topo_core::{Polyline, write_atomic_bytes};

use crate::{KnotError, V};

/// A file format for curves.
///
/// # Validation
/// `curves_survive_every_format`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveFormat {
    /// A header with the columns `x`, `y`, `z`, then a vertex a line.
    Csv,
    /// Three numbers a line; a blank line starts another component, `#` a comment. The molecular form (a count, a title, then an
    /// element with its three numbers a line) is read too.
    Xyz,
    /// Geomview's VECT: components with their numbers of vertices, negative for closed ones.
    Vect,
}

impl CurveFormat {
    /// The format that the extension of a file's name stands for: `csv`, `xyz` or `txt`, `vect` or `vec`.
    ///
    /// # Errors
    /// [`KnotError::CurveFile`] for another extension.
    pub fn of(path: &Path) -> Result<Self, KnotError> {
        let extension = path.extension().and_then(|e| e.to_str());
        match extension.map(str::to_ascii_lowercase).as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("xyz" | "txt" | "dat") => Ok(Self::Xyz),
            Some("vect" | "vec") => Ok(Self::Vect),
            _ => Err(fault(
                path,
                "the extension tells no format; use .csv, .xyz or .vect".to_owned(),
            )),
        }
    }
}

/// One component of a file: its vertices, and whether it is closed where the format says so.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveComponent {
    /// Vertices in order; a last one that repeats the first is left out and makes the component closed.
    pub vertices: Vec<V>,
    /// Whether the curve is closed; `None` in formats that do not tell.
    pub closed: Option<bool>,
}

/// Reads all components of a file, in the format that its extension stands for.
///
/// # Errors
/// [`KnotError::Io`], [`KnotError::CurveFile`] naming the line, [`KnotError::NotFinite`].
pub fn read_components(path: &Path) -> Result<Vec<CurveComponent>, KnotError> {
    let format = CurveFormat::of(path)?;
    let text = std::fs::read_to_string(path).map_err(|source| KnotError::Io {
        path: path.to_owned(),
        action: "read",
        source,
    })?;
    parse_components(path, &text, format)
}

/// Reads the only component of a file.
///
/// # Errors
/// As [`read_components`], and [`KnotError::Link`] if there are several.
pub fn read_curve(path: &Path) -> Result<CurveComponent, KnotError> {
    only(path, read_components(path)?)
}

pub(crate) fn only(
    path: &Path,
    components: Vec<CurveComponent>,
) -> Result<CurveComponent, KnotError> {
    let n_components = components.len();
    let mut components = components.into_iter();
    match (components.next(), n_components) {
        (Some(component), 1) => Ok(component),
        (None, _) => Err(fault(path, "there is no vertex in it".to_owned())),
        _ => Err(KnotError::Link { n_components }),
    }
}

/// Writes a curve in the format that the extension of `path` stands for.
///
/// # Errors
/// [`KnotError::CurveFile`] for an unknown extension, [`KnotError::File`] if it cannot be written.
pub fn write_curve(path: &Path, curve: &Polyline) -> Result<(), KnotError> {
    let text = curve_text(curve, CurveFormat::of(path)?);
    Ok(write_atomic_bytes(path, text.as_bytes())?)
}

/// The text of a curve in a format; numbers read back to the bit.
pub fn curve_text(curve: &Polyline, format: CurveFormat) -> String {
    let n = curve.n_vertices();
    let (mut text, comma) = match format {
        CurveFormat::Csv => ("x,y,z\n".to_owned(), ','),
        CurveFormat::Xyz => (String::new(), ' '),
        CurveFormat::Vect => {
            let sign = if curve.is_closed() { "-" } else { "" };
            (format!("VECT\n1 {n} 0\n{sign}{n}\n0\n"), ' ')
        }
    };
    for x in curve.vertices() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}{comma}{}{comma}{}", x.x, x.y, x.z);
    }
    text
}

/// The components in the text of a file; `path` names it in messages.
///
/// # Errors
/// As [`read_components`], but for those of the file system.
///
/// # Validation
/// `curves_survive_every_format`.
pub fn parse_components(
    path: &Path,
    text: &str,
    format: CurveFormat,
) -> Result<Vec<CurveComponent>, KnotError> {
    let mut components = match format {
        CurveFormat::Csv => csv(path, text)?,
        CurveFormat::Xyz => xyz(path, text)?,
        CurveFormat::Vect => vect(path, text)?,
    };
    for component in &mut components {
        let finite = |x: &V| x.iter().all(|c| c.is_finite());
        if let Some(vertex) = component.vertices.iter().position(|x| !finite(x)) {
            return Err(KnotError::NotFinite { vertex });
        }
        let vertices = &mut component.vertices;
        if vertices.len() > 3 && vertices.first() == vertices.last() {
            vertices.pop();
            component.closed = Some(true);
        }
    }
    Ok(components)
}

fn fault(path: &Path, problem: String) -> KnotError {
    KnotError::CurveFile {
        path: path.to_owned(),
        problem,
    }
}

fn number(path: &Path, line: usize, cell: &str) -> Result<f64, KnotError> {
    cell.parse()
        .map_err(|_| fault(path, format!("line {line}: `{cell}` is not a number")))
}

fn csv(path: &Path, text: &str) -> Result<Vec<CurveComponent>, KnotError> {
    let mut lines = (1..).zip(text.lines()).filter(|(_, l)| {
        let l = l.trim();
        !l.is_empty() && !l.starts_with('#')
    });
    let header = lines.next().map_or("", |(_, line)| line);
    let names: Vec<String> = header
        .split(',')
        .map(|cell| cell.trim().trim_matches('"').to_ascii_lowercase())
        .collect();
    let mut columns = [0; 3];
    for (column, name) in columns.iter_mut().zip(["x", "y", "z"]) {
        *column = names.iter().position(|n| n == name).ok_or_else(|| {
            fault(
                path,
                format!("the first line must be a header that names the columns x, y and z; it is `{header}`"),
            )
        })?;
    }
    let mut vertices = Vec::new();
    for (line, row) in lines {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        if cells.len() != names.len() {
            let (found, expected) = (cells.len(), names.len());
            return Err(fault(
                path,
                format!("line {line}: {found} columns instead of {expected}"),
            ));
        }
        let mut x = V::zeros();
        for (k, column) in columns.iter().enumerate() {
            x[k] = number(path, line, cells[*column])?;
        }
        vertices.push(x);
    }
    Ok(Vec::from_iter((!vertices.is_empty()).then_some(
        CurveComponent {
            vertices,
            closed: None,
        },
    )))
}

fn xyz(path: &Path, text: &str) -> Result<Vec<CurveComponent>, KnotError> {
    let mut lines: Vec<(usize, &str)> = (1..).zip(text.lines().map(str::trim)).collect();
    let first = lines.iter().find(|(_, line)| !line.is_empty());
    let is_molecular = first.is_some_and(|(_, line)| line.parse::<usize>().is_ok());
    if is_molecular {
        let start = lines.iter().position(|(_, line)| !line.is_empty());
        let n: usize = first.map_or(0, |(_, line)| line.parse().unwrap_or(0));
        let skipped = start.unwrap_or(0) + 2;
        lines.drain(..skipped.min(lines.len()));
        if lines.len() < n {
            let found = lines.len();
            return Err(fault(
                path,
                format!("line 1 announces {n} vertices, {found} lines follow the title"),
            ));
        }
        lines.truncate(n);
    }
    let mut components: Vec<CurveComponent> = Vec::new();
    let mut open = false;
    for (line, row) in lines {
        if row.starts_with('#') {
            continue;
        }
        if row.is_empty() {
            open = false;
            continue;
        }
        let mut cells: Vec<&str> = row
            .split(|c: char| c.is_whitespace() || c == ',')
            .filter(|cell| !cell.is_empty())
            .collect();
        if is_molecular && cells.len() > 3 {
            cells = cells[1..4].to_vec();
        }
        let &[x, y, z] = &cells[..] else {
            let found = cells.len();
            return Err(fault(
                path,
                format!("line {line}: {found} numbers instead of 3"),
            ));
        };
        let vertex = V::new(
            number(path, line, x)?,
            number(path, line, y)?,
            number(path, line, z)?,
        );
        match components.last_mut() {
            Some(last) if open => last.vertices.push(vertex),
            _ => components.push(CurveComponent {
                vertices: vec![vertex],
                closed: None,
            }),
        }
        open = true;
    }
    Ok(components)
}

fn vect(path: &Path, text: &str) -> Result<Vec<CurveComponent>, KnotError> {
    let mut words = (1..).zip(text.lines()).flat_map(|(line, row)| {
        let row = row.split('#').next().unwrap_or("");
        row.split_whitespace().map(move |word| (line, word))
    });
    if words.next().is_none_or(|(_, word)| word != "VECT") {
        return Err(fault(path, "the first word must be VECT".to_owned()));
    }
    let mut next = |what: &str| {
        words
            .next()
            .ok_or_else(|| fault(path, format!("the file ends where {what} should stand")))
    };
    let mut integer = |what: &str| -> Result<i64, KnotError> {
        let (line, word) = next(what)?;
        word.parse()
            .map_err(|_| fault(path, format!("line {line}: `{word}` is not {what}")))
    };
    let n_components = integer("the number of components")?;
    let n_vertices = integer("the number of vertices")?;
    integer("the number of colours")?;
    // A count beyond the text is an error below, not a reason to reserve memory.
    let sizes = (0..n_components)
        .map(|_| integer("the size of a component"))
        .collect::<Result<Vec<i64>, _>>()?;
    for _ in 0..n_components {
        integer("the number of colours of a component")?;
    }
    let sum: i128 = sizes.iter().map(|n| i128::from(n.unsigned_abs())).sum();
    if sum != i128::from(n_vertices) {
        return Err(fault(
            path,
            format!("the components have {sum} vertices together, line 2 announces {n_vertices}"),
        ));
    }
    let mut components = Vec::new();
    for size in sizes {
        let mut vertices = Vec::new();
        for _ in 0..size.unsigned_abs() {
            let mut x = V::zeros();
            for k in 0..3 {
                let (line, word) = next("a coordinate")?;
                x[k] = number(path, line, word)?;
            }
            vertices.push(x);
        }
        components.push(CurveComponent {
            vertices,
            closed: Some(size < 0),
        });
    }
    Ok(components)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_braid;

    fn parse(text: &str, format: CurveFormat) -> Result<Vec<CurveComponent>, KnotError> {
        parse_components(Path::new("curve"), text, format)
    }

    #[test]
    fn curves_survive_every_format() {
        let closed = closed_braid(&[1, 1, 1]).expect("a knot");
        let open = Polyline::new(closed.vertices()[..40].to_vec(), false).expect("a chain");
        let folder = std::env::temp_dir().join(format!("topo-knots-curves-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("folder");
        for curve in [&closed, &open] {
            for name in ["c.csv", "c.xyz", "c.vect", "c.VECT"] {
                let path = folder.join(name);
                write_curve(&path, curve).expect("written");
                let found = read_curve(&path).expect("read");
                assert_eq!(found.vertices, curve.vertices(), "{name}");
                let told = name.to_ascii_lowercase().ends_with("vect");
                assert_eq!(found.closed, told.then_some(curve.is_closed()));
            }
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn other_people_s_files_are_read() {
        let vect = "VECT # a comment\n2 7 1\n-3 4\n1 0\n0 0 0  1 0 0\n0 1 0\n 5 5 5 6 5 5 6 6 5 6 6 6\n1 0 0 1\n";
        let found = parse(vect, CurveFormat::Vect).expect("two components");
        assert_eq!(found.len(), 2);
        assert_eq!(
            (found[0].closed, found[1].closed),
            (Some(true), Some(false))
        );
        assert!(matches!(
            only(Path::new("c"), found),
            Err(KnotError::Link { n_components: 2 })
        ));
        let molecular = "4\na title\nC 0 0 0\nC 1 0 0\nC 1 1 0\nC 0 0 0\n";
        let found = parse(molecular, CurveFormat::Xyz).expect("one component");
        assert_eq!((found[0].vertices.len(), found[0].closed), (3, Some(true)));
        let spaced = "# KnotPlot\n0 0 0\n1 0 0\n\n\n5, 5, 5\n6 6 6\n";
        assert_eq!(parse(spaced, CurveFormat::Xyz).expect("two").len(), 2);
        let columns = "s,z,y,x\n0,3,2,1\n1,6,5,4\n";
        let found = parse(columns, CurveFormat::Csv).expect("one component");
        assert_eq!(found[0].vertices[1], V::new(4.0, 5.0, 6.0));
    }

    #[test]
    fn faults_are_named_with_their_lines() {
        for (text, format, expected) in [
            ("x,y\n0,0\n", CurveFormat::Csv, "columns x, y and z"),
            (
                "x,y,z\n0,0,0\n1,oops,0\n",
                CurveFormat::Csv,
                "line 3: `oops`",
            ),
            ("x,y,z\n0,0\n", CurveFormat::Csv, "line 2: 2 columns"),
            ("0 0 0\n1 1\n", CurveFormat::Xyz, "line 2: 2 numbers"),
            ("9\ntitle\nC 0 0 0\n", CurveFormat::Xyz, "announces 9"),
            (
                "0 0 0\n0 NaN 0\n",
                CurveFormat::Xyz,
                "vertex 1 is not finite",
            ),
            ("VEC\n", CurveFormat::Vect, "must be VECT"),
            (
                "VECT\n1 3 0\n-4\n0\n",
                CurveFormat::Vect,
                "4 vertices together",
            ),
            (
                "VECT\n1 3 0\n-3\n0\n0 0 0\n1 x",
                CurveFormat::Vect,
                "line 6: `x`",
            ),
            (
                "VECT\n9999999999 3 0\n-3\n0\n",
                CurveFormat::Vect,
                "file ends",
            ),
        ] {
            let error = parse(text, format).expect_err(expected).to_string();
            assert!(error.contains(expected), "{expected}: {error}");
        }
        assert!(matches!(
            CurveFormat::of(Path::new("knot.obj")),
            Err(KnotError::CurveFile { .. })
        ));
        let none = only(Path::new("c"), parse("", CurveFormat::Xyz).expect("empty"));
        assert!(none.expect_err("empty").to_string().contains("no vertex"));
    }
}
