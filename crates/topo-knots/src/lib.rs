//! Knot table, braid closures, tight shapes, and knot types from coordinates.
//!
//! Reading order: `name` (names of knots and sums), `table` (what is known of a knot), `braid`, `curve_file` (coordinates from and to files), `start_file`, `moebius` and `inversion` (curves to start from),
//! `tighten` (from a loose curve to a tight one, with its certificate), `ideal` (the same, kept on disk),
//! `invariant` (polynomial, determinant and signature from coordinates), `identify` (names from coordinates) and `link` (table,
//! invariants and names of links). What is tightened is `curves`: one closed curve or several.
//!
//! Lengths of tight knots and links are in units of the tube radius: [`TightKnot::length_over_radius`].

mod braid;
mod curve_file;
mod curves;
mod error;
mod exact;
mod ideal;
mod identify;
mod invariant;
mod inversion;
mod link;
mod moebius;
mod name;
mod reduce;
mod rings;
mod start_file;
mod table;
mod tighten;
mod vector;

pub use braid::{braid_closure, closed_braid, n_components, parse_braid};
pub use curve_file::{
    CurveComponent, CurveFile, CurveFormat, CurveFrame, FrameChoice, curve_text, curves_text,
    parse_components, read_components, read_curve, write_curve, write_curves,
};
pub use error::KnotError;
pub use ideal::{
    METHOD_VERSION, ideal, ideal_link, ideal_link_until, ideal_until, is_kept, is_link_kept,
};
pub use identify::{Handedness, KnotType, OpenKnotType, identify, identify_open};
pub use invariant::{
    Invariants, Jones, alexander_polynomial, determinant, jones_polynomial, signature,
};
pub use link::{
    LinkEntry, LinkInvariants, LinkJones, LinkPart, LinkTable, LinkType, identify_link,
    identify_open_link,
};
pub use moebius::relax_moebius;
pub use name::{Factor, KnotName, mirror_name};
pub use start_file::StartCurve;
pub use table::{Chirality, KnotEntry, KnotTable};
pub use tighten::{
    Certificate, SecondOpinion, TightKnot, TightLink, TightenSettings, second_opinion,
    second_opinion_of_link, second_opinion_of_link_until, second_opinion_until, struts,
    struts_of_all, tighten, tighten_by_hops, tighten_by_hops_until, tighten_entry,
    tighten_entry_until, tighten_link, tighten_link_by_hops_until, tighten_link_until,
};

pub use topo_core::{Thickness, thickness, thickness_brute_force, windowed_half_distance};

/// A point or vector in space.
pub use vector::V;
