//! How the ends of an open rod are held, moved and loaded.

mod course;
mod placed;

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::RodError;

pub use course::{Grip, Ramp, TimeCourse};
pub(crate) use course::{GripSchedule, GripSegment};
pub(crate) use placed::PlacedEnds;
pub use placed::RodEnds;

/// How one end is held.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EndCondition {
    /// Nothing holds it.
    #[default]
    Free,
    /// The end vertex is held; the rod may turn about it.
    Pinned,
    /// End vertex, end tangent and end rotation are held.
    Clamped,
}

/// Prescribed motion and load of one end; zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EndMotion {
    /// Velocity of a held end, in h E_b/η.
    #[schemars(extend("x-unit" = "h E_b/η", "examples" = [[0.1, 0.0, 0.0]]))]
    pub velocity: [f64; 3],
    /// Rotation rate about the end tangent of a clamped end, in E_b/η.
    #[schemars(extend("x-unit" = "E_b/η"), example = 0.1)]
    pub rotation_rate: f64,
    /// Force on a free end, per area, in E_b.
    #[schemars(extend("x-unit" = "E_b", "examples" = [[0.1, 0.0, 0.0]]))]
    pub force: [f64; 3],
    /// Torque about the tangent on an end that is not clamped, per area, in E_b h.
    #[schemars(extend("x-unit" = "E_b h"), example = 0.1)]
    pub torque: f64,
}

/// Both ends of an open rod. The default is free and unloaded, at no cost.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Ends {
    /// How the first and the last vertex are held.
    #[schemars(extend("examples" = [["clamped", "free"]]))]
    pub conditions: [EndCondition; 2],
    /// How they move and what loads them.
    #[schemars(extend("examples" = [[{ "velocity": [-0.1, 0.0, 0.0] }, { "velocity": [0.1, 0.0, 0.0] }]]))]
    pub motions: [EndMotion; 2],
}

impl Ends {
    /// Checks that loads act on free ends and motions on held ends, and that the forces on a free rod balance.
    ///
    /// # Errors
    /// Names the contradiction.
    pub fn checked(self, has_twist: bool) -> Result<Self, RodError> {
        let wrong = |reason| Err(RodError::Ends { reason });
        let mut net = Vector3::zeros();
        let mut net_torque = 0.0;
        for (condition, motion) in self.conditions.iter().zip(&self.motions) {
            for x in motion
                .velocity
                .iter()
                .chain(&motion.force)
                .chain([&motion.rotation_rate, &motion.torque])
            {
                topo_core::finite("discharge.ends", *x)?;
            }
            let (moves, turns) = (motion.velocity != [0.0; 3], motion.rotation_rate != 0.0);
            let (pushed, twisted) = (motion.force != [0.0; 3], motion.torque != 0.0);
            match condition {
                EndCondition::Free if moves => {
                    return wrong("a free end has no prescribed velocity: pin or clamp it");
                }
                EndCondition::Pinned | EndCondition::Clamped if pushed => {
                    return wrong("a held end takes no force: free it");
                }
                EndCondition::Clamped if twisted => {
                    return wrong("a clamped end takes no torque: pin or free it");
                }
                EndCondition::Free | EndCondition::Pinned if turns => {
                    return wrong("only a clamped end has a prescribed rotation: clamp it");
                }
                _ => {}
            }
            if (turns || twisted) && !has_twist {
                return wrong("a rod without twist has no end rotation or torque: give it `twist`");
            }
            net += Vector3::from(motion.force);
            net_torque += motion.torque;
        }
        let free = self.conditions == [EndCondition::Free; 2];
        if free && net.norm() > 1e-12 {
            return wrong(
                "the forces on a rod with two free ends must balance: its viscosity is internal, nothing else would hold it",
            );
        }
        if !self.conditions.contains(&EndCondition::Clamped) && f64::abs(net_torque) > 1e-12 {
            return wrong("the torques on a rod without a clamped end must balance");
        }
        Ok(self)
    }

    /// Whether nothing holds, moves or loads the ends.
    pub fn is_free(&self) -> bool {
        *self == Self::default()
    }

    /// Whether work can flow in or out at the ends.
    pub fn is_driven(&self) -> bool {
        self.motions != [EndMotion::default(); 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free(force: [[f64; 3]; 2], torque: [f64; 2]) -> Ends {
        let motion = |end: usize| EndMotion {
            force: force[end],
            torque: torque[end],
            ..Default::default()
        };
        Ends {
            motions: [motion(0), motion(1)],
            ..Default::default()
        }
    }

    /// Internal viscosity resists no common motion, so loads on a free rod must sum to zero; what is held balances any.
    #[test]
    fn loads_on_a_free_rod_balance() {
        let pull = [0.1, -0.2, 0.3];
        let balanced = free([pull, pull.map(|x| -x)], [0.4, -0.4]);
        assert!(balanced.checked(true).is_ok());
        let refused = |ends: Ends, word: &str| {
            let error = ends.checked(true).expect_err("unbalanced").to_string();
            assert!(error.contains(word), "{error}");
        };
        for axis in 0..3 {
            let mut force = [pull, pull.map(|x| -x)];
            force[1][axis] *= -1.0;
            refused(free(force, [0.0; 2]), "forces");
        }
        for torque in [[0.4, 0.4], [0.4, 0.0], [0.0, -0.4]] {
            let twisted = free([[0.0; 3]; 2], torque);
            refused(twisted, "torques");
            let pinned = Ends {
                conditions: [EndCondition::Pinned, EndCondition::Free],
                ..twisted
            };
            refused(pinned, "torques");
        }
        let clamped = Ends {
            conditions: [EndCondition::Clamped, EndCondition::Free],
            ..free([[0.0; 3], pull], [0.0, 0.4])
        };
        assert!(clamped.checked(true).is_ok());
    }
}
