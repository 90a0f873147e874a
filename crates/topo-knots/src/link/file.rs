//! The TOML file of a link, and what must hold of it.

use std::path::Path;

use serde::Deserialize;

use super::LinkJones;
use crate::Chirality;
use crate::braid::check_link_word;
use crate::table::FileReference;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    pub name: String,
    #[serde(default)]
    pub aliases: Vec<String>,
    pub crossing_number: u32,
    pub chirality: Chirality,
    pub braid: Vec<i32>,
    #[serde(default)]
    pub other_braids: Vec<Vec<i32>>,
    pub invariants: FileInvariants,
    pub reference: Option<FileReference>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FileInvariants {
    pub components: Vec<String>,
    pub linking: Vec<i32>,
    pub jones: LinkJones,
}

impl File {
    /// What can be checked without a diagram: names, words, the number of components and of pairs, V(1) and the length.
    pub fn check(&self, path: &Path) -> Result<(), String> {
        let name = &self.name;
        if path.file_stem().is_none_or(|stem| stem != name.as_str()) {
            return Err(format!("`name` is `{name}`; it must equal the file's name"));
        }
        if name.starts_with('m') || name.contains(['/', '\\', '|', '+', ' ']) {
            return Err(format!(
                "`name` = `{name}` must have no blank, bar, plus or slash, nor begin with `m`, which marks mirror images"
            ));
        }
        let n = self.invariants.components.len();
        for word in self.other_braids.iter().chain([&self.braid]) {
            let found = check_link_word(word).map_err(|e| format!("`braid` = {word:?}: {e}"))?;
            if found != n || n < 2 {
                return Err(format!(
                    "`braid` = {word:?} closes to {found} components, `invariants.components` names {n}; give two or more, and a knot to each"
                ));
            }
        }
        let n_pairs = n * (n - 1) / 2;
        if self.invariants.linking.len() != n_pairs {
            return Err(format!(
                "`invariants.linking` has {} numbers; {n} components have {n_pairs} pairs",
                self.invariants.linking.len()
            ));
        }
        // V(1) = (-2)^(n - 1)
        let coefficients = &self.invariants.jones.coefficients;
        let at_one = coefficients
            .iter()
            .try_fold(0_i64, |sum, c| sum.checked_add(*c));
        if at_one != (-2_i64).checked_pow(n as u32 - 1) {
            return Err(format!(
                "`invariants.jones.coefficients` = {coefficients:?} must sum to (-2)^{}",
                n - 1
            ));
        }
        self.reference.as_ref().map_or(Ok(()), FileReference::check)
    }
}
