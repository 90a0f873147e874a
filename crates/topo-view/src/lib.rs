//! Pictures, pages and exports of the results of topological batteries.
//!
//! Reading order: [`data`] (tables as pictures read them) → [`figures`] and [`movies`] (one file each) → [`gallery`] (the page that
//! shows them, with a viewer in three dimensions) and [`reproduction`] (what they say of published claims); [`export`] writes the shapes
//! and fields of a case for other programs; [`stability`] and [`tradeoff`] draw maps of extremes and of what accuracy costs.
//!
//! Fonts, scripts and templates are inside the library: nothing is looked for at run time but the results.

#[cfg(test)]
mod browser;
pub mod chart;
pub mod data;
mod error;
pub mod export;
pub mod figures;
pub mod folder;
pub mod gallery;
pub mod guide;
pub mod movies;
mod outside;
mod plot;
mod program;
pub mod provenance;
pub mod reproduction;
pub mod scenes;
mod shown;
pub mod stability;
pub mod sweeps;
#[cfg(test)]
mod synthetic;
pub mod tradeoff;
mod viewer;

pub use error::ViewError;
pub use outside::Outside;
pub use plot::text::{number, significant};
pub use program::{call_program, program};
pub use shown::Shown;
