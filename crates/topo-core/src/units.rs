//! Reduced units inside, SI at the edge.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::check::{InvalidValue, positive};

/// Material of a fibre, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RodMaterial {
    /// Bending (Young's) modulus E_b, in pascals.
    pub bending_modulus: f64,
    /// Internal viscosity η, in pascal seconds.
    pub viscosity: f64,
    /// Twisting over bending modulus, α: no unit.
    pub twist_ratio: f64,
    /// Stretching over bending modulus, γ: no unit. Chosen below its true value, as a fibre hardly stretches anyway.
    pub stretch_ratio: f64,
}

/// Silicone: E_b = 10 MPa, η = 10 kPa s, α = 1/1.3, γ = 5.
pub const SILICONE: RodMaterial = RodMaterial {
    bending_modulus: 1e7,
    viscosity: 1e4,
    twist_ratio: 1.0 / 1.3,
    stretch_ratio: 5.0,
};

/// The reduced units of a rod: its radius h, its bending modulus E_b and its viscosity η are 1.
///
/// Times are then in η/E_b. Energies inside the code are divided by the cross section A = π h^2, so they are in E_b h.
///
/// # Validation
/// `silicone_fibre_in_si_units`, `there_and_back_again`
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct RodUnits {
    radius: f64,
    bending_modulus: f64,
    viscosity: f64,
}

#[derive(Deserialize)]
struct Unchecked {
    radius: f64,
    bending_modulus: f64,
    viscosity: f64,
}

impl TryFrom<Unchecked> for RodUnits {
    type Error = InvalidValue;
    fn try_from(raw: Unchecked) -> Result<Self, InvalidValue> {
        Self::new(raw.radius, raw.bending_modulus, raw.viscosity)
    }
}

impl RodUnits {
    /// Units of a rod with this radius (metres), bending modulus (pascals) and viscosity (pascal seconds).
    ///
    /// # Errors
    /// [`InvalidValue`] when an argument is not a positive finite number, or units of time and energy would overflow.
    pub fn new(radius: f64, bending_modulus: f64, viscosity: f64) -> Result<Self, InvalidValue> {
        positive("radius", radius)?;
        positive("bending_modulus", bending_modulus)?;
        positive("viscosity", viscosity)?;
        let units = Self {
            radius,
            bending_modulus,
            viscosity,
        };
        positive("unit of time", units.time_to_seconds(1.0))?;
        positive("unit of energy", units.energy_to_joules(1.0))?;
        Ok(units)
    }

    /// Units of a fibre of `material` with this radius (metres).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(material: &RodMaterial, radius: f64) -> Result<Self, InvalidValue> {
        Self::new(radius, material.bending_modulus, material.viscosity)
    }

    /// A reduced `time` (in η/E_b) in seconds.
    pub fn time_to_seconds(&self, time: f64) -> f64 {
        time * (self.viscosity / self.bending_modulus)
    }

    /// `seconds` as a reduced time (in η/E_b).
    pub fn seconds_to_time(&self, seconds: f64) -> f64 {
        seconds / self.time_to_seconds(1.0)
    }

    /// A reduced `length` (in h) in metres.
    pub fn length_to_metres(&self, length: f64) -> f64 {
        length * self.radius
    }

    /// `metres` as a reduced length (in h).
    pub fn metres_to_length(&self, metres: f64) -> f64 {
        metres / self.radius
    }

    /// A reduced `energy` per cross section (in E_b h) in joules: it counts π E_b h^3.
    pub fn energy_to_joules(&self, energy: f64) -> f64 {
        energy * (PI * self.bending_modulus * self.radius.powi(3))
    }

    /// T_0 = 2 L η/(h E_b) of a rod of reduced `length` L, in seconds.
    pub fn reference_seconds(&self, length: f64) -> f64 {
        self.time_to_seconds(reference_time(length))
    }

    /// E_0 = E_b h² L of a rod of reduced `length` L, in joules.
    pub fn reference_joules(&self, length: f64) -> f64 {
        self.energy_to_joules(reference_energy(length))
    }

    /// Mass of a rod of reduced `length` L and `density` ρ (in kg/m³), in kilograms: ρ π h² L.
    pub fn kilograms(&self, length: f64, density: f64) -> f64 {
        density * (PI * self.radius * self.radius) * self.length_to_metres(length)
    }

    /// `joules` as a reduced energy per cross section (in E_b h).
    pub fn joules_to_energy(&self, joules: f64) -> f64 {
        joules / self.energy_to_joules(1.0)
    }
}

/// T_0 = 2 L η/(h E_b) of a rod of reduced `length` L: the unit in which times are reported.
pub fn reference_time(length: f64) -> f64 {
    2.0 * length
}

/// T_b = 2 L^2 η/(π^2 h^2 E_b): the time in which the bending energy of a nearly straight free rod falls by a factor e.
pub fn bending_time(length: f64) -> f64 {
    2.0 * length * length / (PI * PI)
}

/// T_tw = η/(α E_b): the time in which twist relaxes.
pub fn twist_time(twist_ratio: f64) -> f64 {
    1.0 / twist_ratio
}

/// E_0 = E_b h^2 L of a rod of reduced `length` L, per cross section: the unit in which energies are reported.
pub fn reference_energy(length: f64) -> f64 {
    length / PI
}

/// Energy over mass of a rod that stores `energy` (in E_0 = E_b h² L), in E_b/ρ: the mass is ρ π h² L.
pub fn energy_per_mass(energy: f64) -> f64 {
    energy / PI
}

/// An `energy` e per cross section (in E_b h) of a rod of reduced `length` L, in units of E_0 = E_b h² L, as energies are
/// reported.
///
/// ```math
/// E / E_0 = e A / L, \quad A = \pi
/// ```
pub fn energy_over_reference(energy: f64, length: f64) -> f64 {
    energy / reference_energy(length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn silicone_fibre_in_si_units() {
        let units = RodUnits::of(&SILICONE, 1e-3).unwrap();
        assert_relative_eq!(units.time_to_seconds(1.0), 1e-3);
        // L = 50 h: T0 = 0.1 s, T_b = 5.07 T0, T_tw = 0.013 T0.
        assert_relative_eq!(
            units.time_to_seconds(reference_time(50.0)),
            0.1,
            max_relative = 1e-15
        );
        assert_relative_eq!(
            bending_time(50.0) / reference_time(50.0),
            5.066,
            max_relative = 1e-4
        );
        assert_relative_eq!(
            twist_time(SILICONE.twist_ratio) / reference_time(50.0),
            0.013,
            max_relative = 1e-14
        );
        // E0 = E_b h^2 L = 1e7 * 1e-6 * 0.05 J.
        let e0 = units.energy_to_joules(1.0) / energy_over_reference(1.0, 50.0);
        assert_relative_eq!(e0, 0.5, max_relative = 1e-14);
        assert_relative_eq!(units.reference_seconds(50.0), 0.1, max_relative = 1e-14);
        assert_relative_eq!(units.reference_joules(50.0), 0.5, max_relative = 1e-14);
        // 1000 kg/m³ of a wire of 2 mm and 5 cm: 0.157 g
        let mass = units.kilograms(50.0, 1000.0);
        assert_relative_eq!(mass, 1.570_796_326_8e-4, max_relative = 1e-10);
    }

    #[test]
    fn there_and_back_again() {
        let units = RodUnits::new(3e-4, 2e6, 7e2).unwrap();
        for x in [1e-9, 1.0, 2.5e7] {
            assert_relative_eq!(
                units.seconds_to_time(units.time_to_seconds(x)),
                x,
                max_relative = 1e-15
            );
            assert_relative_eq!(
                units.metres_to_length(units.length_to_metres(x)),
                x,
                max_relative = 1e-15
            );
            assert_relative_eq!(
                units.joules_to_energy(units.energy_to_joules(x)),
                x,
                max_relative = 1e-15
            );
        }
    }

    #[test]
    fn broken_units_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(RodUnits::new(bad, 1.0, 1.0).is_err());
            assert!(RodUnits::new(1.0, bad, 1.0).is_err() && RodUnits::new(1.0, 1.0, bad).is_err());
        }
        assert!(
            RodUnits::new(1e-200, 1.0, 1.0).is_err() && RodUnits::new(1.0, 1e-300, 1e300).is_err()
        );
        let text = serde_json::to_string(&RodUnits::new(1.0, 2.0, 3.0).unwrap()).unwrap();
        assert!(serde_json::from_str::<RodUnits>(&text).is_ok());
        assert!(serde_json::from_str::<RodUnits>(&text.replace("2.0", "-2.0")).is_err());
    }
}
