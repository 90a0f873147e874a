//! Kirchhoff rods with twist, contact and friction; the elastic battery: charge, cut, discharge.
