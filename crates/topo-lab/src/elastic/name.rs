//! What tells the cases of elastic scenes apart: the names of their folders and the settings in their rows.

use serde_json::json;
use topo_rod::{EndLoad, FrictionRange, Reading, RodParameters};

use super::case::ElasticCase;
use super::identity::settings_of;
use super::own_term::OwnTerm;
use super::rest::RestKeys;
use super::scene::{ElasticScene, OwnKnots};
use super::tie::Tie;
use crate::preset::Preset;
use crate::sweep::{CaseName, Row, value};
use topo_analysis::{SweepRow, Warnings};

impl ElasticScene {
    /// Name of a case's folder, such as `3_1_twist+0.00_shrunk_n200`: of no other case, whatever the scene.
    ///
    /// What differs from the published settings of the preset is added in words, or as a fingerprint.
    ///
    /// # Validation
    /// `elastic_names_are_injective`
    pub fn case_name(&self, case: &ElasticCase) -> String {
        let rod = &case.rod;
        let usual = Self::published(self.preset);
        let name = CaseName::of(&case.knot);
        let name = match &case.tied {
            Some(tied) if !tied.word.is_empty() => name.word(&tied.word),
            _ => name,
        };
        let name = match rod.twist {
            None => name.word("untwisted"),
            Some(twist) => name.signed("twist", twist),
        };
        let name = name
            .word(rod.reading.name())
            .word(&format!("n{}", rod.n_edges));
        let name = match self.preset {
            Preset::Draft => name,
            other => name.word(other.name()),
        };
        let said = RodParameters {
            twist: rod.twist,
            reading: rod.reading,
            n_edges: rod.n_edges,
            ..usual.rod.clone()
        };
        let name = name.changes(&value(rod), &value(&said), &[]);
        let rest = case.rest.as_ref().map_or(json!({}), |rest| rest.said());
        let name = name.changes(&json!({ "rest": rest }), &json!({ "rest": {} }), &[]);
        let name = match case.load {
            Some(load) => name.changes(
                &json!({ "load": load }),
                &json!({ "load": EndLoad::default() }),
                &[],
            ),
            None => name,
        };
        let labels = self.own_terms.iter().map(OwnTerm::label);
        labels
            .fold(name, |name, label| name.word(label))
            .changes(
                &json!({"imperfection": case.imperfection, "seed": case.seed}),
                &json!({"imperfection": usual.imperfection, "seed": usual.seed}),
                &[],
            )
            .unsaid(&settings_of(self, case), &settings_of(&usual, case))
            .finish(|| json!([case, case.imperfection, case.seed, settings_of(self, case)]))
    }

    /// A row of a case with its settings only.
    pub(super) fn blank_row(&self, case: &ElasticCase) -> SweepRow {
        let rod = &case.rod;
        SweepRow {
            case: self.case_name(case),
            knot: case.knot.clone(),
            name: case.knot.clone(),
            components: case.n_components(),
            twist: rod.twist.unwrap_or(0.0),
            reading: rod.reading.name().to_owned(),
            edges: rod.n_edges,
            slenderness: rod.slenderness,
            length: (rod.reading != Reading::OwnLength).then_some(rod.slenderness),
            twist_ratio: rod.twist_ratio,
            stretch_ratio: rod.stretch_ratio,
            contact_stiffness: rod.contact.map(|c| c.stiffness),
            friction_ratio: rod.friction.map(|f| f.ratio),
            friction_range: rod.friction.map(|f| match f.range {
                FrictionRange::Reading => "reading".to_owned(),
                FrictionRange::Contact => "contact".to_owned(),
                FrictionRange::TimesContact(x) => x.to_string(),
            }),
            load_spring: case.load.map(|l| l.spring),
            load_rest_length: case.load.map(|l| l.rest_length),
            load_dashpot: case.load.map(|l| l.dashpot),
            imperfection: case.imperfection,
            seed: case.seed,
            tolerance: self.accuracy.tolerance,
            ..SweepRow::default()
        }
    }

    /// The scene as [`text`](Self::text) with the settings themselves where a goal picked them.
    pub fn resolved_text(&self) -> String {
        // the folder of knots is named so that it is found from anywhere
        let own_knots = self.own_knots.as_ref().map(OwnKnots::path);
        let own_knots = own_knots.map(|path| std::path::absolute(&path).unwrap_or(path));
        let scene = Self {
            goal: None,
            own_knots: own_knots.as_deref().map(OwnKnots::at),
            tie: self.tie.as_ref().map(Tie::found_from_anywhere),
            rest: self.rest.as_ref().map(RestKeys::found_from_anywhere),
            ..self.clone()
        };
        let labels = self.own_terms.iter().map(OwnTerm::label);
        let text = labels.map(|label| {
            format!("# with the energy term {label} of a program, which this file cannot say\n")
        });
        text.chain([scene.text()]).collect()
    }
}

impl Row for SweepRow {
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
            name: blank.name,
            components: blank.components,
            slenderness: blank.slenderness,
            // that of a knot's own length is known since it was tied
            length: blank.length.or(self.length),
            twist_ratio: blank.twist_ratio,
            stretch_ratio: blank.stretch_ratio,
            contact_stiffness: blank.contact_stiffness,
            friction_ratio: blank.friction_ratio,
            friction_range: blank.friction_range,
            load_spring: blank.load_spring,
            load_rest_length: blank.load_rest_length,
            load_dashpot: blank.load_dashpot,
            imperfection: blank.imperfection,
            seed: blank.seed,
            tolerance: blank.tolerance,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use topo_rod::{Breaking, Criterion, Reading};

    use super::*;
    use crate::elastic::Cuts;

    fn breaks(criterion: Criterion, threshold: f64) -> Option<Breaking> {
        Some(Breaking {
            criterion,
            threshold,
        })
    }

    /// A number of a scene changed by a factor.
    const NUMBERS: [fn(&mut ElasticScene, f64); 12] = [
        |s, f| s.rod.slenderness *= f,
        |s, f| s.rod.twist_ratio *= f,
        |s, f| s.rod.stretch_ratio *= f,
        |s, f| s.rod.contact.as_mut().unwrap().stiffness *= f,
        |s, f| s.rod.friction.as_mut().unwrap().ratio *= f,
        |s, f| s.rod.friction.as_mut().unwrap().range = FrictionRange::TimesContact(f),
        |s, f| s.imperfection *= f,
        |s, f| s.charge.duration *= f,
        |s, f| s.discharge.until_released *= f,
        |s, f| s.discharge.longest *= f,
        |s, f| s.accuracy.tolerance *= f,
        |s, f| s.accuracy.gamma *= f,
    ];

    /// A choice of a scene made in another way.
    const CHOICES: [fn(&mut ElasticScene); 20] = [
        |s| s.rod.contact = None,
        |s| s.rod.friction = None,
        |s| (s.rod.contact, s.rod.friction) = (None, None),
        |s| s.rod.friction.as_mut().unwrap().range = FrictionRange::Contact,
        |s| s.rod.n_edges = 100,
        |s| s.rod.reading = Reading::Hard,
        |s| s.seed = 7,
        |s| s.cuts = Cuts::NearTies(Criterion::Energy),
        |s| s.cuts = Cuts::NearTies(Criterion::Tension),
        |s| s.cuts = Cuts::Largest(Criterion::Tension),
        |s| s.cuts = Cuts::Criteria,
        |s| s.charge.breaking = breaks(Criterion::Tension, 0.8),
        |s| s.charge.breaking = breaks(Criterion::VonMises, 0.8),
        |s| s.charge.breaking = breaks(Criterion::VonMises, 0.9),
        |s| s.cuts = Cuts::All(3),
        |s| s.timeline.closures = 0,
        |s| s.accuracy.reuse = 1,
        |s| *s = ElasticScene::published(Preset::Standard),
        |s| *s = ElasticScene::published(Preset::Paper),
        |s| s.fixed_cuts = Some(BTreeMap::from([("3_1 0".to_owned(), vec![0.5])])),
    ];

    /// Each setting of a scene changed by itself, by a round number and by the least that a number can change.
    #[test]
    fn elastic_names_are_injective() {
        let base = ElasticScene::published(Preset::Draft);
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let mut see = |scene: &ElasticScene, twist: Option<f64>| {
            let name = scene.case_name(&scene.case("3_1", twist));
            assert!(name.len() < 100 && !name.contains(['/', ' ']), "{name}");
            *names.entry(name).or_default() += 1;
        };
        let above = |x: f64| f64::from_bits(x.to_bits() + 1);
        for twist in [
            0.0,
            -0.0,
            1.0,
            1.001,
            1.004,
            above(1.0),
            -0.0075,
            1.0 / 3.0,
            above(1.0 / 3.0),
            1e-9,
            1e9,
        ] {
            see(&base, Some(twist));
        }
        see(&base, None);
        for change in NUMBERS {
            for factor in [0.5, 0.75, 1.0 / 3.0, above(1.0)] {
                let mut scene = base.clone();
                change(&mut scene, factor);
                see(&scene, Some(0.0));
                // together with another one
                scene.rod.slenderness += 1.0;
                see(&scene, Some(0.25));
            }
        }
        for change in CHOICES {
            let mut scene = base.clone();
            change(&mut scene);
            see(&scene, Some(0.0));
        }
        assert!(names.values().all(|n| *n == 1), "{names:#?}");
        assert_eq!(names.len(), 12 + 12 * 8 + 20);
        for plain in [
            "3_1_twist+0.00_shrunk_n200",
            "3_1_untwisted_shrunk_n200",
            "3_1_twist+0.00_shrunk_n200_standard",
        ] {
            assert!(names.contains_key(plain), "{plain}");
        }
    }
}
