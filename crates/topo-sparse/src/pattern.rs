//! Patterns of symmetric matrices, and elimination orders.

use crate::error::SparseError;

/// One triangle of a symmetric pattern with its diagonal, without duplicates: where each column starts, and its sorted rows.
pub(super) fn triangle(
    n: usize,
    entries: impl Iterator<Item = (u32, u32)> + Clone,
    upper: bool,
) -> (Vec<u32>, Vec<u32>) {
    let place = |(i, j): (u32, u32)| {
        if upper {
            (i.max(j), i.min(j))
        } else {
            (i.min(j), i.max(j))
        }
    };
    let entries = entries.chain((0..n as u32).map(|i| (i, i))).map(place);
    // Bucket by column, then order the few rows of each.
    let mut ends = vec![0_u32; n + 1];
    for (column, _) in entries.clone() {
        ends[column as usize + 1] += 1;
    }
    for column in 0..n {
        ends[column + 1] += ends[column];
    }
    let mut bucketed = vec![0_u32; ends[n] as usize];
    let mut next = ends.clone();
    for (column, row) in entries {
        bucketed[next[column as usize] as usize] = row;
        next[column as usize] += 1;
    }
    let mut rows = Vec::with_capacity(bucketed.len());
    let mut starts = vec![0_u32; n + 1];
    for column in 0..n {
        let bucket = &mut bucketed[ends[column] as usize..ends[column + 1] as usize];
        bucket.sort_unstable();
        let first = rows.len();
        for row in bucket {
            if rows.len() == first || rows.last() != Some(row) {
                rows.push(*row);
            }
        }
        starts[column + 1] = rows.len() as u32;
    }
    (starts, rows)
}

/// `order` as 32-bit indices, if it holds each of 0..n once.
pub(super) fn checked_permutation(n: usize, order: &[usize]) -> Result<Vec<u32>, SparseError> {
    let mut seen = vec![false; n];
    for (position, &index) in order.iter().enumerate() {
        if index >= n || std::mem::replace(&mut seen[index], true) {
            return Err(SparseError::Ordering { position, n });
        }
    }
    if order.len() != n {
        return Err(SparseError::Ordering {
            position: order.len(),
            n,
        });
    }
    Ok(order.iter().map(|i| *i as u32).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_hold_each_entry_once() {
        let pattern = [(0, 2), (2, 0), (1, 1), (3, 0), (0, 2)];
        let upper = triangle(4, pattern.into_iter(), true);
        assert_eq!(upper, (vec![0, 1, 2, 4, 6], vec![0, 1, 0, 2, 0, 3]));
        let lower = triangle(4, pattern.into_iter(), false);
        assert_eq!(lower, (vec![0, 3, 4, 5, 6], vec![0, 2, 3, 1, 2, 3]));
    }
}
