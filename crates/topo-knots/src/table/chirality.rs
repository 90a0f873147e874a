//! A knot and its mirror image.

use serde::{Deserialize, Serialize};

/// Whether a knot differs from its mirror image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Chirality {
    /// The mirror image is another knot.
    Chiral,
    /// The mirror image is the same knot.
    Amphichiral,
}
