//! What can be wrong with a rod before a run starts.

use thiserror::Error;
use topo_core::{CurveError, FileError, InvalidValue};

/// A rod, its parameters or its protocol is invalid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RodError {
    /// A number is out of its range.
    #[error(transparent)]
    Value(#[from] InvalidValue),
    /// The centreline is not usable.
    #[error("the centreline cannot carry a rod: {0}")]
    Centreline(#[from] CurveError),
    /// The centreline runs through itself, so that no tube follows it.
    #[error(
        "the centreline touches itself (thickness {thickness:.1e} of {length:.4} in length): no rod can follow it, use a curve whose strands are apart"
    )]
    TouchesItself {
        /// Thickness of the curve, in the unit of the curve.
        thickness: f64,
        /// Its length, in the unit of the curve.
        length: f64,
    },
    /// A disturbed start curve is not near the undisturbed one.
    #[error(
        "the start curve was moved by {moved:.3} h (inf: it has other vertices): keep its vertices and move each by at most {most:.1} h"
    )]
    Disturbance {
        /// Largest displacement, in h; infinite for another number of vertices.
        moved: f64,
        /// What is allowed.
        most: f64,
    },
    /// Fewer edges than a rod needs.
    #[error("a rod of {n_edges} edges cannot be modelled: use at least {least} edges")]
    TooFewEdges {
        /// Edges requested.
        n_edges: usize,
        /// The least number accepted.
        least: usize,
    },
    /// A link without rods.
    #[error("a link needs at least one component: give it a curve")]
    NoComponent,
    /// A component that does not exist, or the same one twice where two are needed.
    #[error(
        "there is no such component as {c} here: take one of 0 to {n_components} - 1, none twice"
    )]
    Component {
        /// Component requested.
        c: usize,
        /// How many there are.
        n_components: usize,
    },
    /// The operation needs the other kind of rod.
    #[error("{operation} needs {needed} rod")]
    WrongTopology {
        /// The operation.
        operation: &'static str,
        /// "a closed" or "an open".
        needed: &'static str,
    },
    /// An end condition contradicts another, or nothing would balance the forces on the rod.
    #[error("the ends are not held consistently: {reason}")]
    Ends {
        /// What is inconsistent, and what would be right.
        reason: &'static str,
    },
    /// A number in time that is none.
    #[error("{key} cannot follow its course in time: {reason}")]
    Course {
        /// Which number of a grip.
        key: &'static str,
        /// What is wrong, and what would be right.
        reason: &'static str,
    },
    /// A load of the ends that cannot be.
    #[error("{key} cannot be: {reason}")]
    Load {
        /// Its key in a scene.
        key: &'static str,
        /// What is wrong, and what would be right.
        reason: &'static str,
    },
    /// A turning angle reached a half turn: the discrete curvature has no value there.
    #[error(
        "the rod folds back on itself at vertex {vertex}: use more edges or a smoother start curve"
    )]
    Folded {
        /// The vertex where two edges are opposite.
        vertex: usize,
    },
    /// An energy term of the caller has a name that cannot be used.
    #[error("the energy term \"{name}\" cannot be added: {reason}")]
    Term {
        /// Its name.
        name: &'static str,
        /// What would be right.
        reason: &'static str,
    },
    /// The start state has no finite energy.
    #[error("the rod cannot start: {0}")]
    Start(#[from] topo_core::Rejection),
    /// A checkpoint could not be written or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The cut is at an end of an open rod.
    #[error("cut at s/L = {at} is at an end of the open rod: cut two edges from it at least")]
    CutAtEnd {
        /// Position requested, s/L.
        at: f64,
    },
    /// The cut is outside of the rod.
    #[error("cut at s/L = {at} is not on the rod: use a number in [0, 1)")]
    CutSite {
        /// Position requested, s/L.
        at: f64,
    },
}
