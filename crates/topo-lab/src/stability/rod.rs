//! Extremes of the rod.

use topo_core::Vector3;
use topo_core::{Interrupt, Polyline, RunHooks};
use topo_rod::{
    Accuracy, ContactParameters, FrictionParameters, Guards, Protocol, RodBattery, RodParameters,
};

use super::cell::{Cell, Verdict};
use super::watch::violations;
use crate::preset::Preset;

/// Drift of the linking number of a closed rod, in turns, that counts as a crossing.
const CROSSING: f64 = 1e-8;

/// Most trial steps of a phase in a draft.
const DRAFT_STEPS: u64 = 10_000;
/// Edges above which a draft follows charge and discharge for a short while only, in T_0.
const LARGE: usize = 200;
const LARGE_DURATION: f64 = 0.02;

/// Energy that is rounding, in E_0.
const NOTHING: f64 = 1e-9;

/// One run.
#[derive(Debug, Clone, Copy)]
struct Case {
    is_eight: bool,
    twist: f64,
    gamma: f64,
    slenderness: f64,
    n_edges: usize,
    friction: f64,
    contact: f64,
    tolerance: f64,
}

const MIDDLE: Case = Case {
    is_eight: false,
    twist: 1.0,
    gamma: 5.0,
    slenderness: 50.0,
    n_edges: 100,
    friction: 0.1,
    contact: 20.0,
    tolerance: 2e-3,
};

impl Case {
    /// Whether it lies where every run must converge.
    fn is_inner(&self) -> bool {
        self.twist.abs() <= 4.0
            && (1.0..=1e3).contains(&self.gamma)
            && (50..=1600).contains(&self.n_edges)
            && self.slenderness == MIDDLE.slenderness
            && self.friction <= 10.0
            && (5.0..=500.0).contains(&self.contact)
            && (1e-4..=1e-2).contains(&self.tolerance)
    }

    fn run(&self, preset: Preset, interrupt: &Interrupt) -> Verdict {
        let parameters = RodParameters {
            slenderness: self.slenderness,
            n_edges: self.n_edges,
            stretch_ratio: self.gamma,
            twist: Some(self.twist),
            contact: Some(ContactParameters {
                stiffness: self.contact,
            }),
            friction: (self.friction > 0.0).then(|| FrictionParameters {
                ratio: self.friction,
                ..Default::default()
            }),
            ..Default::default()
        };
        let mut accuracy = Accuracy {
            tolerance: self.tolerance,
            ..Default::default()
        };
        let mut protocol = Protocol::default();
        if preset == Preset::Draft {
            accuracy.max_steps = DRAFT_STEPS;
            protocol.discharge.until_released = 0.99;
            if self.n_edges > LARGE {
                protocol.charge.duration = LARGE_DURATION;
                protocol.discharge.longest = LARGE_DURATION;
            }
        }
        let curve = if self.is_eight {
            figure_eight()
        } else {
            trefoil()
        };
        let run = || {
            let battery = RodBattery::new(&parameters, &accuracy, Guards::default(), &curve)?;
            let (charged, run) = battery.run(&protocol, &mut RunHooks::new(interrupt))?;
            let record = charged.record();
            let mut found = violations(&record.curve, NOTHING);
            found += u32::from(record.report.own.link_drift.is_some_and(|d| d > CROSSING));
            let Some(run) = run else {
                let reason = format!("charge: {}", record.report.stop);
                return Ok(Verdict::stopped(reason, found));
            };
            found += violations(&run.record.curve, NOTHING);
            let stop = &run.record.report.stop;
            Ok(if stop.is_success() {
                Verdict::converged(found)
            } else {
                Verdict::stopped(format!("discharge: {stop}"), found)
            })
        };
        run().unwrap_or_else(|refused: topo_rod::RodError| {
            Verdict::stopped(format!("refused: {refused}"), 0)
        })
    }
}

/// Cases over a plane of two settings.
struct Map {
    axes: [&'static str; 2],
    xs: &'static [f64],
    ys: &'static [f64],
    case: fn(f64, f64) -> Case,
}

const TWISTS: [f64; 9] = [-20.0, -10.0, -4.0, -2.0, 0.0, 2.0, 4.0, 10.0, 20.0];
const GAMMAS: [f64; 6] = [0.1, 1.0, 10.0, 100.0, 1e3, 1e4];
const STIFFNESSES: [f64; 6] = [1.0, 5.0, 20.0, 100.0, 1e3, 1e4];

const MAPS: [Map; 8] = [
    Map {
        axes: ["twist", "gamma"],
        xs: &TWISTS,
        ys: &GAMMAS,
        case: |x, y| Case {
            twist: x,
            gamma: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["twist of a figure-eight knot", "gamma"],
        xs: &TWISTS,
        ys: &GAMMAS,
        case: |x, y| Case {
            is_eight: true,
            twist: x,
            gamma: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["edges", "twist"],
        xs: &[16.0, 50.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 4000.0],
        ys: &[-4.0, -1.0, 0.0, 1.0, 4.0],
        case: |x, y| Case {
            n_edges: x as usize,
            twist: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["slenderness", "friction"],
        xs: &[10.0, 20.0, 33.0, 50.0, 100.0, 300.0, 1000.0],
        ys: &[0.0, 0.1, 1.0, 10.0, 100.0],
        case: |x, y| Case {
            slenderness: x,
            friction: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["contact stiffness", "tolerance"],
        xs: &STIFFNESSES,
        ys: &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7],
        case: |x, y| Case {
            contact: x,
            tolerance: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["friction", "twist"],
        xs: &[0.0, 0.1, 1.0, 10.0, 100.0],
        ys: &[-20.0, -4.0, -1.0, 0.0, 1.0, 4.0, 20.0],
        case: |x, y| Case {
            friction: x,
            twist: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["contact stiffness", "gamma"],
        xs: &STIFFNESSES,
        ys: &GAMMAS,
        case: |x, y| Case {
            contact: x,
            gamma: y,
            ..MIDDLE
        },
    },
    Map {
        axes: ["edges", "gamma"],
        xs: &[16.0, 50.0, 100.0, 400.0],
        ys: &GAMMAS,
        case: |x, y| Case {
            n_edges: x as usize,
            gamma: y,
            twist: 4.0,
            ..MIDDLE
        },
    },
];

/// All runs.
pub(super) fn cells(preset: Preset) -> Vec<Cell> {
    let mut cells = Vec::new();
    for map in &MAPS {
        for &y in map.ys {
            for &x in map.xs {
                let case = (map.case)(x, y);
                cells.push(Cell {
                    axes: map.axes,
                    at: [x.to_string(), y.to_string()],
                    is_inner: case.is_inner(),
                    run: Box::new(move |interrupt| case.run(preset, interrupt)),
                });
            }
        }
    }
    cells
}

/// A curve over one turn of its parameter.
fn closed(point: impl Fn(f64) -> [f64; 3]) -> Polyline {
    let n = 400;
    let at = |k: usize| Vector3::from(point(std::f64::consts::TAU * k as f64 / n as f64));
    // A smooth curve without double points makes a sound polygon.
    Polyline::new((0..n).map(at).collect(), true).unwrap_or_else(|e| panic!("{e}"))
}

/// A trefoil, not tight.
pub(crate) fn trefoil() -> Polyline {
    closed(trefoil_at)
}

/// A right-handed trefoil over one turn of its parameter.
pub(super) fn trefoil_at(u: f64) -> [f64; 3] {
    let r = 2.0 + (3.0 * u).cos();
    [
        r * (2.0 * u).cos(),
        r * (2.0 * u).sin(),
        -1.2 * (3.0 * u).sin(),
    ]
}

fn figure_eight() -> Polyline {
    closed(|u| {
        let r = 2.0 + (2.0 * u).cos();
        [
            r * (3.0 * u).cos(),
            r * (3.0 * u).sin(),
            1.2 * (4.0 * u).sin(),
        ]
    })
}
