//! probe
use topo_core::Polyline;
use topo_knots::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    for f in &a[1..] {
        let x: Vec<V> = std::fs::read_to_string(f)
            .unwrap()
            .lines()
            .map(|l| {
                let v: Vec<f64> = l.split_whitespace().map(|c| c.parse().unwrap()).collect();
                V::new(v[0], v[1], v[2])
            })
            .collect();
        let c = Polyline::new(x, true).unwrap();
        let th = thickness(&c);
        println!(
            "{f} {:?} L/tau {} inv {:?} {}",
            th,
            c.length() / th.tau,
            Invariants::of(c.vertices()),
            identify(c.vertices(), &KnotTable::builtin())
                .unwrap()
                .label()
        );
        if std::env::var("T").is_ok() {
            let s = TightenSettings {
                n_kicks: 0,
                n_kicks_a_start: 0,
                ..TightenSettings::draft()
            };
            let k = tighten("x", &[c], &s).unwrap();
            println!("  L {} Wr {}", k.length_over_radius, k.certificate.writhe);
            let t: String = k
                .curve
                .vertices()
                .iter()
                .map(|v| format!("{} {} {}\n", v.x, v.y, v.z))
                .collect();
            std::fs::write(f.replace(".txt", ".tight"), t).unwrap();
        }
    }
}
