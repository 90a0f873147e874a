//! Extremes of the nematic.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use topo_core::Interrupt;
use topo_nematic::tensor::uniaxial;
use topo_nematic::{
    Anchoring, ChargeSettings, ChargedNematic, DischargeSettings, FlowParameters, Material,
    NematicAccuracy, NematicBattery, NematicError, NematicParameters, NematicState, RunHooks,
    SurfacePattern, SwitchSettings, SwitchTarget,
};

use super::cell::{Cell, Verdict};
use super::watch::violations;
use crate::preset::Preset;

/// Energy that is rounding, in L xi_N: that of a small distortion is hundreds.
const NOTHING: f64 = 1e-6;

/// What starts a run, besides the tilted uniform field.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Start {
    Uniform,
    /// Random directors of the given order over the equilibrium one.
    Random {
        seed: u64,
        order: f64,
    },
}

/// What follows the charge.
#[derive(Debug, Clone, PartialEq)]
enum Release {
    /// The surface is set free.
    Free,
    /// Other patterns take turns, each for a while of so many R²/(Gamma L), then the surface is set free.
    Turns { n: usize, each: f64 },
    /// Ramped over a time in tau_N.
    Ramp(f64, SwitchTarget),
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
struct Case {
    q: i32,
    radius: f64,
    spacing: f64,
    /// Edge of the cell over the radius, along x and y.
    edge: f64,
    anchoring: Anchoring,
    material: Material,
    has_flow: bool,
    tolerance: f64,
    start: Start,
    release: Release,
    is_inner: bool,
}

fn middle() -> Case {
    Case {
        q: 2,
        radius: 7.0,
        spacing: 1.5,
        edge: 40.0 / 7.0,
        anchoring: Anchoring::Strong,
        material: Material::default(),
        has_flow: false,
        tolerance: 3e-5,
        start: Start::Uniform,
        release: Release::Free,
        is_inner: true,
    }
}

impl Case {
    fn run(&self, preset: Preset, interrupt: &Interrupt) -> Verdict {
        self.try_run(preset, interrupt)
            .unwrap_or_else(|refused| Verdict::stopped(format!("refused: {refused}"), 0))
    }

    fn battery(&self, preset: Preset) -> Result<NematicBattery, NematicError> {
        let parameters = NematicParameters {
            radius: self.radius,
            spacing: self.spacing,
            cell: [self.edge, self.edge, 0.75 * self.edge],
            pattern: SurfacePattern::Winding(self.q),
            anchoring: self.anchoring,
            material: self.material,
            ..NematicParameters::default()
        };
        let accuracy = NematicAccuracy {
            tolerance: self.tolerance,
            max_steps: max_steps(preset),
            memory_limit: Some(2 << 30),
            ..NematicAccuracy::default()
        };
        NematicBattery::new(&parameters, &accuracy)
    }

    fn charge(
        &self,
        battery: &NematicBattery,
        preset: Preset,
        interrupt: &Interrupt,
    ) -> Result<ChargedNematic, NematicError> {
        let settings = ChargeSettings {
            tolerance: if preset == Preset::Draft { 1e-6 } else { 1e-8 },
            max_steps: max_steps(preset),
            ..ChargeSettings::default()
        };
        let mut hooks = RunHooks::new(interrupt);
        match self.start {
            Start::Uniform => battery.charge(&settings, &mut hooks),
            Start::Random { seed, order } => {
                let start = random(battery, seed, order * self.material.order())?;
                battery.charge_from(&start, &settings, &mut hooks)
            }
        }
    }

    fn try_run(&self, preset: Preset, interrupt: &Interrupt) -> Result<Verdict, NematicError> {
        let battery = self.battery(preset)?;
        let mut charged = self.charge(&battery, preset, interrupt)?;
        let report = charged.report();
        let mut found = broken(charged.state());
        if !report.is_converged() {
            let reason = format!("charge: {}, rms H {:.0e}", report.stop, report.rms_field);
            return Ok(Verdict::stopped(reason, found));
        }
        let mut switch = SwitchSettings::default();
        match &self.release {
            Release::Free => {}
            Release::Ramp(ramp, to) => {
                switch.ramp = Some(*ramp);
                switch.to = to.clone();
            }
            Release::Turns { n, each } => {
                for turn in 0..*n {
                    let (next, stop, wrong) =
                        self.turn(&battery, &charged, turn, *each, interrupt)?;
                    found += wrong;
                    if let Some(stop) = stop {
                        return Ok(Verdict::stopped(stop, found));
                    }
                    charged = next;
                }
            }
        }
        let discharge = DischargeSettings {
            until_released: if preset == Preset::Draft {
                0.99
            } else {
                0.9995
            },
            flow: self.has_flow.then(FlowParameters::default),
            ..DischargeSettings::default()
        };
        let run = charged
            .switch(&switch)?
            .discharge(&discharge, &mut RunHooks::new(interrupt))?;
        found += broken(&run.state);
        let report = &run.record.report;
        // A ramp does work: there the books must close instead.
        found += match self.release {
            Release::Ramp(..) => u32::from(report.ledger_residual > 0.02),
            _ => violations(&run.record.curve, NOTHING),
        };
        Ok(if report.stop.is_success() {
            Verdict::converged(found)
        } else {
            Verdict::stopped(format!("discharge: {}", report.stop), found)
        })
    }

    /// The pattern changes at once and the nematic follows for a while.
    fn turn(
        &self,
        battery: &NematicBattery,
        charged: &ChargedNematic,
        turn: usize,
        each: f64,
        interrupt: &Interrupt,
    ) -> Result<(ChargedNematic, Option<String>, u32), NematicError> {
        let pattern = if turn.is_multiple_of(2) {
            SurfacePattern::Homeotropic
        } else {
            SurfacePattern::Winding(self.q)
        };
        let settings = SwitchSettings {
            to: SwitchTarget::Pattern {
                pattern: pattern.clone(),
                anchoring: self.anchoring,
            },
            ramp: None,
        };
        let discharge = DischargeSettings {
            until_released: 1.0 - 1e-9,
            longest: each,
            ..DischargeSettings::default()
        };
        let run = charged
            .switch(&settings)?
            .discharge(&discharge, &mut RunHooks::new(interrupt))?;
        let found = violations(&run.record.curve, NOTHING) + broken(&run.state);
        let stop = &run.record.report.stop;
        let stop = (!stop.is_success()).then(|| format!("turn {turn}: {stop}"));
        let next = NematicParameters {
            pattern,
            ..battery.parameters().clone()
        };
        let next = NematicBattery::new(&next, battery.accuracy())?.adopt(&run.state)?;
        Ok((next, stop, found))
    }
}

/// Most steps of a charge and of a discharge.
fn max_steps(preset: Preset) -> u64 {
    if preset == Preset::Draft {
        4000
    } else {
        100_000
    }
}

/// 1 if a number of the field is not finite.
fn broken(state: &NematicState) -> u32 {
    u32::from(!state.q_tensor().iter().all(|x| x.is_finite()))
}

/// Random directors in every cell.
fn random(battery: &NematicBattery, seed: u64, order: f64) -> Result<NematicState, NematicError> {
    let rng = std::cell::RefCell::new(Pcg64::seed_from_u64(seed));
    let particle = battery.particle().copied();
    NematicState::from_fn(*battery.grid(), particle, |_| {
        let mut rng = rng.borrow_mut();
        let mut number = || 2.0 * rng.random::<f64>() - 1.0;
        uniaxial(order, [number(), number(), number() + 1e-3])
    })
}

/// A case with the axes of its map and where it lies on them.
type Placed = ([&'static str; 2], [String; 2], Case);

/// All runs.
pub(super) fn cells(preset: Preset) -> Vec<Cell> {
    let maps = [
        windings(),
        surfaces(),
        flows(),
        phases(),
        turns(),
        ramps(),
        random_starts(),
    ];
    maps.into_iter()
        .flatten()
        .map(|(axes, at, case)| Cell {
            axes,
            at,
            is_inner: case.is_inner,
            run: Box::new(move |interrupt| case.run(preset, interrupt)),
        })
        .collect()
}

fn text(x: f64, y: f64) -> [String; 2] {
    [x.to_string(), y.to_string()]
}

fn windings() -> Vec<Placed> {
    let mut map = Vec::new();
    for spacing in [0.5, 1.0, 1.5, 2.0, 2.4, 3.0] {
        for q in [1, 2, 4, 8, 12, 20, 40] {
            let case = Case {
                q,
                spacing,
                is_inner: q <= 12 && spacing <= 2.0,
                ..middle()
            };
            map.push((["q", "spacing"], text(q.into(), spacing), case));
        }
    }
    map
}

fn surfaces() -> Vec<Placed> {
    let mut map = Vec::new();
    for (name, anchoring) in [
        ("free", Anchoring::Free),
        ("weak 0.1", Anchoring::Weak(0.1)),
        ("weak 1", Anchoring::Weak(1.0)),
        ("weak 1000", Anchoring::Weak(1e3)),
        ("strong", Anchoring::Strong),
    ] {
        for edge in [2.2, 3.2, 3.6, 4.0, 40.0 / 7.0, 8.0] {
            let case = Case {
                edge,
                anchoring,
                is_inner: edge >= 4.0,
                ..middle()
            };
            let at = [format!("{edge:.2}"), name.to_owned()];
            map.push((["cell edge over radius", "anchoring"], at, case));
        }
    }
    map
}

fn flows() -> Vec<Placed> {
    let mut map = Vec::new();
    for viscosity in [1e-3, 1e-2, 1.38, 1e2, 1e3] {
        for flow_alignment in [0.0, 0.3, 0.6, 1.0, 2.0] {
            let case = Case {
                has_flow: true,
                material: Material {
                    viscosity,
                    flow_alignment,
                    ..Material::default()
                },
                is_inner: viscosity >= 1.0 && flow_alignment <= 1.0,
                ..middle()
            };
            map.push((["chi", "eta"], text(flow_alignment, viscosity), case));
        }
    }
    map
}

fn phases() -> Vec<Placed> {
    let mut map = Vec::new();
    for tolerance in [1e-1, 1e-2, 1e-3, 3e-5, 1e-6, 1e-7] {
        // The uniform nematic is stable below A = 0.1062 and exists below 0.1195.
        for a in [-0.5, -0.19, 0.0, 0.1, 0.119, 0.2] {
            let case = Case {
                tolerance,
                material: Material {
                    a,
                    surface_order: (a > 0.119).then_some(0.5),
                    ..Material::default()
                },
                is_inner: a == -0.19 && (1e-6..=1e-3).contains(&tolerance),
                ..middle()
            };
            map.push((["A", "tolerance"], text(a, tolerance), case));
        }
    }
    map
}

fn turns() -> Vec<Placed> {
    let mut map = Vec::new();
    for each in [1e-4, 1e-2, 0.1] {
        for n in [0, 1, 2, 5] {
            let case = Case {
                release: Release::Turns { n, each },
                ..middle()
            };
            let axes = ["pattern switches", "time of each"];
            map.push((axes, text(n as f64, each), case));
        }
    }
    map
}

fn ramps() -> Vec<Placed> {
    let mut map = Vec::new();
    let pattern = |pattern| SwitchTarget::Pattern {
        pattern,
        anchoring: Anchoring::Strong,
    };
    for (name, to) in [
        ("free", SwitchTarget::default()),
        ("homeotropic", pattern(SurfacePattern::Homeotropic)),
        ("q = 5", pattern(SurfacePattern::Winding(5))),
    ] {
        for ramp in [0.1, 1.0, 10.0, 100.0] {
            let case = Case {
                release: Release::Ramp(ramp, to.clone()),
                ..middle()
            };
            map.push((["ramp", "to"], [ramp.to_string(), name.to_owned()], case));
        }
    }
    map
}

fn random_starts() -> Vec<Placed> {
    let mut map = Vec::new();
    for order in [0.01, 1.0, 3.0] {
        for seed in 1..=4 {
            let case = Case {
                start: Start::Random { seed, order },
                // A tangle of lines may take longer than its budget.
                is_inner: false,
                ..middle()
            };
            let axes = ["random start", "its order over equilibrium"];
            map.push((axes, text(seed as f64, order), case));
        }
    }
    map
}
