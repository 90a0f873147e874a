//! Where a tight tube touches itself.

use std::f64::consts::PI;

use topo_core::{Polyline, closest_points};

use super::pairs::all_close_pairs;
use crate::V;
use crate::curves::Curves;

/// Struts of a tight closed curve: the two ends of each on the centreline, the shortest first.
///
/// A strut joins strands at most `1 + slack` diameters of the thickest tube apart that are at least half a turn of that tube
/// (π radii) apart along the curve. Of struts whose two ends are both within `spacing` edges of those of a shorter strut, only
/// the shorter one is kept, so that a line of contact is a row of struts.
///
/// # Validation
/// `struts_join_strands_a_diameter_apart`
///
/// # References
/// [ashton2011]
///
/// [ashton2011]: https://doi.org/10.1080/10586458.2011.544581
pub fn struts(curve: &Polyline, slack: f64, spacing: usize) -> Vec<[V; 2]> {
    struts_of_all(std::slice::from_ref(curve), slack, spacing)
}

/// Struts of several tight curves together, as [`struts`] of one: between two curves there are no strands too near along them.
///
/// # Validation
/// `struts_join_the_rings_of_a_link`
pub fn struts_of_all(curves: &[Polyline], slack: f64, spacing: usize) -> Vec<[V; 2]> {
    let curves = Curves::from(curves.to_vec());
    let (x, rings, tau) = (curves.vertices(), curves.rings(), curves.thickness().tau);
    let (next, edges) = (rings.next(), curves.edge_lengths());
    let apart_at_least = PI * tau;
    let reach = 2.0 * tau * (1.0 + slack);
    let mut pairs = Vec::new();
    all_close_pairs(&x, &rings, reach, &mut pairs);
    // Edges between two of one curve, the shorter way around.
    let around = |a: usize, b: usize| {
        let n = rings.range(rings.ring(a)).len();
        match rings.ring(a) == rings.ring(b) {
            true => a.abs_diff(b).min(n - a.abs_diff(b)),
            false => usize::MAX,
        }
    };
    let h = |a: usize| edges[rings.ring(a)];
    let mut found: Vec<(f64, usize, usize, [V; 2])> = pairs
        .iter()
        .map(|&(i, j)| (i as usize, j as usize))
        .filter(|&(i, j)| around(i, j) as f64 * h(i) >= apart_at_least)
        .filter_map(|(i, j)| {
            let (a, b, c, d) = (x[i], x[next[i]], x[j], x[next[j]]);
            let (square, s, t) = closest_points(&a, &b, &c, &d);
            let ends = [a + (b - a) * s, c + (d - c) * t];
            (square < reach * reach).then_some((square, i, j, ends))
        })
        .collect();
    found.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut kept: Vec<(usize, usize, [V; 2])> = Vec::new();
    for (_, i, j, ends) in found {
        let near = |a: usize, b: usize| around(a, b) <= spacing;
        let hidden = kept
            .iter()
            .any(|&(k, l, _)| near(i, k) && near(j, l) || near(i, l) && near(j, k));
        if !hidden {
            kept.push((i, j, ends));
        }
    }
    kept.into_iter().map(|(_, _, ends)| ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, LinkTable, TightenSettings, tighten_entry, tighten_link};

    #[test]
    fn struts_join_the_rings_of_a_link() {
        let settings = TightenSettings {
            n_variants: 0,
            n_kicks: 0,
            ..TightenSettings::draft()
        };
        let hopf = LinkTable::builtin()
            .get("hopf")
            .expect("known")
            .into_owned();
        let tight = tighten_link(&hopf, &settings).expect("tight");
        // All points of one ring are a diameter from the middle of the other: many struts, all between the rings.
        let found = struts_of_all(&tight.curves, 5e-3, 2);
        assert!(found.len() > 10, "{}", found.len());
        for [a, b] in &found {
            assert!((2.0 - 1e-9..2.0101).contains(&(a - b).norm()));
        }
        let ends = |c: &Polyline| struts(c, 5e-3, 2).len();
        assert!(tight.curves.iter().map(ends).sum::<usize>() < found.len() / 2);
    }

    #[test]
    fn struts_join_strands_a_diameter_apart() {
        let table = KnotTable::builtin();
        let settings = TightenSettings {
            n_variants: 0,
            n_kicks: 0,
            ..TightenSettings::draft()
        };
        let tight = tighten_entry(&table.get("3_1").expect("known"), &settings).expect("tight");
        let found = struts(&tight.curve, 5e-3, 2);
        // Nearly every place of a tight trefoil touches, and a row has one strut in three edges.
        let n = tight.curve.n_edges();
        assert!(
            (n / 5..2 * n).contains(&found.len()),
            "{} of {n}",
            found.len()
        );
        let length = |[a, b]: &[V; 2]| (a - b).norm();
        assert!(found.windows(2).all(|w| length(&w[0]) <= length(&w[1])));
        for strut in &found {
            assert!((2.0 - 1e-9..2.0101).contains(&length(strut)));
        }
        // Whatever the size of the curve.
        let double = tight.curve.scaled(2.0).expect("scaled");
        assert_eq!(struts(&double, 5e-3, 2).len(), found.len());
    }
}
