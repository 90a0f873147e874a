//! The parameters of a rod in a scene: material, twist, contact, friction, the reading of L/h, and the accuracy.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{finite, in_range, positive};

use crate::RodError;

/// How L/h = 50 is read for a knot whose ropelength is not 50.
///
/// The ropelengths of the knots to seven crossings run from 32.7 to 65.7 radii, so one slenderness cannot be literal for all:
/// either the tube, the length or the material must differ from the nominal one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reading {
    /// L as given; the contact diameter shrinks to fit, the friction range stays 2h.
    #[default]
    Shrunk,
    /// L as given, the true tube of diameter 2h: tight knots start stretched.
    Hard,
    /// L as given; contact diameter and friction range both scaled so that every knot is tight.
    Tight,
    /// The length is the knot's own ropelength, the true tube.
    OwnLength,
}

impl Reading {
    /// The name used in tables and scenes.
    pub fn name(self) -> &'static str {
        match self {
            Reading::Shrunk => "shrunk",
            Reading::Hard => "hard",
            Reading::Tight => "tight",
            Reading::OwnLength => "own-length",
        }
    }
}

/// Lengths of a rod once the reading has been applied, in units of h.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tube {
    /// Natural length L of the rod, in h.
    pub length: f64,
    /// Distance d_c below which two strands repel each other, in h.
    pub contact_diameter: f64,
    /// Distance below which friction acts between two strands, in h.
    pub friction_range: f64,
    /// Length of the start curve, in h (longer than `length` when the rod starts stretched).
    pub start_length: f64,
}

/// Contact between strands: the stiffness k_c of the penalty, in units of E_b/h³ per area and length squared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ContactParameters {
    /// Stiffness k_c, in E_b/h³.
    #[schemars(range(min = 1e-6, max = 1e9), extend("x-unit" = "E_b/h³"), example = 50.0)]
    pub stiffness: f64,
}

impl Default for ContactParameters {
    fn default() -> Self {
        Self { stiffness: 20.0 }
    }
}

/// The range of friction.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionRange {
    /// As the reading says: 2h, or the contact diameter for `tight`.
    #[default]
    Reading,
    /// The contact diameter d_c.
    Contact,
    /// A multiple of the contact diameter.
    TimesContact(
        #[schemars(range(min = 1e-3, max = 10), extend("x-unit" = "d_c"), example = 1.1)] f64,
    ),
}

/// Friction between strands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FrictionParameters {
    /// η_f/η: no unit.
    #[schemars(range(min = 0, max = 1e6), extend("x-unit" = "1"), example = 0.2)]
    pub ratio: f64,
    /// Its range.
    #[schemars(example = FrictionRange::Contact)]
    pub range: FrictionRange,
}

impl Default for FrictionParameters {
    fn default() -> Self {
        Self {
            ratio: 0.1,
            range: FrictionRange::Reading,
        }
    }
}

/// Material, load and resolution of one rod.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RodParameters {
    /// Slenderness L/h: no unit.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub slenderness: f64,
    /// How the slenderness is read.
    pub reading: Reading,
    /// Number of edges N.
    #[schemars(range(min = Self::LEAST_EDGES))]
    pub n_edges: usize,
    /// Ratio α of twist to bending stiffness, 1/(1 + Poisson's ratio): no unit.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub twist_ratio: f64,
    /// Ratio γ = E/E_b of stretching to bending modulus: no unit.
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub stretch_ratio: f64,
    /// Twist density θ'h tied in before the ends are fused; `None`: no twist is modelled at all.
    pub twist: Option<f64>,
    /// `None`: strands pass through each other (only the crossing check notices).
    pub contact: Option<ContactParameters>,
    /// `None`: no friction is modelled.
    pub friction: Option<FrictionParameters>,
    /// Drag ζ on the mean velocity of each component of a link, Z_c = ζ L_c/L²: no unit. A rod of one component has none.
    #[serde(default = "usual_drag", skip_serializing_if = "is_usual_drag")]
    pub drag: f64,
}

/// Resistance of a component to its motion as a whole, in parts of that to its slowest bending; results do not depend on it.
const USUAL_DRAG: f64 = 1.0;

fn usual_drag() -> f64 {
    USUAL_DRAG
}

fn is_usual_drag(drag: &f64) -> bool {
    *drag == USUAL_DRAG
}

impl Default for RodParameters {
    fn default() -> Self {
        Self {
            slenderness: 50.0,
            reading: Reading::Shrunk,
            n_edges: 200,
            twist_ratio: 1.0 / 1.3,
            stretch_ratio: 5.0,
            twist: Some(0.0),
            contact: Some(ContactParameters::default()),
            friction: Some(FrictionParameters::default()),
            drag: USUAL_DRAG,
        }
    }
}

impl RodParameters {
    /// Least number of edges of a rod.
    pub const LEAST_EDGES: usize = 8;

    /// Checks every number.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn checked(self) -> Result<Self, RodError> {
        positive("slenderness", self.slenderness)?;
        if self.n_edges < Self::LEAST_EDGES {
            return Err(RodError::TooFewEdges {
                n_edges: self.n_edges,
                least: Self::LEAST_EDGES,
            });
        }
        in_range("twist_ratio", self.twist_ratio, 1e-6, 1e3)?;
        in_range("stretch_ratio", self.stretch_ratio, 1e-3, 1e6)?;
        in_range("drag", self.drag, 1e-6, 1e6)?;
        if let Some(twist) = self.twist {
            finite("twist", twist)?;
        }
        if let Some(contact) = self.contact {
            in_range("contact.stiffness", contact.stiffness, 1e-6, 1e9)?;
        }
        if let Some(friction) = self.friction {
            in_range("friction.ratio", friction.ratio, 0.0, 1e6)?;
            if let FrictionRange::TimesContact(factor) = friction.range {
                in_range("friction.range.times-contact", factor, 1e-3, 10.0)?;
            }
        }
        Ok(self)
    }

    /// Lengths for a start curve of the given ropelength (length over thickness radius).
    ///
    /// # Errors
    /// The ropelength must be finite and not below 6 (that of the circle is 2π).
    pub fn tube(&self, ropelength: f64) -> Result<Tube, RodError> {
        in_range("ropelength", ropelength, 6.0, 1e6)?;
        let l = self.slenderness;
        let (length, contact, range, start_length) = match self.reading {
            Reading::Shrunk => (l, 2.0 * (l / ropelength).min(1.0), 2.0, l),
            Reading::Hard => (l, 2.0, 2.0, l.max(ropelength)),
            Reading::Tight => (l, 2.0 * l / ropelength, 2.0 * l / ropelength, l),
            Reading::OwnLength => (ropelength, 2.0, 2.0, ropelength),
        };
        let friction_range = match self.friction.map(|f| f.range).unwrap_or_default() {
            FrictionRange::Reading => range,
            FrictionRange::Contact => contact,
            FrictionRange::TimesContact(factor) => factor * contact,
        };
        Ok(Tube {
            length,
            contact_diameter: contact,
            friction_range,
            start_length,
        })
    }
}

/// Which integrator of `topo-core` advances the rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Linearly implicit, four stages, order 3.
    #[default]
    Ros34pw2,
    /// Linearly implicit, two stages, order 2.
    Ros2w,
    /// Stabilised explicit.
    Rkc2,
}

/// Settings that decide on speed and accuracy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Accuracy {
    /// Target of the local error of a step, in h.
    #[schemars(range(min = 1e-10, max = 1))]
    pub tolerance: f64,
    /// Coefficient g of ROS2-W (1 + 1/√2 for loose, 1 − 1/√2 for tight tolerances).
    pub gamma: f64,
    /// Which integrator.
    pub integrator: IntegratorKind,
    /// Number of steps for which one factorised Newton matrix is used; the order holds for any matrix.
    pub reuse: usize,
    /// Width of the Verlet skin, in h.
    pub skin: f64,
    /// Limit of steps in a phase; the run stops there and reports it.
    pub max_steps: u64,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            tolerance: 2e-3,
            gamma: topo_core::GAMMA_L_STABLE_LARGE,
            integrator: IntegratorKind::default(),
            reuse: 8,
            skin: 0.5,
            max_steps: 200_000,
        }
    }
}

impl Accuracy {
    /// Checks every number.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn checked(self) -> Result<Self, RodError> {
        in_range("accuracy.tolerance", self.tolerance, 1e-10, 1.0)?;
        in_range("accuracy.gamma", self.gamma, 0.25, 4.0)?;
        in_range("accuracy.reuse", self.reuse as f64, 1.0, 1e9)?;
        in_range("accuracy.skin", self.skin, 0.01, 4.0)?;
        in_range("accuracy.max_steps", self.max_steps as f64, 1.0, 1e15)?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests;
