//! Tight shapes of knots and links of the tables, computed once and kept in a folder, under a hash of what they depend on.

use std::path::{Path, PathBuf};

use topo_core::{Interrupt, load_checkpoint, save_checkpoint};

use crate::tighten::{Origin, Tight, mirrored, tighten_origin};
use crate::{KnotEntry, KnotError, LinkEntry, TightKnot, TightLink, TightenSettings};

/// Changes whenever the tightening gives other results, so that older files are not used.
pub const METHOD_VERSION: u32 = 1;

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
    ideal_origin(entry, settings, cache, interrupt)
}

/// As [`ideal`], of a link.
///
/// # Errors
/// As [`ideal`].
///
/// # Validation
/// `links_are_kept_too`
pub fn ideal_link(
    entry: &LinkEntry,
    settings: &TightenSettings,
    cache: Option<&Path>,
) -> Result<TightLink, KnotError> {
    ideal_link_until(entry, settings, cache, &Interrupt::new())
}

/// As [`ideal_link`], but ended early when `interrupt` requests it; nothing is then kept in the folder.
///
/// # Errors
/// As [`ideal`], and [`KnotError::InterruptedLink`] with the best curves so far.
pub fn ideal_link_until(
    entry: &LinkEntry,
    settings: &TightenSettings,
    cache: Option<&Path>,
    interrupt: &Interrupt,
) -> Result<TightLink, KnotError> {
    ideal_origin(entry, settings, cache, interrupt)
}

fn ideal_origin<O: Origin>(
    entry: &O,
    settings: &TightenSettings,
    cache: Option<&Path>,
    interrupt: &Interrupt,
) -> Result<O::Tight, KnotError> {
    let Some(folder) = cache else {
        return tighten_origin(entry, settings, interrupt);
    };
    if entry.is_mirror_image() {
        let itself = ideal_origin(&entry.mirror(), settings, cache, interrupt);
        return mirrored(itself);
    }
    let path = cache_path(folder, entry, settings);
    if let Ok(tight) = load_checkpoint::<O::Tight>(&path, O::Tight::SCHEMA) {
        return Ok(tight);
    }
    let tight = tighten_origin(entry, settings, interrupt)?;
    std::fs::create_dir_all(folder).map_err(|source| KnotError::Io {
        path: folder.to_owned(),
        action: "create the folder",
        source,
    })?;
    save_checkpoint(&path, O::Tight::SCHEMA, &tight)?;
    Ok(tight)
}

/// Whether [`ideal`] would find the shape in the folder `cache`.
pub fn is_kept(entry: &KnotEntry, settings: &TightenSettings, cache: &Path) -> bool {
    is_file_there(entry, settings, cache)
}

/// Whether [`ideal_link`] would find the shape in the folder `cache`.
pub fn is_link_kept(entry: &LinkEntry, settings: &TightenSettings, cache: &Path) -> bool {
    is_file_there(entry, settings, cache)
}

fn is_file_there<O: Origin>(entry: &O, settings: &TightenSettings, cache: &Path) -> bool {
    match entry.is_mirror_image() {
        true => is_file_there(&entry.mirror(), settings, cache),
        false => cache_path(cache, entry, settings).exists(),
    }
}

/// File that holds the tight shape of `entry` under `settings`.
fn cache_path<O: Origin>(folder: &Path, entry: &O, settings: &TightenSettings) -> PathBuf {
    // The debug text of a number reads back to the bit, so nothing that matters is lost.
    let key = format!("{METHOD_VERSION}\n{entry:?}\n{settings:?}");
    let hash = blake3::hash(key.as_bytes()).to_hex();
    folder.join(format!("{}-{}.tight", entry.name(), &hash[..16]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, LinkTable};

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
        let path = cache_path(&folder, &*entry, &settings);
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
            load_checkpoint::<TightKnot>(&path, TightKnot::SCHEMA).expect("replaced");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn links_are_kept_too() {
        let folder = tempfile::tempdir().expect("a folder");
        let table = LinkTable::builtin();
        let settings = TightenSettings {
            n_kicks: 0,
            n_kicks_a_start: 0,
            n_variants: 0,
            ..TightenSettings::draft()
        };
        let entry = table.get("solomon").expect("known");
        let made = |entry| ideal_link(entry, &settings, Some(folder.path())).expect("tight");
        let first = made(&entry);
        assert!(is_link_kept(&entry, &settings, folder.path()));
        let kept = made(&entry);
        assert_eq!((kept.cpu_seconds, &kept), (first.cpu_seconds, &first));
        // The mirror image comes from the same file.
        let mirror = entry.mirror();
        assert!(is_link_kept(&mirror, &settings, folder.path()));
        let turned = made(&mirror);
        assert_eq!((turned.name.as_str(), turned.mirror()), ("mL4a1", first));
        mirror.verify(&turned.curves).expect("the mirror image");
        let interrupt = Interrupt::new();
        interrupt.request();
        let hopf = table.get("hopf").expect("known");
        let cut = ideal_link_until(&hopf, &settings, Some(folder.path()), &interrupt);
        let Err(KnotError::InterruptedLink { best }) = cut else {
            panic!("{cut:?}")
        };
        hopf.verify(&best.curves).expect("a Hopf link");
        assert!(!best.certificate.converged && !is_link_kept(&hopf, &settings, folder.path()));
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
        let path = |entry: &KnotEntry, settings| cache_path(Path::new("c"), entry, settings);
        assert_ne!(path(a, &draft), path(b, &draft));
        assert_ne!(path(a, &draft), path(a, &standard));
        assert_eq!(path(a, &draft), path(&a.clone(), &TightenSettings::draft()));
    }
}
