//! The printed table of an elastic sweep.

use topo_analysis::SweepRow;

pub(super) const HEADER: &str =
    "knot    theta'h     cut    E/E0      Wr     t50     t90     t95     t99  untied";

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
