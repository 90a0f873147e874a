//! Knot types during discharges.

use super::rows::of;
use super::times::{Site, tied};
use crate::data::{Case, Cut, series};
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict};
use topo_analysis::UNKNOT;

/// Knots without a simpler one to pass through: below three crossings there is the unknot only, and 4_1, which could pass through
/// 3_1 only, becomes the unknot by a change of any of its four crossings. Each of the other twelve becomes a knot of fewer
/// crossings by one change.
pub const WITHOUT_INTERMEDIATE: [&str; 2] = ["3_1", "4_1"];

/// Knot types of the discharge of a row, repetitions left out.
fn types(moments: &[crate::data::Moment], row: &Cut) -> Vec<String> {
    let own = moments.iter().filter(|m| (m.cut - row.cut).abs() < 1e-12);
    let mut types: Vec<String> = own
        .filter_map(|m| m.knot.clone().filter(|k| !k.is_empty()))
        .collect();
    types.dedup();
    types
}

fn passes_others(types: &[String], knot: &str) -> bool {
    types.iter().any(|k| k != knot && k != UNKNOT)
}

pub fn one_cut(t: &Tables) -> Said {
    text_of(t, Site::Largest)
}

pub fn near_ties(t: &Tables) -> Said {
    tied(t, text_of)
}

fn text_of(t: &Tables, site: Site) -> Said {
    let s = of(t)?;
    let (mut through, mut n, mut of_7_4) = (0, 0, Vec::new());
    for case in s.knots().into_iter().filter_map(|k| s.at(k, 0.0)) {
        let knot = case.first().knot.as_str();
        if WITHOUT_INTERMEDIATE.contains(&knot) {
            continue;
        }
        for types in discharges(t, case, site) {
            n += 1;
            through += usize::from(passes_others(&types, knot));
            if knot == "7_4" {
                of_7_4.push(types);
            }
        }
    }
    if n == 0 {
        return None;
    }
    let passed = of_7_4.iter().filter(|t| passes_others(t, "7_4")).count();
    let shown = match (&of_7_4[..], site) {
        ([], _) => String::new(),
        ([only], Site::Largest) => {
            let names: Vec<String> = only.iter().map(|k| text::knot_name(k)).collect();
            format!("7₄: {}; ", names.join(" → "))
        }
        (all, _) => format!("7₄ through others for {passed} of {} cuts; ", all.len()),
    };
    let what = match site {
        Site::Largest => "untwisted knots",
        Site::NearTies => "discharges of untwisted knots",
    };
    Some((
        format!("{shown}{through} of {n} {what} that have a simpler one to pass through do so"),
        Verdict::both(2 * passed > of_7_4.len(), 2 * through > n),
    ))
}

/// Types of the discharges of a state; of none where its series is missing or has no types.
fn discharges(t: &Tables, case: &Case, site: Site) -> Vec<Vec<String>> {
    let path = t.results.join("elastic").join(case.folder());
    let Ok(moments) = series(&path.join("series.csv")) else {
        return Vec::new();
    };
    let rows = match site {
        Site::Largest => &case.cuts[..1],
        Site::NearTies => &case.cuts[..],
    };
    let types = rows.iter().map(|row| types(&moments, row));
    types.filter(|types| !types.is_empty()).collect()
}
