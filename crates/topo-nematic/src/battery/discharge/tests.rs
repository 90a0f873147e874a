//! Order of the coupling in steps of a given length, and its stability.

use std::f64::consts::PI;

use topo_core::{Interrupt, Rejection};

use super::flow::CoupledFlow;
use crate::stabilised::{Drift, Stabilised};
use crate::tensor::uniaxial;
use crate::{
    ChargeSettings, DischargeSettings, FlowParameters, FreeSurface, NematicBattery,
    NematicParameters, NematicState, RunHooks, SurfacePattern, SwitchSettings, SwitchTarget,
};

const N: usize = 24;

/// A larger ratio than that of the material: at its own, errors of flow and relaxation have opposite signs and cancel by chance.
const MORE: f64 = 4.0;

/// A tilt that decays, by its director at a place along the wave, 0 to 1.
#[derive(Clone, Copy, Debug)]
enum Tilt {
    Bend,
    Splay,
    Even,
    Odd,
}

impl Tilt {
    fn is_between_plates(self) -> bool {
        matches!(self, Self::Even | Self::Odd)
    }

    fn director(self, at: f64) -> [f64; 3] {
        let wave = 0.05 * (2.0 * PI * at).cos();
        match self {
            Self::Bend => [wave.cos(), 0.0, wave.sin()],
            Self::Splay => [wave.sin(), 0.0, wave.cos()],
            Self::Even => {
                // The mode of plates with flow: tan(phi)/phi = 1 + 1/beta.
                let phi: f64 = 1.143260;
                let tilt = 0.05 * ((2.0 * phi * (at - 0.5)).cos() - phi.cos());
                [tilt.sin(), 0.0, tilt.cos()]
            }
            Self::Odd => {
                let tilt = 0.05 * (2.0 * PI * at).sin();
                [tilt.sin(), 0.0, tilt.cos()]
            }
        }
    }
}

/// The field after a time, in steps of one length.
///
/// Short steps go before, until the layers next to plates have formed: there the flow terms and Γ H cancel.
fn after(tilt: Tilt, time: f64, n_steps: u32) -> Result<Vec<f64>, Rejection> {
    let parameters = NematicParameters {
        radius: 1.0,
        spacing: 1.0,
        cells: Some(if tilt.is_between_plates() {
            [4, 4, N]
        } else {
            [N, 4, 4]
        }),
        particle: false,
        periodic: !tilt.is_between_plates(),
        ..Default::default()
    };
    let battery = NematicBattery::new(&parameters, &Default::default()).unwrap();
    let order = parameters.material.order();
    let state = NematicState::from_fn(*battery.grid(), None, |[x, _, z]| {
        let along = if tilt.is_between_plates() { z } else { x };
        uniaxial(order, tilt.director(along / N as f64))
    })
    .unwrap();
    let keep = SwitchSettings {
        to: SwitchTarget::Keep,
        ramp: None,
    };
    let switched = battery.adopt(&state).unwrap().switch(&keep).unwrap();
    let surface = battery.charged_surface();
    let kernel = battery
        .kernel::<f64>(&surface, battery.accuracy().threads)
        .without_gaps();
    let mut field = Stabilised::new(&kernel, state.q_tensor().to_vec()).with_drift(MORE);
    let mut flow = CoupledFlow::new(&switched, &FlowParameters::default()).unwrap();
    flow.begin(&kernel, &mut field, None).unwrap();
    let n_before = if tilt.is_between_plates() { 40 } else { 0 };
    let before = std::iter::repeat_n(0.25, n_before);
    let then = std::iter::repeat_n(time / f64::from(n_steps), n_steps as usize);
    for dt in before.chain(then) {
        let drift = Some(&mut flow as &mut dyn Drift<f64>);
        field.try_step(&kernel, dt, drift)?;
        field.accept();
    }
    Ok(field.q)
}

/// Root mean square distance of two fields.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum();
    (sum / a.len() as f64).sqrt()
}

#[test]
fn coupled_steps_are_of_order_two() {
    for tilt in [Tilt::Bend, Tilt::Splay, Tilt::Even, Tilt::Odd] {
        let time = if matches!(tilt, Tilt::Even) {
            60.0
        } else {
            16.0
        };
        let exact = after(tilt, time, 512).unwrap();
        let errors = [16, 32, 64].map(|n| distance(&after(tilt, time, n).unwrap(), &exact));
        let order = (errors[0] / errors[2]).log2() / 2.0;
        println!("{tilt:?}: {errors:?} order {order:.2}");
        // In the layers next to plates, where Γ H and the flow terms cancel, a part of an order is lost.
        let least = if matches!(tilt, Tilt::Even) { 1.7 } else { 1.9 };
        assert!(order > least, "{tilt:?} {order}");
    }
}

/// A drift of a given ratio to the rate by the molecular field: every mode just decays faster.
struct Multiple(f64);

impl Drift<f64> for Multiple {
    fn at(&mut self, _q: &[f64], field: &[f64], drift: &mut [f64]) -> Result<(), Rejection> {
        for (drift, field) in drift.iter_mut().zip(field) {
            *drift = self.0 * field;
        }
        Ok(())
    }
}

#[test]
fn stiff_drifts_stay_stable() {
    let parameters = NematicParameters {
        radius: 1.0,
        spacing: 1.0,
        cells: Some([4, 4, N]),
        particle: false,
        ..Default::default()
    };
    let battery = NematicBattery::new(&parameters, &Default::default()).unwrap();
    let order = parameters.material.order();
    let kernel = battery.kernel::<f64>(&battery.charged_surface(), battery.accuracy().threads);
    // Waves of all lengths, so that all of the spectrum is there.
    let state = NematicState::from_fn(*battery.grid(), None, |[x, y, z]| {
        let tilt = 1e-3 * ((7.0 * x + 13.0 * y + 31.0 * z).sin() + (0.5 * PI * z / N as f64).cos());
        uniaxial(order, [tilt.sin(), 0.0, tilt.cos()])
    })
    .unwrap();
    let mut start = vec![0.0; kernel.array_length()];
    kernel.spread(state.q_tensor(), &mut start);
    for (largest, ratio) in [
        (1.09, 0.0),
        (1.09, 1.09),
        (1.09, 0.5),
        (6.0, 6.0),
        (6.0, 0.0),
    ] {
        let mut field = Stabilised::new(&kernel, start.clone()).with_drift(largest);
        let mut drift = Multiple(ratio);
        field.set_drift(&kernel, &mut drift).unwrap();
        let start = kernel.energy(&field.q).total();
        let mut end = start;
        for step in 0..60 {
            // Steps that grow: forty times the explicit limit and more.
            let dt = 6.0 * 1.03_f64.powi(step);
            field.try_step(&kernel, dt, Some(&mut drift)).unwrap();
            field.accept();
            end = kernel.energy(&field.q).total();
            assert!(
                end < start,
                "{largest} {ratio} step {step}: {start:e} {end:e}"
            );
        }
        // Soft modes may swing through zero on their way; none is left.
        println!(
            "{largest} {ratio}: {:.1e} of the energy is left",
            end / start
        );
        assert!(end < 1e-6 * start, "{largest} {ratio}: {start:e} {end:e}");
    }
}

/// A colloid of charge 2, charged well enough to be let go.
fn charged() -> crate::ChargedNematic {
    let parameters = NematicParameters {
        radius: 6.0,
        pattern: SurfacePattern::Winding(2),
        ..Default::default()
    };
    let battery = NematicBattery::new(&parameters, &Default::default()).unwrap();
    let settings = ChargeSettings {
        tolerance: 1e-4,
        order_tolerance: 1e-2,
        ..Default::default()
    };
    let hooks = &mut RunHooks::new(&Interrupt::new());
    battery.charge(&settings, hooks).unwrap()
}

#[test]
fn flow_takes_what_the_energy_of_the_switched_surface_loses_by_it() {
    // -dF/dt along what the flow does to Q, F being that of the surface after the switch, by differences; against f.u, which the
    // ledger books. At once, and after a ramp: cells at the sphere then weigh otherwise than while charged.
    let charged = charged();
    for (surface, ramp) in [
        (FreeSurface::CutCell, None),
        (FreeSurface::Staircase, None),
        (FreeSurface::CutCell, Some(0.5)),
    ] {
        let settings = SwitchSettings {
            to: SwitchTarget::Free(surface),
            ramp,
        };
        let switched = charged.switch(&settings).unwrap();
        let after = charged.surface_after(&settings);
        let kernel = charged
            .battery
            .kernel::<f64>(&after, charged.battery.accuracy().threads)
            .without_gaps();
        let mut errors = Vec::new();
        let mut see = |sample: &crate::battery::record::NematicSample,
                       state: &NematicState,
                       flow: Option<&crate::flow::FlowCoupling>| {
            let flow = flow.unwrap();
            if sample.time < ramp.unwrap_or(0.0) {
                return;
            }
            let mut rate = vec![0.0; state.q_tensor().len()];
            flow.add_rate(state.q_tensor(), &mut rate);
            let energy = |t: &[f64]| {
                let moved: Vec<f64> = (state.q_tensor().iter().zip(&rate))
                    .map(|(q, r)| q + t[0] * r)
                    .collect();
                kernel.energy(&moved).total()
            };
            let slope = topo_core::finite_difference_gradient(energy, &[0.0], 1e-2)[0];
            errors.push(flow.power() / -slope - 1.0);
        };
        let discharge = DischargeSettings {
            // no further than the first look after the switch or ramp
            longest: (ramp.unwrap_or(0.0) + 1e-3) / charged.battery.diffusion_time(),
            first_output: 1e-6,
            outputs_per_decade: 1e5,
            flow: Some(FlowParameters::default()),
            ..Default::default()
        };
        let hooks = &mut RunHooks::new(&Interrupt::new()).with_samples(&mut see);
        switched.discharge(&discharge, hooks).unwrap();
        println!("{surface:?} {ramp:?}: {errors:?}");
        assert!(errors.len() > 1 && errors.iter().all(|e| e.abs() < 1e-9));
    }
}

#[test]
fn mean_powers_are_those_of_exponential_decay() {
    // The mean of exp(-t) over 0..1 and over 0..3; equal powers, and none at all, have themselves as their mean.
    let mean = super::model::mean_power;
    for time in [1.0_f64, 3.0, 2e-4, 1e-6] {
        let exact = -(-time).exp_m1() / time;
        assert!((mean(1.0, (-time).exp()) - exact).abs() < 1e-8, "{time}");
    }
    assert_eq!([mean(2.5, 2.5), mean(0.0, 0.0)], [2.5, 0.0]);
}
