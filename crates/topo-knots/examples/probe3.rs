//! probe
use topo_knots::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let t = KnotTable::builtin();
    let e = t.get(&a[1]).unwrap();
    for steps in [200, 1000, 4000] {
        let c = relax_moebius(&e.start_curve().unwrap(), 320, steps).unwrap();
        let th = thickness(&c);
        println!("{steps} {:?} L/tau {}", th, c.length() / th.tau);
        let t: String = c
            .vertices()
            .iter()
            .map(|v| format!("{} {} {}\n", v.x, v.y, v.z))
            .collect();
        std::fs::write(format!("/tmp/k/d1/moeb_{}_{steps}.txt", a[1]), t).unwrap();
    }
}
