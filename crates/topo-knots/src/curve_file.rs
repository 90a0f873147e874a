//! Curves from and to files: comma-separated values, XYZ, and Geomview's VECT, the format of Ridgerunner and KnotPlot.
//!
//! Reading order: `text` (bytes to lines), `cells` (lines to numbers), `columns` and `rows` (which of them are coordinates),
//! `table` (rows to components and frames), `xyz` (headers, counts and titles), `vect`, and `write`. Nothing in a file is
//! dropped silently: what is not a coordinate is listed in [`CurveFile::notes`] or refused.

mod cells;
mod columns;
mod component;
mod fault;
mod rows;
mod source;
mod table;
mod text;
mod vect;
mod write;
mod xyz;

use std::path::Path;
use std::str::FromStr;

use crate::KnotError;
use component::FrameOf;
use fault::{fault, quoted};

pub use component::CurveComponent;
pub use write::{curve_text, curves_text, write_curve, write_curves};

/// A file format for curves.
///
/// # Validation
/// `curves_survive_every_format`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveFormat {
    /// A header with the columns `x`, `y`, `z`, also after a `#`, then one vertex per line, with commas or semicolons between
    /// the numbers. Further columns may give the component (`component`, `line`, `chain`), the frame (`frame`, `time`, `cut`)
    /// and whether the curve is `closed`.
    Csv,
    /// Three numbers per line; a blank line, `NaN NaN NaN` or `X` starts another component, `#` a comment. A header is read as
    /// in `Csv`. The molecular form (a count, a title, then per line an element with its three numbers, and again for each
    /// frame) is read too.
    Xyz,
    /// Geomview's VECT: components with their numbers of vertices, negative for closed ones.
    Vect,
}

impl CurveFormat {
    /// The format of the extension of a file name: `csv` or `tsv`, `xyz`, `txt` or `dat`, `vect` or `vec`.
    ///
    /// # Errors
    /// [`KnotError::CurveFile`] for another extension.
    pub fn of(path: &Path) -> Result<Self, KnotError> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        extension.parse().map_err(|_: KnotError| {
            fault(
                path,
                "the extension tells no format; use .csv, .xyz or .vect",
            )
        })
    }
}

impl FromStr for CurveFormat {
    type Err = KnotError;

    /// The format of a name such as `csv`.
    fn from_str(name: &str) -> Result<Self, KnotError> {
        match name.to_ascii_lowercase().as_str() {
            "csv" | "tsv" => Ok(Self::Csv),
            "xyz" | "txt" | "dat" => Ok(Self::Xyz),
            "vect" | "vec" => Ok(Self::Vect),
            _ => Err(fault(
                Path::new(name),
                "no format for curves; use csv, xyz or vect",
            )),
        }
    }
}

/// Which frame of a file to read, if it holds a curve at several times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FrameChoice {
    /// The only one; a file with several is refused.
    #[default]
    Only,
    /// The last one.
    Last,
    /// The one with this number, from 1.
    Number(usize),
}

/// A frame of a file that holds several.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CurveFrame {
    /// Its number, from 1.
    pub number: usize,
    /// How many there are.
    pub n_frames: usize,
    /// Its title or its time, if the file gives one.
    pub label: Option<String>,
}

/// What a curve file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveFile {
    /// The components, of the frame that was chosen; at least one.
    pub components: Vec<CurveComponent>,
    /// Which frame that is, if there are several.
    pub frame: Option<CurveFrame>,
    /// Notes for the reader: how columns without names, another encoding and the ends were interpreted.
    pub notes: Vec<String>,
}

impl CurveFile {
    /// Reads a file, in `format` or in the format of its extension; `-` is the standard input.
    ///
    /// # Errors
    /// [`KnotError::Io`], or [`KnotError::CurveFile`] with line and remedy.
    ///
    /// # Validation
    /// `files_as_people_have_them`, `what_does_not_add_up_is_refused_with_its_line`.
    pub fn read(
        path: &Path,
        format: Option<CurveFormat>,
        frame: FrameChoice,
    ) -> Result<Self, KnotError> {
        if format.is_none() && source::is_standard_input(path) {
            let problem = "the standard input has no name to tell its format; give it";
            return Err(fault(path, problem));
        }
        // Read first: what is no file is better called so than an extension unknown.
        let bytes = source::read(path)?;
        let format = format.map_or_else(|| CurveFormat::of(path), Ok)?;
        Self::parse(path, &bytes, format, frame)
    }

    /// Reads the content of a file; `path` names it in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read), except those of the file system.
    pub fn parse(
        path: &Path,
        bytes: &[u8],
        format: CurveFormat,
        choice: FrameChoice,
    ) -> Result<Self, KnotError> {
        if bytes.is_empty() {
            return Err(fault(path, "the file is empty"));
        }
        let (text, note) = text::decode(path, bytes)?;
        let mut notes = Vec::from_iter(note);
        let mut frames = match format {
            CurveFormat::Csv => xyz::csv(path, &text, &mut notes)?,
            CurveFormat::Xyz => xyz::xyz(path, &text, &mut notes)?,
            CurveFormat::Vect => vec![FrameOf {
                label: None,
                components: vect::vect(path, &text)?,
            }],
        };
        let mut seen = std::collections::HashSet::new();
        notes.retain(|note| seen.insert(note.clone()));
        let frame = chosen(path, &frames, choice)?;
        let n_frames = frames.len();
        let FrameOf { label, components } = frames.swap_remove(frame);
        if components.iter().all(|c| c.vertices.is_empty()) {
            let problem = "there is no vertex in it";
            return Err(fault(path, problem));
        }
        Ok(Self {
            components: components.into_iter().map(closed_by_repetition).collect(),
            frame: (n_frames > 1).then_some(CurveFrame {
                number: frame + 1,
                n_frames,
                label,
            }),
            notes,
        })
    }
}

/// The index of the frame to read.
fn chosen(path: &Path, frames: &[FrameOf], choice: FrameChoice) -> Result<usize, KnotError> {
    let n = frames.len();
    let name = |k: usize| {
        frames[k]
            .label
            .as_deref()
            .map_or_else(String::new, |label| format!(" ({})", quoted(label)))
    };
    match choice {
        _ if n == 0 => Err(fault(path, "there is no vertex in it")),
        FrameChoice::Number(k) if k == 0 || k > n => Err(fault(
            path,
            format!(
                "there is no frame {k}; frames are 1{} to {n}{}",
                name(0),
                name(n - 1)
            ),
        )),
        FrameChoice::Number(k) => Ok(k - 1),
        FrameChoice::Only if n > 1 => Err(fault(
            path,
            format!(
                "there are {n} frames, 1{} to {n}{}; choose one or give a file of one",
                name(0),
                name(n - 1)
            ),
        )),
        FrameChoice::Only | FrameChoice::Last => Ok(n - 1),
    }
}

fn closed_by_repetition(mut component: CurveComponent) -> CurveComponent {
    let vertices = &mut component.vertices;
    if vertices.len() > 3 && vertices.first() == vertices.last() {
        vertices.pop();
        component.closed = Some(true);
        component.repeats_first = true;
    }
    component
}

/// Reads all components of a file of one frame, in the format of its extension.
///
/// # Errors
/// As [`CurveFile::read`], and [`KnotError::CurveFile`] for a file of several frames.
pub fn read_components(path: &Path) -> Result<Vec<CurveComponent>, KnotError> {
    Ok(CurveFile::read(path, None, FrameChoice::Only)?.components)
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
        (None, _) => Err(fault(path, "there is no vertex in it")),
        _ => Err(KnotError::Link { n_components }),
    }
}

/// The components in the content of a file of one frame; `path` names it in messages.
///
/// # Errors
/// As [`read_components`], except those of the file system.
pub fn parse_components(
    path: &Path,
    bytes: impl AsRef<[u8]>,
    format: CurveFormat,
) -> Result<Vec<CurveComponent>, KnotError> {
    Ok(CurveFile::parse(path, bytes.as_ref(), format, FrameChoice::Only)?.components)
}

#[cfg(test)]
mod tests;
