//! Seeds and findings of the fuzz targets, replayed through the same functions without a fuzzer.

use std::path::{Path, PathBuf};

use topo_tests::parsers::{PARSERS, checkpoint_payloads, nematic_payloads, rod_payloads};

fn folder(kind: &str, target: &str) -> PathBuf {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
    fuzz.join(kind).join(target)
}

/// The files of a folder, by name; none if it is not there.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|e| e.path()).collect();
    files.sort();
    files
}

#[test]
fn seeds_and_findings_of_the_fuzz_targets_pass() {
    for (name, parser) in PARSERS {
        let seeds = files(&folder("seeds", name));
        assert!(!seeds.is_empty(), "no seed of {name}");
        for file in seeds
            .into_iter()
            .chain(files(&folder("corpus-findings", name)))
        {
            let bytes = std::fs::read(&file).expect("a file");
            let outcome = std::panic::catch_unwind(|| parser(&bytes));
            assert!(outcome.is_ok(), "{}", file.display());
        }
    }
}

#[test]
fn seeds_and_findings_belong_to_targets() {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
    let manifest = std::fs::read_to_string(fuzz.join("Cargo.toml")).expect("the manifest");
    for (name, _) in PARSERS {
        assert!(
            manifest.contains(&format!("name = \"{name}\"")),
            "no target {name}"
        );
        assert!(
            fuzz.join(format!("fuzz_targets/{name}.rs")).exists(),
            "no target {name}"
        );
    }
    for kind in ["seeds", "corpus-findings"] {
        for folder in files(&fuzz.join(kind)) {
            let name = folder.file_name().map(|n| n.to_string_lossy().into_owned());
            let known = PARSERS
                .iter()
                .any(|(target, _)| Some(*target) == name.as_deref());
            assert!(
                known || !folder.is_dir(),
                "{} is no target's",
                folder.display()
            );
        }
    }
}

#[test]
fn checkpoints_of_the_present_schemas_are_gone_on_from() {
    for (name, parser) in PARSERS {
        let payloads = match name {
            "checkpoint" => checkpoint_payloads(),
            "nematic_checkpoint" => nematic_payloads(),
            "rod_checkpoint" => rod_payloads(),
            _ => continue,
        };
        for (_, bytes) in payloads {
            parser(&bytes);
        }
    }
}

/// Each of many bytes of a sound checkpoint changed: refused, or gone on from.
#[test]
fn changed_checkpoints_of_rods_are_refused_or_gone_on_from() {
    for (_, bytes) in rod_payloads() {
        let stride = bytes.len() / 150;
        for at in (1..bytes.len()).step_by(stride.max(1)) {
            let mut changed = bytes.clone();
            changed[at] ^= [0x01, 0x40, 0x80][at % 3];
            topo_tests::parsers::rod_checkpoint(&changed);
        }
    }
}
