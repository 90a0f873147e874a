//! What was published of the colloid, number by number: the defaults are those of [patil2020discharging], and scenes mean it.
//!
//! Numbers are typed here, never taken from the code.

use std::path::Path;

use topo_analysis::{DischargeTimes, NEMATIC_SHARES, NematicRow};
use topo_core::Interrupt;
use topo_lab::{NematicScene, Preset};
use topo_nematic::anchoring::{Plate, PlateDirector};
use topo_nematic::flow::{FlowCoupling, FlowSolver};
use topo_nematic::stokes::Drive;
use topo_nematic::{
    Anchoring, Boundary, ChargeSettings, DischargeSettings, EnergyParts, FlowParameters,
    FreeSurface, Material, NematicAccuracy, NematicBattery, NematicParameters, Precision, RunHooks,
    Sides, SurfacePattern, SwitchSettings, SwitchTarget,
};

#[test]
fn val_published_material() {
    // "A = -0.19 L/xi_N², B = -2.34 L/xi_N² and C = 1.91 L/xi_N² [...] alignment regime chi = 1, isotropic viscosity eta = 1.38"; the
    // unit printed, xi_N²/(L tau_N), is that of Gamma: a viscosity is 1.38/Gamma.
    let m = Material::default();
    assert_eq!([m.a, m.b, m.c], [-0.19, -2.34, 1.91]);
    assert_eq!([m.elastic_constant, m.rotational_mobility], [1.0, 1.0]);
    assert_eq!([m.flow_alignment, m.viscosity], [1.0, 1.38]);
    assert_eq!((m.second_elastic_constant, m.surface_order), (None, None));
    // What follows from them, by hand: S_eq = (2.34 + sqrt(2.34² + 24·0.19·1.91))/(6·1.91).
    let near = |x: f64, y: f64| (x / y - 1.0).abs() < 4e-6;
    assert!(near(m.equilibrium_order().unwrap(), 0.532838));
    assert!(near(m.frank_constant(), 1.27762));
    assert!(near(m.reference_density(), -0.0423540));
    assert!(near(m.order_stiffness(), 1.003421));
    assert!(near(m.correlation_length(), 0.998294));
    // The director aligns in a shear: lambda = (3S + 4)/(9S) chi... = 1.1674, and the flow speeds bend by 1 + beta.
    let lambda = (3.0 * m.order() + 4.0) / (9.0 * m.order()) * m.flow_alignment;
    assert!((lambda - 1.1674).abs() < 1e-4, "{lambda}");
    assert!(near(m.backflow(), 1.087323), "{}", m.backflow());
}

#[test]
fn val_published_colloid_and_its_cell() {
    let p = NematicParameters::default();
    assert_eq!([p.radius, p.spacing], [52.5, 1.5]);
    assert_eq!((p.particle, p.periodic, p.cells), (true, false, None));
    assert_eq!(p.anchoring, Anchoring::Strong);
    assert_eq!(p.boundary, Boundary::CutLink);
    let perpendicular = Plate {
        director: PlateDirector::Perpendicular,
        anchoring: Anchoring::Strong,
    };
    assert_eq!(p.plates, perpendicular);
    assert_eq!(p.plates.director_along(2), [0.0, 0.0, 1.0]);
    assert_eq!((p.sides, p.field), (Sides::Periodic, None));
    assert_eq!(p.material, Material::default());
    // "200 x 200 x 150 mesh with grid resolution 1.5 xi_N"; "tau_d = R²/Gamma L = 2760 tau_N", 2756.25 unrounded.
    let battery = NematicBattery::new(&p, &NematicAccuracy::default()).unwrap();
    assert_eq!(battery.grid().cells(), [200, 200, 150]);
    assert_eq!(battery.diffusion_time(), 2756.25);
    let faster = NematicParameters {
        material: Material {
            rotational_mobility: 2.0,
            elastic_constant: 1.25,
            ..p.material
        },
        ..p
    };
    let battery = NematicBattery::new(&faster, &NematicAccuracy::default()).unwrap();
    assert_eq!(battery.diffusion_time(), 1102.5);
}

#[test]
fn val_published_pattern() {
    // n_q = (sin θ cos qφ, sin θ sin qφ, cos θ) at a point of the sphere, by its angles.
    let (theta, phi) = (1.1_f64, 2.3_f64);
    let place = [
        7.0 * theta.sin() * phi.cos(),
        7.0 * theta.sin() * phi.sin(),
        7.0 * theta.cos(),
    ];
    for q in [-3, 1, 2, 5, 12] {
        let turn = f64::from(q) * phi;
        let n = [
            theta.sin() * turn.cos(),
            theta.sin() * turn.sin(),
            theta.cos(),
        ];
        let found = SurfacePattern::Winding(q).q_tensor(0.6, place);
        let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2)];
        for ((a, b), x) in pairs.into_iter().zip(found) {
            let third = if a == b { 1.0 / 3.0 } else { 0.0 };
            let exact = 0.6 * 1.5 * (n[a] * n[b] - third);
            assert!((x - exact).abs() < 1e-14, "{q} {a}{b}: {x} {exact}");
        }
    }
}

#[test]
fn val_published_method_and_our_settings_of_it() {
    let flow = FlowParameters::default();
    assert_eq!(
        (flow.boundary_residual, flow.solver_tolerance),
        (0.01, 1e-8)
    );
    assert_eq!(
        (flow.solver, flow.drive),
        (FlowSolver::Auto, Drive::default())
    );
    assert_eq!(flow.memory_limit, 17_179_869_184);
    assert!(flow.drive.is_zero());
    let parameters = NematicParameters {
        radius: 6.0,
        ..Default::default()
    };
    let battery = NematicBattery::new(&parameters, &NematicAccuracy::default()).unwrap();
    let coupling = FlowCoupling::new(
        battery.grid(),
        battery.particle(),
        &parameters.material,
        &flow,
    );
    assert_eq!(coupling.unwrap().solver(), "spectral");

    let accuracy = NematicAccuracy::default();
    assert_eq!(accuracy.tolerance, 3e-5);
    assert_eq!(accuracy.precision, Precision::Double);
    assert_eq!((accuracy.max_steps, accuracy.memory_limit), (100_000, None));
    check_charge(&battery);
    check_release();
}

/// A tilt of 0.05 cos(pi z/L_z) along x, to rms H < 1e-8 and an order parameter at rest.
fn check_charge(battery: &NematicBattery) {
    let charge = ChargeSettings::default();
    assert_eq!((charge.seeds, charge.seed_azimuth), (vec![0.05], 0.0));
    assert_eq!((charge.tolerance, charge.order_tolerance), (1e-8, 1e-6));
    assert_eq!((charge.coarse_start, charge.max_steps), (false, 50_000));
    let start = battery.start(0.05, 0.0).unwrap();
    let [nx, ny, nz] = battery.grid().cells();
    for k in 0..nz {
        let at = start.tensor(battery.grid().index([nx - 1, ny - 1, k]));
        let z = (k as f64 + 0.5) / nz as f64 - 0.5;
        let tilt = 0.05 * (std::f64::consts::PI * z).cos();
        let exact = 1.5 * 0.532838 * tilt.sin() * tilt.cos();
        assert!((at[2] - exact).abs() < 1e-6, "{k}: {} {exact}", at[2]);
        assert_eq!(at[4], 0.0);
    }
}

fn check_release() {
    // "switching off the anchoring [...] allowing the director field to take any orientation".
    let free = SwitchTarget::Free(FreeSurface::CutCell);
    assert_eq!(
        SwitchSettings::default(),
        SwitchSettings {
            to: free,
            ramp: None
        }
    );
    // "red isosurface at S = 0.35".
    let discharge = DischargeSettings::default();
    assert_eq!(
        (discharge.until_released, discharge.longest),
        (0.9995, 10.0)
    );
    assert_eq!(
        (discharge.first_output, discharge.outputs_per_decade),
        (1e-4, 8.0)
    );
    assert_eq!((discharge.ring_threshold, discharge.flow), (0.35, None));
    assert_eq!(NEMATIC_SHARES, [0.5, 0.9, 0.99, 0.999]);
    // A ring counts as buckled from a tilt of a hundredth on.
    let tilted = |order_parameter| NematicRow {
        order_parameter,
        ..Default::default()
    };
    assert!(tilted(0.0101).is_buckled() && !tilted(0.0099).is_buckled());
}

#[test]
fn val_published_sweeps() {
    // Radius, cells, charges without flow, charges with flow.
    let all = |n: u32| (1..=n).collect::<Vec<u32>>();
    let cases = [
        (Preset::Draft, 20.0, [76, 76, 58], all(10), vec![4]),
        (Preset::Standard, 25.0, [96, 96, 72], all(12), all(12)),
        (Preset::Paper, 52.5, [200, 200, 150], vec![], all(12)),
        (Preset::Reference, 52.5, [200, 200, 150], vec![], all(12)),
    ];
    for (preset, radius, cells, still, flowing) in cases {
        let scene = NematicScene::published(preset);
        assert_eq!(scene.charge, ChargeSettings::default());
        assert_eq!(scene.switch, SwitchSettings::default());
        assert_eq!(scene.discharge, DischargeSettings::default());
        assert_eq!(scene.accuracy, NematicAccuracy::default());
        let of = |with: bool| -> Vec<u32> {
            let cases = scene.cases().into_iter();
            cases
                .filter(|c| c.flow.is_some() == with)
                .map(|c| c.q)
                .collect()
        };
        assert_eq!((of(false), of(true)), (still, flowing), "{preset:?}");
        for case in scene.cases() {
            let expected = NematicParameters {
                radius,
                pattern: SurfacePattern::Winding(case.q as i32),
                ..Default::default()
            };
            assert_eq!(case.nematic, expected, "{preset:?}");
            assert_eq!(case.flow.unwrap_or_default(), FlowParameters::default());
            let battery = NematicBattery::new(&case.nematic, &scene.accuracy).unwrap();
            assert_eq!(battery.grid().cells(), cells, "{preset:?}");
        }
    }
    // The scene file of the published colloid is the preset.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/nematic-paper.toml");
    let file = NematicScene::read(&path).unwrap();
    assert_eq!(file.cases(), NematicScene::published(Preset::Paper).cases());
}

#[test]
fn law_units_scale_out_of_a_discharge_with_flow() {
    // Energies times e, mobility times g and viscosity over g, lengths times l (and L by l²): the same fields, at times over e g, with
    // energies times e l³ and speeds times e g l.
    let run = |e: f64, g: f64, l: f64| {
        let m = Material::default();
        let material = Material {
            a: e * m.a,
            b: e * m.b,
            c: e * m.c,
            elastic_constant: e * l * l * m.elastic_constant,
            rotational_mobility: g * m.rotational_mobility,
            viscosity: m.viscosity / g,
            ..m
        };
        let parameters = NematicParameters {
            radius: 6.0 * l,
            spacing: 1.5 * l,
            pattern: SurfacePattern::Winding(2),
            material,
            ..Default::default()
        };
        let battery = NematicBattery::new(&parameters, &NematicAccuracy::default()).unwrap();
        let charge = ChargeSettings {
            tolerance: 1e-4 * e,
            order_tolerance: 1e-3,
            ..Default::default()
        };
        let hooks = &mut RunHooks::new(&Interrupt::new());
        let charged = battery.charge(&charge, hooks).unwrap();
        let settings = DischargeSettings {
            until_released: 0.8,
            flow: Some(FlowParameters::default()),
            ..Default::default()
        };
        let switched = charged.switch(&SwitchSettings::default()).unwrap();
        let run = switched.discharge(&settings, hooks).unwrap();
        assert!(run.is_finished(), "{}", run.record.report.stop);
        run
    };
    // Time and largest speed at which each share is released, and what was dissipated by rotation and by viscosity, in units of l³ e.
    let read = |e: f64, g: f64, l: f64| {
        let run = run(e, g, l);
        let curve = &run.record.curve;
        let times = [0.1, 0.5, 0.75].map(|share| {
            let ends = [run.start, 0.0];
            let times = DischargeTimes::between(curve, &EnergyParts::NAMES, ends, &[share]);
            times.at(share).unwrap().value * e * g
        });
        let unit = e * l * l * l;
        let ledger = &run.record.report.ledger;
        let energies = [run.start, ledger.dissipated(0), ledger.dissipated(1)].map(|f| f / unit);
        let speed = run.record.report.own.flow.unwrap().max_speed / (e * g * l);
        let residual = run.record.report.ledger_residual;
        assert!(residual < 3e-3, "residual {residual}");
        [&times[..], &energies, &[speed]].concat()
    };
    let plain = read(1.0, 1.0, 1.0);
    assert!(plain.iter().all(|x| *x > 1e-3), "{plain:?}");
    for (e, g, l) in [
        (2.0, 1.0, 1.0),
        (1.0, 4.0, 1.0),
        (1.0, 1.0, 2.0),
        (0.5, 2.0, 4.0),
    ] {
        let scaled = read(e, g, l);
        println!("{e} {g} {l}: {scaled:?} {plain:?}");
        for (a, b) in scaled.iter().zip(&plain) {
            assert!(
                (a / b - 1.0).abs() < 2e-3,
                "{e} {g} {l}: {scaled:?} {plain:?}"
            );
        }
    }
}
