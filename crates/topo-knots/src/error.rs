//! What can go wrong with knots; each case names the cause and the remedy.

use std::path::PathBuf;

use thiserror::Error;

use crate::TightKnot;

/// Refusals of the knot table, the braid closure, the tightening and the identification.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum KnotError {
    /// No knot of that name is in the table.
    #[error("no knot `{name}` in the table; {}add one with a file `{name}.toml` in a knot folder", near_names(.near))]
    UnknownKnot {
        /// The requested name.
        name: String,
        /// Names in the table that resemble it.
        near: Vec<String>,
    },
    /// A sum that is not in the table, with a factor that has no braid word.
    #[error(
        "`{name}` is not in the table, and cannot be made from its factors as `{factor}` has no braid word; add `braid` to the file of `{factor}`, or a file `{name}.toml` with a curve"
    )]
    SumWithoutWord {
        /// The sum.
        name: String,
        /// The factor without a word.
        factor: String,
    },
    /// The braid word has no letters.
    #[error(
        "the braid word is empty; give generators such as [1, 1, 1] (the trefoil), or a polygon"
    )]
    EmptyBraid,
    /// A letter of the braid word is no integer.
    #[error("`{letter}` is no generator of a braid; give integers such as \"1 -2 1 -2\"")]
    Letter {
        /// What was given.
        letter: String,
    },
    /// A letter of the braid word is zero.
    #[error(
        "generator {position} of the braid word is 0; generators count from 1, a negative one is the inverse"
    )]
    ZeroGenerator {
        /// Position of the letter, from 0.
        position: usize,
    },
    /// A letter of the braid word is beyond the largest one that the embedding accepts.
    #[error("generator {generator} of the braid word is beyond the largest served, {largest}")]
    GeneratorTooLarge {
        /// The letter.
        generator: i32,
        /// The largest letter accepted.
        largest: i32,
    },
    /// A strand between the first and the last is touched by no generator, so the closure falls apart.
    #[error(
        "generator {generator} (or its inverse) never occurs in the braid word, so its closure falls apart; use every generator from 1 to {largest}"
    )]
    UnusedGenerator {
        /// The missing generator.
        generator: i32,
        /// The largest generator of the word.
        largest: i32,
    },
    /// Several components instead of one.
    #[error(
        "this is a link of {n_components} components; only knots (one component) are served: give one component at a time"
    )]
    Link {
        /// Number of components.
        n_components: usize,
    },
    /// A knot file could not be understood.
    #[error("{}: {problem}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Key, value and remedy.
        problem: String,
    },
    /// A file of coordinates could not be understood.
    #[error("{}: {problem}", path.display())]
    CurveFile {
        /// The file.
        path: PathBuf,
        /// Line and remedy.
        problem: String,
    },
    /// A file could not be read or written.
    #[error("{}: cannot {action}: {source}; {}", path.display(), io_remedy(.source))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was tried.
        action: &'static str,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The invariants of the coordinates contradict those in the table.
    #[error(
        "{knot}: {what} is {found} from the coordinates but {expected} in the table; correct the braid word or the invariants of the knot file"
    )]
    Mismatch {
        /// The knot.
        knot: String,
        /// Which invariant.
        what: &'static str,
        /// The table's value.
        expected: String,
        /// The value found.
        found: String,
    },
    /// A curve changed its knot type while it was deformed.
    #[error(
        "{knot}: the curve passed through itself while {stage} (found {found}); lower the step limit or use another start"
    )]
    PassedThroughItself {
        /// The knot.
        knot: String,
        /// What was being done.
        stage: &'static str,
        /// The type found afterwards.
        found: String,
    },
    /// The coordinates cannot make a curve.
    #[error("a closed curve needs at least 3 vertices and an open one 2, got {n_vertices}")]
    TooFewVertices {
        /// How many were given.
        n_vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A coordinate has digits too far below the size of the curve for exact arithmetic.
    #[error(
        "vertex {vertex} has a coordinate so small beside the size of the curve that exact arithmetic cannot hold both; round it, to 0 say"
    )]
    Spread {
        /// Index of the vertex.
        vertex: usize,
    },
    /// No projection of the curve was in general position.
    #[error(
        "no projection of the curve is in general position; does the curve touch or overlap itself?"
    )]
    Degenerate,
    /// The diagram has too many crossings for exact invariants.
    #[error(
        "the simplest diagram found has {n_crossings} crossings, too many for exact invariants; untangle or smooth the curve, or shorten the braid word"
    )]
    TooComplicated {
        /// Its number of crossings.
        n_crossings: usize,
    },
    /// A setting is out of its range.
    #[error("setting `{name}` is {value}; {expected}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Value given.
        value: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// No start led to a tight shape.
    #[error("{knot}: none of the {n_starts} starts could be tightened; last reason: {last}")]
    NotTightened {
        /// The knot.
        knot: String,
        /// Number of starts tried.
        n_starts: usize,
        /// Reason of the last failure.
        last: String,
    },
    /// The tightening was interrupted: nothing is kept of it but this.
    #[error(
        "{}: interrupted; the best curve so far has length {:.4} over its radius",
        best.name,
        best.length_over_radius
    )]
    Interrupted {
        /// The best curve so far, not converged.
        best: Box<TightKnot>,
    },
    /// A file of the cache could not be written.
    #[error(transparent)]
    File(#[from] topo_core::FileError),
    /// The curve is refused by the geometry.
    #[error(transparent)]
    Curve(#[from] topo_core::CurveError),
}

fn io_remedy(source: &std::io::Error) -> &'static str {
    match source.kind() {
        std::io::ErrorKind::NotFound => "check that the path exists",
        std::io::ErrorKind::PermissionDenied => "check its permissions",
        std::io::ErrorKind::InvalidData => "save it as UTF-8 text",
        _ => "check the path, its permissions and the disk",
    }
}

fn near_names(near: &[String]) -> String {
    if near.is_empty() {
        String::new()
    } else {
        format!("did you mean {}? Or ", near.join(", "))
    }
}
