//! Rows of the nematic tables: sweep, time series, defect lines, slices.

use std::fmt;

use serde::{Deserialize, Serialize};
use topo_core::MinimumState;

use crate::warnings::Warnings;

/// Whether a discharge has a fluid that flows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Flow {
    /// No velocity is modelled.
    #[default]
    Off,
    /// The fluid flows.
    On,
}

impl Flow {
    /// Whether the fluid flows.
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

impl From<bool> for Flow {
    fn from(is_on: bool) -> Self {
        if is_on { Self::On } else { Self::Off }
    }
}

impl fmt::Display for Flow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(if self.is_on() { "on" } else { "off" })
    }
}

/// One discharge of a charged colloid: lengths in ξ_N, energies in L ξ_N, times in τ_N = ξ_N²/(Γ L).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NematicRow {
    /// Folder of the case.
    pub case: String,
    /// Radius of the particle, in ξ_N.
    pub radius: f64,
    /// Grid spacing, in ξ_N.
    pub spacing: f64,
    /// Winding of the anchoring.
    pub q: u32,
    /// How the particle's surface meets the grid: cut-link or node-mask.
    pub boundary: String,
    /// Storage of the field: f64 or f32.
    pub precision: String,
    /// Whether the fluid flows.
    pub flow: Flow,
    /// What the particle's surface prefers: charge (of winding q), homeotropic, planar, uniform or table; none without a particle.
    #[serde(default)]
    pub pattern: String,
    /// How strongly: strong, free, or the strength W in L/ξ_N.
    #[serde(default)]
    pub anchoring: String,
    /// Length of the box along x, in ξ_N.
    #[serde(default)]
    pub cell_x: f64,
    /// Length along y, in ξ_N.
    #[serde(default)]
    pub cell_y: f64,
    /// Length along z, the distance between the plates, in ξ_N.
    #[serde(default)]
    pub cell_z: f64,
    /// A, in L/ξ_N².
    #[serde(default)]
    pub a: f64,
    /// B, in L/ξ_N².
    #[serde(default)]
    pub b: f64,
    /// C, in L/ξ_N².
    #[serde(default)]
    pub c: f64,
    /// Elastic constant L: 1 in reduced units.
    #[serde(default)]
    pub elastic_constant: f64,
    /// Second elastic constant L_2, in L; empty where none is modelled.
    #[serde(default)]
    pub second_elastic_constant: Option<f64>,
    /// Rotational mobility Γ: 1 in reduced units.
    #[serde(default)]
    pub rotational_mobility: f64,
    /// Flow alignment χ: no unit.
    #[serde(default)]
    pub flow_alignment: f64,
    /// Isotropic viscosity η, in 1/Γ.
    #[serde(default)]
    pub viscosity: f64,
    /// Order S at surfaces: no unit; empty for that of equilibrium.
    #[serde(default)]
    pub surface_order: Option<f64>,
    /// Anisotropy of the external field: no unit; empty where none is modelled.
    #[serde(default)]
    pub field_anisotropy: Option<f64>,
    /// Target of the local error: no unit.
    #[serde(default)]
    pub tolerance: f64,
    /// Free energy after charging, in L ξ_N.
    pub f_charged: f64,
    /// Free energy just after the switch, in L ξ_N.
    pub f_after_switch: f64,
    /// Free energy of the state of equilibrium after the switch, in L ξ_N: shares count down to it.
    pub f_final: f64,
    /// Size of the horizontal order parameter after charging: no unit; zero below the buckling transition.
    pub order_parameter: f64,
    /// Lowest eigenvalue of the Hessian of the energy at the charged state, in L/ξ_N²: a small change along its mode decays at Γ
    /// times this.
    pub lowest_eigenvalue: Option<f64>,
    /// What the eigenvalue means for the charged state: minimum, saddle or marginal.
    pub state: Option<MinimumState>,
    /// Mean distance of the ring from the axis, in ξ_N.
    pub ring_radius: Option<f64>,
    /// Undulations of the ring's height: the strongest mode.
    pub ring_mode: Option<u32>,
    /// Amplitude of that mode, in ξ_N.
    pub ring_amplitude: Option<f64>,
    /// Time at which half of the energy after the switch was released, in τ_N.
    pub t50: Option<f64>,
    /// Same for 90 %.
    pub t90: Option<f64>,
    /// Same for 99 %.
    pub t99: Option<f64>,
    /// Same for 99.9 %.
    pub t999: Option<f64>,
    /// Time at which half of the charged energy was released, the switch included, in τ_N.
    pub t50_charged: Option<f64>,
    /// Same for 90 %.
    pub t90_charged: Option<f64>,
    /// Same for 99 %.
    pub t99_charged: Option<f64>,
    /// Same for 99.9 %.
    pub t999_charged: Option<f64>,
    /// Rate −d ln(F − F_final)/dt at the end of the discharge, in 1/τ_N.
    pub late_rate: Option<f64>,
    /// Accepted steps of the discharge.
    pub steps: u64,
    /// Evaluations of the rate, charge and discharge.
    pub evaluations: u64,
    /// Updates of the velocity.
    pub stokes_updates: u64,
    /// Iterations of the particle's constraint in all of them.
    pub stokes_iterations: u64,
    /// Processor time of charge and discharge, in seconds.
    pub cpu_seconds: f64,
    /// Largest number of bytes held by fields, lists and solvers.
    pub peak_bytes: u64,
    /// What is doubtful about it.
    pub warnings: Warnings,
}

/// Order parameter above which a ring counts as buckled.
pub const BUCKLED: f64 = 0.01;

impl NematicRow {
    /// Whether two rows are of one discharge, whatever their resolution.
    pub fn is_same_discharge(&self, other: &Self) -> bool {
        let settings = |r: &Self| {
            (
                [&r.boundary, &r.pattern, &r.anchoring].map(String::clone),
                r.flow,
                (r.q, r.radius, [r.a, r.b, r.c, r.elastic_constant]),
                [r.rotational_mobility, r.flow_alignment, r.viscosity],
                [
                    r.second_elastic_constant,
                    r.surface_order,
                    r.field_anisotropy,
                ],
            )
        };
        settings(self) == settings(other)
    }

    /// Whether the ring is buckled; symmetry makes the order parameter zero below, to the residual of the charge.
    pub fn is_buckled(&self) -> bool {
        self.order_parameter > BUCKLED
    }

    /// t50, t90, t99 and t99.9, relative to the energy after the switch.
    pub fn times(&self) -> [Option<f64>; 4] {
        [self.t50, self.t90, self.t99, self.t999]
    }
}

/// The battery at one time of its discharge: lengths in ξ_N, energies in L ξ_N, times in τ_N = ξ_N²/(Γ L), L the elastic constant.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NematicSample {
    /// Time since the switch, in τ_N.
    pub time: f64,
    /// Free energy, in L ξ_N.
    pub energy: f64,
    /// Energy dissipated by reorientation since the switch, in L ξ_N.
    pub dissipated_rotation: f64,
    /// Energy dissipated by flow since the switch, in L ξ_N.
    pub dissipated_flow: f64,
    /// Horizontal order parameter along x: no unit.
    pub order_x: f64,
    /// Horizontal order parameter along y: no unit.
    pub order_y: f64,
    /// Size of the mean horizontal director, with the director taken upwards: no unit.
    pub tilt: f64,
    /// Mean distance of the ring from the axis, in ξ_N; empty without a ring.
    pub ring_radius: Option<f64>,
    /// Largest speed, in ξ_N/τ_N, with flow.
    pub max_speed: Option<f64>,
    /// Power of the nematic's force on the fluid, in L ξ_N/τ_N, with flow.
    pub power: Option<f64>,
    /// Correlation of the velocity in three dimensions with the first one, over the cells of the fluid: 1 along it, −1 against it; empty
    /// without flow, and in tables older than the column.
    #[serde(default)]
    pub flow_correlation: Option<f64>,
}

/// A point of a defect line, in ξ_N from the particle's centre; times in τ_N.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LinePoint {
    /// Time since the switch, in τ_N; empty for the charged state.
    pub time: Option<f64>,
    /// Which line.
    pub line: usize,
    /// Whether it is closed.
    pub closed: bool,
    /// Coordinate x, in ξ_N.
    pub x: f64,
    /// Coordinate y, in ξ_N.
    pub y: f64,
    /// Coordinate z, in ξ_N.
    pub z: f64,
    /// Angle between the rotation axis of the director around the line and the line, in degrees: 0 is a +1/2 profile, 90 a
    /// twisted one, 180 a −1/2 profile; empty where it is unclear.
    pub angle: Option<f64>,
}

/// A point of the vertical plane through the particle's centre, in ξ_N from it; times in τ_N.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SlicePoint {
    /// Time since the switch, in τ_N; empty for the charged state.
    pub time: Option<f64>,
    /// Horizontal position, in ξ_N.
    pub x: f64,
    /// Vertical position, in ξ_N.
    pub z: f64,
    /// Order S: no unit.
    pub order: f64,
    /// Component x of the unit director.
    pub nx: f64,
    /// Component y of the unit director.
    pub ny: f64,
    /// Component z of the unit director.
    pub nz: f64,
    /// Velocity, in ξ_N/τ_N, with flow.
    pub ux: Option<f64>,
    /// Velocity, in ξ_N/τ_N, with flow.
    pub uz: Option<f64>,
    /// Vorticity about y, in 1/τ_N, with flow.
    pub vorticity: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{read_table, write_table};

    #[test]
    fn the_sweep_carries_the_agreed_header() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.csv");
        let rows = vec![NematicRow {
            q: 4,
            state: Some(MinimumState::Marginal),
            t999: Some(3.5),
            warnings: "a;b".into(),
            ..Default::default()
        }];
        write_table(&path, &rows).unwrap();
        assert_eq!(read_table::<NematicRow>(&path).unwrap(), rows);
        assert_eq!(
            std::fs::read_to_string(&path)
                .unwrap()
                .lines()
                .next()
                .unwrap(),
            "case,radius,spacing,q,boundary,precision,flow,pattern,anchoring,cell_x,cell_y,cell_z,a,b,c,elastic_constant,second_elastic_constant,rotational_mobility,flow_alignment,viscosity,surface_order,field_anisotropy,tolerance,f_charged,f_after_switch,f_final,order_parameter,lowest_eigenvalue,state,ring_radius,ring_mode,ring_amplitude,t50,t90,t99,t999,t50_charged,t90_charged,t99_charged,t999_charged,late_rate,steps,evaluations,stokes_updates,stokes_iterations,cpu_seconds,peak_bytes,warnings"
        );
    }
}
