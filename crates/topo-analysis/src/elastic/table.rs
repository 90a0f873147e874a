//! Rows of the elastic tables.

use crate::further::Further;
use crate::warnings::Warnings;
use serde::{Deserialize, Serialize};

/// One discharge: energies in E_0 = E_b h² L, times in T_0 = 2 L η/(h E_b), L the row's own length.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Folder of the case beside the table.
    pub case: String,
    /// Knot type, or that of a link.
    pub knot: String,
    /// Name found for the curves that were tied, hand included: of a knot or link of the table, else what fits.
    #[serde(default)]
    pub name: String,
    /// Number of closed fibres that were charged.
    #[serde(default = "one")]
    pub components: usize,
    /// Linking numbers of the charged fibres, 1 and 2, 1 and 3 and so on to the last two, semicolons between them; empty for a knot.
    #[serde(default)]
    pub linking: String,
    /// Twist density θ'h tied in before the ends were fused.
    pub twist: f64,
    /// Position of the cut, s/L; of a link along its components, one after the other.
    pub cut: f64,
    /// Criteria by which the site was chosen, semicolons between them: energy, curvature, tension, von-mises; empty where the place was
    /// given, and in older tables.
    #[serde(default)]
    pub cut_by: String,
    /// Reading of the slenderness.
    pub reading: String,
    /// Edges of the rod.
    pub edges: usize,
    /// Slenderness L/h.
    #[serde(default)]
    pub slenderness: f64,
    /// Natural length L of all fibres together, in h, whose T_0 and E_0 the row is in; empty in older tables of knots with a length of
    /// their own.
    #[serde(default)]
    pub length: Option<f64>,
    /// Ratio α of twist to bending stiffness: no unit.
    #[serde(default)]
    pub twist_ratio: f64,
    /// Stretch stiffness γ = E/E_b.
    #[serde(default)]
    pub stretch_ratio: f64,
    /// Stiffness k_c of the contact, in E_b/h³; empty without contact.
    #[serde(default)]
    pub contact_stiffness: Option<f64>,
    /// η_f/η; empty without friction.
    #[serde(default)]
    pub friction_ratio: Option<f64>,
    /// Where friction reaches: as the reading says, contact, or a multiple of the contact diameter; empty without friction.
    #[serde(default)]
    pub friction_range: Option<String>,
    /// Stiffness of the spring of the load per area, in E_b/h; empty without a load.
    #[serde(default)]
    pub load_spring: Option<f64>,
    /// Length at which that spring is at rest, in h; empty without a load.
    #[serde(default)]
    pub load_rest_length: Option<f64>,
    /// Resistance of the dashpot of the load per area, in η/h; empty without a load.
    #[serde(default)]
    pub load_dashpot: Option<f64>,
    /// Random perturbation of the start curve, in h.
    #[serde(default)]
    pub imperfection: f64,
    /// Its seed, and that of the closures.
    #[serde(default)]
    pub seed: u64,
    /// Target of the local error, in h.
    #[serde(default)]
    pub tolerance: f64,
    /// Elastic energy after charging, in E_0.
    pub energy: f64,
    /// Its bending part, in E_0.
    pub bend: f64,
    /// Its twist part, in E_0.
    pub twist_energy: f64,
    /// Its stretch part, in E_0.
    pub stretch: f64,
    /// Energies of further terms after charging, in E_0, one column of that name each; not read back from tables.
    #[serde(default, skip_serializing_if = "Further::is_empty")]
    pub further: Further,
    /// Elastic energy after charging, in E_0, of the mirror image that was not kept, for an amphichiral knot; empty where only
    /// one image was charged, and in older tables without this column.
    #[serde(default)]
    pub energy_other_image: Option<f64>,
    /// Writhe after charging: no unit.
    pub writhe: f64,
    /// Total twist after charging, in turns.
    pub total_twist: f64,
    /// Time at which half of the elastic energy before the cut was released, in T_0; 0 if the cut itself released it.
    pub t50: Option<f64>,
    /// Same for 90 %.
    pub t90: Option<f64>,
    /// Same for 95 %.
    pub t95: Option<f64>,
    /// Same for 99 %.
    pub t99: Option<f64>,
    /// Time at which half of the elastic energy left by the cut was released, in T_0.
    pub t50_after_cut: Option<f64>,
    /// Same for 90 %.
    pub t90_after_cut: Option<f64>,
    /// Same for 95 %.
    pub t95_after_cut: Option<f64>,
    /// Same for 99 %.
    pub t99_after_cut: Option<f64>,
    /// Time of the last change of the knot type to the unknot, in T_0; empty if not seen.
    pub t_untie: Option<f64>,
    /// What the charge took, in E_0: the elastic energy of the fibre tied without twist, and the work of twisting it.
    #[serde(default)]
    pub energy_in: Option<f64>,
    /// Work on the load by the end of the discharge, in E_0; empty without a load.
    #[serde(default)]
    pub work: Option<f64>,
    /// Heat of the discharge, in E_0: what internal viscosity, twist viscosity and friction dissipated.
    #[serde(default)]
    pub heat: Option<f64>,
    /// What its energy account leaves open, over the largest energy in it.
    #[serde(default)]
    pub residual: Option<f64>,
    /// Largest power on the load in the mean over a step, in E_0/T_0; empty without a load.
    #[serde(default)]
    pub peak_power: Option<f64>,
    /// `work` over `energy_in`; empty without a load.
    #[serde(default)]
    pub efficiency: Option<f64>,
    /// Elastic energy after charging over the mass of the fibre, in E_b/ρ.
    #[serde(default)]
    pub energy_per_mass: Option<f64>,
    /// Largest |Δ(Tw + Wr)| while closed, in turns.
    pub link_drift: Option<f64>,
    /// Least distance of vertices of different strands over the contact diameter, charge and discharge.
    pub min_distance_over_contact: Option<f64>,
    /// Accepted steps of charge and discharge.
    pub steps: u64,
    /// Refused steps of charge and discharge.
    pub rejected: u64,
    /// Processor time of this discharge and its share of the charge, in seconds.
    pub cpu_seconds: f64,
    /// What is doubtful about it.
    pub warnings: Warnings,
}

/// Components of the rows of tables without that column.
fn one() -> usize {
    1
}

impl SweepRow {
    /// Whether two rows are of one charged state, whatever their resolution.
    pub fn is_same_state(&self, other: &Self) -> bool {
        let settings = |r: &Self| {
            (
                r.knot.clone(),
                r.reading.clone(),
                [
                    r.twist,
                    r.slenderness,
                    r.twist_ratio,
                    r.stretch_ratio,
                    r.imperfection,
                ],
                [
                    r.contact_stiffness,
                    r.friction_ratio,
                    r.load_spring,
                    r.load_rest_length,
                    r.load_dashpot,
                ],
                r.friction_range.clone(),
                r.seed,
            )
        };
        settings(self) == settings(other)
    }

    /// t50, t90, t95 and t99.
    pub fn times(&self) -> [Option<f64>; 4] {
        [self.t50, self.t90, self.t95, self.t99]
    }
}
