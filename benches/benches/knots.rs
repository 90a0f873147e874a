//! What the knot generator is made of: thickness, invariants, names, one search and one level, the certificate.

use criterion::{Criterion, criterion_group, criterion_main};
use topo_knots::{
    Certificate, Invariants, KnotTable, TightenSettings, alexander_polynomial, closed_braid,
    identify, identify_open, jones_polynomial, struts, thickness, thickness_brute_force, tighten,
};

fn knots(c: &mut Criterion) {
    let table = KnotTable::builtin();
    let knot = table.get("7_7").expect("of the table");
    let start = closed_braid(&knot.braid).expect("a knot");
    let curve = start.resampled(500).expect("resampled");
    c.bench_function("closed braid of 7_7", |b| {
        b.iter(|| closed_braid(&knot.braid))
    });
    c.bench_function("thickness, 500 edges", |b| b.iter(|| thickness(&curve)));
    c.bench_function("thickness by brute force, 500 edges", |b| {
        b.iter(|| thickness_brute_force(&curve));
    });
    let x = curve.vertices();
    c.bench_function("invariants from coordinates, 500 vertices", |b| {
        b.iter(|| Invariants::of(x));
    });
    c.bench_function("Alexander polynomial from coordinates, 500 vertices", |b| {
        b.iter(|| alexander_polynomial(x));
    });
    c.bench_function("Jones polynomial from coordinates, 500 vertices", |b| {
        b.iter(|| jones_polynomial(x));
    });
    c.bench_function("name of a closed curve, 500 vertices", |b| {
        b.iter(|| identify(x, &table));
    });
    c.bench_function("name of an open curve, 32 closures", |b| {
        b.iter(|| identify_open(&x[..450], 32, 0, &table));
    });
    let once = TightenSettings {
        n_variants: 0,
        n_kicks: 0,
        n_kicks_a_start: 0,
        ..TightenSettings::draft()
    };
    let mut slow = c.benchmark_group("slow");
    slow.sample_size(10);
    slow.bench_function("tight 3_1 from one start, draft", |b| {
        let start = closed_braid(&[1, 1, 1]).expect("a knot");
        b.iter(|| tighten("3_1", std::slice::from_ref(&start), &once));
    });
    let start = closed_braid(&[1, 1, 1]).expect("a knot");
    let tight = tighten("3_1", std::slice::from_ref(&start), &once).expect("tight");
    slow.bench_function("certificate of a tight 3_1, draft", |b| {
        b.iter(|| Certificate::of(&tight.curve, true));
    });
    slow.bench_function("struts of a tight 3_1, draft", |b| {
        b.iter(|| struts(&tight.curve, 5e-3, 2));
    });
    slow.finish();
}

criterion_group!(benches, knots);
criterion_main!(benches);
