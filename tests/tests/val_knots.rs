//! Knotted rods with a known answer: the thin trefoil is the doubly covered circle, achiral knots do not see the sign of twist.

use std::f64::consts::PI;

use nalgebra::Matrix3;
use topo_core::{Polyline, RunHooks};
use topo_knots::{KnotTable, TightKnot, TightenSettings, V, tighten_entry};
use topo_rod::{Accuracy, ChargeSettings, ContactParameters, Guards, RodBattery, RodParameters};
use topo_tests::curves::trefoil;
use topo_tests::run::{Setup, rod, run_to, stored};

const LENGTH: f64 = 50.0;

/// Elastic energy of the relaxed trefoil without twist, over that of the doubly covered circle, 8π² B/L.
fn trefoil_energy(diameter: f64, n_edges: usize) -> f64 {
    let mut setup = Setup::bare(2e-3).with_stretch_ratio(100.0);
    setup.parameters.contact = Some(ContactParameters::default());
    setup.tube.contact_diameter = diameter;
    // strands beside each other, hardly touching
    let loose = trefoil(2000, 4.0, 0.52 * diameter);
    let curve = loose.resampled(n_edges).unwrap();
    let curve = curve.scaled(LENGTH / curve.length()).unwrap();
    let mut simulation = setup.simulation(rod(&curve, 0.0));
    run_to(&mut simulation, 1000.0);
    let elastic = stored(&simulation, "bend") + stored(&simulation, "stretch");
    run_to(&mut simulation, 2000.0);
    let later = stored(&simulation, "bend") + stored(&simulation, "stretch");
    assert!((later / elastic - 1.0).abs() < 1e-5, "still relaxing");
    assert!(
        stored(&simulation, "contact") > 0.0,
        "nothing holds the knot"
    );
    elastic / (2.0 * PI * PI / LENGTH)
}

/// Checks the excess over the limit: positive, falling, and with the fit e = e₀ + a (d_c/L)² of the two thinnest.
fn check_limit(cases: &[(f64, usize)]) {
    let energies: Vec<f64> = cases.iter().map(|&(d, n)| trefoil_energy(d, n)).collect();
    for (&(d, n), e) in cases.iter().zip(&energies) {
        println!("d_c/L {:.4}, {n} edges: excess {:.5}", d / LENGTH, e - 1.0);
    }
    assert!(energies.iter().all(|e| *e > 1.0));
    assert!(energies.windows(2).all(|e| e[1] < e[0]));
    let [thick, thin] = [cases.len() - 2, cases.len() - 1];
    let ratio = (cases[thick].0 / cases[thin].0).powi(2);
    let limit = (ratio * energies[thin] - energies[thick]) / (ratio - 1.0);
    println!("extrapolated {limit:.5}");
    assert!((limit - 1.0).abs() < 0.03, "extrapolated {limit:.5}");
    // the form of the fit: each halving of d_c quarters the excess
    for e in energies.windows(2) {
        let power = ((e[0] - 1.0) / (e[1] - 1.0)).log2();
        println!("excess falls with the power {power:.2} of the diameter");
        assert!((1.7..2.3).contains(&power), "power {power:.2}");
    }
}

/// The elastic trefoil tends to the doubly covered circle as its contact diameter goes to zero.
///
/// # References
/// [gerlach2017].
#[test]
fn val_thin_trefoil_is_the_doubly_covered_circle() {
    check_limit(&[(2.0, 200), (1.0, 200), (0.5, 300), (0.25, 600)]);
}

/// The same with edges half as long and one step further.
#[test]
#[ignore = "long: 1 minute"]
fn long_thin_trefoil_is_the_doubly_covered_circle() {
    check_limit(&[
        (2.0, 400),
        (1.0, 400),
        (0.5, 600),
        (0.25, 1200),
        (0.125, 1600),
    ]);
}

/// Elastic energy of a knot of the table charged at the twist θ'.
fn charged_energy(curve: &Polyline, n_edges: usize, twist: f64) -> f64 {
    let parameters = RodParameters {
        n_edges,
        twist: Some(twist),
        ..Default::default()
    };
    let battery = RodBattery::new(&parameters, &Accuracy::default(), Guards::default(), curve);
    let run = battery
        .unwrap()
        .charge(&ChargeSettings::default(), &mut RunHooks::default())
        .unwrap();
    assert!(run.record().report.stop.is_success());
    run.record().samples.last().unwrap().elastic()
}

fn tight(name: &str) -> TightKnot {
    let table = KnotTable::builtin();
    tighten_entry(&table.get(name).unwrap(), &TightenSettings::standard()).unwrap()
}

fn flipped(curve: &Polyline) -> Polyline {
    let vertices = curve.vertices().iter().map(|x| V::new(x.x, x.y, -x.z));
    Polyline::new(vertices.collect(), true).unwrap()
}

/// How far the charged energies at the twists θ' and −θ' differ, from one curve.
fn handedness(name: &str, n_edges: usize) -> [f64; 3] {
    let start = tight(name).centreline().unwrap();
    [0.5, 1.0, 2.0].map(|twist| {
        let [plus, minus] = [twist, -twist].map(|t| charged_energy(&start, n_edges, t));
        let found = (plus / minus - 1.0).abs();
        println!("{name} at {twist}, {n_edges} edges: {plus:.6} and {minus:.6}, {found:.1e}");
        found
    })
}

/// 4_1 can be deformed into its mirror image, so that its energy cannot depend on the sign of the twist.
#[test]
fn val_figure_eight_does_not_see_the_sign_of_twist() {
    let found = handedness("4_1", 100);
    assert!(found.iter().all(|d| *d < 1e-3), "{found:?}");
}

/// The same at the edges of the default preset. The tight 6_3 is not its mirror image, and from that one curve the energies do
/// differ: a finding of this code, whatever the edge length, held here to a factor of two.
#[test]
#[ignore = "long: 1 minute"]
fn long_achiral_knots_do_not_see_the_sign_of_twist() {
    let found = handedness("4_1", 200);
    assert!(found.iter().all(|d| *d < 1e-3), "{found:?}");
    for (found, seen) in handedness("6_3", 200).iter().zip([2.4e-3, 9.9e-4, 3.5e-4]) {
        let ratio = found / seen;
        assert!((0.5..2.0).contains(&ratio), "{found:.1e} of {seen:.1e}");
    }
}

/// Root mean square distance of a closed curve from its mirror image, best placed, in its own unit.
fn distance_from_mirror_image(curve: &Polyline) -> f64 {
    let n = 120;
    let centred = |curve: &Polyline| -> Vec<V> {
        let curve = curve.resampled(n).unwrap();
        let middle = curve.centroid();
        curve.vertices().iter().map(|x| x - middle).collect()
    };
    let (here, mut image) = (centred(curve), centred(&flipped(curve)));
    let size: f64 = here.iter().map(|x| 2.0 * x.norm_squared()).sum();
    let mut best = f64::INFINITY;
    for _sense in 0..2 {
        for shift in 0..n {
            let mut cross = Matrix3::zeros();
            for (k, x) in here.iter().enumerate() {
                cross += image[(k + shift) % n] * x.transpose();
            }
            let singular = cross.svd(false, false).singular_values;
            let last = singular.min() * cross.determinant().signum();
            let overlap = singular.sum() - singular.min() + last;
            best = best.min((size - 2.0 * overlap).max(0.0) / n as f64);
        }
        image.reverse();
    }
    best.sqrt()
}

/// The tight 4_1 is its own mirror image; the tight 6_3 is not, although the knot is.
///
/// A rigid motion that mirrors 6_3 would be a turn by a quarter with a reflection. The tightest curve with this symmetry that is
/// known here is 15 % longer, so that tightening ends in one of two images, whatever its accuracy.
#[test]
fn val_tight_figure_eight_is_its_mirror_image() {
    let [four, six] = ["4_1", "6_3"].map(|name| distance_from_mirror_image(&tight(name).curve));
    println!("distance from the mirror image: 4_1 {four:.4}, 6_3 {six:.4}");
    assert!(four < 0.05, "4_1: {four}");
    assert!(six > 1.0, "6_3: {six}");
}
