//! The nematic material: bulk and elastic constants, mobility, flow alignment, viscosity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{InvalidValue, finite, positive};

use crate::NematicError;
use crate::tensor::{Tensor5, contract, square_traceless};

/// Constants of a nematic in reduced units.
///
/// ```math
/// f = \tfrac{A}{2} Q_{ij}Q_{ji} + \tfrac{B}{3} Q_{ij}Q_{jk}Q_{ki} + \tfrac{C}{4} (Q_{ij}Q_{ji})^2
///   + \tfrac{L}{2} (\partial_k Q_{ij})^2 + \tfrac{L_2}{2} (\partial_j Q_{ij})^2
/// ```
///
/// The defaults are those of [patil2020discharging]; its viscosity is 1.38/Γ, since the printed unit is inverted. Q is the
/// order tensor.
///
/// # References
/// [patil2020discharging], [beris1994]
///
/// [patil2020discharging]: https://doi.org/10.1103/PhysRevResearch.2.043196
/// [beris1994]: https://doi.org/10.1093/oso/9780195076943.001.0001
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// A, in L/ξ_N².
    #[schemars(extend("x-unit" = "L/ξ_N²"), example = -0.1)]
    pub a: f64,
    /// B, in L/ξ_N².
    #[schemars(extend("x-unit" = "L/ξ_N²"), example = -2.0)]
    pub b: f64,
    /// C, in L/ξ_N².
    #[schemars(extend("x-unit" = "L/ξ_N²", "exclusiveMinimum" = 0), example = 2.0)]
    pub c: f64,
    /// Elastic constant L: 1 in reduced units.
    #[schemars(extend("x-unit" = "L", "exclusiveMinimum" = 0), example = 0.9)]
    pub elastic_constant: f64,
    /// Second elastic constant L_2, in L; leave it out and no term is modelled.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "L", "x-default" = "not modelled"), example = 0.1)]
    pub second_elastic_constant: Option<f64>,
    /// Rotational mobility Γ, of dQ/dt = Γ H: 1 in reduced units. In the original paper: "rotational viscosity parameter".
    #[schemars(extend("x-unit" = "Γ", "exclusiveMinimum" = 0), example = 2.0)]
    pub rotational_mobility: f64,
    /// Flow alignment χ: no unit.
    #[schemars(extend("x-unit" = "1"), example = 0.5)]
    pub flow_alignment: f64,
    /// Isotropic viscosity η, in 1/Γ.
    #[schemars(extend("x-unit" = "1/Γ", "exclusiveMinimum" = 0), example = 1.0)]
    pub viscosity: f64,
    /// Order S at surfaces and of start fields: no unit; the equilibrium order when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1", "x-default" = "the equilibrium order", "exclusiveMinimum" = 0), example = 0.5)]
    pub surface_order: Option<f64>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            a: -0.19,
            b: -2.34,
            c: 1.91,
            elastic_constant: 1.0,
            second_elastic_constant: None,
            rotational_mobility: 1.0,
            flow_alignment: 1.0,
            viscosity: 1.38,
            surface_order: None,
        }
    }
}

impl Material {
    /// The material, if its constants are valid.
    ///
    /// # Errors
    /// A constant that is not finite or has the wrong sign; B² < 24 A C without a surface order; an elastic energy that is not
    /// positive definite (L_2 ≤ −3 L/5).
    pub fn checked(self) -> Result<Self, NematicError> {
        finite("material.a", self.a)?;
        finite("material.b", self.b)?;
        positive("material.c", self.c)?;
        positive("material.elastic_constant", self.elastic_constant)?;
        positive("material.rotational_mobility", self.rotational_mobility)?;
        finite("material.flow_alignment", self.flow_alignment)?;
        positive("material.viscosity", self.viscosity)?;
        if let Some(second) = self.second_elastic_constant {
            let least = -0.6 * self.elastic_constant;
            if !(second.is_finite() && second > least) {
                return Err(InvalidValue::new(
                    "material.second_elastic_constant",
                    second,
                    format!("a finite number above -3/5 of the elastic constant ({least})"),
                )
                .into());
            }
        }
        match self.surface_order {
            Some(order) => {
                positive("material.surface_order", order)?;
            }
            None if self.equilibrium_order().is_none() => {
                return Err(NematicError::NoNematicPhase {
                    a: self.a,
                    b: self.b,
                    c: self.c,
                });
            }
            None => {}
        }
        Ok(self)
    }

    /// Order S_eq of the uniform nematic, if there is a positive one.
    ///
    /// ```math
    /// S_{\mathrm{eq}} = \frac{-B + \sqrt{B^2 - 24 A C}}{6 C}
    /// ```
    pub fn equilibrium_order(&self) -> Option<f64> {
        let discriminant = self.b * self.b - 24.0 * self.a * self.c;
        let order = (-self.b + discriminant.sqrt()) / (6.0 * self.c);
        // A negative discriminant gives NaN, which is not above zero.
        (order > 0.0 && order.is_finite()).then_some(order)
    }

    /// Order of surfaces and start fields: the one given, else the equilibrium order (0 without one).
    pub fn order(&self) -> f64 {
        self.surface_order
            .or_else(|| self.equilibrium_order())
            .unwrap_or(0.0)
    }

    /// Bulk energy density of a uniaxial nematic of order `order`, in L/ξ_N².
    pub fn uniaxial_density(&self, order: f64) -> f64 {
        let s2 = order * order;
        0.75 * self.a * s2 + 0.25 * self.b * s2 * order + 0.5625 * self.c * s2 * s2
    }

    /// Bulk energy density of the uniform equilibrium, from which energies count, in L/ξ_N²; 0 without a nematic phase.
    pub fn reference_density(&self) -> f64 {
        self.equilibrium_order()
            .map_or(0.0, |order| self.uniaxial_density(order))
    }

    /// Whether the uniform nematic is metastable: the isotropic liquid has a lower energy.
    pub fn is_metastable(&self) -> bool {
        self.reference_density() > 0.0
    }

    /// Bulk energy density of Q above the reference, in L/ξ_N².
    pub fn bulk_density(&self, q: &Tensor5) -> f64 {
        let t = contract(q, q);
        let cube = contract(&square_traceless(q), q);
        0.5 * self.a * t + self.b / 3.0 * cube + 0.25 * self.c * t * t - self.reference_density()
    }

    /// Bulk part of the molecular field, −∂f/∂Q made traceless, in L/ξ_N².
    ///
    /// ```math
    /// H = -A Q - B\,(Q^2)_{\mathrm{tr}} - C\,(Q:Q)\,Q
    /// ```
    pub fn bulk_field(&self, q: &Tensor5) -> Tensor5 {
        let square = square_traceless(q);
        let linear = self.a + self.c * contract(q, q);
        std::array::from_fn(|c| -linear * q[c] - self.b * square[c])
    }

    /// Rate at which a uniform nematic returns to the equilibrium order, over Γ; also L/ξ_N².
    ///
    /// ```math
    /// A + B S_{\mathrm{eq}} + \tfrac92 C S_{\mathrm{eq}}^2
    /// ```
    pub fn order_stiffness(&self) -> f64 {
        let s = self.order();
        self.a + self.b * s + 4.5 * self.c * s * s
    }

    /// Nematic correlation length ξ_N, in the unit of length; infinite where the order is not stable.
    pub fn correlation_length(&self) -> f64 {
        let stiffness = self.order_stiffness();
        if stiffness > 0.0 {
            (self.elastic_constant / stiffness).sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Largest ratio by which the flow that a small tilt drives speeds its decay (bend, or splay where χ is negative).
    ///
    /// ```math
    /// \beta = \frac{2 a^2}{\eta\,\Gamma}, \qquad a = \tfrac12 |\chi| \left(\tfrac23 + \tfrac S2\right) + \tfrac34 S
    /// ```
    ///
    /// # Validation
    /// `val_tilts_decay_at_the_rates_of_the_coupled_equations`
    pub fn backflow(&self) -> f64 {
        let s = self.order();
        let a = 0.5 * self.flow_alignment.abs() * (2.0 / 3.0 + 0.5 * s) + 0.75 * s;
        2.0 * a * a / (self.viscosity * self.rotational_mobility)
    }

    /// Frank's elastic constant of the director, K = (9/2) L S², in L.
    pub fn frank_constant(&self) -> f64 {
        4.5 * self.elastic_constant * self.order().powi(2)
    }

    /// An upper bound of the second derivative of the bulk energy along any direction, for orders up to `order`.
    pub(crate) fn largest_bulk_stiffness(&self, order: f64) -> f64 {
        (self.a + self.b.abs() * order + 4.5 * self.c * order * order).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;
    use approx::assert_relative_eq;

    #[test]
    fn derived_constants_of_the_published_material() {
        let m = Material::default().checked().unwrap();
        assert_relative_eq!(m.order(), 0.532838, max_relative = 1e-6);
        assert_relative_eq!(m.reference_density(), -0.0423540, max_relative = 1e-6);
        assert_relative_eq!(m.frank_constant(), 1.27762, max_relative = 1e-5);
        assert_relative_eq!(m.order_stiffness(), 1.003421, max_relative = 1e-6);
        assert_relative_eq!(m.correlation_length(), 0.998294, max_relative = 1e-6);
        assert!(!m.is_metastable());
    }

    #[test]
    fn bulk_field_is_the_gradient_and_vanishes_in_equilibrium() {
        let m = Material::default();
        let equilibrium = uniaxial(m.order(), [0.36, 0.48, 0.8]);
        assert!(m.bulk_density(&equilibrium).abs() < 1e-15);
        assert!(m.bulk_field(&equilibrium).iter().all(|h| h.abs() < 1e-15));
        let q = [0.3, -0.1, 0.2, 0.05, -0.4];
        let field = m.bulk_field(&q);
        let density = |x: &[f64]| m.bulk_density(&[x[0], x[1], x[2], x[3], x[4]]);
        let gradient = topo_core::finite_difference_gradient(density, &q, 1e-3);
        for (c, g) in gradient.iter().enumerate() {
            // The energy changes by -H:dQ, where dQ has the one component c and what keeps it traceless.
            let mut unit = [0.0; 5];
            unit[c] = 1.0;
            assert_relative_eq!(-contract(&field, &unit), *g, max_relative = 1e-9);
        }
    }

    #[test]
    fn impossible_materials_are_refused_and_metastable_ones_named() {
        let with = |change: fn(&mut Material)| {
            let mut m = Material::default();
            change(&mut m);
            m.checked()
        };
        assert!(matches!(
            with(|m| m.a = 1.0),
            Err(NematicError::NoNematicPhase { .. })
        ));
        assert!(
            with(|m| {
                m.a = 1.0;
                m.surface_order = Some(0.4);
            })
            .is_ok()
        );
        assert!(with(|m| m.a = 0.11).unwrap().is_metastable());
        for bad in [f64::NAN, f64::INFINITY] {
            for change in [0, 1, 2, 3, 4, 5, 6, 7, 8] {
                let mut m = Material::default();
                match change {
                    0 => m.a = bad,
                    1 => m.b = bad,
                    2 => m.c = bad,
                    3 => m.elastic_constant = bad,
                    4 => m.second_elastic_constant = Some(bad),
                    5 => m.rotational_mobility = bad,
                    6 => m.flow_alignment = bad,
                    7 => m.viscosity = bad,
                    _ => m.surface_order = Some(bad),
                }
                assert!(m.checked().is_err(), "{change}");
            }
        }
        // Positive definite down to L_2 = -3 L/5.
        assert!(with(|m| m.second_elastic_constant = Some(-0.601)).is_err());
        assert!(with(|m| m.second_elastic_constant = Some(-0.599)).is_ok());
        assert!(
            with(|m| m.b = 2.34).is_ok(),
            "a positive B has a smaller S_eq"
        );
    }
}
