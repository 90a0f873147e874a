//! The TOML file of a knot, and what must hold of it.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::chirality::Chirality;
use crate::Jones;
use crate::braid::check_word;
use crate::name::KnotName;

/// Largest signature, power or number of coefficients of a file: far beyond any knot whose invariants can be computed.
const LARGEST_NUMBER: u32 = 10_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    pub name: String,
    #[serde(default)]
    pub aliases: Vec<String>,
    pub crossing_number: u32,
    pub chirality: Chirality,
    #[serde(default)]
    pub braid: Vec<i32>,
    #[serde(default)]
    pub other_braids: Vec<Vec<i32>>,
    pub polygon: Option<PathBuf>,
    pub fourier: Option<PathBuf>,
    pub invariants: FileInvariants,
    pub reference: Option<FileReference>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FileInvariants {
    pub alexander: Vec<i64>,
    pub determinant: u64,
    pub signature: i32,
    pub jones: Option<Jones>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileReference {
    pub length_over_radius: f64,
    pub source: String,
}

impl FileReference {
    /// The published length is a length.
    pub(crate) fn check(&self) -> Result<(), String> {
        let length = self.length_over_radius;
        if length.is_finite() && length > 0.0 {
            return Ok(());
        }
        Err(format!(
            "`reference.length_over_radius` = {length} must be positive"
        ))
    }
}

impl File {
    /// The name is written as the table writes it, and is the file's.
    pub(super) fn check_name(&self, path: &Path) -> Result<(), String> {
        let name = &self.name;
        let canonical = KnotName::parse(name).to_string();
        if *name != canonical || name.starts_with('m') && !name.contains('#') {
            return Err(format!(
                "`name` = `{name}`: a leading `m` is that of a mirror image, and factors stand in the order of the table; `{}` would do",
                canonical.trim_start_matches('m')
            ));
        }
        if path.file_stem().is_none_or(|stem| stem != name.as_str()) {
            return Err(format!("`name` is `{name}`; it must equal the file's name"));
        }
        Ok(())
    }

    /// Alexander polynomial, determinant and signature are a knot's, and fit each other.
    pub(super) fn check_invariants(&self) -> Result<(), String> {
        let FileInvariants {
            alexander,
            determinant,
            signature,
            ..
        } = &self.invariants;
        // Any sum of numbers of 64 bits fits.
        let wide = || alexander.iter().map(|c| i128::from(*c));
        let signed = |(k, c): (usize, i128)| if k % 2 == 0 { c } else { -c };
        let at_minus_one: i128 = wide().enumerate().map(signed).sum();
        if alexander.iter().ne(alexander.iter().rev())
            || alexander.first().is_none_or(|c| *c <= 0)
            || wide().sum::<i128>().abs() != 1
        {
            return Err(format!(
                "`invariants.alexander` = {alexander:?} is not a knot's: give all coefficients, symmetric, the first positive, with sum 1 or -1"
            ));
        }
        if self.crossing_number == 0 && *alexander != [1] {
            return Err(format!(
                "`crossing_number` = 0 is the unknot's, whose `invariants.alexander` is [1] and not {alexander:?}"
            ));
        }
        if at_minus_one.unsigned_abs() != u128::from(*determinant) {
            return Err(format!(
                "`invariants.determinant` = {determinant} is not |Delta(-1)| = {} of `alexander`",
                at_minus_one.abs()
            ));
        }
        if signature.unsigned_abs() > LARGEST_NUMBER {
            return Err(format!(
                "`invariants.signature` = {signature} is beyond {LARGEST_NUMBER}"
            ));
        }
        if signature % 2 != 0 {
            return Err(format!(
                "`invariants.signature` = {signature} is odd; a knot's is even"
            ));
        }
        if self.chirality == Chirality::Amphichiral && *signature != 0 {
            return Err(format!(
                "`invariants.signature` = {signature} contradicts `chirality` = \"amphichiral\"; it must be 0"
            ));
        }
        Ok(())
    }

    /// The Jones polynomial, if given, is one of a knot of this determinant.
    pub(super) fn check_jones(&self) -> Result<(), String> {
        let determinant = self.invariants.determinant;
        let Some(jones) = &self.invariants.jones else {
            return Ok(());
        };
        if jones.lowest.unsigned_abs() > LARGEST_NUMBER
            || !(1..=LARGEST_NUMBER as usize).contains(&jones.coefficients.len())
        {
            return Err(format!(
                "`invariants.jones` has {} coefficients from power {} on: 1 to {LARGEST_NUMBER}, and powers up to it, are possible",
                jones.coefficients.len(),
                jones.lowest
            ));
        }
        if !jones.fits_a_knot(determinant) {
            return Err(format!(
                "`invariants.jones` = {} is not a knot's of determinant {determinant}: V(1) = 1, V'(1) = 0 and |V(-1)| = determinant must hold",
                jones.text()
            ));
        }
        Ok(())
    }

    /// The name can be that of a folder, the published length is a length, and words are those of knots.
    pub(super) fn check_rest(&self) -> Result<(), String> {
        if self.name.is_empty() || self.name.contains(['/', '\\', '|', ' ']) {
            return Err(format!(
                "`name` = `{}` must have no blank, bar or slash",
                self.name
            ));
        }
        if let Some(reference) = &self.reference {
            reference.check()?;
        }
        if !self.braid.is_empty() {
            check_word(&self.braid).map_err(|e| format!("`braid` = {:?}: {e}", self.braid))?;
        }
        for word in &self.other_braids {
            check_word(word).map_err(|e| format!("`other_braids`: {word:?}: {e}"))?;
        }
        Ok(())
    }
}
