//! One link of the table, read from its TOML file and checked on the way.

use std::path::Path;

use serde::Serialize;
use topo_core::Polyline;

use super::file::File;
use super::{LinkInvariants, LinkJones, LinkTable, identify_link};
use crate::curves::Curves;
use crate::name::{is_mirror_image, mirror_name};
use crate::{Chirality, Invariants, KnotError, KnotTable, V, braid_closure};

/// Most vertices of start curves: many more than any level of the tightening has.
const LONGEST_START: usize = 4000;

/// One link type of the table, whatever the order and the orientations of its components.
///
/// # Validation
/// `invariants_of_the_links`, `files_of_links_with_faults_are_named`
///
/// # References
/// [linkinfo2026]
///
/// [linkinfo2026]: https://linkinfo.knotinfo.org
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LinkEntry {
    /// Thistlethwaite's name, as `L6a4`, or that of a family, as `chain(4)`; mirror images carry a leading `m`.
    pub name: String,
    /// Other names, such as `whitehead` or `T(2,4)`.
    pub aliases: Vec<String>,
    /// Braid word whose closure is the link, all strands oriented alike; may be empty if start curves are given.
    pub braid: Vec<i32>,
    /// Further words of the same link, from whose closures tightening starts too; their orientations may be others.
    pub other_braids: Vec<Vec<i32>>,
    /// Least number of crossings of a diagram; of an unnamed link, those of the simplest diagram found.
    pub crossing_number: u32,
    /// Whether the mirror image is another link, orientations left aside.
    pub chirality: Chirality,
    /// Names of the components as knots.
    pub components: Vec<String>,
    /// Of the closure of the word.
    pub invariants: LinkInvariants,
    /// Published length of the tight link in units of the tube radius; `None` where none is published.
    pub length_over_radius: Option<f64>,
    /// Key of the publication of the length.
    pub source: Option<String>,
    /// Curves to start from instead of, or beside, the closed braid.
    pub start: Option<Vec<Polyline>>,
}

impl LinkEntry {
    /// Reads an entry from the text of its file; `path` names it.
    ///
    /// # Errors
    /// [`KnotError::Table`] naming the key and the remedy.
    ///
    /// # Validation
    /// `files_of_links_with_faults_are_named`
    pub fn parse(path: &Path, text: &str) -> Result<Self, KnotError> {
        let fault = |problem: String| KnotError::Table {
            path: path.to_owned(),
            problem,
        };
        let file: File = toml::from_str(text).map_err(|e| fault(e.to_string()))?;
        file.check(path).map_err(fault)?;
        let knots = KnotTable::builtin();
        let own = |name: &String| -> Result<Invariants, KnotError> {
            Ok(knots.get(name)?.invariants.clone())
        };
        let components = file.invariants.components;
        let invariants = LinkInvariants {
            components: components.iter().map(own).collect::<Result<_, _>>()?,
            linking: file.invariants.linking,
            jones: None,
        };
        let lambda: i32 = invariants.linking.iter().sum();
        let jones = file.invariants.jones;
        let (length_over_radius, source) = match file.reference {
            Some(reference) => (Some(reference.length_over_radius), Some(reference.source)),
            None => (None, None),
        };
        Ok(Self {
            name: file.name,
            aliases: file.aliases,
            braid: file.braid,
            other_braids: file.other_braids,
            crossing_number: file.crossing_number,
            chirality: file.chirality,
            components,
            invariants: LinkInvariants {
                // The file has the polynomial with the orientations of the word.
                jones: Some(LinkJones {
                    twice_lowest: jones.twice_lowest - 3 * lambda,
                    coefficients: jones.coefficients,
                }),
                ..invariants
            },
            length_over_radius,
            source,
            start: None,
        })
    }

    /// The entry of the closure of a word that belongs to a family, such as a chain; its components are unknots.
    ///
    /// # Errors
    /// Those of [`braid_closure`] and of its invariants.
    pub(super) fn of_family(
        name: String,
        braid: Vec<i32>,
        crossing_number: u32,
        chirality: Chirality,
        reference: Option<(f64, &str)>,
    ) -> Result<Self, KnotError> {
        let invariants = LinkInvariants::of_curves(&braid_closure(&braid)?.into())?;
        Ok(Self {
            name,
            aliases: Vec::new(),
            other_braids: Vec::new(),
            crossing_number,
            chirality,
            components: vec!["0_1".to_owned(); invariants.n_components()],
            braid,
            invariants,
            length_over_radius: reference.map(|(length, _)| length),
            source: reference.map(|(_, source)| source.to_owned()),
            start: None,
        })
    }

    /// An entry for the closure of a braid word of several components.
    ///
    /// A link with one certain name gets its entry of the table, with the word as one more start. Any other is called `unnamed` and
    /// has the invariants of the closure.
    ///
    /// # Errors
    /// As [`braid_closure`], [`KnotError::NoLink`] for a knot, and those of [`identify_link`].
    ///
    /// # Validation
    /// `words_and_curves_become_links`
    pub fn of_braid(word: &[i32], table: &LinkTable) -> Result<Self, KnotError> {
        let curves = braid_closure(word)?;
        let (mut entry, known) = Self::of_type(&curves, table)?;
        if !known {
            entry.braid = word.to_vec();
        } else if entry.braid != word {
            entry.other_braids.push(word.to_vec());
        }
        Ok(entry)
    }

    /// An entry for closed curves, as [`of_braid`](Self::of_braid) for a word.
    ///
    /// # Errors
    /// [`KnotError::NoLink`] for a single curve, [`KnotError::Component`] for one that is no closed polygon,
    /// [`KnotError::ComponentsTouch`] for curves that meet, and those of [`identify_link`].
    ///
    /// # Validation
    /// `words_and_curves_become_links`
    pub fn of_curves(components: &[Vec<V>], table: &LinkTable) -> Result<Self, KnotError> {
        let curve = |(k, vertices): (usize, &Vec<V>)| {
            Polyline::new(vertices.clone(), true).map_err(|e| KnotError::Component {
                component: k + 1,
                reason: Box::new(e.into()),
            })
        };
        let curves = components.iter().enumerate().map(curve);
        let mut curves = curves.collect::<Result<Vec<_>, _>>()?;
        let (mut entry, known) = Self::of_type(&curves, table)?;
        if curves.iter().map(Polyline::n_vertices).sum::<usize>() > LONGEST_START {
            curves = Curves::from(curves).resampled(LONGEST_START)?.into_parts();
            entry.verify(&curves)?;
        }
        if known {
            // The table's own word is one more start.
            entry.other_braids.push(entry.braid.clone());
        }
        entry.start = Some(curves);
        Ok(entry)
    }

    /// The entry of the table for the type of curves, or a new one without a start; true if it is of the table.
    fn of_type(curves: &[Polyline], table: &LinkTable) -> Result<(Self, bool), KnotError> {
        if curves.len() < 2 {
            return Err(KnotError::NoLink);
        }
        let vertices: Vec<&[V]> = curves.iter().map(Polyline::vertices).collect();
        let found = identify_link(&vertices, table)?;
        if let Some(name) = found.name() {
            return Ok((table.get(name)?.into_owned(), true));
        }
        let own = Self {
            name: "unnamed".to_owned(),
            aliases: Vec::new(),
            braid: Vec::new(),
            other_braids: Vec::new(),
            crossing_number: found.n_crossings() as u32,
            chirality: Chirality::Chiral,
            components: found.components.iter().map(|kind| kind.label()).collect(),
            invariants: LinkInvariants::of(&vertices)?,
            length_over_radius: None,
            source: None,
            start: None,
        };
        Ok((own, false))
    }

    /// Number of components.
    pub fn n_components(&self) -> usize {
        self.components.len()
    }

    /// Whether it is the mirror image of what the table lists: the name begins with `m`.
    pub fn is_mirror_image(&self) -> bool {
        is_mirror_image(&self.name)
    }

    /// The entry of the mirror image: negated words, `m` before the names.
    pub fn mirror(&self) -> Self {
        let negated = |word: &Vec<i32>| word.iter().map(|g| -g).collect::<Vec<_>>();
        let knots = KnotTable::builtin();
        let mirrored = |start: &Vec<Polyline>| start.iter().map(Polyline::mirrored).collect();
        Self {
            name: mirror_name(&self.name),
            aliases: self.aliases.iter().map(|name| mirror_name(name)).collect(),
            braid: negated(&self.braid),
            other_braids: self.other_braids.iter().map(negated).collect(),
            components: self
                .components
                .iter()
                .map(|name| knots.mirror_label(name))
                .collect(),
            invariants: self.invariants.mirror(),
            start: self.start.as_ref().map(mirrored),
            ..self.clone()
        }
    }

    /// Curves of this type to start tightening from: those given, else the closed braid.
    ///
    /// # Errors
    /// Those of [`braid_closure`].
    pub fn start_curves(&self) -> Result<Vec<Polyline>, KnotError> {
        match &self.start {
            Some(start) => Ok(start.clone()),
            None => braid_closure(&self.braid),
        }
    }

    /// Compares the invariants of curves with those of the entry, whatever the order and the orientations of the components.
    ///
    /// # Errors
    /// [`KnotError::Mismatch`], and those of [`LinkInvariants::of`].
    pub fn verify(&self, curves: &[Polyline]) -> Result<LinkInvariants, KnotError> {
        let vertices: Vec<&[V]> = curves.iter().map(Polyline::vertices).collect();
        let found = LinkInvariants::of(&vertices)?;
        match found.fits(&self.invariants) {
            true => Ok(found),
            false => Err(KnotError::Mismatch {
                knot: self.name.clone(),
                what: "type",
                expected: self.invariants.text(),
                found: found.text(),
            }),
        }
    }
}
