//! What can go wrong with knots; each case names the cause and the remedy.

use std::path::PathBuf;

use thiserror::Error;

use crate::{TightKnot, TightLink};

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
        "this is a link of {n_components} components where a knot, one component, is needed: give one component at a time, or a link where links are served"
    )]
    Link {
        /// Number of components.
        n_components: usize,
    },
    /// No link of that name is in the table.
    #[error(
        "no link `{name}` in the table; {}names are such as L6a4, whitehead, chain(3) or T(3,3)", near_links(.near)
    )]
    UnknownLink {
        /// The requested name.
        name: String,
        /// Names in the table that resemble it.
        near: Vec<String>,
    },
    /// A single component where a link is needed.
    #[error(
        "this is a knot, a single component, where a link of several is needed: give it as a knot"
    )]
    NoLink,
    /// A component of a link is refused.
    #[error("component {component}: {reason}")]
    Component {
        /// Number of the component, from 1.
        component: usize,
        /// Why.
        reason: Box<KnotError>,
    },
    /// A component is open.
    #[error(
        "component {component} is open: its ends are {gap:.3} times its longest edge apart; close it, or repeat its first vertex at the end"
    )]
    OpenComponent {
        /// Number of the component, from 1.
        component: usize,
        /// Distance of the ends over the longest edge.
        gap: f64,
    },
    /// Two components have a point in common, or all of them.
    #[error(
        "components {first} and {second} {}; move them apart, or remove one if it was given twice", touching(*.share, *.depth)
    )]
    ComponentsTouch {
        /// Number of one component, from 1.
        first: usize,
        /// Number of the other.
        second: usize,
        /// Share of the vertices of the first that lie on the second.
        share: f64,
        /// Distance of the two over the size of both together.
        depth: f64,
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
    /// The tightening of a link was interrupted: nothing is kept of it but this.
    #[error(
        "{}: interrupted; the best curves so far have length {:.4} over their radius",
        best.name,
        best.length_over_radius
    )]
    InterruptedLink {
        /// The best curves so far, not converged.
        best: Box<TightLink>,
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

fn touching(share: f64, depth: f64) -> String {
    match share {
        1.0 => "coincide at every vertex of the first".to_owned(),
        s if s > 0.0 => format!(
            "coincide at {:.3} % of the vertices of the first",
            100.0 * s
        ),
        _ => format!("meet: they come within {depth:.1e} of their size"),
    }
}

fn near_links(near: &[String]) -> String {
    match near.is_empty() {
        true => String::new(),
        false => format!("did you mean {}? ", near.join(", ")),
    }
}

fn near_names(near: &[String]) -> String {
    if near.is_empty() {
        String::new()
    } else {
        format!("did you mean {}? Or ", near.join(", "))
    }
}
