//! Anchoring: which tensor a surface prefers, and how strongly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{InvalidValue, finite, non_negative};

use crate::NematicError;
use crate::tensor::{Tensor5, order_and_director, uniaxial};

/// Largest number of turns of a pattern: beyond it no grid that fits in memory would show it.
const LARGEST_CHARGE: i32 = 10_000;

/// How strongly a surface holds the tensor it prefers.
///
/// ```math
/// F_s = \tfrac{W}{2} \int |Q - Q_s|^2\, dA
/// ```
///
/// Q_s is the tensor that the surface prefers. Strong anchoring is the limit of large W, a free surface that of W = 0.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Anchoring {
    /// Q = Q_s on the surface.
    #[default]
    Strong,
    /// With the strength W, in L/ξ_N.
    Weak(#[schemars(range(min = 0), extend("x-unit" = "L/ξ_N"), example = 1.0)] f64),
    /// No preference.
    Free,
}

impl Anchoring {
    pub(crate) fn checked(self, name: &str) -> Result<Self, NematicError> {
        if let Self::Weak(strength) = self {
            non_negative(name, strength)?;
        }
        Ok(self)
    }

    /// Conductance of a link of conductance `link` that ends on an area of `area` h², both over L h, and the share of its
    /// energy that is stored in the anchoring.
    pub(crate) fn conductance(self, link: f64, area: f64, h_over_l: f64) -> (f64, f64) {
        match self {
            Self::Strong => (link, 0.0),
            Self::Free => (0.0, 0.0),
            Self::Weak(strength) => {
                let hold = strength * h_over_l * area;
                if hold > 0.0 {
                    (link * hold / (link + hold), link / (link + hold))
                } else {
                    (0.0, 0.0)
                }
            }
        }
    }
}

/// Directors on a grid of polar angles (rows, from 0 to π) and azimuths (columns, periodic), the azimuth running faster.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectorTable {
    /// Polar angles, at least 2: 0 and π are the first and the last.
    #[schemars(range(min = 2), extend("x-unit" = "1"), example = 2)]
    pub n_polar: usize,
    /// Azimuths, at least 1: the first is 0.
    #[schemars(range(min = 1), extend("x-unit" = "1"), example = 1)]
    pub n_azimuth: usize,
    /// n_polar times n_azimuth directors; any length but zero, either sign.
    #[schemars(extend("x-unit" = "1", "examples" = [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]))]
    pub directors: Vec<[f64; 3]>,
}

impl DirectorTable {
    fn check(&self, name: &str) -> Result<(), NematicError> {
        let expected = self.n_polar.saturating_mul(self.n_azimuth);
        if self.n_polar < 2 || self.n_azimuth < 1 || self.directors.len() != expected {
            return Err(NematicError::Length {
                what: "the director table",
                found: self.directors.len(),
                expected: expected.max(2),
            });
        }
        for d in &self.directors {
            unit(&format!("{name}.table.directors"), *d)?;
        }
        Ok(())
    }

    /// Interpolated linearly between tensors, so that the sign of a director does not matter, then made uniaxial.
    fn director(&self, polar: f64, azimuth: f64) -> [f64; 3] {
        let row = polar / std::f64::consts::PI * (self.n_polar - 1) as f64;
        let column = azimuth.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU
            * self.n_azimuth as f64;
        let (r, c) = (
            (row.floor().max(0.0) as usize).min(self.n_polar - 2),
            column.floor() as usize % self.n_azimuth,
        );
        let (u, v) = (row - r as f64, column - column.floor());
        let mut q = [0.0; 5];
        for (dr, dc, weight) in [
            (0, 0, (1.0 - u) * (1.0 - v)),
            (0, 1, (1.0 - u) * v),
            (1, 0, u * (1.0 - v)),
            (1, 1, u * v),
        ] {
            let at = (r + dr) * self.n_azimuth + (c + dc) % self.n_azimuth;
            let one = uniaxial(1.0, normalised(self.directors[at]));
            q.iter_mut().zip(one).for_each(|(s, x)| *s += weight * x);
        }
        order_and_director(&q).1
    }
}

/// The director that a particle's surface prefers.
///
/// ```math
/// n_q = (\sin\theta \cos q\varphi,\ \sin\theta \sin q\varphi,\ \cos\theta), \qquad
/// n_{\text{homeotropic}} = \nu, \qquad n_{\text{planar}} = \frac{a - (a \cdot \nu)\, \nu}{|a - (a \cdot \nu)\, \nu|}
/// ```
///
/// θ and φ are the polar angle and the azimuth of the point of the sphere, ν is the normal there, a the axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SurfacePattern {
    /// n_q = (sin θ cos qφ, sin θ sin qφ, cos θ), of effective charge q.
    #[serde(rename = "charge")]
    Winding(
        #[schemars(range(min = -LARGEST_CHARGE, max = LARGEST_CHARGE), extend("x-unit" = "turns"), example = 2)]
         i32,
    ),
    /// Along the surface normal.
    Homeotropic,
    /// Tangential, along the projection of an axis.
    Planar {
        /// The axis.
        #[schemars(extend("x-unit" = "1", "examples" = [[0.0, 0.0, 1.0]]))]
        axis: [f64; 3],
    },
    /// The same director everywhere.
    Uniform {
        /// The director.
        #[schemars(extend("x-unit" = "1", "examples" = [[1.0, 0.0, 0.0]]))]
        director: [f64; 3],
    },
    /// Given on a grid of angles.
    Table(DirectorTable),
}

impl SurfacePattern {
    /// Checks the pattern; `name` is the key that holds it.
    ///
    /// # Errors
    /// A vector without direction, a table of the wrong length, a charge beyond ±10 000.
    pub fn check(&self, name: &str) -> Result<(), NematicError> {
        match self {
            Self::Winding(q) if q.unsigned_abs() > LARGEST_CHARGE.unsigned_abs() => {
                return Err(InvalidValue::new(
                    format!("{name}.charge"),
                    f64::from(*q),
                    format!("at most {LARGEST_CHARGE} turns"),
                )
                .into());
            }
            Self::Winding(_) | Self::Homeotropic => {}
            Self::Planar { axis } => {
                unit(&format!("{name}.planar.axis"), *axis)?;
            }
            Self::Uniform { director } => {
                unit(&format!("{name}.uniform.director"), *director)?;
            }
            Self::Table(table) => table.check(name)?,
        }
        Ok(())
    }

    /// Number of turns of the pattern along the equator.
    pub fn charge(&self) -> Option<i32> {
        match self {
            Self::Winding(q) => Some(*q),
            _ => None,
        }
    }

    /// Director at the point of the sphere that lies in `direction` (of any length but zero).
    pub fn director(&self, direction: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = normalised(direction);
        match self {
            Self::Winding(q) => {
                let sin = x.hypot(y);
                let angle = f64::from(*q) * y.atan2(x);
                [sin * angle.cos(), sin * angle.sin(), z]
            }
            Self::Homeotropic => [x, y, z],
            Self::Planar { axis } => {
                let a = normalised(*axis);
                let along = a[0] * x + a[1] * y + a[2] * z;
                let tangent = [a[0] - along * x, a[1] - along * y, a[2] - along * z];
                let length = (tangent[0].powi(2) + tangent[1].powi(2) + tangent[2].powi(2)).sqrt();
                if length > 1e-9 {
                    tangent.map(|t| t / length)
                } else {
                    // At the poles of the axis no tangent is preferred.
                    normalised(if x.abs() < 0.9 {
                        [1.0 - x * x, -x * y, -x * z]
                    } else {
                        [-x * y, 1.0 - y * y, -y * z]
                    })
                }
            }
            Self::Uniform { director } => normalised(*director),
            Self::Table(table) => table.director(z.clamp(-1.0, 1.0).acos(), y.atan2(x)),
        }
    }

    /// The preferred tensor of order `order` at the point in `direction`.
    pub fn q_tensor(&self, order: f64, direction: [f64; 3]) -> Tensor5 {
        uniaxial(order, self.director(direction))
    }
}

/// The director that a plate prefers.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PlateDirector {
    /// Along the normal of the plate.
    #[default]
    Perpendicular,
    /// In the plane of the plate, at this angle (radians) from its first axis.
    Planar(#[schemars(extend("x-unit" = "rad"), example = 0.5)] f64),
    /// The direction given.
    Along(#[schemars(extend("x-unit" = "1", "examples" = [[0.0, 1.0, 1.0]]))] [f64; 3]),
}

/// A plate: what it prefers and how strongly.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Plate {
    /// Preferred director.
    #[schemars(example = PlateDirector::Planar(0.5))]
    pub director: PlateDirector,
    /// Strength of the anchoring.
    #[schemars(example = Anchoring::Weak(1.0))]
    pub anchoring: Anchoring,
}

impl Plate {
    pub(crate) fn checked(self, name: &str) -> Result<Self, NematicError> {
        self.anchoring.checked(&format!("{name}.anchoring.weak"))?;
        match self.director {
            PlateDirector::Perpendicular => {}
            PlateDirector::Planar(angle) => {
                finite(&format!("{name}.director.planar"), angle)?;
            }
            PlateDirector::Along(d) => {
                unit(&format!("{name}.director.along"), d)?;
            }
        }
        Ok(self)
    }

    /// Preferred director of a plate whose normal is along `axis`.
    pub fn director_along(&self, axis: usize) -> [f64; 3] {
        let mut director = [0.0; 3];
        match self.director {
            PlateDirector::Perpendicular => director[axis] = 1.0,
            PlateDirector::Planar(angle) => {
                let (first, second) = match axis {
                    0 => (1, 2),
                    1 => (0, 2),
                    _ => (0, 1),
                };
                director[first] = angle.cos();
                director[second] = angle.sin();
            }
            PlateDirector::Along(d) => return normalised(d),
        }
        director
    }
}

/// Returns a vector if it has a direction.
pub(crate) fn unit(name: &str, v: [f64; 3]) -> Result<[f64; 3], NematicError> {
    for x in v {
        finite(name, x)?;
    }
    if v.iter().all(|x| x.abs() < 1e-150) {
        return Err(InvalidValue::new(name, 0.0, "a vector with a direction").into());
    }
    Ok(normalised(v))
}

/// The unit vector; z for a vector without direction.
pub(crate) fn normalised(v: [f64; 3]) -> [f64; 3] {
    let scale = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(scale > 0.0 && scale.is_finite()) {
        return [0.0, 0.0, 1.0];
    }
    let v = v.map(|x| x / scale);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>().abs()
    }

    #[test]
    fn patterns_have_their_symmetry() {
        let r = [0.48, 0.36, 0.8];
        assert!((along(SurfacePattern::Winding(1).director(r), r) - 1.0).abs() < 1e-12);
        assert_eq!(
            SurfacePattern::Homeotropic.director([0.0, 0.0, 2.0]),
            [0.0, 0.0, 1.0]
        );
        let planar = SurfacePattern::Planar {
            axis: [0.0, 0.0, 3.0],
        };
        for d in [r, [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1e-12, 1.0]] {
            let n = planar.director(d);
            assert!(along(n, normalised(d)) < 1e-9, "{d:?} {n:?}");
            assert!((along(n, n) - 1.0).abs() < 1e-9);
        }
        // n_q turns q times along the equator.
        let n = SurfacePattern::Winding(6).director([0.5_f64.cos(), 0.5_f64.sin(), 0.0]);
        assert!((n[0] - 3.0_f64.cos()).abs() < 1e-12 && (n[1] - 3.0_f64.sin()).abs() < 1e-12);
    }

    #[test]
    fn a_table_reproduces_the_pattern_it_was_made_from() {
        let pattern = SurfacePattern::Winding(3);
        let (n_polar, n_azimuth) = (61, 240);
        let mut directors = Vec::new();
        for p in 0..n_polar {
            for a in 0..n_azimuth {
                let (t, f) = (
                    std::f64::consts::PI * f64::from(p) / 60.0,
                    std::f64::consts::TAU * f64::from(a) / 240.0,
                );
                let n = pattern.director([t.sin() * f.cos(), t.sin() * f.sin(), t.cos()]);
                // Signs and lengths do not matter.
                let scale = if a % 3 == 0 { -2.0 } else { 0.5 };
                directors.push(n.map(|x| scale * x));
            }
        }
        let table = SurfacePattern::Table(DirectorTable {
            n_polar: n_polar as usize,
            n_azimuth: n_azimuth as usize,
            directors,
        });
        table.check("p").unwrap();
        for d in [
            [0.3, 0.4, 0.5],
            [-0.7, 0.1, -0.2],
            [0.0, -1.0, 0.01],
            [1.0, -1e-9, 0.0],
        ] {
            let agreement = along(table.director(d), pattern.director(d));
            assert!(agreement > 1.0 - 1e-5, "{d:?} {agreement}");
        }
    }

    #[test]
    fn weak_anchoring_lies_between_strong_and_free() {
        let conductance = |a: Anchoring| a.conductance(2.0, 1.0, 1.5).0;
        assert_eq!(conductance(Anchoring::Strong), 2.0);
        assert_eq!(conductance(Anchoring::Free), 0.0);
        assert_eq!(conductance(Anchoring::Weak(0.0)), 0.0);
        assert!((conductance(Anchoring::Weak(1e12)) - 2.0).abs() < 1e-9);
        assert!(conductance(Anchoring::Weak(1.0)) < conductance(Anchoring::Weak(2.0)));
    }

    #[test]
    fn broken_patterns_are_refused() {
        for bad in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
            assert!(SurfacePattern::Planar { axis: bad }.check("p").is_err());
            assert!(
                SurfacePattern::Uniform { director: bad }
                    .check("p")
                    .is_err()
            );
        }
        assert!(SurfacePattern::Winding(i32::MIN).check("p").is_err());
        assert!(SurfacePattern::Winding(-7).check("p").is_ok());
        let table = |n_polar, n_azimuth, n: usize| {
            SurfacePattern::Table(DirectorTable {
                n_polar,
                n_azimuth,
                directors: vec![[0.0, 0.0, 1.0]; n],
            })
            .check("p")
        };
        assert!(table(2, 1, 2).is_ok());
        assert!(
            table(1, 1, 1).is_err() && table(3, 2, 5).is_err() && table(usize::MAX, 2, 0).is_err()
        );
        assert!(Anchoring::Weak(-1.0).checked("w").is_err());
        assert!(Anchoring::Weak(f64::NAN).checked("w").is_err());
    }
}
