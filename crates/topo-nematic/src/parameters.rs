//! The parameters of a nematic battery in a scene: sizes, surfaces, material, and the accuracy.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{InvalidValue, finite, in_range, positive};

use crate::anchoring::{Anchoring, Plate, SurfacePattern};
use crate::boundary::Boundary;
use crate::kernel::run::Threads;
use crate::real::Precision;
use crate::tensor::{Tensor5, uniaxial};
use crate::{Faces, Grid, Material, NematicError};

/// A uniform external field, electric or magnetic.
///
/// ```math
/// f = -\tfrac12\, \chi_a\, E_i Q_{ij} E_j
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExternalField {
    /// E, in the unit that makes χ_a E² an energy density in L/ξ_N².
    #[schemars(extend("x-unit" = "√(L/ξ_N²)", "examples" = [[0.0, 0.0, 0.1]]))]
    pub vector: [f64; 3],
    /// Anisotropy χ_a: no unit. A positive one aligns the director with E.
    #[schemars(extend("x-unit" = "1"), example = 1.0)]
    pub anisotropy: f64,
}

impl ExternalField {
    /// Molecular field of the external field, −∂f/∂Q made traceless, in L/ξ_N².
    pub fn molecular_field(&self) -> Tensor5 {
        let square = self.vector.iter().map(|e| e * e).sum::<f64>();
        if square == 0.0 {
            return [0.0; 5];
        }
        let length = square.sqrt();
        // E_i E_j - E² δ_ij/3 is a uniaxial tensor of order 2 E²/3.
        let q = uniaxial(2.0 * square / 3.0, self.vector.map(|e| e / length));
        q.map(|x| 0.5 * self.anisotropy * x)
    }
}

/// What is at the sides of the cell.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sides {
    /// The opposite side: a square array of particles.
    #[default]
    Periodic,
    /// Walls.
    Walled(Plate),
}

/// The battery: a particle between plates, in reduced units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NematicParameters {
    /// Radius R of the particle, in ξ_N.
    #[schemars(extend("x-unit" = "ξ_N", "exclusiveMinimum" = 0), example = 25.0)]
    pub radius: f64,
    /// Grid spacing h, in ξ_N.
    #[schemars(extend("x-unit" = "ξ_N", "exclusiveMinimum" = 0), example = 1.25)]
    pub spacing: f64,
    /// Edges of the cell in radii; each is rounded to an even number of spacings.
    #[schemars(extend("x-unit" = "R", "examples" = [[6.0, 6.0, 5.0]]))]
    pub cell: [f64; 3],
    /// Numbers of cells, instead of `cell`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1", "x-default" = "those of `cell`", "examples" = [[60, 60, 50]]))]
    pub cells: Option<[usize; 3]>,
    /// Whether there is a particle.
    #[schemars(example = false)]
    pub particle: bool,
    /// What its surface prefers while charged.
    #[schemars(example = SurfacePattern::Homeotropic)]
    pub pattern: SurfacePattern,
    /// Strength of that anchoring.
    #[schemars(example = Anchoring::Weak(1.0))]
    pub anchoring: Anchoring,
    /// How the anchored surface is represented on the grid.
    #[schemars(example = Boundary::NodeMask)]
    pub boundary: Boundary,
    /// The plates below and above.
    pub plates: Plate,
    /// The sides.
    #[schemars(example = Sides::Walled(Plate::default()))]
    pub sides: Sides,
    /// No plates: periodic along z too. Only with default plates and periodic sides.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    #[schemars(extend("default" = false), example = true)]
    pub periodic: bool,
    /// The material.
    #[schemars(extend("x-as" = "material"))]
    pub material: Material,
    /// An external field; leave it out and none is modelled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<ExternalField>,
}

impl Default for NematicParameters {
    fn default() -> Self {
        Self {
            radius: 52.5,
            spacing: 1.5,
            cell: [40.0 / 7.0, 40.0 / 7.0, 30.0 / 7.0],
            cells: None,
            particle: true,
            pattern: SurfacePattern::Winding(1),
            anchoring: Anchoring::Strong,
            boundary: Boundary::CutLink,
            plates: Plate::default(),
            sides: Sides::Periodic,
            periodic: false,
            material: Material::default(),
            field: None,
        }
    }
}

/// Coarsest spacing accepted, in correlation lengths.
const COARSEST: f64 = 2.5;
/// Fewest spacings a wavelength of the pattern should have.
const FINEST_PATTERN: f64 = 8.0;

impl NematicParameters {
    /// The parameters, if they are valid.
    ///
    /// # Errors
    /// A value out of range, or a spacing above 2.5 correlation lengths.
    pub fn checked(mut self) -> Result<Self, NematicError> {
        positive("nematic.radius", self.radius)?;
        positive("nematic.spacing", self.spacing)?;
        for edge in self.cell {
            positive("nematic.cell", edge)?;
        }
        self.material = self.material.checked()?;
        self.pattern.check("nematic.pattern")?;
        self.anchoring = self.anchoring.checked("nematic.anchoring.weak")?;
        self.plates = self.plates.checked("nematic.plates")?;
        if let Sides::Walled(plate) = self.sides {
            plate.checked("nematic.sides.walled")?;
        }
        let has_walls = self.plates != Plate::default() || self.sides != Sides::Periodic;
        if self.periodic && has_walls {
            let remedy =
                "false where plates or walled sides are given: a periodic cell has neither";
            return Err(InvalidValue::new("nematic.periodic", 1.0, remedy).into());
        }
        if let Some(field) = &self.field {
            for e in field.vector {
                finite("nematic.field.vector", e)?;
            }
            finite("nematic.field.anisotropy", field.anisotropy)?;
            if !field.molecular_field().iter().all(|x| x.is_finite()) {
                return Err(InvalidValue::new(
                    "nematic.field",
                    field.anisotropy,
                    "a field whose square is finite",
                )
                .into());
            }
        }
        let length = self.material.correlation_length();
        if self.spacing > COARSEST * length {
            return Err(NematicError::SpacingTooCoarse {
                spacing: self.spacing,
                correlation_length: length,
                limit: COARSEST * length,
            });
        }
        Ok(self)
    }

    /// The grid, with spacing `spacing`.
    pub(crate) fn grid(&self, spacing: f64) -> Result<Grid, NematicError> {
        let sides = match self.sides {
            Sides::Periodic => Faces::Periodic,
            Sides::Walled(_) => Faces::Wall,
        };
        let even = |edge: f64| {
            let half = (0.5 * edge * self.radius / spacing).round();
            // The cast saturates: the grid refuses what is too large.
            2 * (half as usize).clamp(2, usize::MAX / 4)
        };
        let ratio = self.spacing / spacing;
        let cells = match self.cells {
            None => self.cell.map(even),
            Some(cells) if ratio == 1.0 => cells,
            Some(cells) => cells.map(|n| 2 * ((0.5 * n as f64 * ratio).round() as usize).max(2)),
        };
        let plates = if self.periodic {
            Faces::Periodic
        } else {
            Faces::Wall
        };
        Ok(Grid::new(cells, spacing, [sides, sides, plates])?)
    }

    /// What is unusual, although valid.
    pub(crate) fn warnings(&self, grid: &Grid) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.material.is_metastable() {
            warnings.push(format!(
                "the nematic is metastable: f(S_eq) = {:.3e} lies above that of the isotropic liquid",
                self.material.reference_density()
            ));
        }
        if self.material.equilibrium_order().is_none() {
            warnings.push(
                "there is no nematic phase: energies are counted from the isotropic liquid"
                    .to_owned(),
            );
        }
        if !self.particle {
            return warnings;
        }
        if let Some(q) = self.pattern.charge() {
            if q == 0 {
                warnings.push("charge 0 enforces no defect ring".to_owned());
            }
            let nodes = std::f64::consts::TAU * self.radius / self.spacing / f64::from(q.abs());
            if nodes < FINEST_PATTERN {
                warnings.push(format!(
                    "charge {q} is under-resolved: {nodes:.1} nodes a wavelength on the equator, {FINEST_PATTERN} are needed"
                ));
            }
        }
        if grid.cells().iter().any(|n| n % 2 == 1) {
            warnings.push(format!(
                "a grid of {:?} cells has an odd number: the particle's centre is no corner of cells",
                grid.cells()
            ));
        }
        warnings
    }
}

/// Accuracy of a discharge, storage and threads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NematicAccuracy {
    /// Local error of a step: root mean square of |dQ|/S over the fluid.
    #[schemars(range(min = 1e-9, max = 0.1), extend("x-unit" = "1"), example = 1e-5)]
    pub tolerance: f64,
    /// Precision in which the field is stored while it is discharged; it is always charged in double precision.
    #[schemars(example = Precision::Single)]
    pub precision: Precision,
    /// Threads that share one field.
    #[schemars(extend("x-as" = "--jobs"))]
    pub threads: Threads,
    /// Limit of trial steps.
    #[schemars(range(min = 1, max = 1_000_000_000_000_000_u64), extend("x-unit" = "steps"), example = 10_000)]
    pub max_steps: u64,
    /// Largest memory estimate of a run that is accepted, in bytes.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "bytes", "x-default" = "no other limit"), example = 8_000_000_000_u64)]
    pub memory_limit: Option<u64>,
}

impl Default for NematicAccuracy {
    fn default() -> Self {
        Self {
            tolerance: 3e-5,
            precision: Precision::Double,
            threads: Threads::One,
            max_steps: 100_000,
            memory_limit: None,
        }
    }
}

impl NematicAccuracy {
    /// The accuracy, if it is valid.
    ///
    /// # Errors
    /// A tolerance outside 1e-9..0.1, or a limit of 0 steps.
    pub fn checked(self) -> Result<Self, NematicError> {
        in_range("accuracy.tolerance", self.tolerance, 1e-9, 0.1)?;
        in_range("accuracy.max_steps", self.max_steps as f64, 1.0, 1e15)?;
        Ok(self)
    }
}
