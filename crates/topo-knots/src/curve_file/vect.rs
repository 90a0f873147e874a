//! Geomview's VECT.

use std::path::Path;

use super::cells::number;
use super::fault::{fault, fault_at, quoted};
use super::{CurveComponent, text};
use crate::{KnotError, V};

/// Numbers of a colour: red, green, blue, opacity.
const COLOUR: u64 = 4;

/// The words of a file with their lines, comments left out.
struct Words<'a, I> {
    path: &'a Path,
    words: I,
    last_line: usize,
}

impl<'a, I: Iterator<Item = (usize, &'a str)>> Words<'a, I> {
    fn next(&mut self, what: &str) -> Result<(usize, &'a str), KnotError> {
        let (line, word) = self.words.next().ok_or_else(|| {
            let problem = format!(
                "the file ends where {what} should stand; correct the counts or complete it"
            );
            fault_at(self.path, self.last_line, &problem)
        })?;
        self.last_line = line;
        Ok((line, word))
    }

    fn integer(&mut self, what: &str) -> Result<i64, KnotError> {
        let (line, word) = self.next(what)?;
        word.parse()
            .map_err(|_| fault_at(self.path, line, &format!("{} is not {what}", quoted(word))))
    }

    fn count(&mut self, what: &str) -> Result<u64, KnotError> {
        let n = self.integer(what)?;
        u64::try_from(n)
            .map_err(|_| fault_at(self.path, self.last_line, &format!("`{n}` is not {what}")))
    }

    fn number(&mut self, what: &str) -> Result<f64, KnotError> {
        let (line, word) = self.next(what)?;
        number(word).map_err(|problem| fault_at(self.path, line, &problem.message(word)))
    }
}

/// What the head of a file announces.
struct Counts {
    line: usize,
    n_vertices: u64,
    n_colours: u64,
    /// Vertices of each component, negative where it is closed.
    sizes: Vec<i64>,
}

impl Counts {
    fn read<'a>(
        words: &mut Words<'a, impl Iterator<Item = (usize, &'a str)>>,
    ) -> Result<Self, KnotError> {
        let path = words.path;
        let (line, word) = words.next("VECT")?;
        if word != "VECT" {
            let problem = format!("the first word must be VECT, not {}", quoted(word));
            return Err(fault_at(path, line, &problem));
        }
        let n_components = words.count("the number of components")?;
        let line = words.last_line;
        let n_vertices = words.count("the number of vertices")?;
        let n_colours = words.count("the number of colours")?;
        // A count beyond the text is an error below, not a reason to reserve memory.
        let sizes = (0..n_components)
            .map(|_| words.integer("the size of a component"))
            .collect::<Result<Vec<i64>, _>>()?;
        let colours = (0..n_components)
            .map(|_| words.count("the number of colours of a component"))
            .collect::<Result<Vec<u64>, _>>()?;
        let agree = |what: &str, sum: u128, announced: u64| {
            let problem = format!(
                "the components have {sum} {what} together, line {line} announces {announced}; correct the counts"
            );
            (sum == u128::from(announced))
                .then_some(())
                .ok_or_else(|| fault(path, problem))
        };
        let all = sizes.iter().map(|n| u128::from(n.unsigned_abs())).sum();
        agree("vertices", all, n_vertices)?;
        let all = colours.iter().map(|n| u128::from(*n)).sum();
        agree("colours", all, n_colours)?;
        Ok(Self {
            line,
            n_vertices,
            n_colours,
            sizes,
        })
    }
}

/// The components of a file: counts, sizes, numbers of colours, vertices, colours, and nothing beyond.
pub(super) fn vect(path: &Path, text: &str) -> Result<Vec<CurveComponent>, KnotError> {
    let words = text::lines(text).flat_map(|(line, row)| {
        let row = row.split('#').next().unwrap_or("");
        let row = row.trim_end_matches('\u{1a}');
        row.split_whitespace().map(move |word| (line, word))
    });
    let mut words = Words {
        path,
        words,
        last_line: 1,
    };
    let Counts {
        line: counts_line,
        n_vertices,
        n_colours,
        sizes,
    } = Counts::read(&mut words)?;
    let mut components = Vec::new();
    for size in sizes {
        let mut vertices = Vec::new();
        for _ in 0..size.unsigned_abs() {
            let mut x = V::zeros();
            for k in 0..3 {
                x[k] = words.number("a coordinate")?;
            }
            vertices.push(x);
        }
        components.push(CurveComponent::new(vertices, Some(size < 0)));
    }
    for _ in 0..n_colours.saturating_mul(COLOUR) {
        words.number("the part of a colour")?;
    }
    if let Some((line, word)) = words.words.next() {
        let problem = format!(
            "{} is left over after {n_vertices} vertices and {n_colours} colours; correct the counts on line {counts_line} and below",
            quoted(word)
        );
        return Err(fault_at(path, line, &problem));
    }
    Ok(components)
}
