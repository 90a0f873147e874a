//! A phase that was stopped and goes on ends with the same bits, and needs all that it remembers for that.

use std::mem::swap;
use std::path::Path;

use tempfile::TempDir;
use topo_core::{Interrupt, Model, load_checkpoint, save_checkpoint};

use super::*;
use crate::battery::tests::{hopf_link, trefoil};
use crate::model::PARTS;
use crate::{
    Accuracy, ChargeSettings, ContactParameters, CutSite, DischargeSettings, EndLoad, EndMotion,
    Ends, FrictionParameters, Grip, Guards, IntegratorKind, PullSettings, Ramp, RodEnds,
    RodParameters, TimeCourse, Twisting,
};

/// A rod and what is done with it.
#[derive(Clone)]
struct Setup {
    rod: RodParameters,
    accuracy: Accuracy,
    discharge: DischargeSettings,
    is_link: bool,
    twisting: Option<Twisting>,
}

fn setup(integrator: IntegratorKind, twist: Option<f64>, rubs: bool) -> Setup {
    Setup {
        rod: RodParameters {
            n_edges: 40,
            twist,
            contact: Some(ContactParameters::default()),
            friction: rubs.then(FrictionParameters::default),
            ..RodParameters::default()
        },
        accuracy: Accuracy {
            integrator,
            tolerance: 2e-2,
            ..Accuracy::default()
        },
        discharge: DischargeSettings {
            longest: 3.0,
            ..DischargeSettings::default()
        },
        is_link: false,
        twisting: None,
    }
}

/// Two rings of different length, linked so tightly that they press on each other, and the second of them cut.
fn linked(integrator: IntegratorKind, rubs: bool) -> Setup {
    let mut setup = setup(integrator, Some(2.0), rubs);
    setup.rod.slenderness = 26.0;
    setup.rod.n_edges = 51;
    setup.discharge.longest = 1.0;
    setup.is_link = true;
    setup
}

impl Setup {
    fn battery(&self) -> RodBattery {
        let guards = Guards::default();
        if self.is_link {
            let rods = hopf_link();
            let battery = RodBattery::link(&self.rod, &self.accuracy, guards, &rods).unwrap();
            // curved at rest where friction is left out
            return match self.rod.friction {
                Some(_) => battery,
                None => battery
                    .with_rest(|_, s| [0.1, 0.05 * s.sin()], |c, _| 0.1 * c as f64)
                    .unwrap(),
            };
        }
        RodBattery::new(&self.rod, &self.accuracy, guards, &trefoil(1.0)).unwrap()
    }

    /// Charges and discharges, until stopped; of each phase what it remembered last is kept in `folder`, and its report is returned.
    fn run(&self, folder: &Path, stop: Option<(Phase, u64)>) -> Result<Vec<String>, RodError> {
        self.run_with(folder, stop, 1e9)
    }

    fn run_with(
        &self,
        folder: &Path,
        stop: Option<(Phase, u64)>,
        interval: f64,
    ) -> Result<Vec<String>, RodError> {
        let interrupt = Interrupt::new();
        let mut stopping = |p: &Progress| {
            if stop == Some((p.phase, p.step)) {
                interrupt.request();
            }
        };
        let mut hooks = RunHooks::new(&interrupt)
            .with_progress(&mut stopping)
            .with_checkpoint(&folder.join("charge"), interval);
        let charge = ChargeSettings {
            duration: 0.5,
            twisting: self.twisting.clone(),
            ..ChargeSettings::default()
        };
        let charged = self.battery().charge(&charge, &mut hooks)?;
        let mut reports = vec![serde_json::to_string(&charged.record().report).unwrap()];
        if !hooks.is_interrupted() {
            hooks.keep_in(&folder.join("discharge"));
            let component = usize::from(self.is_link);
            let cut = charged.cut(CutSite::On { component, at: 0.3 })?;
            let run = cut.discharge(&self.discharge, &mut hooks)?;
            reports.push(serde_json::to_string(&run.record.report).unwrap());
        }
        // what was finished is in memory until something is written
        hooks.keep_in(&folder.join("last"));
        hooks.save("last/1", "", &())?;
        Ok(reports)
    }
}

/// The checkpoint in `folder`, without the time that it took.
fn kept(folder: &Path, phase: &str) -> (String, Saved) {
    let mut kept: (String, Saved) = load_checkpoint(&folder.join(phase), SCHEMA).unwrap();
    kept.1.4.cpu_seconds = 0.0;
    kept
}

fn bytes(kept: &(String, Saved)) -> Vec<u8> {
    topo_core::checkpoint_bytes(Path::new("kept"), SCHEMA, kept).unwrap()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// When the tips of the undisturbed discharge parted: at which of its steps.
fn parting(folder: &Path) -> u64 {
    let (_, saved) = kept(folder, "discharge");
    let parted = saved.4.parted.expect("the tips part");
    let scale = topo_core::reference_time(saved.1.length());
    let steps = saved.3.curve.time().iter();
    steps
        .filter(|t| **t * scale <= parted * (1.0 + 1e-12))
        .count() as u64
        - 1
}

/// Both integrators, with and without friction and twist; stopped in the charge, and in the discharge before, at and after the parting
/// of the tips.
#[test]
fn law_resumed_rods_end_with_the_same_bits() {
    use IntegratorKind::{Rkc2, Ros2w, Ros34pw2};
    for (integrator, twist, rubs) in [
        (Ros34pw2, Some(2.0), true),
        (Ros2w, None, false),
        (Ros34pw2, Some(-1.0), false),
        (Rkc2, Some(2.0), true),
        (Rkc2, None, false),
    ] {
        let setup = setup(integrator, twist, rubs);
        let undisturbed = folder();
        let reports = setup.run(undisturbed.path(), None).unwrap();
        let parted = parting(undisturbed.path());
        let stopped = folder();
        let stops = [
            (Phase::Charge, 1),
            (Phase::Charge, 12),
            (Phase::Discharge, 1),
            (Phase::Discharge, parted / 2),
            (Phase::Discharge, parted - 1),
            (Phase::Discharge, parted),
            (Phase::Discharge, parted + 1),
            (Phase::Discharge, parted + 9),
        ];
        for stop in stops {
            setup.run(stopped.path(), Some(stop)).unwrap();
        }
        let what = format!("{integrator:?} {twist:?} {rubs}");
        assert_eq!(setup.run(stopped.path(), None).unwrap(), reports, "{what}");
        for phase in ["charge", "discharge"] {
            let [a, b] = [&undisturbed, &stopped].map(|f| bytes(&kept(f.path(), phase)));
            assert!(
                a == b,
                "{what}: the {phase} remembers something else at its end"
            );
        }
    }
}

/// A rod twisted in time, which then works on a load: stopped before, while and after it is twisted, and in its discharge. Turned at a
/// constant rate and by a torque; a link, with a natural shape, by a torque too.
#[test]
fn law_resumed_work_ends_with_the_same_bits() {
    use IntegratorKind::{Rkc2, Ros34pw2};
    let ramp = || {
        Some(TimeCourse::Ramp(Ramp {
            to: 1.0,
            over: 0.25,
        }))
    };
    for (mut setup, torque) in [
        (setup(Ros34pw2, Some(1.0), true), None),
        (setup(Rkc2, Some(1.0), true), None),
        (setup(Ros34pw2, Some(1.0), true), ramp()),
        (setup(Rkc2, Some(1.0), true), ramp()),
        (linked(Ros34pw2, false), ramp()),
    ] {
        let what = format!("{:?} {torque:?}", setup.accuracy.integrator);
        setup.twisting = Some(Twisting { over: 0.5, torque });
        setup.discharge.longest = 1.0;
        setup.discharge.load = Some(EndLoad {
            spring: 1e-3,
            dashpot: 0.02,
            ..EndLoad::default()
        });
        let undisturbed = folder();
        let reports = setup.run(undisturbed.path(), None).unwrap();
        let (_, charge) = kept(undisturbed.path(), "charge");
        let scale = topo_core::reference_time(charge.1.length());
        let begun = |t: f64| charge.3.curve.time().iter().filter(|s| **s < t).count() as u64;
        assert!(charge.4.tied.is_some() && scale > 0.0);
        let [begins, ends] = [begun(0.5 - 1e-9), begun(1.0 - 1e-9)];
        let corner = begun(0.75 - 1e-9);
        let charge = [
            1,
            begins - 1,
            begins,
            begins + 1,
            begins + 5,
            corner,
            corner + 1,
            ends - 1,
            ends,
            ends + 1,
            ends + 4,
        ];
        let stopped = folder();
        let stops = charge.map(|step| (Phase::Charge, step));
        let discharge = [1, 7, 20].map(|step| (Phase::Discharge, step));
        for stop in stops.into_iter().chain(discharge) {
            setup.run(stopped.path(), Some(stop)).unwrap();
        }
        assert_eq!(setup.run(stopped.path(), None).unwrap(), reports, "{what}");
        assert!(reports[1].contains("peak_power"));
    }
}

/// An open rod that is pulled, turned and let go at one end: stopped before, at and after each corner of its courses.
#[test]
fn law_resumed_pulls_end_with_the_same_bits() {
    let setup = setup(IntegratorKind::Ros34pw2, Some(0.0), true);
    let arc = (0..=40).map(|k| {
        let s = 0.1 * f64::from(k);
        topo_core::Vector3::new(s.cos(), s.sin(), 0.1 * s)
    });
    let arc = topo_core::Polyline::new(arc.collect(), false).unwrap();
    let battery = RodBattery::open(&setup.rod, &setup.accuracy, Guards::default(), &arc).unwrap();
    let none = TimeCourse::default;
    let drawn = Grip {
        condition: crate::EndCondition::Clamped,
        displacement: [
            TimeCourse::Table(vec![[0.0, 0.0], [0.1, 1.0], [0.2, 1.0]]),
            none(),
            none(),
        ],
        rotation: TimeCourse::Ramp(Ramp {
            to: 1.0,
            over: 0.15,
        }),
        released: Some(0.3),
        ..Grip::default()
    };
    let held = Grip {
        condition: crate::EndCondition::Clamped,
        ..Grip::default()
    };
    let settings = PullSettings {
        grips: [held, drawn],
        duration: 0.4,
        outputs: 10,
    };
    let run = |folder: &Path, stop: Option<u64>| {
        let interrupt = Interrupt::new();
        let mut stopping = |p: &Progress| {
            if stop == Some(p.step) {
                interrupt.request();
            }
        };
        let mut hooks = RunHooks::new(&interrupt)
            .with_progress(&mut stopping)
            .with_checkpoint(&folder.join("pull"), 1e9);
        let pulled = battery.pull(&settings, &mut hooks).unwrap();
        let record = pulled.record();
        let samples: Vec<_> = record
            .samples
            .iter()
            .map(|s| (s.time, s.work, s.grips))
            .collect();
        (
            serde_json::to_string(&record.report).unwrap(),
            format!("{samples:?}"),
            record.curve.time().to_vec(),
        )
    };
    let undisturbed = run(folder().path(), None);
    let at = |t: f64| undisturbed.2.iter().filter(|s| **s < t - 1e-9).count() as u64;
    let stopped = folder();
    for corner in [0.1, 0.15, 0.2, 0.3].map(at) {
        for step in [corner - 1, corner, corner + 1] {
            run(stopped.path(), Some(step));
        }
    }
    let resumed = run(stopped.path(), None);
    assert_eq!((resumed.0, resumed.1), (undisturbed.0, undisturbed.1));
}

/// A link stopped in its charge and in its discharge, with friction, and curved and twisted at rest.
#[test]
fn law_resumed_links_end_with_the_same_bits() {
    for (integrator, rubs) in [
        (IntegratorKind::Ros34pw2, true),
        (IntegratorKind::Ros2w, false),
    ] {
        let setup = linked(integrator, rubs);
        let undisturbed = folder();
        let reports = setup.run(undisturbed.path(), None).unwrap();
        let stopped = folder();
        for stop in [
            (Phase::Charge, 1),
            (Phase::Charge, 12),
            (Phase::Discharge, 1),
            (Phase::Discharge, 9),
            (Phase::Discharge, 30),
        ] {
            setup.run(stopped.path(), Some(stop)).unwrap();
        }
        assert_eq!(setup.run(stopped.path(), None).unwrap(), reports, "{rubs}");
        assert!(reports.iter().all(|r| r.contains("component_bytes")));
        for phase in ["charge", "discharge"] {
            let [a, b] = [&undisturbed, &stopped].map(|f| bytes(&kept(f.path(), phase)));
            assert!(a == b, "the {phase} of a link remembers something else");
        }
    }
}

/// Writing checkpoints at every step, and keeping none, leads to the same run.
#[test]
fn checkpoints_do_not_change_a_run() {
    let setup = setup(IntegratorKind::Ros34pw2, Some(2.0), true);
    let often = folder();
    let reports = setup.run_with(often.path(), None, 0.0).unwrap();
    let charge = ChargeSettings {
        duration: 0.5,
        ..ChargeSettings::default()
    };
    let none = &mut RunHooks::default();
    let charged = setup.battery().charge(&charge, none).unwrap();
    let cut = charged.cut(CutSite::At(0.3)).unwrap();
    let run = cut.discharge(&setup.discharge, none).unwrap();
    let records = [&charged.record().report, &run.record.report];
    assert_eq!(
        records.map(|r| serde_json::to_string(r).unwrap()),
        reports[..]
    );
}

/// A rod pulled and twisted at its end, so that guards, work and held vertices are in it.
fn driven() -> Setup {
    let mut setup = setup(IntegratorKind::Ros34pw2, Some(2.0), true);
    let pulled = EndMotion {
        velocity: [0.02, 0.01, 0.0],
        rotation_rate: 0.02,
        ..EndMotion::default()
    };
    setup.discharge.ends = Ends {
        conditions: [crate::EndCondition::Clamped; 2],
        motions: [EndMotion::default(), pulled],
    };
    setup.discharge.longest = 0.5;
    setup
}

/// A discharge that was stopped at its first step, and at one of its early steps; of the latter how it went on.
struct Stopped {
    setup: Setup,
    at: u64,
    charge: TempDir,
    fresh: (String, Saved),
    saved: (String, Saved),
    later: Vec<u8>,
}

/// Steps after which memories are compared.
const STEPS: u64 = 3;

impl Stopped {
    /// Stopped at the first step that is `wanted`, by its memory and that of the next one.
    fn of(setup: Setup, wanted: fn(&ModelMemory, &ModelMemory) -> bool) -> Self {
        let place = folder();
        let stop = |at: u64| {
            let reports = setup.run(place.path(), Some((Phase::Discharge, at)));
            reports.map(|_| kept(place.path(), "discharge")).unwrap()
        };
        let fresh = stop(1);
        let mut now = stop(8);
        let (at, saved) = (8..200)
            .find_map(|at| {
                let before = std::mem::replace(&mut now, stop(at + 1));
                wanted(&before.1.2, &now.1.2).then_some((at, before))
            })
            .expect("such a step");
        // in one go, from the beginning
        std::fs::remove_file(place.path().join("discharge")).unwrap();
        let later = bytes(&stop(at + STEPS));
        Self {
            setup,
            at,
            charge: place,
            fresh,
            saved,
            later,
        }
    }

    /// Whether what was stopped, its memory changed by `change`, remembers the same some steps later as what was not.
    fn goes_on_alike(&self, change: &dyn Fn(&mut Saved, &mut Saved)) -> bool {
        let changed = folder();
        let charge = changed.path().join("charge");
        std::fs::copy(self.charge.path().join("charge"), charge).unwrap();
        let ((case, mut saved), mut fresh) = (self.saved.clone(), self.fresh.1.clone());
        change(&mut saved, &mut fresh);
        save_checkpoint(&changed.path().join("discharge"), SCHEMA, &(case, saved)).unwrap();
        let stop = Some((Phase::Discharge, self.at + STEPS));
        // a memory in which something is missing may be refused
        let run = self.setup.run(changed.path(), stop);
        run.is_ok() && bytes(&kept(changed.path(), "discharge")) == self.later
    }
}

/// Each part of the memory, taken from the beginning of the discharge instead, is missed after a refused step, amid the use of one
/// matrix, or by the explicit integrator: the run goes on otherwise.
#[test]
fn every_part_of_the_memory_is_needed() {
    let explicit = setup(IntegratorKind::Rkc2, Some(2.0), true);
    let stopped = [
        Stopped::of(driven(), |now, _| now.is_wary()),
        Stopped::of(driven(), ModelMemory::is_reusing),
        Stopped::of(explicit, |_, _| true),
    ];
    for place in &stopped {
        let alike = |change: &dyn Fn(&mut Saved, &mut Saved)| place.goes_on_alike(change);
        assert!(alike(&|_, _| {}), "the whole memory");
        assert!(!alike(&|s, f| swap(&mut s.0, &mut f.0)), "simulation");
        assert!(!alike(&|s, f| swap(&mut s.1, &mut f.1)), "state");
        assert!(!alike(&|s, f| swap(&mut s.2, &mut f.2)), "model");
        assert!(!alike(&|s, f| swap(&mut s.3, &mut f.3)), "seen");
    }
    for (part, name) in PARTS.iter().enumerate() {
        let forget = |s: &mut Saved, f: &mut Saved| s.2.take_part(part, &mut f.2);
        let is_missed = stopped.iter().any(|place| !place.goes_on_alike(&forget));
        assert!(is_missed, "{name} is not missed");
    }
}

#[test]
fn what_does_not_fit_a_phase_is_refused() {
    let setup = setup(IntegratorKind::Ros34pw2, Some(2.0), true);
    let place = folder();
    setup.run(place.path(), Some((Phase::Charge, 9))).unwrap();
    let path = place.path().join("charge");
    let (case, sound): (String, Saved) = load_checkpoint(&path, SCHEMA).unwrap();
    let charge = |case: &str, saved: &Saved| {
        save_checkpoint(&path, SCHEMA, &(case, saved)).unwrap();
        let settings = ChargeSettings {
            duration: 0.5,
            ..ChargeSettings::default()
        };
        let mut hooks = RunHooks::default().with_checkpoint(&path, 1e9);
        let charged = setup.battery().charge(&settings, &mut hooks);
        charged.map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(charge(&case, &sound), Ok(()));
    let foreign = charge("another", &sound).unwrap_err();
    assert!(foreign.contains("belongs to another case"), "{foreign}");
    let model = setup.battery();
    let model = model.model(model.start(), RodEnds::default()).unwrap();
    let n_dof = model.n_dof();
    assert_eq!(n_dof, 160);
    type Flaw = (&'static str, fn(&mut Saved));
    let flaws: [Flaw; 4] = [
        ("rod is another", |s| s.1 = s.1.cut_at(3).unwrap()),
        ("time", |s| s.4.parted = Some(1e9)),
        ("samples", |s| s.3.samples.push(s.3.samples[0].clone())),
        ("time", |s| s.4.cpu_seconds = f64::NAN),
    ];
    for (word, spoil) in flaws {
        let mut saved = sound.clone();
        spoil(&mut saved);
        let refused = charge(&case, &saved).unwrap_err();
        assert!(
            refused.contains(word) && refused.contains("corrupt"),
            "{word}: {refused}"
        );
    }
    for (part, name) in PARTS.iter().enumerate() {
        let mut saved = sound.clone();
        if saved.2.spoil(part) {
            let refused = charge(&case, &saved);
            assert!(refused.is_err_and(|e| e.contains("corrupt")), "{name}");
        }
    }
}
