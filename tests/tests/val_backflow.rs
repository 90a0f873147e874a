//! Director and flow together: decay rates of small tilts, with the velocity that they drive.

use std::f64::consts::PI;

use topo_core::Interrupt;
use topo_nematic::tensor::uniaxial;
use topo_nematic::{
    Discharge, DischargeSettings, FlowParameters, Material, NematicAccuracy, NematicBattery,
    NematicParameters, NematicState, RunHooks, SwitchSettings, SwitchTarget,
};

/// A small tilt of a uniform director that decays by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// No boundaries (natural ends of a whole number of half waves), director along the wave vector.
    Bend,
    /// No boundaries, director across, tilted along the wave vector.
    Splay,
    /// No boundaries, director across, tilted about the wave vector.
    Twist,
    /// Between no-slip plates with strong perpendicular anchoring: no net flow of angular momentum.
    Even,
    /// Between such plates, a whole wave.
    Odd,
}

/// Extent across the wave in xi_N, and cells that resolve it.
const N: usize = 40;
const TILT: f64 = 0.05;

/// 2 a²/(eta Gamma) of a director along (`bend`) or across the wave vector: the flow speeds the decay by 1 + beta.
fn beta(m: &Material, bend: bool) -> f64 {
    let (s, chi) = (m.equilibrium_order().unwrap(), m.flow_alignment);
    let sign = if bend { 1.0 } else { -1.0 };
    let a = 0.5 * (chi * (2.0 / 3.0 + s / 2.0) + sign * 1.5 * s);
    2.0 * a * a / (m.viscosity * m.rotational_mobility)
}

/// The root of tan(phi)/phi = 1 + 1/beta below pi/2, by bisection.
fn even_phase(beta: f64) -> f64 {
    let (mut low, mut high) = (0.1, PI / 2.0 - 1e-9);
    for _ in 0..100 {
        let phi = 0.5 * (low + high);
        if phi.tan() / phi < 1.0 + 1.0 / beta {
            low = phi;
        } else {
            high = phi;
        }
    }
    low
}

impl Mode {
    /// Rate of the amplitude over Gamma L k² in the continuum; k = pi/gap between plates.
    fn exact(self, m: &Material, flow: bool) -> f64 {
        let beta = |bend| if flow { beta(m, bend) } else { 0.0 };
        match self {
            Self::Bend => 1.0 + beta(true),
            Self::Splay => 1.0 + beta(false),
            Self::Twist => 1.0,
            Self::Even if flow => {
                let beta = beta(true);
                4.0 * even_phase(beta).powi(2) * (1.0 + beta) / (PI * PI)
            }
            Self::Even => 1.0,
            Self::Odd => 4.0 * (1.0 + beta(true)),
        }
    }

    fn parameters(self, n: usize) -> NematicParameters {
        let between_plates = matches!(self, Self::Even | Self::Odd);
        let cells = if between_plates { [4, 4, n] } else { [n, 4, 4] };
        NematicParameters {
            radius: 1.0,
            spacing: N as f64 / n as f64,
            cells: Some(cells),
            particle: false,
            periodic: !between_plates,
            ..Default::default()
        }
    }

    /// The tilted director at a point, `largest` being its largest angle from uniform but for a factor of order one.
    fn director(self, m: &Material, largest: f64, [x, _, z]: [f64; 3], flow: bool) -> [f64; 3] {
        let length = N as f64;
        let wave = largest * (2.0 * PI * x / length).cos();
        let across = z - 0.5 * length;
        match self {
            Self::Bend => [wave.cos(), 0.0, wave.sin()],
            Self::Splay => [wave.sin(), 0.0, wave.cos()],
            Self::Twist => [0.0, wave.sin(), wave.cos()],
            Self::Even => {
                let phi = if flow {
                    even_phase(beta(m, true))
                } else {
                    PI / 2.0
                };
                let tilt = largest * ((2.0 * phi * across / length).cos() - phi.cos());
                [tilt.sin(), 0.0, tilt.cos()]
            }
            Self::Odd => {
                let tilt = largest * (2.0 * PI * across / length).sin();
                [tilt.sin(), 0.0, tilt.cos()]
            }
        }
    }

    /// Wave number of the unit of rates.
    fn wave_number(self) -> f64 {
        let waves = match self {
            Self::Even | Self::Odd => PI,
            _ => 2.0 * PI,
        };
        waves / N as f64
    }
}

/// A decay as it was followed: its rate against the exact one, and what it took.
struct Decay {
    error: f64,
    n_steps: u64,
    /// Mean step while the rate was measured.
    mean_step: f64,
    n_updates: u64,
    ledger_residual: f64,
}

fn discharge(mode: Mode, n: usize, tilt: f64, tolerance: f64, flow: bool) -> (Discharge, Material) {
    let accuracy = NematicAccuracy {
        tolerance,
        ..Default::default()
    };
    let battery = NematicBattery::new(&mode.parameters(n), &accuracy).unwrap();
    let material = battery.parameters().material;
    let order = material.order();
    let state = NematicState::from_fn(*battery.grid(), None, |point| {
        uniaxial(order, mode.director(&material, tilt, point, flow))
    })
    .unwrap();
    let settings = DischargeSettings {
        until_released: 0.96,
        longest: 1e6,
        flow: flow.then(FlowParameters::default),
        ..Default::default()
    };
    let keep = SwitchSettings {
        to: SwitchTarget::Keep,
        ramp: None,
    };
    let switched = battery.adopt(&state).unwrap().switch(&keep).unwrap();
    let hooks = &mut RunHooks::new(&Interrupt::new());
    (switched.discharge(&settings, hooks).unwrap(), material)
}

/// Follows a mode; its rate is that of the amplitude while the energy falls from 0.5 to 0.05 of its start.
fn decay(mode: Mode, tolerance: f64, flow: bool) -> Decay {
    decay_on(mode, N, TILT, tolerance, flow)
}

/// The same on `n` cells across, from a tilt of its own.
fn decay_on(mode: Mode, n: usize, tilt: f64, tolerance: f64, flow: bool) -> Decay {
    let (run, material) = discharge(mode, n, tilt, tolerance, flow);
    let curve = &run.record.curve;
    let crossing = |share: f64| {
        let goal = share * curve.stored_total(0);
        let i = (1..curve.len())
            .find(|i| curve.stored_total(*i) <= goal)
            .unwrap();
        let (e0, e1) = (curve.stored_total(i - 1), curve.stored_total(i));
        let (t0, t1) = (curve.time()[i - 1], curve.time()[i]);
        t0 + (t1 - t0) * (e0 / goal).ln() / (e0 / e1).ln()
    };
    let (from, to) = (crossing(0.5), crossing(0.05));
    let rate = (0.5_f64 / 0.05).ln() / (2.0 * (to - from));
    let between = curve.time().iter().filter(|t| (from..to).contains(*t));
    let unit = mode.wave_number().powi(2);
    let report = &run.record.report;
    Decay {
        error: rate / unit / mode.exact(&material, flow) - 1.0,
        n_steps: report.n_steps,
        mean_step: (to - from) / between.count() as f64,
        n_updates: report.own.flow.map_or(0, |f| f.counters.n_updates),
        ledger_residual: report.ledger_residual,
    }
}

const MODES: [Mode; 5] = [Mode::Bend, Mode::Splay, Mode::Twist, Mode::Even, Mode::Odd];

#[test]
fn val_tilts_decay_at_the_rates_of_the_coupled_equations() {
    let m = Material::default();
    // Published parameters: numbers of the closed forms, from outside.
    assert!((m.backflow() - beta(&m, true)).abs() < 1e-12);
    for (mode, rate) in [
        (Mode::Bend, 2.087323),
        (Mode::Splay, 1.006489),
        (Mode::Twist, 1.0),
        (Mode::Even, 1.105707),
        (Mode::Odd, 8.349291),
    ] {
        assert!((mode.exact(&m, true) - rate).abs() < 2e-6, "{mode:?}");
    }
    for (mode, tolerance) in MODES.into_iter().flat_map(|m| [(m, 3e-5), (m, 1e-6)]) {
        let [still, flowing] = [false, true].map(|flow| decay(mode, tolerance, flow));
        println!(
            "{mode:?}, {tolerance:e}: {:+.3} % without flow in {} steps, {:+.3} % with it in {} steps and {} updates",
            100.0 * still.error,
            still.n_steps,
            100.0 * flowing.error,
            flowing.n_steps,
            flowing.n_updates
        );
        let limit = if tolerance < 1e-5 { 3e-3 } else { 5e-3 };
        assert!(flowing.error.abs() < limit, "{mode:?} {}", flowing.error);
        // Flow inside the error control: it adds next to nothing to the error of the same mode without it.
        let added = flowing.error.abs() - still.error.abs();
        let limit = if tolerance < 1e-5 { 1e-3 } else { 1.5e-3 };
        assert!(added < limit, "{mode:?} {added}");
        assert!(
            flowing.ledger_residual < 5e-3,
            "{mode:?} {}",
            flowing.ledger_residual
        );
    }
}

#[test]
fn law_rates_between_plates_are_of_order_two_in_the_step() {
    let [coarse, fine, limit] = [1e-5, 1e-8, 1e-9].map(|tol| decay(Mode::Even, tol, true));
    let ratio = (coarse.error - limit.error) / (fine.error - limit.error);
    let order = ratio.abs().ln() / (coarse.mean_step / fine.mean_step).ln();
    println!(
        "steps of {:.2} and {:.2}: order {order:.2}",
        coarse.mean_step, fine.mean_step
    );
    assert!(order > 1.9, "{order}");
}

#[test]
fn law_rates_with_flow_converge_in_space() {
    // An odd mode is a whole wave: of order two, with the gradient of the flow itself of order four.
    let error = |n: usize| decay_on(Mode::Odd, n, 0.01, 1e-8, true).error;
    let [coarse, middle, fine] = [N / 2, N, 2 * N].map(error);
    let order = ((coarse - middle) / (middle - fine)).log2();
    let limit = fine + (fine - middle) / 3.0;
    println!("odd mode: order {order:.2}, in the limit {limit:+.1e}");
    assert!(
        order > 1.9 && limit.abs() < 2e-4,
        "{coarse} {middle} {fine}"
    );
}

#[test]
fn val_flow_of_two_waves_turns_as_their_rates_say() {
    // Tilts of two waves, k and 2 k, by the same small angle: the velocity of a tilt goes as k, its rate as k². The one wave drives
    // half of the speed of the other and outlives it, so that the flow goes from both to the longer wave alone.
    let m = Material::default();
    let battery = NematicBattery::new(
        &Mode::Bend.parameters(2 * N),
        &NematicAccuracy {
            tolerance: 1e-6,
            ..Default::default()
        },
    )
    .unwrap();
    let k = Mode::Bend.wave_number();
    let state = NematicState::from_fn(*battery.grid(), None, |[x, _, _]| {
        let tilt = 0.01 * ((k * x).cos() + (2.0 * k * x).cos());
        uniaxial(m.order(), [tilt.cos(), 0.0, tilt.sin()])
    })
    .unwrap();
    let keep = SwitchSettings {
        to: SwitchTarget::Keep,
        ramp: None,
    };
    let settings = DischargeSettings {
        until_released: 0.999,
        longest: 1e6,
        flow: Some(FlowParameters::default()),
        ..Default::default()
    };
    let switched = battery.adopt(&state).unwrap().switch(&keep).unwrap();
    let run = switched
        .discharge(&settings, &mut RunHooks::new(&Interrupt::new()))
        .unwrap();
    let rate = Mode::Bend.exact(&m, true) * k * k;
    let (mut worst, mut least): (f64, f64) = (0.0, 1.0);
    for sample in &run.record.samples {
        let (a, b) = (
            (-rate * sample.time).exp(),
            2.0 * (-4.0 * rate * sample.time).exp(),
        );
        let exact = (a + 2.0 * b) / (5.0 * (a * a + b * b)).sqrt();
        let found = sample.flow_correlation.unwrap();
        worst = worst.max((found - exact).abs());
        least = least.min(found);
    }
    let n = run.record.samples.len();
    println!("{n} samples: worst {worst:.1e}, least correlation {least:.4}");
    assert!(n > 20 && run.record.samples[0].flow_correlation.unwrap() > 1.0 - 1e-9);
    // at the end the longer wave is all that is left: 1/sqrt(5)
    assert!(worst < 2e-3 && (least - 0.2_f64.sqrt()).abs() < 2e-3);
}
