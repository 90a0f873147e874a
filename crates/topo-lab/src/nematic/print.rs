//! The printed table of a nematic sweep.

use topo_analysis::{NematicRow, nematic_resonance};

pub(super) const HEADER: &str =
    "  q flow  F charged  F after  order  ring/R mode     t50     t90     t99   t99.9  CPU s   MB";

pub(super) const LEGEND: &[&str] = &[
    "F: free energy in L xi_N, charged and after the switch; order: order parameter, above zero where the ring is buckled",
    "ring/R: mean radius of the ring; mode: its strongest mode of height",
    "times after the switch in tau_N = xi_N^2/(Gamma L), R^2/(Gamma L) is (R/xi_N)^2 of them; t50: 50 % of the energy after it is released",
];

pub(super) fn line(r: &NematicRow) -> String {
    let time = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.2}"));
    format!(
        "{:3} {:>4} {:10.2} {:8.2} {:6.4} {:7} {:>4} {} {} {} {} {:6.1} {:4.0}",
        r.q,
        r.flow,
        r.f_charged,
        r.f_after_switch,
        r.order_parameter,
        r.ring_radius
            .map_or_else(|| "-".to_owned(), |a| format!("{:7.3}", a / r.radius)),
        r.ring_mode
            .map_or_else(|| "-".to_owned(), |m| m.to_string()),
        time(r.t50),
        time(r.t90),
        time(r.t99),
        time(r.t999),
        r.cpu_seconds,
        r.peak_bytes as f64 / 1e6
    )
}

/// What the discharge times of many windings say, without flow and with it.
pub(super) fn resonances(all: &[NematicRow]) -> Vec<String> {
    let mut lines = Vec::new();
    for flow in [topo_analysis::Flow::Off, topo_analysis::Flow::On] {
        let rows: Vec<_> = all.iter().filter(|r| r.flow == flow).cloned().collect();
        if rows.len() > 2 {
            let found = nematic_resonance(&rows);
            lines.push(format!(
                "flow {flow}: q_c = {}, 50 % rate {}, 99.9 % rate largest at q = {}",
                found.q_c.map_or("none".to_owned(), |q| q.to_string()),
                if found.half_rate_is_monotonic {
                    "monotonic"
                } else {
                    "not monotonic"
                },
                found
                    .peak_999
                    .map_or("none".to_owned(), |(q, _)| q.to_string())
            ));
        }
    }
    lines
}
