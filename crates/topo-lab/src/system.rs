//! The systems that maps of the extremes and trade-offs are about.

/// Which part of the product is driven to its extremes, or measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum System {
    /// Charge, cut and discharge of knotted rods.
    Rod,
    /// Charge, switch and discharge of colloids.
    Nematic,
    /// Tight shapes of knots, and the naming of curves.
    Knots,
}

impl System {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Rod, Self::Nematic, Self::Knots];

    /// Stem of its table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rod => "rod",
            Self::Nematic => "nematic",
            Self::Knots => "knots",
        }
    }
}
