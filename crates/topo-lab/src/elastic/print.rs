//! The printed table of an elastic sweep.

use topo_analysis::SweepRow;

use super::si::Si;

const HEADER: &str =
    "knot    theta'h     cut    E/E0      Wr     t50     t90     t95     t99  untied";
const SI_HEADER: &str = "        E/J     t99/s";

pub(super) fn header(si: Option<&Si>) -> String {
    format!("{HEADER}{}", si.map_or("", |_| SI_HEADER))
}

const LEGEND: &[&str] = &[
    "cut: its place, s/L; E/E0: energy before the cut, E0 = E_b h^2 L; Wr: writhe before it",
    "times after the cut in T0 = 2 L eta/(h E_b); t50: 50 % of the energy before the cut is released; untied: the knot is gone",
];

/// The same of a scene in SI units.
const SI_LEGEND: &[&str] = &[
    LEGEND[0],
    LEGEND[1],
    "E/J, t99/s: energy and time in joules and seconds; sweep-si.csv has the others",
];

pub(super) fn legend(si: Option<&Si>) -> &'static [&'static str] {
    si.map_or(LEGEND, |_| SI_LEGEND)
}

/// Energy in joules and t99 in seconds.
fn in_si(r: &SweepRow, si: &Si) -> String {
    let scale = si.scale(r);
    let cell = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.3e}"));
    let joules = cell(scale.map(|s| r.energy * s.energy));
    let seconds = cell(scale.and_then(|s| Some(r.t99? * s.time)));
    format!(" {joules:>10} {seconds:>9}")
}

pub(super) fn line(r: &SweepRow, si: Option<&Si>) -> String {
    let cell = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.3}"));
    let si = si.map_or_else(String::new, |si| in_si(r, si));
    format!(
        "{:6} {:+8.3} {:7.4} {:7.4} {:+7.3} {} {} {} {} {}{si}",
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
