//! A picture that a battery draws of its own.

use super::cases::Cases;
use crate::error::ViewError;
use crate::figures::Drawn;

/// A picture of a sweep that only its battery can draw, such as the shapes of its charged states.
#[derive(Debug, Clone, Copy)]
pub struct OwnPicture {
    /// File stem.
    pub name: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Draws it; `None` where the cases have nothing of the kind.
    pub draw: fn(&Cases) -> Result<Option<Drawn>, ViewError>,
}
