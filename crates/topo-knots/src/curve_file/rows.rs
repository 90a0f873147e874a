//! The rows of a table, and what single columns show before it is read.

use std::collections::HashSet;

use super::cells::{is_missing, split};

/// Least number of rows of a block of equal cells that may be a component.
const LEAST_BLOCK: usize = 3;

/// A line of a table; an empty one ends a component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    pub number: usize,
    pub text: &'a str,
}

impl Line<'_> {
    /// Whether the line ends a component: blank, or a mark that programs write between chains.
    pub(super) fn is_break(&self) -> bool {
        matches!(self.text, "" | "X" | "TER" | "&" | ">")
    }
}

/// Lines, of which those that are no break are rows. They are split again for each use, which is cheaper than to keep the
/// cells.
pub(super) struct Rows<'a, 'b>(pub &'b [Line<'a>]);

impl<'a> Rows<'a, '_> {
    /// The rows in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Line<'a>> {
        self.0.iter().filter(|line| !line.is_break())
    }

    /// The cells of a column; empty where a row is too short.
    pub(super) fn column(&self, column: usize) -> impl Iterator<Item = &'a str> {
        let mut cells = Vec::new();
        self.iter().map(move |line| {
            split(line.text, &mut cells);
            cells.get(column).copied().unwrap_or("")
        })
    }

    /// Whether a column counts the rows, one by one; it may start again, as it does with the next component.
    pub(super) fn counts(&self, column: usize) -> bool {
        let (mut n, mut start, mut last) = (0, 0_i64, 0_i64);
        for cell in self.column(column).filter(|cell| !is_missing(cell)) {
            let Ok(value) = cell.parse::<i64>() else {
                return false;
            };
            if n == 0 {
                start = value;
            } else if last.checked_add(1) != Some(value) && !(value == start && value < last) {
                return false;
            }
            (n, last) = (n + 1, value);
        }
        n > 2
    }

    /// The row where the second block of equal cells begins, if the column is made of such blocks, each of three rows or more and of
    /// another value.
    pub(super) fn second_block(&self, column: usize) -> Option<usize> {
        let mut values = HashSet::new();
        let mut block: Option<(&str, usize)> = None;
        let mut second = None;
        for (row, cell) in self.column(column).enumerate() {
            match &mut block {
                Some((value, n)) if *value == cell => *n += 1,
                Some((_, n)) if *n < LEAST_BLOCK => return None,
                _ => {
                    if !values.insert(cell) {
                        return None;
                    }
                    second = second.or(block.map(|_| row));
                    block = Some((cell, 1));
                }
            }
        }
        second.filter(|_| block.is_some_and(|(_, n)| n >= LEAST_BLOCK))
    }
}
