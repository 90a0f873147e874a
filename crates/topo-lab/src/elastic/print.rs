//! The printed table of an elastic sweep.

use topo_analysis::SweepRow;

pub(super) const HEADER: &str =
    "knot    theta'h     cut    E/E0      Wr     t50     t90     t95     t99  untied";

pub(super) const LEGEND: &[&str] = &[
    "cut: its place, s/L; E/E0: energy before the cut, E0 = E_b h^2 L; Wr: writhe before it",
    "times after the cut in T0 = 2 L eta/(h E_b); t50: 50 % of the energy before the cut is released; untied: the knot is gone",
];

pub(super) fn line(r: &SweepRow) -> String {
    let cell = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.3}"));
    format!(
        "{:6} {:+8.3} {:7.4} {:7.4} {:+7.3} {} {} {} {} {}",
        r.knot,
        r.twist,
        r.cut,
        r.energy,
        r.writhe,
        cell(r.t50),
        cell(r.t90),
        cell(r.t95),
        cell(r.t99),
        cell(r.t_untie)
    )
}
