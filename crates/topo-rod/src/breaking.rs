//! Where a fibre breaks: what is largest there, and a limit that it breaks at.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::positive;

use crate::density::energy_density;
use crate::energy::{At, Bend, EnergyTerm, Twist};
use crate::{Chain, CutCandidate, RodError, RodParameters};

/// What is largest where a fibre breaks: readings of "the point of maximum stress".
///
/// Stresses are those at the surface of the fibre, on the outer side of its bend, in E_b:
///
/// ```math
/// \sigma = \gamma\, (|x'| - 1) + h \kappa, \qquad \tau = \frac{\alpha}{2}\, h\, \theta', \qquad
/// \sigma_{\text{M}}^2 = \sigma^2 + 3 \tau^2
/// ```
///
/// with κ and θ' counted from the natural shape; compression tears nothing, σ ≥ 0. The shear modulus is α E_b/2. All of them are
/// averaged over windows of π h along the rod, as the energy density is.
///
/// # Validation
/// `val_stresses_of_a_bent_twisted_stretched_coil`, `val_a_natural_curve_bears_no_stress`
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// Elastic energy per volume, in E_b.
    #[default]
    Energy,
    /// Curvature of the centreline κ per natural length, in 1/h.
    Curvature,
    /// Tension σ, axial and of bending, in E_b.
    Tension,
    /// Von Mises stress of tension and twist, in E_b.
    VonMises,
}

impl Criterion {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Energy, Self::Curvature, Self::Tension, Self::VonMises];

    /// The name used in tables and scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Curvature => "curvature",
            Self::Tension => "tension",
            Self::VonMises => "von-mises",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Curvature => "1/h",
            Self::Energy | Self::Tension | Self::VonMises => "E_b",
        }
    }

    /// The measure at each vertex, not smoothed.
    pub(crate) fn measure(
        self,
        rod: &RodParameters,
        terms: &[Box<dyn EnergyTerm>],
        at: At<'_>,
    ) -> Vec<f64> {
        match self {
            Self::Energy => energy_density(terms, at),
            Self::Curvature => curvature(at),
            Self::Tension => tension(rod, terms, at),
            Self::VonMises => {
                let mut stress = tension(rod, terms, at);
                if let Some(twist) = Twist::of(rod) {
                    // 3 τ² = 3 (α θ'/2)² = 6 α w with the energy w = α θ'²/8
                    let twisted = density_of(twist.name(), terms, at);
                    for (sigma, w) in stress.iter_mut().zip(twisted) {
                        *sigma = (*sigma * *sigma + 6.0 * rod.twist_ratio * w).sqrt();
                    }
                }
                stress
            }
        }
    }
}

impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A fibre breaks by itself while it is charged: when and where the measure of a criterion, smoothed over π h, first exceeds a
/// threshold.
///
/// # Validation
/// `val_a_swelling_ring_breaks_when_its_tension_passes_the_threshold`
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Breaking {
    /// What is held against the threshold.
    #[schemars(example = Criterion::VonMises)]
    pub criterion: Criterion,
    /// What the fibre bears: in E_b, of the curvature in 1/h.
    #[schemars(extend("x-unit" = "E_b, 1/h", "exclusiveMinimum" = 0), example = 0.8)]
    pub threshold: f64,
}

impl Breaking {
    /// Checks the threshold.
    ///
    /// # Errors
    /// One that is not positive and finite.
    pub fn checked(self) -> Result<Self, RodError> {
        positive("charge.break.threshold", self.threshold)?;
        Ok(self)
    }
}

/// A break that was reached: when, where and at which value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Broken {
    /// Time of the charge, in T_0: the end of the first step after which the threshold was exceeded.
    pub time: f64,
    /// The site, with the value of the criterion.
    pub site: CutCandidate,
}

/// Elastic energy per area and length of the term `name` alone; zero where there is none.
fn density_of(name: &str, terms: &[Box<dyn EnergyTerm>], at: At<'_>) -> Vec<f64> {
    let mut density = vec![0.0; at.state.n_vertices()];
    if let Some(term) = terms.iter().find(|term| term.name() == name) {
        term.add_density(at, &mut density);
    }
    density
}

/// |κ| per natural length at each vertex, in 1/h; 0 at free ends.
fn curvature(at: At<'_>) -> Vec<f64> {
    let bent = &at.geometry.binormal;
    let of = |chain: &Chain| {
        let inverse = 1.0 / chain.rest_length();
        let own = chain.vertices();
        own.map(move |i| bent[i].norm() * inverse)
            .collect::<Vec<_>>()
    };
    at.state.components().iter().flat_map(of).collect()
}

/// σ at each vertex, in E_b.
fn tension(rod: &RodParameters, terms: &[Box<dyn EnergyTerm>], at: At<'_>) -> Vec<f64> {
    // h κ, counted from the natural curvature, by the energy w = κ²/8
    let mut stress = density_of(Bend.name(), terms, at);
    for sigma in &mut stress {
        *sigma = (8.0 * *sigma).sqrt();
    }
    for chain in at.state.components() {
        let strain = |j: usize| at.geometry.edge_length[j] / chain.rest_length() - 1.0;
        for i in chain.vertices() {
            let axial = if chain.interior().contains(&i) {
                0.5 * (strain(chain.edge_before(i)) + strain(i))
            } else {
                strain(i.min(chain.last() - 1))
            };
            stress[i] = (stress[i] + rod.stretch_ratio * axial).max(0.0);
        }
    }
    stress
}

#[cfg(test)]
mod tests;
