//! Entries of the table for what is not in it: a braid word, a curve.

use topo_core::Polyline;

use super::{KnotType, identify};
use crate::start_file::StartCurve;
use crate::table::{Chirality, KnotEntry, KnotTable};
use crate::{KnotError, V, closed_braid};

/// Most vertices of a start curve: many more than any level of the tightening has.
const LONGEST_START: usize = 4000;

impl KnotEntry {
    /// An entry for the closure of a braid word.
    ///
    /// A knot whose name is certain gets its entry of the table, with the word as one more start. Any other knot is called
    /// `unnamed` and has the invariants of the closure.
    ///
    /// # Errors
    /// As [`closed_braid`], and those of [`identify`](crate::identify).
    ///
    /// # Validation
    /// `words_and_curves_become_entries`.
    pub fn of_braid(word: &[i32], table: &KnotTable) -> Result<Self, KnotError> {
        let curve = closed_braid(word)?;
        let (mut entry, known) = Self::of_type(&identify(curve.vertices(), table)?, table)?;
        if !known {
            entry.braid = word.to_vec();
        } else if entry.braid != word {
            entry.other_braids.push(word.to_vec());
        }
        Ok(entry)
    }

    /// An entry for a closed curve, as [`of_braid`](Self::of_braid) for a word; a curve of many vertices is resampled.
    ///
    /// # Errors
    /// [`KnotError::Curve`] for vertices that coincide, [`KnotError::Mismatch`] if resampling to 4000 vertices changes the type,
    /// and those of [`identify`](crate::identify).
    pub fn of_curve(vertices: &[V], table: &KnotTable) -> Result<Self, KnotError> {
        let (mut entry, known) = Self::of_type(&identify(vertices, table)?, table)?;
        let mut curve = Polyline::new(vertices.to_vec(), true)?;
        if vertices.len() > LONGEST_START {
            curve = curve.resampled(LONGEST_START)?;
            entry.verify(&curve)?;
        }
        if known {
            // The table's own word is one more start.
            entry.other_braids.push(entry.braid.clone());
        }
        entry.start = Some(StartCurve::Polygon(curve.into_vertices()));
        Ok(entry)
    }

    /// The entry of the table for a type, mirrored if need be, or a new one without a start; true if it is of the table.
    fn of_type(kind: &KnotType, table: &KnotTable) -> Result<(Self, bool), KnotError> {
        if let (true, Some(name)) = (kind.is_certain(), kind.name())
            && let Ok(entry) = table.get(&name.to_string())
        {
            return Ok((entry.into_owned(), true));
        }
        let own = Self {
            name: if kind.is_unknot() { "0_1" } else { "unnamed" }.to_owned(),
            aliases: Vec::new(),
            jones: kind.jones.clone(),
            braid: Vec::new(),
            other_braids: Vec::new(),
            crossing_number: kind.n_crossings as u32,
            chirality: if kind.is_unknot() {
                Chirality::Amphichiral
            } else {
                Chirality::Chiral
            },
            invariants: kind.invariants.clone(),
            length_over_radius: None,
            source: None,
            start: None,
        };
        Ok((own, false))
    }
}
