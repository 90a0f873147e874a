//! Scenes beside the published sweep: what its outcome depends on, and the end of a discharge.

use topo_rod::{ContactParameters, EndLoad, FrictionParameters, FrictionRange, Reading};

use super::choices::Cuts;
use super::keys::DASHPOT;
use super::scene::ElasticScene;
use crate::preset::Preset;
use crate::scene::Axis;

/// What a scene beside the sweep is run for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Another choice of friction range or reading: what is slow under each of them is slow for its knot type.
    Choice,
    /// A member of the study of friction.
    Friction,
    /// The last of the energy.
    End,
    /// What the reading of "the point of maximum stress" does to the untwisted knots.
    Breaking,
    /// What a knot does as a motor: work on a load, power and efficiency.
    Work,
}

/// A scene beside the sweep; its tables lie in a folder of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// What is chosen differently, in words.
    pub name: String,
    /// What it is run for.
    pub purpose: Purpose,
    /// What is run.
    pub scene: ElasticScene,
}

/// Stiffnesses k_c of the study beside the default of 20.
const STIFFNESSES: [f64; 2] = [5.0, 100.0];
/// Friction ranges of the study over the contact diameter; 1 is a [`Purpose::Choice`] already.
const RANGES: [f64; 3] = [1.1, 1.2, 1.3];
/// η_f/η of the study beside the default of 0.1.
const RATIOS: [f64; 2] = [0.0, 1.0];
/// Share of the energy after which the last mode is alone: modes next to it decay at least four times as fast.
const LAST_SHARE: f64 = 0.99999;

/// Where a discharge against a load ends: the last hundredth of the energy would take most of the time.
const WORKED_SHARE: f64 = 0.99;
/// And when, in T_0: the stiffest dashpots of the study take thousands.
const LONGEST_WORK: f64 = 1e5;
/// Tolerance of work, in h, or that of the preset if it is finer: at 1e-4 every energy account closes to 1e-3.
const WORK_TOLERANCE: f64 = 1e-4;
/// Its output times per decade: only sums over the discharge are drawn.
const WORK_OUTPUTS: f64 = 4.0;
/// Edges of a rod that works, in a draft.
const DRAFT_WORK_EDGES: usize = 100;

/// Twists θ'h at which knots work on a load, and the resistances c of its dashpot, in η/h.
fn work_of(preset: Preset) -> (&'static [f64], &'static [f64]) {
    match preset {
        Preset::Draft => (&[0.0, 2.0], &[0.1, 1.0, 30.0]),
        _ => (
            &[-2.0, -1.0, 0.0, 1.0, 2.0],
            &[0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0],
        ),
    }
}

impl ElasticScene {
    /// The scenes run beside this sweep: the untwisted knots under four other choices, and cut where each criterion has its largest;
    /// all knots at five twists followed to 99.999 %, and at two or five against loads; and beyond draft the untwisted knots, cut once,
    /// in a study of friction.
    pub fn variants(&self) -> Vec<Variant> {
        let mut variants = vec![Variant {
            name: "friction range of the contact diameter".to_owned(),
            purpose: Purpose::Choice,
            scene: self.with_friction("elastic-contact-range", |_, friction| {
                friction.range = FrictionRange::Contact;
            }),
        }];
        for reading in [Reading::Tight, Reading::Hard, Reading::OwnLength] {
            let mut scene = self.untwisted(&format!("elastic-{}", reading.name()));
            scene.rod.reading = reading;
            variants.push(Variant {
                name: format!("reading “{}”", reading.name()),
                purpose: Purpose::Choice,
                scene,
            });
        }
        variants.push(self.last());
        variants.push(self.breaking());
        variants.push(self.work());
        if self.preset != Preset::Draft {
            variants.extend(self.friction_study());
        }
        variants
    }

    /// One friction parameter at a time; where friction acts in the overlap only, the stiffness sets it, so that both extremes are
    /// run there too.
    fn friction_study(&self) -> Vec<Variant> {
        let mut variants = Vec::new();
        let mut add =
            |name: String,
             folder: &str,
             change: &dyn Fn(&mut ContactParameters, &mut FrictionParameters)| {
                let mut scene = self.with_friction(&format!("elastic-friction-{folder}"), change);
                scene.cuts = Cuts::default();
                variants.push(Variant {
                    name,
                    purpose: Purpose::Friction,
                    scene,
                });
            };
        for k in STIFFNESSES {
            add(
                format!("stiffness {k}"),
                &format!("stiffness-{k}"),
                &|contact, _| contact.stiffness = k,
            );
        }
        for r in RANGES {
            add(
                format!("range {r} d_c"),
                &format!("range-{r}"),
                &|_, friction| friction.range = FrictionRange::TimesContact(r),
            );
        }
        for ratio in RATIOS {
            add(
                format!("η_f/η = {ratio}"),
                &format!("ratio-{ratio}"),
                &|_, friction| friction.ratio = ratio,
            );
        }
        for k in STIFFNESSES {
            add(
                format!("range d_c, stiffness {k}"),
                &format!("range-1-stiffness-{k}"),
                &|contact, friction| {
                    contact.stiffness = k;
                    friction.range = FrictionRange::Contact;
                },
            );
        }
        variants
    }

    /// Discharges followed until one mode is left.
    fn last(&self) -> Variant {
        let mut scene = Self {
            folder: "elastic-last".to_owned(),
            twists: vec![-2.0, -1.0, 0.0, 1.0, 2.0],
            cuts: Cuts::default(),
            ..self.clone()
        };
        scene.discharge.until_released = LAST_SHARE;
        // types are found by the sweep
        scene.timeline.closures = 0;
        Variant {
            name: "followed to 99.999 %".to_owned(),
            purpose: Purpose::End,
            scene,
        }
    }

    /// Untwisted knots cut at the near ties of the energy density and at the largest of each other criterion, and followed no further than their t99.
    fn breaking(&self) -> Variant {
        let mut scene = self.untwisted("elastic-breaking");
        scene.cuts = Cuts::Criteria;
        scene.discharge.until_released = 0.99;
        scene.timeline.closures = 0;
        Variant {
            name: "cut where each criterion is largest".to_owned(),
            purpose: Purpose::Breaking,
            scene,
        }
    }

    /// All knots, cut once, whose tips move against dashpots.
    fn work(&self) -> Variant {
        let (twists, dashpots) = work_of(self.preset);
        let mut scene = Self {
            folder: "elastic-work".to_owned(),
            twists: twists.to_vec(),
            cuts: Cuts::default(),
            load: Some(EndLoad {
                dashpot: dashpots[0],
                ..EndLoad::default()
            }),
            axes: vec![Axis::of_numbers(DASHPOT, dashpots)],
            ..self.clone()
        };
        scene.discharge.until_released = WORKED_SHARE;
        scene.discharge.longest = LONGEST_WORK;
        scene.discharge.outputs_per_decade = WORK_OUTPUTS;
        scene.timeline.closures = 0;
        scene.accuracy.tolerance = scene.accuracy.tolerance.min(WORK_TOLERANCE);
        if self.preset == Preset::Draft {
            scene.rod.n_edges = DRAFT_WORK_EDGES;
        }
        Variant {
            name: "work on a dashpot between the tips".to_owned(),
            purpose: Purpose::Work,
            scene,
        }
    }

    fn untwisted(&self, folder: &str) -> Self {
        Self {
            folder: folder.to_owned(),
            twists: vec![0.0],
            ..self.clone()
        }
    }

    fn with_friction(
        &self,
        folder: &str,
        change: impl Fn(&mut ContactParameters, &mut FrictionParameters),
    ) -> Self {
        let mut scene = self.untwisted(folder);
        if let (Some(contact), Some(friction)) = (&mut scene.rod.contact, &mut scene.rod.friction) {
            change(contact, friction);
        }
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(preset: Preset, purpose: Purpose) -> Vec<ElasticScene> {
        let all = ElasticScene::published(preset).variants();
        let wanted = all.into_iter().filter(|v| v.purpose == purpose);
        wanted.map(|v| v.scene).collect()
    }

    #[test]
    fn the_other_choices_are_run_at_every_preset() {
        for preset in [Preset::Draft, Preset::Standard, Preset::Paper] {
            let choices = of(preset, Purpose::Choice);
            assert!(choices.iter().all(|v| v.twists == [0.0]));
            let tubes = choices.iter().map(|v| v.rod.tube(60.0).unwrap());
            let tubes: Vec<_> = tubes
                .map(|t| (t.length, t.contact_diameter, t.friction_range))
                .collect();
            let d = 2.0 * 50.0 / 60.0;
            assert_eq!(
                tubes,
                [
                    (50.0, d, d),
                    (50.0, d, d),
                    (50.0, 2.0, 2.0),
                    (60.0, 2.0, 2.0)
                ]
            );
        }
    }

    #[test]
    fn the_study_of_friction_changes_what_it_says_and_nothing_else() {
        assert!(of(Preset::Draft, Purpose::Friction).is_empty());
        let study = of(Preset::Standard, Purpose::Friction);
        let seen: Vec<(f64, f64, f64)> = study
            .iter()
            .map(|v| {
                let tube = v.rod.tube(60.0).unwrap();
                let (contact, friction) = (v.rod.contact.unwrap(), v.rod.friction.unwrap());
                let range = tube.friction_range / tube.contact_diameter;
                (
                    contact.stiffness,
                    (1e6 * range).round() / 1e6,
                    friction.ratio,
                )
            })
            .collect();
        // 2h over the contact diameter of a knot of ropelength 60 is 1.2
        assert_eq!(
            seen,
            [
                (5.0, 1.2, 0.1),
                (100.0, 1.2, 0.1),
                (20.0, 1.1, 0.1),
                (20.0, 1.2, 0.1),
                (20.0, 1.3, 0.1),
                (20.0, 1.2, 0.0),
                (20.0, 1.2, 1.0),
                (5.0, 1.0, 0.1),
                (100.0, 1.0, 0.1),
            ]
        );
        let published = ElasticScene::published(Preset::Standard);
        for scene in &study {
            assert_eq!(scene.cuts, Cuts::default());
            assert_eq!(scene.twists, [0.0]);
            let mut rod = scene.rod.clone();
            (rod.contact, rod.friction) = (published.rod.contact, published.rod.friction);
            assert_eq!(rod, published.rod);
        }
    }

    #[test]
    fn every_criterion_is_tried_on_the_untwisted_knots() {
        for preset in [Preset::Draft, Preset::Standard, Preset::Paper] {
            let breaking = of(preset, Purpose::Breaking);
            assert_eq!(breaking.len(), 1);
            assert_eq!(breaking[0].cuts, Cuts::Criteria);
            assert_eq!(breaking[0].twists, [0.0]);
            assert_eq!(breaking[0].rod, ElasticScene::published(preset).rod);
        }
    }

    #[test]
    fn every_knot_works_on_every_load() {
        let table = topo_knots::KnotTable::builtin();
        for (preset, n_twists, n_loads) in [(Preset::Draft, 2, 3), (Preset::Standard, 5, 10)] {
            let work = of(preset, Purpose::Work);
            assert_eq!(work.len(), 1);
            let cases = work[0].cases(&table).unwrap();
            assert_eq!(cases.len(), 14 * n_twists * n_loads);
            // the loads of a state run fastest, each a case of its own name
            let dashpots: Vec<f64> = cases.iter().map(|c| c.load.unwrap().dashpot).collect();
            let (first, rest) = dashpots.split_at(n_loads);
            assert!(first.windows(2).all(|pair| pair[0] < pair[1]));
            assert!(rest.chunks(n_loads).all(|again| again == first));
            let mut names: Vec<_> = cases.iter().map(|c| work[0].case_name(c)).collect();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), cases.len());
            // but for the edges of a draft the fibre is that of the sweep
            let mut rod = work[0].rod.clone();
            let published = ElasticScene::published(preset).rod;
            rod.n_edges = published.n_edges;
            assert_eq!(rod, published);
        }
    }

    #[test]
    fn the_end_of_the_discharge_is_followed_at_five_twists_and_folders_differ() {
        let last = of(Preset::Draft, Purpose::End);
        assert_eq!(last.len(), 1);
        assert_eq!(last[0].twists, [-2.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!(last[0].discharge.until_released, 0.99999);
        let all = ElasticScene::published(Preset::Paper).variants();
        let mut folders: Vec<_> = all.iter().map(|v| &v.scene.folder).collect();
        folders.sort();
        folders.dedup();
        assert_eq!(folders.len(), all.len());
        assert!(folders.iter().all(|f| f.as_str() != "elastic"));
    }
}
