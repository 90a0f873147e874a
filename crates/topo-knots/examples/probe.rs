//! probe
use topo_knots::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let s = match a[1].as_str() {
        "draft" => TightenSettings::draft(),
        "standard" => TightenSettings::standard(),
        _ => TightenSettings::fine(),
    };
    let t = KnotTable::builtin();
    for name in &a[2..] {
        let e = t.get(name).unwrap();
        let k = tighten_entry(e, &s).unwrap();
        let c = &k.certificate;
        if let Ok(d) = std::env::var("DUMP") {
            let t: String = k
                .curve
                .vertices()
                .iter()
                .map(|v| format!("{} {} {}\n", v.x, v.y, v.z))
                .collect();
            std::fs::write(format!("{d}/{name}.txt"), t).unwrap();
        }
        println!(
            "{name:6} n {:5} L {:9.4} exc {:+.4} % Wr {:+.4} acn {:.4} res {:.4} conv {} struts {} kinks {} cpu {:.2} fact {}",
            k.curve.n_vertices(),
            k.length_over_radius,
            e.length_over_radius
                .map_or(f64::NAN, |r| 100.0 * (k.length_over_radius / r - 1.0)),
            c.writhe,
            c.average_crossing_number,
            c.residual,
            c.converged,
            c.n_struts,
            c.n_kinks,
            k.cpu_seconds,
            k.n_factorisations
        );
    }
}
