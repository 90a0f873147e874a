//! Tests of the sparse factor against its own product and a dense one.

use super::*;
use proptest::prelude::*;

/// Ring of `n` blocks of `b` rows with extra contacts between far blocks, as of a knotted rod.
fn ring_pattern(n: u32, b: u32, contacts: u32) -> Vec<(u32, u32)> {
    let mut pairs: Vec<(u32, u32)> = (0..n).map(|i| (i, (i + 1) % n)).collect();
    if b > 1 {
        pairs.extend((0..n).map(|i| (i, (i + 2) % n)));
    }
    // Three long contact regions, neighbours in space of a strand that runs along.
    for k in 0..contacts {
        let i = (k / 4) % (n / 2);
        pairs.push((i, (2 * n / 3 + n - i + k % 4) % n));
    }
    let mut entries = Vec::new();
    for (i, j) in pairs.into_iter().chain((0..n).map(|i| (i, i))) {
        for p in 0..b {
            for q in 0..b {
                entries.push((b * i + p, b * j + q));
            }
        }
    }
    entries
}

/// Fills a diagonally dominant matrix.
fn fill(matrix: &mut SparseCholesky, pattern: &[(u32, u32)]) {
    let n = matrix.n_rows();
    for &(i, j) in pattern {
        let (i, j) = (i as usize, j as usize);
        if i != j {
            let slot = matrix.slot(i, j).unwrap();
            matrix.values_mut()[slot] = -1.0 / (1.0 + ((i * 7 + j * 7) % 5) as f64);
        }
    }
    let mut dominance = vec![0.0; n];
    let off: Vec<f64> = matrix.values().iter().map(|v| v.abs()).collect();
    for (slot, v) in off.iter().enumerate() {
        let (i, j) = matrix.place_of(slot);
        if i != j {
            dominance[i] += v;
            dominance[j] += v;
        }
    }
    for (i, d) in dominance.iter().enumerate() {
        let slot = matrix.slot(i, i).unwrap();
        matrix.values_mut()[slot] = d + 0.1;
    }
}

fn residual(matrix: &mut SparseCholesky, n_rhs: usize) -> f64 {
    let n = matrix.n_rows();
    let exact: Vec<f64> = (0..n * n_rhs)
        .map(|i| ((i * i) as f64 * 0.37).sin())
        .collect();
    let mut rhs = vec![0.0; n * n_rhs];
    for (x, y) in exact.chunks_exact(n).zip(rhs.chunks_exact_mut(n)) {
        matrix.multiply(x, y);
    }
    matrix.solve_in_place(&mut rhs, n_rhs);
    exact
        .iter()
        .zip(&rhs)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn solves_what_it_multiplies() {
    for (n, b, contacts) in [(200, 1, 800), (200, 3, 800), (5, 1, 0), (1, 1, 0)] {
        let pattern = if n > 1 {
            ring_pattern(n, b, contacts)
        } else {
            vec![]
        };
        let size = (n * b) as usize;
        let backwards: Vec<usize> = (0..size).rev().collect();
        for threshold in [
            SupernodalThreshold::FORCE_SIMPLICIAL,
            SupernodalThreshold::FORCE_SUPERNODAL,
            SupernodalThreshold::AUTO,
        ] {
            for ordering in [None, Some(backwards.as_slice())] {
                let mut matrix =
                    SparseCholesky::with_threshold(size, &pattern, ordering, threshold).unwrap();
                fill(&mut matrix, &pattern);
                matrix.factor().unwrap();
                for n_rhs in [1, 3, 7] {
                    let worst = residual(&mut matrix, n_rhs);
                    assert!(worst < 1e-11, "{matrix:?} {n_rhs}: {worst:e}");
                }
            }
        }
    }
}

#[test]
fn multiply_agrees_with_a_dense_product() {
    let pattern = [(0, 1), (1, 0), (3, 1), (2, 2)];
    let mut matrix = SparseCholesky::new(4, &pattern).unwrap();
    assert_eq!(matrix.n_nonzeros(), 6);
    assert_eq!(matrix.slot(2, 3), None);
    assert_eq!(matrix.slot(0, 9), None);
    assert_eq!(matrix.slot(1, 3), matrix.slot(3, 1));
    let mut dense = nalgebra::DMatrix::zeros(4, 4);
    for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (3, 3), (1, 0), (3, 1)]
        .into_iter()
        .enumerate()
    {
        let (value, slot) = (k as f64 + 1.5, matrix.slot(i, j).unwrap());
        matrix.values_mut()[slot] = value;
        dense[(i, j)] = value;
        dense[(j, i)] = value;
    }
    let x = nalgebra::DVector::from_vec(vec![1.0, -2.0, 0.5, 3.0]);
    let mut y = vec![f64::NAN; 4];
    matrix.multiply(x.as_slice(), &mut y);
    assert_eq!(nalgebra::DVector::from_vec(y), dense * x);
}

#[test]
fn refuses_what_is_not_positive_definite() {
    for threshold in [
        SupernodalThreshold::FORCE_SIMPLICIAL,
        SupernodalThreshold::FORCE_SUPERNODAL,
    ] {
        let pattern = ring_pattern(30, 1, 20);
        let mut matrix = SparseCholesky::with_threshold(30, &pattern, None, threshold).unwrap();
        fill(&mut matrix, &pattern);
        let slot = matrix.slot(17, 17).unwrap();
        let good = matrix.values()[slot];
        matrix.values_mut()[slot] = -1e6;
        assert_eq!(
            matrix.factor(),
            Err(SparseError::NotPositiveDefinite { column: 17 })
        );
        let off = matrix.slot(4, 5).unwrap();
        for bad in [f64::NAN, f64::INFINITY] {
            let keep = matrix.values()[off];
            matrix.values_mut()[off] = bad;
            assert_eq!(
                matrix.factor(),
                Err(SparseError::NotFinite { row: 5, column: 4 })
            );
            matrix.values_mut()[off] = keep;
        }
        matrix.values_mut()[slot] = good;
        matrix.factor().unwrap();
        assert_eq!(matrix.n_factorisations(), 4);
    }
}

#[test]
fn a_singular_laplacian_needs_a_gauge() {
    let pattern: Vec<(u32, u32)> = (0..50).map(|i| (i, (i + 1) % 50)).collect();
    let mut matrix = SparseCholesky::new(50, &pattern).unwrap();
    for i in 0..50 {
        let (diagonal, off) = (
            matrix.slot(i, i).unwrap(),
            matrix.slot(i, (i + 1) % 50).unwrap(),
        );
        matrix.values_mut()[diagonal] = 2.0;
        matrix.values_mut()[off] = -1.0;
    }
    assert!(matches!(
        matrix.factor(),
        Err(SparseError::NotPositiveDefinite { .. })
    ));
}

#[test]
fn refuses_broken_patterns_and_orderings() {
    assert_eq!(
        SparseCholesky::new(0, &[]).unwrap_err(),
        SparseError::Size { n: 0 }
    );
    assert!(matches!(
        SparseCholesky::new(usize::MAX, &[]),
        Err(SparseError::Size { .. })
    ));
    assert!(matches!(
        SparseCholesky::new(3, &[(0, 3)]),
        Err(SparseError::OutOfBounds { column: 3, .. })
    ));
    for bad in [vec![0, 1], vec![0, 1, 1], vec![0, 1, 3], vec![0, 1, 2, 0]] {
        assert!(matches!(
            SparseCholesky::with_ordering(3, &[], Some(&bad)),
            Err(SparseError::Ordering { .. })
        ));
    }
}

proptest! {
    #[test]
    fn extreme_values_give_a_solution_or_a_reason(raw in prop::collection::vec(any::<f64>(), 6), factor: bool) {
        let mut matrix = SparseCholesky::new(3, &[(0, 1), (1, 2), (2, 0)]).unwrap();
        matrix.values_mut().copy_from_slice(&raw);
        if factor && matrix.factor().is_ok() {
            prop_assert!(raw.iter().all(|v| v.is_finite()));
            prop_assert!(matrix.factor_values.iter().all(|v| v.is_finite()));
        }
    }
}

#[test]
fn blocked_ordering_solves_the_same_system() {
    let (n, b) = (60, 3);
    let pattern = ring_pattern(n, b, 100);
    let blocks: Vec<(u32, u32)> = ring_pattern(n, 1, 100)
        .into_iter()
        .chain((0..n).map(|i| (i, (i + 2) % n)))
        .collect();
    let mut matrix = SparseCholesky::blocked(n as usize, b as usize, &blocks).unwrap();
    fill(&mut matrix, &pattern);
    matrix.factor().unwrap();
    assert!(residual(&mut matrix, 3) < 1e-11);
    assert!(SparseCholesky::blocked(4, 3, &[(0, 4)]).is_err());
    assert!(SparseCholesky::blocked(0, 3, &[]).is_err());
}
