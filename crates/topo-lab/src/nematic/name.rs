//! What tells the cases of nematic scenes apart: the names of their folders and the settings in their rows.

use serde_json::{Value, json};
use topo_nematic::{
    Anchoring, ChargeSettings, DischargeSettings, FlowParameters, NematicAccuracy,
    NematicParameters, SurfacePattern, SwitchSettings,
};

use super::case::NematicCase;
use super::identity::hashed_accuracy;
use super::scene::NematicScene;
use crate::sweep::{CaseName, Row, value};
use topo_analysis::{NematicRow, Warnings};

/// Keys of a colloid that its name says in words of their own.
const SAID: [&str; 5] = ["radius", "spacing", "pattern", "boundary", "particle"];

impl NematicScene {
    /// Name of a case's folder, such as `q04_r20_h1.5_cut-link_f64_flow-on`: of no other case, whatever the scene.
    ///
    /// What differs from the published colloid is added in words, or as a fingerprint.
    ///
    /// # Validation
    /// `nematic_names_are_injective`
    pub fn case_name(&self, case: &NematicCase) -> String {
        let nematic = &case.nematic;
        let usual = NematicParameters::default();
        let first = match &nematic.pattern {
            _ if !nematic.particle => "no-particle".to_owned(),
            SurfacePattern::Winding(q) => format!("q{q:02}"),
            other => pattern_name(other).to_owned(),
        };
        let has_more = match &nematic.pattern {
            SurfacePattern::Winding(_) => !nematic.particle && nematic.pattern != usual.pattern,
            SurfacePattern::Homeotropic => !nematic.particle,
            _ => true,
        };
        CaseName::of(&first)
            .number("r", nematic.radius)
            .number("h", nematic.spacing)
            .word(nematic.boundary.name())
            .word(self.accuracy.precision.name())
            .word(if case.flow.is_some() {
                "flow-on"
            } else {
                "flow-off"
            })
            .unsaid_if(has_more)
            .changes(&value(nematic), &value(&usual), &SAID)
            .unsaid(
                &self.unsaid(case.flow),
                &usual_settings(self.accuracy.precision, case.flow),
            )
            .finish(|| json!([case, self.unsaid(case.flow)]))
    }

    /// Settings that names do not say.
    fn unsaid(&self, flow: Option<FlowParameters>) -> Value {
        json!([
            self.charge,
            self.switch,
            self.discharge,
            hashed_accuracy(&self.accuracy),
            flow
        ])
    }

    /// A row of a case with its settings only.
    pub(super) fn blank_row(&self, case: &NematicCase) -> NematicRow {
        let (nematic, material) = (&case.nematic, &case.nematic.material);
        let edges = nematic.cell.map(|edge| edge * nematic.radius);
        let edges = nematic
            .cells
            .map_or(edges, |cells| cells.map(|n| n as f64 * nematic.spacing));
        NematicRow {
            case: self.case_name(case),
            radius: nematic.radius,
            spacing: nematic.spacing,
            q: case.q,
            boundary: nematic.boundary.name().to_owned(),
            precision: self.accuracy.precision.name().to_owned(),
            flow: case.flow.is_some().into(),
            pattern: if nematic.particle {
                pattern_name(&nematic.pattern).to_owned()
            } else {
                "none".to_owned()
            },
            anchoring: match nematic.anchoring {
                Anchoring::Strong => "strong".to_owned(),
                Anchoring::Free => "free".to_owned(),
                Anchoring::Weak(strength) => strength.to_string(),
            },
            cell_x: edges[0],
            cell_y: edges[1],
            cell_z: edges[2],
            a: material.a,
            b: material.b,
            c: material.c,
            elastic_constant: material.elastic_constant,
            second_elastic_constant: material.second_elastic_constant,
            rotational_mobility: material.rotational_mobility,
            flow_alignment: material.flow_alignment,
            viscosity: material.viscosity,
            surface_order: material.surface_order,
            field_anisotropy: nematic.field.map(|field| field.anisotropy),
            tolerance: self.accuracy.tolerance,
            ..NematicRow::default()
        }
    }

    /// The scene as [`text`](Self::text) with the settings themselves where a goal picked them; the goal where each case has its own.
    pub fn resolved_text(&self) -> String {
        let scene = Self {
            goal: self.goal.filter(|_| self.fitted.is_some()),
            ..self.clone()
        };
        scene.text()
    }
}

fn usual_settings(precision: topo_nematic::Precision, flow: Option<FlowParameters>) -> Value {
    let accuracy = NematicAccuracy {
        precision,
        ..NematicAccuracy::default()
    };
    json!([
        ChargeSettings::default(),
        SwitchSettings::default(),
        DischargeSettings::default(),
        hashed_accuracy(&accuracy),
        flow.map(|_| FlowParameters::default())
    ])
}

fn pattern_name(pattern: &SurfacePattern) -> &'static str {
    match pattern {
        SurfacePattern::Winding(_) => "charge",
        SurfacePattern::Homeotropic => "homeotropic",
        SurfacePattern::Planar { .. } => "planar",
        SurfacePattern::Uniform { .. } => "uniform",
        SurfacePattern::Table(_) => "table",
        _ => "other",
    }
}

impl Row for NematicRow {
    fn cpu_seconds(&self) -> f64 {
        self.cpu_seconds
    }

    fn warnings(&self) -> &Warnings {
        &self.warnings
    }

    fn with_settings_of(self, blank: &Self) -> Self {
        let blank = blank.clone();
        Self {
            case: blank.case,
            pattern: blank.pattern,
            anchoring: blank.anchoring,
            cell_x: blank.cell_x,
            cell_y: blank.cell_y,
            cell_z: blank.cell_z,
            a: blank.a,
            b: blank.b,
            c: blank.c,
            elastic_constant: blank.elastic_constant,
            second_elastic_constant: blank.second_elastic_constant,
            rotational_mobility: blank.rotational_mobility,
            flow_alignment: blank.flow_alignment,
            viscosity: blank.viscosity,
            surface_order: blank.surface_order,
            field_anisotropy: blank.field_anisotropy,
            tolerance: blank.tolerance,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use topo_nematic::{Boundary, ExternalField, Precision, Threads};

    use super::*;
    use crate::preset::Preset;

    /// A number of a scene changed by a factor.
    const NUMBERS: [fn(&mut NematicScene, f64); 12] = [
        |s, f| s.nematic.radius *= f,
        |s, f| s.nematic.spacing *= f,
        |s, f| s.nematic.cell[2] *= f,
        |s, f| s.nematic.anchoring = Anchoring::Weak(f),
        |s, f| s.nematic.material.b *= f,
        |s, f| s.nematic.material.viscosity *= f,
        |s, f| s.nematic.material.surface_order = Some(f),
        |s, f| {
            s.nematic.field = Some(ExternalField {
                vector: [0.0, 0.0, 1.0],
                anisotropy: f,
            });
        },
        |s, f| s.charge.tolerance *= f,
        |s, f| s.switch.ramp = Some(f),
        |s, f| s.discharge.until_released *= f,
        |s, f| s.accuracy.tolerance *= f,
    ];

    /// A choice of a scene made in another way.
    const CHOICES: [fn(&mut NematicScene); 9] = [
        |_| {},
        |s| s.charges = vec![11],
        |s| s.flowing = None,
        |s| (s.flowing, s.flow.as_mut().unwrap().boundary_residual) = (None, 0.1),
        |s| s.nematic.particle = false,
        |s| (s.nematic.particle, s.charges) = (false, vec![3]),
        |s| s.nematic.boundary = Boundary::NodeMask,
        |s| s.nematic.periodic = true,
        |s| s.accuracy.precision = Precision::Single,
    ];

    const PATTERNS: [SurfacePattern; 5] = [
        SurfacePattern::Winding(-1),
        SurfacePattern::Homeotropic,
        SurfacePattern::Planar {
            axis: [0.0, 0.0, 1.0],
        },
        SurfacePattern::Planar {
            axis: [1.0, 0.0, 1.0],
        },
        SurfacePattern::Uniform {
            director: [0.0, 0.0, 1.0],
        },
    ];

    /// Each setting of a scene changed by itself, by a round number and by the least that a number can change.
    #[test]
    fn nematic_names_are_injective() {
        let base = NematicScene::published(Preset::Draft);
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let see = |names: &mut BTreeMap<String, usize>, scene: &NematicScene| {
            let name = scene.case_name(&NematicScene::cases(scene)[0]);
            assert!(name.len() < 100 && !name.contains(['/', ' ']), "{name}");
            *names.entry(name).or_default() += 1;
        };
        let above = |x: f64| f64::from_bits(x.to_bits() + 1);
        for change in NUMBERS {
            for factor in [0.5, 0.75, 1.0 / 3.0, above(1.0)] {
                let mut scene = base.clone();
                change(&mut scene, factor);
                see(&mut names, &scene);
                scene.nematic.material.flow_alignment = 0.5;
                see(&mut names, &scene);
            }
        }
        for change in CHOICES {
            let mut scene = base.clone();
            change(&mut scene);
            see(&mut names, &scene);
        }
        for pattern in PATTERNS {
            let mut scene = base.clone();
            scene.charges.clear();
            scene.nematic.pattern = pattern;
            see(&mut names, &scene);
        }
        assert!(names.values().all(|n| *n == 1), "{names:#?}");
        assert_eq!(names.len(), 12 * 8 + 14);
        for plain in [
            "q01_r20_h1.5_cut-link_f64_flow-off",
            "q01_r20_h1.5_cut-link_f64_flow-on",
            "homeotropic_r20_h1.5_cut-link_f64_flow-off",
            "no-particle_r20_h1.5_cut-link_f64_flow-off",
        ] {
            assert!(names.contains_key(plain), "{plain} in {names:#?}");
        }
        // what changes no number changes no name
        let mut scene = base.clone();
        scene.accuracy.threads = Threads::All;
        see(&mut names, &scene);
        assert_eq!(names["q01_r20_h1.5_cut-link_f64_flow-off"], 2);
    }
}
