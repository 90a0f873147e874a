//! Tight shapes of the table's knots, computed once and kept in a folder, under a hash of what they depend on.

use std::path::{Path, PathBuf};

use topo_core::{Interrupt, load_checkpoint, save_checkpoint};

use crate::tighten::mirrored;
use crate::{KnotEntry, KnotError, TightKnot, TightenSettings, tighten_entry_until};

/// Changes whenever the tightening gives other results, so that older files are not used.
pub const METHOD_VERSION: u32 = 1;
/// Name and version of the type in the files.
const SCHEMA: &str = "tight-knot/1";

/// The tight shape of a knot: from the folder `cache` if a valid file is there, else computed and kept there.
///
/// The file's name holds a hash of the entry, the settings and the version of the method. A file that cannot be read, is
/// truncated or corrupt is computed again and replaced. A mirror image is made from the file of the knot itself.
///
/// # Errors
/// As [`tighten_entry`](crate::tighten_entry), and [`KnotError::File`] if the result cannot be written.
///
/// # Validation
/// `a_corrupt_cache_is_replaced`
pub fn ideal(
    entry: &KnotEntry,
    settings: &TightenSettings,
    cache: Option<&Path>,
) -> Result<TightKnot, KnotError> {
    ideal_until(entry, settings, cache, &Interrupt::new())
}

/// As [`ideal`], but ended early when `interrupt` requests it; nothing is then kept in the folder.
///
/// # Errors
/// As [`ideal`], and [`KnotError::Interrupted`] with the best curve so far.
///
/// # Validation
/// `an_interrupted_shape_is_not_kept`
pub fn ideal_until(
    entry: &KnotEntry,
    settings: &TightenSettings,
    cache: Option<&Path>,
    interrupt: &Interrupt,
) -> Result<TightKnot, KnotError> {
    let Some(folder) = cache else {
        return tighten_entry_until(entry, settings, interrupt);
    };
    if entry.is_mirror_image() {
        let itself = ideal_until(&entry.mirror(), settings, cache, interrupt);
        return mirrored(itself);
    }
    let path = cache_path(folder, entry, settings);
    if let Ok(tight) = load_checkpoint::<TightKnot>(&path, SCHEMA) {
        return Ok(tight);
    }
    let tight = tighten_entry_until(entry, settings, interrupt)?;
    std::fs::create_dir_all(folder).map_err(|source| KnotError::Io {
        path: folder.to_owned(),
        action: "create the folder",
        source,
    })?;
    save_checkpoint(&path, SCHEMA, &tight)?;
    Ok(tight)
}

/// Whether [`ideal`] would find the shape in the folder `cache`.
pub fn is_kept(entry: &KnotEntry, settings: &TightenSettings, cache: &Path) -> bool {
    if entry.is_mirror_image() {
        return is_kept(&entry.mirror(), settings, cache);
    }
    cache_path(cache, entry, settings).exists()
}

/// File that holds the tight shape of `entry` under `settings`.
fn cache_path(folder: &Path, entry: &KnotEntry, settings: &TightenSettings) -> PathBuf {
    // The debug text of a number reads back to the bit, so nothing that matters is lost.
    let key = format!("{METHOD_VERSION}\n{entry:?}\n{settings:?}");
    let hash = blake3::hash(key.as_bytes()).to_hex();
    folder.join(format!("{}-{}.tight", entry.name, &hash[..16]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::KnotTable;

    #[test]
    fn a_corrupt_cache_is_replaced() {
        let folder = std::env::temp_dir().join(format!("topo-knots-cache-{}", std::process::id()));
        let table = KnotTable::builtin();
        let entry = table.get("3_1").expect("known");
        let settings = TightenSettings {
            n_kicks: 0,
            n_kicks_a_start: 0,
            n_variants: 0,
            ..TightenSettings::draft()
        };
        let first = ideal(&entry, &settings, Some(&folder)).expect("tight");
        let path = cache_path(&folder, &entry, &settings);
        assert_eq!(
            ideal(&entry, &settings, Some(&folder)).expect("cached"),
            first
        );
        let sound = std::fs::read(&path).expect("written");
        let mut corrupt = sound.clone();
        corrupt[sound.len() / 2] ^= 1;
        for bad in [&corrupt[..], &sound[..sound.len() - 9], b""] {
            std::fs::write(&path, bad).expect("written");
            let again = ideal(&entry, &settings, Some(&folder)).expect("computed again");
            assert_eq!(again.curve, first.curve);
            load_checkpoint::<TightKnot>(&path, SCHEMA).expect("replaced");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn an_interrupted_shape_is_not_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let table = KnotTable::builtin();
        let settings = TightenSettings::draft();
        let interrupt = Interrupt::new();
        interrupt.request();
        for name in ["3_1", "m3_1"] {
            let entry = table.get(name).expect("known");
            let made = ideal_until(&entry, &settings, Some(folder.path()), &interrupt);
            let Err(KnotError::Interrupted { best }) = made else {
                panic!("{made:?}")
            };
            assert_eq!(best.name, name);
            assert!(!is_kept(&entry, &settings, folder.path()));
        }
    }

    #[test]
    fn the_file_depends_on_entry_and_settings() {
        let table = KnotTable::builtin();
        let (a, b) = (
            &*table.get("3_1").expect("known"),
            &*table.get("m3_1").expect("known"),
        );
        let (draft, standard) = (TightenSettings::draft(), TightenSettings::standard());
        let path = |entry, settings| cache_path(Path::new("c"), entry, settings);
        assert_ne!(path(a, &draft), path(b, &draft));
        assert_ne!(path(a, &draft), path(a, &standard));
        assert_eq!(path(a, &draft), path(&a.clone(), &TightenSettings::draft()));
    }
}
