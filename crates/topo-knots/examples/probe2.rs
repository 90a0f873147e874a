//! probe
use topo_knots::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let t = KnotTable::builtin();
    let e = t.get(&a[1]).unwrap();
    let n: u64 = a[2].parse().unwrap();
    for seed in 0..n {
        let plain = e.start_curve().unwrap();
        let start = match seed % 3 {
            0 => relax_moebius(&plain, 320, 120).unwrap(),
            1 => relax_moebius(&plain, 320, 30 + 17 * seed as usize).unwrap(),
            _ => plain,
        };
        let s = TightenSettings {
            seed,
            n_kicks: 2 * (seed as usize % 4),
            n_kicks_a_start: 1,
            ..TightenSettings::draft()
        };
        let Ok(k) = tighten("x", &[start], &s) else {
            println!("fail {seed}");
            continue;
        };
        let c = &k.certificate;
        println!(
            "{seed:3} n {:5} L {:9.4} Wr {:+.4} res {:.4} cpu {:.2}",
            k.curve.n_vertices(),
            k.length_over_radius,
            c.writhe,
            c.residual,
            k.cpu_seconds
        );
        let t: String = k
            .curve
            .vertices()
            .iter()
            .map(|v| format!("{} {} {}\n", v.x, v.y, v.z))
            .collect();
        std::fs::write(format!("/tmp/k/d1/{}_{seed:03}.txt", a[1]), t).unwrap();
    }
}
