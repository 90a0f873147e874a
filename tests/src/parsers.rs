//! What must hold of every parser for any bytes: it refuses or it reads, and what it read comes back when written and read again.
//!
//! The fuzz targets of the folder `fuzz` call these functions, and the test `fuzzing` replays its seeds and findings through them.

mod batteries;

use std::fmt::Debug;
use std::path::Path;

use nalgebra::Vector3;
use serde::Serialize;
use serde::de::DeserializeOwned;
use topo_analysis::{KnotRow, NematicRow, SweepRow, parse_table, table_bytes};
use topo_core::{
    Counters, DischargeCurve, Ledger, Polyline, RejectionCounts, Snapshot, StepControl,
    checkpoint_bytes, parse_checkpoint,
};
use topo_knots::{
    CurveFile, CurveFormat, FrameChoice, Invariants, KnotEntry, KnotError, TightKnot, closed_braid,
    curve_text, n_components, parse_braid, parse_components,
};
use topo_lab::{
    Battery, Colloid, Elastic, ElasticScene, FieldSnapshot, NematicScene, RestProfile, parse_scene,
};

pub use batteries::{nematic_checkpoint, nematic_payloads, rod_checkpoint, rod_payloads};

/// What is called with the bytes of a file.
pub type Parser = fn(&[u8]);

/// All parsers with the names of their fuzz targets.
pub const PARSERS: [(&str, Parser); 11] = [
    ("elastic_scene", elastic_scene),
    ("nematic_scene", nematic_scene),
    ("knot_file", knot_file),
    ("braid", braid),
    ("csv", csv),
    ("xyz", xyz),
    ("vect", vect),
    ("table", table),
    ("checkpoint", checkpoint),
    ("nematic_checkpoint", nematic_checkpoint),
    ("rod_checkpoint", rod_checkpoint),
];

/// Batteries whose scenes there are.
const BATTERIES: [&dyn Battery; 2] = [&Elastic, &Colloid];

/// Longest braid word whose invariants are computed: beyond it a single input takes seconds.
const LONGEST_WORD: usize = 10;

fn named() -> &'static Path {
    Path::new("input")
}

/// Numbers compare by their text, since a NaN differs from itself.
fn same(first: &impl Debug, second: &impl Debug) {
    assert_eq!(format!("{first:?}"), format!("{second:?}"));
}

/// TOML scenes of rods.
pub fn elastic_scene(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    // The table decides which battery it is; either way nothing may panic.
    drop(parse_scene(&BATTERIES, text, named()));
    if let Ok(scene) = ElasticScene::parse(text, named()) {
        let written = scene.text();
        let again = ElasticScene::parse(&written, named());
        same(&again.expect("what was written is a scene"), &scene);
    }
}

/// TOML scenes of colloids.
pub fn nematic_scene(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    drop(parse_scene(&BATTERIES, text, named()));
    if let Ok(scene) = NematicScene::parse(text, named()) {
        let written = scene.text();
        let again = NematicScene::parse(&written, named());
        same(&again.expect("what was written is a scene"), &scene);
        assert!(!scene.cases().is_empty(), "a scene without a case");
    }
}

/// TOML files of knots; the part after a line `---` is the file that it may name.
pub fn knot_file(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let (text, other) = text.split_once("\n---\n").unwrap_or((text, ""));
    let load = |_: &Path| Ok::<_, KnotError>(other.to_owned());
    if let Ok(entry) = KnotEntry::parse(Path::new("x.toml"), text, &load) {
        // A leading `m` marks mirror images: such an alias is one, and loses it.
        if !entry.aliases.iter().any(|alias| alias.starts_with('m')) {
            same(&entry.mirror().mirror(), &entry);
        }
    }
}

/// Braid words as text.
pub fn braid(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let Ok(word) = parse_braid(text) else { return };
    let spelled: Vec<String> = word.iter().map(i32::to_string).collect();
    assert_eq!(parse_braid(&spelled.join(" ")).expect("a word"), word);
    let Ok(n) = n_components(&word) else {
        assert!(closed_braid(&word).is_err(), "a knot without components");
        return;
    };
    if word.len() > LONGEST_WORD {
        return;
    }
    let Ok(curve) = closed_braid(&word) else {
        return;
    };
    assert_eq!(n, 1, "a link passed for a knot");
    let invariants = |word: &[i32]| {
        let curve = closed_braid(word).expect("a knot");
        Invariants::of(curve.vertices()).expect("in general position")
    };
    let own = Invariants::of(curve.vertices()).expect("in general position");
    // The mirror image, and the word begun at its second letter.
    let mirrored: Vec<i32> = word.iter().map(|g| -g).collect();
    assert_eq!(invariants(&mirrored), own.mirror());
    let turned = [&word[1..], &word[..1]].concat();
    assert_eq!(invariants(&turned), own);
}

/// Curves, snapshots and natural shapes as comma-separated values.
pub fn csv(data: &[u8]) {
    curve(data, CurveFormat::Csv);
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    if let Ok(profile) = RestProfile::parse(text, ["twist"]) {
        let [first, middle, last] = [-1.0, 0.3, 2.0].map(|s| profile.at(s)[0]);
        let miss = (first - last).abs();
        assert!(middle.is_finite() && miss <= 1e-9 * first.abs().max(last.abs()).max(1.0));
    }
    if let Ok(snapshot) = Snapshot::parse(named(), text) {
        // A header may repeat or leave out names; such a table is read but cannot be written.
        if let Ok(written) = snapshot.text(named()) {
            same(
                &Snapshot::parse(named(), &written).expect("a table"),
                &snapshot,
            );
        }
    }
}

/// Curves as XYZ.
pub fn xyz(data: &[u8]) {
    curve(data, CurveFormat::Xyz);
}

/// Curves as VECT.
pub fn vect(data: &[u8]) {
    curve(data, CurveFormat::Vect);
}

fn curve(data: &[u8], format: CurveFormat) {
    drop(parse_components(named(), data, format));
    let Ok(file) = CurveFile::parse(named(), data, format, FrameChoice::Last) else {
        return;
    };
    spelt_otherwise(data, format, &file);
    for component in file.components {
        let closed = component.closed.unwrap_or(false);
        let Ok(curve) = Polyline::new(component.vertices, closed) else {
            continue;
        };
        let written = curve_text(&curve, format);
        let again = parse_components(named(), &written, format).expect("what was written");
        assert_eq!(again.len(), 1);
        same(&again[0].vertices, &curve.vertices());
        if format == CurveFormat::Vect {
            assert_eq!(again[0].closed, Some(closed));
        }
    }
}

/// The same text with other ends of lines, a byte-order mark or in UTF-16 holds the same curve.
fn spelt_otherwise(data: &[u8], format: CurveFormat, file: &CurveFile) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    if text.starts_with('\u{feff}') || text.contains('\r') {
        return;
    }
    let utf16 = text.encode_utf16().flat_map(u16::to_be_bytes);
    for variant in [
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        format!("\u{feff}{text}").into_bytes(),
        [0xfe, 0xff].into_iter().chain(utf16).collect(),
    ] {
        let again = CurveFile::parse(named(), &variant, format, FrameChoice::Last);
        let again = again.expect("the same text");
        same(&again.components, &file.components);
        same(&again.frame, &file.frame);
    }
}

/// Tables of results.
pub fn table(data: &[u8]) {
    rows::<SweepRow>(data);
    rows::<NematicRow>(data);
    rows::<KnotRow>(data);
}

fn rows<T: Debug + Serialize + DeserializeOwned>(data: &[u8]) {
    let Ok(rows) = parse_table::<T>(named(), data) else {
        return;
    };
    if !rows.is_empty() {
        let bytes = table_bytes(named(), &rows).expect("written");
        same(&parse_table::<T>(named(), &bytes).expect("a table"), &rows);
    }
}

/// Checkpoints: the bytes as a file, and as what a sound file holds.
pub fn checkpoint(data: &[u8]) {
    typed::<(Polyline, DischargeCurve, Ledger)>(data, "core/1");
    typed::<(StepControl, Counters, RejectionCounts)>(data, "control/1");
    typed::<TightKnot>(data, "tight-knot/1");
    if let Ok(file) = checkpoint_bytes(named(), "nematic-field/1", &Raw(data)) {
        drop(FieldSnapshot::parse(named(), &file));
    }
}

/// Reads bytes as a checkpoint of a type, directly and below a sound head and digest.
fn typed<T: Debug + Serialize + DeserializeOwned>(data: &[u8], schema: &str) {
    if parse_checkpoint::<T>(named(), data, schema).is_ok() {
        let mut flipped = data.to_vec();
        let middle = flipped.len() / 2;
        flipped[middle] ^= 1;
        assert!(parse_checkpoint::<T>(named(), &flipped, schema).is_err());
    }
    let file = checkpoint_bytes(named(), schema, &Raw(data)).expect("encoded");
    if let Ok(value) = parse_checkpoint::<T>(named(), &file, schema) {
        let again = checkpoint_bytes(named(), schema, &value).expect("encoded");
        let back: T = parse_checkpoint(named(), &again, schema).expect("a checkpoint");
        same(&back, &value);
    }
}

/// Bytes that stand for a value already encoded.
struct Raw<'a>(&'a [u8]);

impl Serialize for Raw<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeTuple;
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        for byte in self.0 {
            tuple.serialize_element(byte)?;
        }
        tuple.end()
    }
}

/// Inputs of [`checkpoint`] that are sound, with names.
pub fn checkpoint_payloads() -> Vec<(&'static str, Vec<u8>)> {
    let payload = |value: Vec<u8>, schema: &str| {
        let head = HEAD + schema.len() + 8;
        value[head..value.len() - DIGEST].to_vec()
    };
    let corner = |x, y, z| Vector3::new(x, y, z);
    let curve = Polyline::new(
        vec![
            corner(0.0, 0.0, 0.0),
            corner(1.0, 0.0, 0.0),
            corner(0.0, 2.0, 1e-3),
        ],
        true,
    );
    let curve = curve.expect("a triangle");
    let mut released = DischargeCurve::new(["bend", "twist"], ["viscous"]);
    released.push(0.0, &[1.0, 0.5], &[0.0]).expect("a sample");
    released.push(0.5, &[0.5, 0.25], &[0.75]).expect("a sample");
    let mut ledger = Ledger::new(&["bend", "twist"], &["viscous"]);
    ledger.set_stored(&[1.0, 0.5]);
    ledger.dissipate(0, 0.25);
    ledger.record_event("cut", 0.1, 0.125);
    let mut control = StepControl::new(1e-3, 0.1).expect("a control");
    control.accept(0.1, 5e-4, 3);
    let (counters, rejected) = (Counters::default(), RejectionCounts::default());
    let core = checkpoint_bytes(named(), "core/1", &(curve, released, ledger));
    let steps = checkpoint_bytes(named(), "control/1", &(control, counters, rejected));
    let (core, steps) = (core.expect("encoded"), steps.expect("encoded"));
    vec![
        ("core", payload(core.clone(), "core/1")),
        ("control", payload(steps, "control/1")),
        ("file", core),
    ]
}

/// Bytes of a checkpoint before the name of its schema: magic word, format, the name's length.
const HEAD: usize = 8 + 4 + 2;
/// Bytes of the digest at its end.
const DIGEST: usize = 32;
