//! The closure of a braid word as a curve along which a tube of radius 1 does not touch itself.

use std::f64::consts::{PI, TAU};

use topo_core::Polyline;

use crate::{KnotError, V};

/// Distance of neighbouring strands in units of the tube radius.
const STRAND_GAP: f64 = 2.4;
/// Arc that the innermost strand has for one column of crossings.
const COLUMN_ARC: f64 = 5.3;
/// Height of a strand over a crossing.
const LIFT: f64 = 1.3;
/// Vertices per unit of length.
const PER_UNIT: f64 = 3.0;
/// Largest generator accepted: a word of this size already needs thousands of vertices.
const LARGEST_GENERATOR: i32 = 64;

/// The letters of a braid word written as integers with blanks, commas or brackets between them, such as `1 -2 1 -2`.
///
/// # Errors
/// [`KnotError::Letter`] with the text that is not an integer.
///
/// # Validation
/// `words_are_read_from_text`.
pub fn parse_braid(text: &str) -> Result<Vec<i32>, KnotError> {
    text.split(|c: char| c.is_whitespace() || ",[]".contains(c))
        .filter(|letter| !letter.is_empty())
        .map(|letter| {
            letter.parse().map_err(|_| KnotError::Letter {
                letter: letter.to_owned(),
            })
        })
        .collect()
}

/// Number of components of the closure of a braid word.
///
/// # Errors
/// [`KnotError::EmptyBraid`], [`KnotError::ZeroGenerator`], [`KnotError::GeneratorTooLarge`].
pub fn n_components(word: &[i32]) -> Result<usize, KnotError> {
    let permutation = permutation(word)?;
    let mut seen = vec![false; permutation.len()];
    let mut n = 0;
    for start in 0..seen.len() {
        if !seen[start] {
            n += 1;
            let mut strand = start;
            while !seen[strand] {
                seen[strand] = true;
                strand = permutation[strand];
            }
        }
    }
    Ok(n)
}

/// Place at which the strand from each place ends.
fn permutation(word: &[i32]) -> Result<Vec<usize>, KnotError> {
    if word.is_empty() {
        return Err(KnotError::EmptyBraid);
    }
    if let Some(position) = word.iter().position(|&g| g == 0) {
        return Err(KnotError::ZeroGenerator { position });
    }
    if let Some(&generator) = word
        .iter()
        .find(|g| g.unsigned_abs() > LARGEST_GENERATOR as u32)
    {
        return Err(KnotError::GeneratorTooLarge {
            generator,
            largest: LARGEST_GENERATOR,
        });
    }
    let n_strands = word
        .iter()
        .map(|g| g.unsigned_abs() as usize)
        .max()
        .unwrap_or(0)
        + 1;
    let mut at_place: Vec<usize> = (0..n_strands).collect();
    for g in word {
        let k = g.unsigned_abs() as usize;
        at_place.swap(k - 1, k);
    }
    let mut permutation = vec![0; n_strands];
    for (place, &strand) in at_place.iter().enumerate() {
        permutation[strand] = place;
    }
    Ok(permutation)
}

/// Refuses words whose closure is not a knot.
pub(crate) fn check_word(word: &[i32]) -> Result<(), KnotError> {
    match check_link_word(word)? {
        1 => Ok(()),
        n_components => Err(KnotError::Link { n_components }),
    }
}

/// Refuses words whose closure falls apart; its number of components.
pub(crate) fn check_link_word(word: &[i32]) -> Result<usize, KnotError> {
    let n_components = n_components(word)?;
    let largest = word.iter().map(|g| g.abs()).max().unwrap_or(0);
    for generator in 1..=largest {
        if !word.iter().any(|g| g.abs() == generator) {
            return Err(KnotError::UnusedGenerator { generator, largest });
        }
    }
    Ok(n_components)
}

/// The closure of a braid word as a closed curve along which a tube of radius 1 does not touch itself.
///
/// Positive generators give right-handed crossings. Strand k runs at radius R + 2.4 k around the z axis; crossings that
/// do not touch share a column.
///
/// # Errors
/// [`KnotError::EmptyBraid`], [`KnotError::ZeroGenerator`], [`KnotError::GeneratorTooLarge`],
/// [`KnotError::UnusedGenerator`], [`KnotError::Link`].
///
/// # Validation
/// `braids_of_the_table_are_legal_tubes`, `invariants_of_the_table`.
pub fn closed_braid(word: &[i32]) -> Result<Polyline, KnotError> {
    check_word(word)?;
    let columns = columns(word);
    Ok(component(&columns, 0)?.0)
}

/// The closure of a braid word of any number of components, each closed and oriented along the braid, that of the innermost strand
/// first: together they are such a tube too.
///
/// # Errors
/// As [`closed_braid`], but for [`KnotError::Link`].
///
/// # Validation
/// `closures_of_links_are_legal_tubes`
pub fn braid_closure(word: &[i32]) -> Result<Vec<Polyline>, KnotError> {
    let n_components = check_link_word(word)?;
    let columns = columns(word);
    let mut is_done = Vec::new();
    let mut components = Vec::with_capacity(n_components);
    for place in 0.. {
        if components.len() == n_components {
            break;
        }
        if !is_done.contains(&place) {
            let (curve, places) = component(&columns, place)?;
            is_done.extend(places);
            components.push(curve);
        }
    }
    Ok(components)
}

/// The component through a place of the braid, and all places that it runs through.
fn component(columns: &[Vec<i32>], first: usize) -> Result<(Polyline, Vec<usize>), KnotError> {
    let n_columns = columns.len();
    let inner = (COLUMN_ARC * n_columns as f64 / TAU).max(STRAND_GAP);
    let width = TAU / n_columns as f64;
    let mut vertices = Vec::new();
    let mut place = first;
    let mut places = Vec::new();
    loop {
        places.push(place);
        for (c, column) in columns.iter().enumerate() {
            let (next, lift) = step(column, place);
            let radius = inner + STRAND_GAP * 0.5 * (place + next) as f64;
            let n = (radius * width * PER_UNIT).ceil() as usize;
            for k in 0..n {
                let u = k as f64 / n as f64;
                let ramp = 0.5 * (1.0 - (PI * u).cos());
                let r = inner + STRAND_GAP * (place as f64 + ramp * (next as f64 - place as f64));
                let (sin, cos) = ((c as f64 + u) * width).sin_cos();
                vertices.push(V::new(r * cos, r * sin, lift * (PI * u).sin().powi(2)));
            }
            place = next;
        }
        if place == first {
            break;
        }
    }
    let rough = Polyline::new(vertices, true)?;
    let n_edges = (rough.length() * PER_UNIT).round() as usize;
    Ok((rough.resampled(n_edges)?, places))
}

/// Groups the letters greedily: those in one column touch no common strand.
fn columns(word: &[i32]) -> Vec<Vec<i32>> {
    let n_strands = word
        .iter()
        .map(|g| g.unsigned_abs() as usize)
        .max()
        .unwrap_or(0)
        + 1;
    let mut free_from = vec![0; n_strands];
    let mut columns: Vec<Vec<i32>> = Vec::new();
    for &g in word {
        let k = g.unsigned_abs() as usize;
        let column = free_from[k - 1].max(free_from[k]);
        if column == columns.len() {
            columns.push(Vec::new());
        }
        columns[column].push(g);
        free_from[k - 1] = column + 1;
        free_from[k] = column + 1;
    }
    columns
}

/// Where the strand at `place` goes in a column, and how high.
fn step(column: &[i32], place: usize) -> (usize, f64) {
    for &g in column {
        let k = g.unsigned_abs() as usize;
        // At a right-handed crossing the strand that moves outward lies above.
        let up = if g > 0 { LIFT } else { -LIFT };
        if place + 1 == k {
            return (k, up);
        }
        if place == k {
            return (k - 1, -up);
        }
    }
    (place, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_no_knot_are_named() {
        assert!(matches!(closed_braid(&[]), Err(KnotError::EmptyBraid)));
        assert!(matches!(
            closed_braid(&[1, 0, 1]),
            Err(KnotError::ZeroGenerator { position: 1 })
        ));
        assert!(matches!(
            closed_braid(&[1, 1]),
            Err(KnotError::Link { n_components: 2 })
        ));
        assert!(matches!(
            closed_braid(&[1, 1, 1, 3]),
            Err(KnotError::UnusedGenerator {
                generator: 2,
                largest: 3
            })
        ));
        assert!(matches!(
            closed_braid(&[1, i32::MIN]),
            Err(KnotError::GeneratorTooLarge { .. })
        ));
        assert_eq!(n_components(&[1, -2, 1, -2, 1, -2]).expect("a link"), 3);
    }

    #[test]
    fn words_are_read_from_text() {
        assert_eq!(parse_braid("[1 -2, 1,-2]").expect("a word"), [1, -2, 1, -2]);
        assert_eq!(parse_braid(" ").expect("no letter"), [0; 0]);
        for (text, letter) in [
            ("1 a 1", "`a`"),
            ("1 2.5", "`2.5`"),
            ("9999999999", "`9999999999`"),
        ] {
            let error = parse_braid(text).expect_err(text).to_string();
            assert!(error.contains(letter), "{error}");
        }
    }

    #[test]
    fn closures_of_links_are_legal_tubes() {
        for (word, sizes) in [
            (&[1, 1][..], 2),
            (&[1, -2, 1, -2, 1, -2], 3),
            (&[1, 1, 2, 2, 3, 3], 4),
            (&[1, 1, 1, 2, 2], 2),
            (&[1, 2, 3, 4].repeat(5), 5),
        ] {
            let parts = braid_closure(word).expect("a link");
            assert_eq!(
                (parts.len(), n_components(word).expect("a word")),
                (sizes, sizes)
            );
            let tau = topo_core::thickness_of_all(&parts).tau;
            assert!((1.0..1.3).contains(&tau), "{word:?}: {tau}");
        }
        let knot = braid_closure(&[1, -2, 1, -2]).expect("a knot");
        assert_eq!(knot, [closed_braid(&[1, -2, 1, -2]).expect("a knot")]);
        assert!(matches!(
            braid_closure(&[1, 1, 3, 3]),
            Err(KnotError::UnusedGenerator { generator: 2, .. })
        ));
    }

    #[test]
    fn letters_that_commute_share_a_column() {
        assert_eq!(
            columns(&[1, 3, 2, 1, 3]),
            vec![vec![1, 3], vec![2], vec![1, 3]]
        );
    }
}
