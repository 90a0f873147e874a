//! The free surface against closed forms, and how the field goes on into the sphere.

use std::f64::consts::PI;

use topo_core::Interrupt;

use super::*;
use crate::anchoring::Plate;
use crate::tensor::uniaxial;
use crate::{
    ChargeSettings, EnergyParts, Material, NematicAccuracy, NematicParameters, RunHooks, Sides,
};

fn battery(parameters: &NematicParameters) -> NematicBattery {
    NematicBattery::new(parameters, &NematicAccuracy::default()).unwrap()
}

/// Energy of a field on the cut cells of a free particle of radius `n` spacings of 1, in a box whose faces hold nothing.
fn free_energy(n: f64, cells: usize, f: impl Fn([f64; 3]) -> [f64; 5]) -> EnergyParts {
    let plate = Plate {
        anchoring: Anchoring::Free,
        ..Default::default()
    };
    let battery = battery(&NematicParameters {
        radius: n,
        spacing: 1.0,
        cells: Some([cells; 3]),
        plates: plate,
        sides: Sides::Walled(plate),
        ..Default::default()
    });
    let (grid, particle) = (battery.grid, battery.particle.unwrap());
    let state =
        NematicState::from_fn(grid, Some(particle), |p| f(particle.offset(&grid, p))).unwrap();
    let kernel = battery.kernel::<f64>(&Surface::Free(FreeSurface::CutCell), Threads::One);
    // the cells inside as well
    let mut q = vec![0.0; kernel.array_length()];
    kernel.spread(state.q_tensor(), &mut q);
    for k in 0..cells {
        for j in 0..cells {
            for i in 0..cells {
                let at = grid.index([i, j, k]);
                let value = f(particle.offset(&grid, grid.centre([i, j, k])));
                (0..5).for_each(|c| q[c * kernel.stride + at] = value[c]);
            }
        }
    }
    kernel.energy(&q)
}

#[test]
fn cut_cells_hold_the_energy_of_uniform_gradients_and_orders() {
    // Q_xy = g s along an axis: (L/2) 2 g² times the volume, of which half a cell at either end has no link. An order off equilibrium:
    // its density times the volume.
    let (g, order) = (0.01, 0.3);
    let m = Material::default();
    let density = m.uniaxial_density(order) - m.reference_density();
    for (n, cells) in [(8.3, 26_usize), (12.4, 34)] {
        let (area, sphere) = (4.0 * PI * n * n, 4.0 / 3.0 * PI * f64::powi(n, 3));
        let plane = (cells * cells) as f64;
        let volumes = [0, 1, 2].map(|axis| {
            let energy = free_energy(n, cells, |p| [0.0, g * p[axis], 0.0, 0.0, 0.0]);
            plane + energy.elastic / (g * g)
        });
        let energy = free_energy(n, cells, |_| uniaxial(order, [0.6, 0.0, 0.8]));
        assert!(energy.elastic.abs() < 1e-12);
        let whole = plane * cells as f64;
        for volume in volumes.into_iter().chain([energy.bulk / density]) {
            // Cells with less than a twentieth of fluid take no part: a layer of some hundredths of a spacing.
            let layer = (whole - volume - sphere) / area;
            println!("{n}: {layer:.4}");
            assert!((0.0..0.05).contains(&layer), "{n}: {layer}");
        }
    }
}

#[test]
fn the_field_goes_on_into_the_sphere_about_as_steeply_as_outside() {
    // The energy at the switch is continuous by the choice of this slope, whatever apertures and volumes are: so look at the slope.
    let slope = |charge: i32, radius: f64| {
        let battery = battery(&NematicParameters {
            radius,
            pattern: SurfacePattern::Winding(charge),
            ..Default::default()
        });
        let settings = ChargeSettings {
            tolerance: 1e-5,
            order_tolerance: 1e-3,
            ..Default::default()
        };
        let charged = battery
            .charge(&settings, &mut RunHooks::new(&Interrupt::new()))
            .unwrap();
        let kernel = battery.kernel::<f64>(&Surface::Free(FreeSurface::CutCell), Threads::One);
        let goal = charged.energy().total();
        let mut state = charged.state().clone();
        let extended =
            extend_into_cut_cells(&battery, Anchoring::Strong, &kernel, goal, &mut state);
        println!("q = {charge}, R = {radius}: {:.3}", extended.steepness);
        assert!((extended.energy / goal - 1.0).abs() < 1e-6);
        extended.steepness
    };
    // Below 1 while the cells at the sphere are large against what they resolve: 0.69, 0.62, 0.83; 1.01 at q = 2, R = 24.
    for (charge, radius, least) in [(1, 7.5, 0.55), (2, 7.5, 0.55), (2, 12.0, 0.75)] {
        let found = slope(charge, radius);
        assert!((least..1.1).contains(&found), "{charge} {radius}: {found}");
    }
}
