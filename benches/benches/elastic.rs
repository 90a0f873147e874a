//! What a step of the elastic battery is made of: writhe, contact list, one charge.

use criterion::{Criterion, criterion_group, criterion_main};
use topo_core::Vector3;
use topo_core::{Polyline, RunHooks};
use topo_rod::contact::ContactPairs;
use topo_rod::{Accuracy, ChargeSettings, Guards, RodBattery, RodParameters, RodState};

/// A trefoil on a torus with `n` vertices.
fn trefoil(n: usize) -> Polyline {
    let point = |k: usize| {
        let u = std::f64::consts::TAU * k as f64 / n as f64;
        let r = 2.0 + (3.0 * u).cos();
        Vector3::new(
            r * (2.0 * u).cos(),
            r * (2.0 * u).sin(),
            -1.2 * (3.0 * u).sin(),
        )
    };
    Polyline::new((0..n).map(point).collect(), true).expect("a torus knot has distinct vertices")
}

fn elastic(c: &mut Criterion) {
    let curve = trefoil(200);
    c.bench_function("writhe of 200 edges", |b| b.iter(|| curve.writhe()));
    let tight = curve
        .scaled(40.0 / curve.length())
        .expect("a positive factor");
    let rod = RodState::new(&tight, 50.0, 0.0).expect("200 edges");
    let mut pairs = ContactPairs::new(2.0, 0.5);
    pairs.update(&rod);
    c.bench_function("contact pairs from the list, 200 edges", |b| {
        b.iter(|| pairs.update(&rod))
    });
    c.bench_function("contact list and pairs, 200 edges", |b| {
        b.iter(|| ContactPairs::new(2.0, 0.5).update(&rod));
    });
    let parameters = RodParameters {
        twist: Some(1.0),
        ..RodParameters::default()
    };
    let battery = RodBattery::new(&parameters, &Accuracy::default(), Guards::default(), &curve)
        .expect("default parameters");
    let brief = ChargeSettings {
        duration: 0.02,
        ..ChargeSettings::default()
    };
    let mut group = c.benchmark_group("rod");
    group.sample_size(10);
    group.bench_function("charge of 0.02 T0, 200 edges", |b| {
        b.iter(|| battery.charge(&brief, &mut RunHooks::default()));
    });
    group.finish();
}

criterion_group!(benches, elastic);
criterion_main!(benches);
