//! What surfaces hold: weak anchoring, links to the sphere counted by hand, and what a switch removes of it.

use std::f64::consts::PI;

use topo_core::Interrupt;
use topo_nematic::anchoring::{Plate, PlateDirector};
use topo_nematic::tensor::uniaxial;
use topo_nematic::{
    Anchoring, Boundary, ChargedNematic, DischargeSettings, FreeSurface, Material, NematicAccuracy,
    NematicBattery, NematicParameters, NematicState, RunHooks, SurfacePattern, SwitchSettings,
    SwitchTarget,
};

/// |Q - Q'|² of two directors at right angles, order S: (9/4) S² |nn - mm|² = (9/2) S², at the published S_eq.
const ACROSS: f64 = 4.5 * 0.532838 * 0.532838;

/// A uniform nematic along z.
fn uniform(parameters: &NematicParameters) -> ChargedNematic {
    let battery = NematicBattery::new(parameters, &NematicAccuracy::default()).unwrap();
    let order = parameters.material.order();
    let q = uniaxial(order, [0.0, 0.0, 1.0]);
    let state = NematicState::from_fn(*battery.grid(), battery.particle().copied(), |_| q).unwrap();
    battery.adopt(&state).unwrap()
}

/// A particle whose surface wants the director along x.
fn particle(anchoring: Anchoring, boundary: Boundary) -> NematicParameters {
    NematicParameters {
        radius: 15.0,
        anchoring,
        boundary,
        pattern: SurfacePattern::Uniform {
            director: [1.0, 0.0, 0.0],
        },
        ..Default::default()
    }
}

#[test]
fn val_weak_anchoring_holds_half_its_strength_a_square_and_area() {
    // The particle: W/2 |Q - Q_s|² 4πR², where the field does not give.
    for strength in [1e-7, 2e-7] {
        let parts = *uniform(&particle(Anchoring::Weak(strength), Boundary::CutLink)).energy();
        let exact = 0.5 * strength * ACROSS * 4.0 * PI * 225.0;
        println!("particle: {:+.3} %", 100.0 * (parts.surface / exact - 1.0));
        assert!(
            (parts.surface / exact - 1.0).abs() < 0.01,
            "{parts:?} {exact}"
        );
        assert!(
            parts.elastic < 1e-5 * exact && parts.bulk.abs() < 1e-3 * exact,
            "{parts:?}"
        );
    }
    // Plates that want x below and above: half a cell of the nematic is in series, 1/W + h/(2L).
    let elastic_constant = 1.7;
    for (strength, spacing) in [(0.3, 1.5), (5.0, 0.8)] {
        let parameters = NematicParameters {
            radius: 1.0,
            spacing,
            cells: Some([4, 6, 10]),
            particle: false,
            plates: Plate {
                director: PlateDirector::Along([1.0, 0.0, 0.0]),
                anchoring: Anchoring::Weak(strength),
            },
            material: Material {
                elastic_constant,
                ..Default::default()
            },
            ..Default::default()
        };
        let energy = uniform(&parameters).energy().total();
        let held = 1.0 / (1.0 / strength + 0.5 * spacing / elastic_constant);
        let exact = 2.0 * 24.0 * spacing * spacing * 0.5 * held * ACROSS;
        assert!(
            (energy / exact - 1.0).abs() < 1e-5,
            "{strength}: {energy} {exact}"
        );
    }
}

/// Sum over links between a cell outside a sphere about the middle of a box and one inside, of 1/θ, θ being the share outside but 0.2 at
/// least; or their number.
fn links(cells: [usize; 3], h: f64, radius: f64, whole: bool) -> f64 {
    let middle = cells.map(|n| 0.5 * n as f64);
    let at = |ijk: [usize; 3]| -> [f64; 3] {
        std::array::from_fn(|a| (ijk[a] as f64 + 0.5 - middle[a]) * h)
    };
    let square = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
    let mut sum = 0.0;
    for k in 0..cells[2] {
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                let from = at([i, j, k]);
                if square(from) < radius * radius {
                    continue;
                }
                for (axis, step) in (0..3).flat_map(|axis| [(axis, -h), (axis, h)]) {
                    let mut to = from;
                    to[axis] += step;
                    if square(to) >= radius * radius {
                        continue;
                    }
                    // |from + s (to - from)|² = R² by bisection
                    let (mut low, mut high) = (0.0, 1.0);
                    for _ in 0..60 {
                        let share = 0.5 * (low + high);
                        let mut x = from;
                        x[axis] += share * step;
                        if square(x) > radius * radius {
                            low = share;
                        } else {
                            high = share;
                        }
                    }
                    sum += if whole { 1.0 } else { 1.0 / f64::max(low, 0.2) };
                }
            }
        }
    }
    sum
}

#[test]
fn val_a_switch_that_drops_the_links_removes_what_they_hold() {
    for boundary in [Boundary::CutLink, Boundary::NodeMask] {
        let charged = uniform(&particle(Anchoring::Strong, boundary));
        let cells = charged.battery().grid().cells();
        let whole = boundary == Boundary::NodeMask;
        // (L h/2) |ΔQ|² a link
        let exact = 0.75 * ACROSS * links(cells, 1.5, 15.0, whole);
        let held = charged.energy().total();
        assert!(
            (held / exact - 1.0).abs() < 1e-5,
            "{boundary:?}: {held} {exact}"
        );
        let stairs = SwitchSettings {
            to: SwitchTarget::Free(FreeSurface::Staircase),
            ramp: None,
        };
        let switched = charged.switch(&stairs).unwrap();
        assert!((switched.removed() / exact - 1.0).abs() < 1e-5);
        assert!(switched.start().abs() < 1e-9 * exact);
        let hooks = &mut RunHooks::new(&Interrupt::new());
        let run = switched
            .discharge(&DischargeSettings::default(), hooks)
            .unwrap();
        let ledger = &run.record.report.ledger;
        assert!((run.removed / exact - 1.0).abs() < 1e-5);
        assert_eq!(ledger.events().len(), 1);
        assert!((ledger.events()[0].removed / exact - 1.0).abs() < 1e-5);
        assert!((ledger.stored_start() / exact - 1.0).abs() < 1e-5);
        // What is left is the uniform nematic: nothing to release.
        assert_eq!((run.stored, run.record.report.n_steps), (None, 0));
        assert!(run.record.report.ledger_residual < 1e-9);
    }
}
