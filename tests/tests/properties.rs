//! Properties of what is read and written: scenes, braids, curves, checkpoints.

use std::fmt::Write as _;
use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use topo_core::{FileError, Interrupt, Polyline, checkpoint_bytes, parse_checkpoint};
use topo_knots::{
    CurveFormat, Handedness, KnotTable, KnotType, V, closed_braid, curve_text, identify,
    parse_braid, parse_components,
};
use topo_lab::{ElasticScene, NematicScene};
use topo_nematic::{
    ChargeSettings, NematicAccuracy, NematicBattery, NematicError, NematicParameters, RunHooks,
};

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(6),
        ..ProptestConfig::default()
    }
}

fn named() -> &'static Path {
    Path::new("scene.toml")
}

/// A value of any kind that TOML knows.
fn any_value() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<i64>().prop_map(|x| x.to_string()),
        any::<f64>().prop_map(toml_number),
        any::<bool>().prop_map(|x| x.to_string()),
        "[a-z0-9:_-]{0,8}".prop_map(|x| format!("\"{x}\"")),
        prop::collection::vec(-3.0..9.0_f64, 0..4).prop_map(|x| format!("{x:?}")),
        (any::<i64>(), any::<i64>())
            .prop_map(|(a, b)| format!("{{ from = {a}, to = 2.0, n = {b} }}")),
        Just("{}".to_owned()),
    ]
}

fn toml_number(x: f64) -> String {
    if x.is_finite() {
        format!("{x:?}")
    } else if x.is_nan() {
        "nan".to_owned()
    } else {
        if x > 0.0 { "inf" } else { "-inf" }.to_owned()
    }
}

/// Keys of scenes by table, known ones and one that nobody knows.
const ROD_KEYS: [(&str, &[&str]); 6] = [
    (
        "rod",
        &[
            "knot",
            "slenderness",
            "reading",
            "twist",
            "poisson_ratio",
            "stretch_ratio",
            "imperfection",
            "seed",
            "wrong_key",
        ],
    ),
    ("rod.contact", &["stiffness", "wrong_key"]),
    ("rod.friction", &["ratio", "range", "wrong_key"]),
    ("charge", &["duration", "wrong_key"]),
    (
        "discharge",
        &[
            "cuts",
            "until_released",
            "longest",
            "closures",
            "ends",
            "wrong_key",
        ],
    ),
    (
        "accuracy",
        &[
            "preset",
            "edges",
            "tolerance",
            "gamma",
            "integrator",
            "reuse",
            "max_steps",
            "wrong_key",
        ],
    ),
];
const COLLOID_KEYS: [(&str, &[&str]); 7] = [
    (
        "nematic",
        &[
            "q",
            "radius",
            "spacing",
            "cell",
            "cells",
            "particle",
            "pattern",
            "anchoring",
            "boundary",
            "plates",
            "sides",
            "field",
            "wrong_key",
        ],
    ),
    (
        "material",
        &[
            "a",
            "b",
            "c",
            "elastic_constant",
            "second_elastic_constant",
            "viscosity",
            "surface_order",
            "wrong_key",
        ],
    ),
    (
        "charge",
        &[
            "seeds",
            "tolerance",
            "max_steps",
            "coarse_start",
            "wrong_key",
        ],
    ),
    ("switch", &["to", "ramp", "wrong_key"]),
    (
        "discharge",
        &["until_released", "longest", "flow", "wrong_key"],
    ),
    (
        "flow",
        &[
            "q",
            "every",
            "boundary_residual",
            "solver",
            "memory_limit",
            "wrong_key",
        ],
    ),
    (
        "accuracy",
        &[
            "tolerance",
            "precision",
            "threads",
            "max_steps",
            "memory_limit",
            "wrong_key",
        ],
    ),
];

/// A scene of up to three keys with any values beside what it must have.
fn any_scene(
    keys: &'static [(&'static str, &'static [&'static str])],
    needed: (&'static str, &'static str),
) -> impl Strategy<Value = String> {
    let key = (0..keys.len()).prop_flat_map(move |t| (Just(t), 0..keys[t].1.len(), any_value()));
    prop::collection::vec(key, 0..4).prop_map(move |chosen| {
        let mut text = String::new();
        for (t, (table, names)) in keys.iter().enumerate() {
            let mine: Vec<_> = chosen.iter().filter(|c| c.0 == t).collect();
            if mine.is_empty() && *table != needed.0 {
                continue;
            }
            let _ = writeln!(text, "[{table}]");
            let mut done: Vec<&str> = Vec::new();
            for (_, k, value) in mine {
                if !done.contains(&names[*k]) {
                    let _ = writeln!(text, "{} = {value}", names[*k]);
                    done.push(names[*k]);
                }
            }
            if *table == needed.0 && !done.iter().any(|d| needed.1.starts_with(d)) {
                let _ = writeln!(text, "{}", needed.1);
            }
        }
        text
    })
}

/// What a reader said of a text: the same scene again, or the key at fault.
fn judge<E: std::fmt::Display>(
    text: &str,
    read: Result<String, E>,
    again: impl Fn(&str) -> Result<String, E>,
) -> Result<(), TestCaseError> {
    match read {
        Ok(written) => {
            prop_assert!(!text.contains("wrong_key"), "{text}");
            let second = again(&written);
            prop_assert_eq!(second.map_err(|e| e.to_string()), Ok(written));
        }
        Err(error) => {
            let message = error.to_string();
            // Dashes and underlines are one to whoever looks for a key.
            let keys: Vec<String> = text
                .lines()
                .filter_map(|line| line.split_once(" = "))
                .map(|(key, _)| key.replace('_', "-"))
                .collect();
            let plain = message.replace('_', "-");
            // Several keys decide together whether there is a nematic phase, and how fine the grid must be.
            let derived = ["spacing", "nematic phase"];
            prop_assert!(
                keys.iter().any(|key| plain.contains(key.as_str()))
                    || derived.iter().any(|word| plain.contains(word)),
                "{text}\n{message}"
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(1500))]

    #[test]
    fn elastic_scenes_come_back_as_written(text in any_scene(&ROD_KEYS, ("rod", "knot = \"3_1\""))) {
        let read = |text: &str| ElasticScene::parse(text, named()).map(|scene| scene.text());
        judge(&text, read(&text), read)?;
        if let Ok(scene) = ElasticScene::parse(&text, named()) {
            let again = ElasticScene::parse(&scene.text(), named());
            prop_assert_eq!(again.map_err(|e| e.to_string()), Ok(scene));
        }
    }

    #[test]
    fn nematic_scenes_come_back_as_written(text in any_scene(&COLLOID_KEYS, ("nematic", "radius = 15.0"))) {
        let read = |text: &str| NematicScene::parse(text, named()).map(|scene| scene.text());
        judge(&text, read(&text), read)?;
    }

    #[test]
    fn poisson_ratios_come_back(ratio in -0.999..0.5_f64) {
        let scene = ElasticScene::parse(&format!("[rod]\nknot = \"3_1\"\ntwist = 1.0\npoisson_ratio = {ratio:?}"), named()).unwrap();
        let again = ElasticScene::parse(&scene.text(), named()).unwrap();
        prop_assert_eq!(again.rod.twist_ratio.to_bits(), scene.rod.twist_ratio.to_bits());
    }
}

/// A word of up to so many letters on up to four strands whose closure may be a knot.
fn word(longest: usize) -> impl Strategy<Value = Vec<i32>> {
    prop::collection::vec(prop_oneof![1..4_i32, -3..0_i32], 1..longest)
}

fn kind_of(word: &[i32], table: &KnotTable) -> KnotType {
    let curve = closed_braid(word).expect("a knot");
    identify(curve.vertices(), table).expect("in general position")
}

proptest! {
    #![proptest_config(config(120))]

    #[test]
    fn braids_keep_their_knot(word in word(9), turn in 0..8_usize, by in 1..4_i32) {
        let spelled: Vec<String> = word.iter().map(i32::to_string).collect();
        prop_assert_eq!(&parse_braid(&spelled.join(", ")).unwrap(), &word);
        prop_assume!(closed_braid(&word).is_ok());
        let table = KnotTable::builtin();
        let kind = kind_of(&word, &table);
        // Begun at another letter, and conjugated by one that the word has.
        let mut turned = word.clone();
        turned.rotate_left(turn % word.len());
        let by = by.min(word.iter().map(|g| g.abs()).max().unwrap_or(1));
        let conjugated = [&[by], &word[..], &[-by]].concat();
        for other in [turned, conjugated] {
            let other = kind_of(&other, &table);
            prop_assert_eq!(&other.invariants, &kind.invariants);
            prop_assert_eq!(other.label(), kind.label());
        }
        let mirrored: Vec<i32> = word.iter().map(|g| -g).collect();
        let mirrored = kind_of(&mirrored, &table);
        prop_assert_eq!(&mirrored.invariants, &kind.invariants.mirror());
        prop_assert_eq!(mirrored.types(), kind.types());
        prop_assert_eq!(mirrored.handedness, opposite(kind.handedness));
    }
}

fn opposite(handedness: Handedness) -> Handedness {
    match handedness {
        Handedness::Tabulated => Handedness::Mirrored,
        Handedness::Mirrored => Handedness::Tabulated,
        other => other,
    }
}

/// Any finite number, from the smallest to the largest.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        -10.0..10.0_f64,
        prop::num::f64::NORMAL.prop_map(|x| x % 1e100)
    ]
}

fn points(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<V>> {
    let point = (coordinate(), coordinate(), coordinate());
    prop::collection::vec(point.prop_map(|(x, y, z)| V::new(x, y, z)), n)
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn curves_come_back_to_the_bit(points in points(4..30), closed: bool) {
        let curve = Polyline::new(points, closed);
        prop_assume!(curve.is_ok());
        let curve = curve.unwrap();
        for format in [CurveFormat::Csv, CurveFormat::Xyz, CurveFormat::Vect] {
            let text = curve_text(&curve, format);
            let back = parse_components(named(), &text, format).unwrap();
            prop_assert_eq!(back.len(), 1);
            let bits = |v: &[V]| v.iter().flat_map(|x| [x.x, x.y, x.z]).map(f64::to_bits).collect::<Vec<_>>();
            prop_assert_eq!(bits(&back[0].vertices), bits(curve.vertices()));
            if format == CurveFormat::Vect {
                prop_assert_eq!(back[0].closed, Some(closed));
            }
        }
    }

    /// Other ends of lines, a byte-order mark and UTF-16 change no bit of a curve.
    #[test]
    fn curves_do_not_depend_on_the_encoding(points in points(4..30), end in prop_oneof!["\r\n", "\r", "\n"]) {
        let curve = Polyline::new(points, true);
        prop_assume!(curve.is_ok());
        let curve = curve.unwrap();
        for format in [CurveFormat::Csv, CurveFormat::Xyz, CurveFormat::Vect] {
            let text = format!("\u{feff}{}", curve_text(&curve, format).replace('\n', &end));
            let utf16 = |bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
            for bytes in [text.clone().into_bytes(), utf16(u16::to_le_bytes), utf16(u16::to_be_bytes)] {
                let back = parse_components(named(), &bytes, format).unwrap();
                let bits = |v: &[V]| v.iter().flat_map(|x| [x.x, x.y, x.z]).map(f64::to_bits).collect::<Vec<_>>();
                prop_assert_eq!(bits(&back[0].vertices), bits(curve.vertices()));
            }
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "[VECT0-9 .,\\-ex#yz\n]{0,60}") {
        for format in [CurveFormat::Csv, CurveFormat::Xyz, CurveFormat::Vect] {
            if let Err(error) = parse_components(named(), &text, format) {
                prop_assert!(!error.to_string().is_empty());
            }
        }
    }
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn names_do_not_depend_on_the_view(
        raw in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 8..30),
        (roll, pitch, yaw) in (-3.0..3.0_f64, -1.5..1.5_f64, -3.0..3.0_f64),
        size in 0.01..100.0_f64,
        first in 0..8_usize,
    ) {
        let table = KnotTable::builtin();
        let x: Vec<V> = raw.into_iter().map(V::from).collect();
        let kind = identify(&x, &table).expect("in general position");
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
        let mut moved: Vec<V> = x.iter().map(|x| turn * x * size + Vector3::new(5.0, -3.0, 1.0)).collect();
        moved.rotate_left(first);
        let seen = identify(&moved, &table).expect("in general position");
        prop_assert_eq!(&seen.invariants, &kind.invariants);
        prop_assert_eq!((seen.types(), seen.handedness), (kind.types(), kind.handedness));
        moved.reverse();
        let back = identify(&moved, &table).expect("in general position");
        prop_assert_eq!(&back.invariants, &kind.invariants);
        let mirrored: Vec<V> = x.iter().map(|x| V::new(x.x, x.y, -x.z)).collect();
        let mirrored = identify(&mirrored, &table).expect("in general position");
        prop_assert_eq!(&mirrored.invariants, &kind.invariants.mirror());
        prop_assert_eq!((mirrored.types(), mirrored.handedness), (kind.types(), opposite(kind.handedness)));
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn broken_checkpoints_are_refused(
        numbers in prop::collection::vec(any::<f64>(), 0..40),
        text in ".{0,20}",
        at: prop::sample::Index,
        flip in 1..=255_u8,
    ) {
        let value = (numbers, text);
        let sound = checkpoint_bytes(named(), "pair/1", &value).unwrap();
        let back: (Vec<f64>, String) = parse_checkpoint(named(), &sound, "pair/1").unwrap();
        let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!((bits(&back.0), &back.1), (bits(&value.0), &value.1));
        let at = at.index(sound.len());
        let read = |bytes: &[u8]| parse_checkpoint::<(Vec<f64>, String)>(named(), bytes, "pair/1");
        let mut broken = sound.clone();
        broken[at] ^= flip;
        prop_assert!(read(&broken).is_err(), "byte {}", at);
        prop_assert!(read(&sound[..at]).is_err(), "cut at {}", at);
    }
}

/// A charge that is interrupted, its checkpoint broken at one byte: it is refused, and never gone on from.
#[test]
fn broken_checkpoints_of_a_nematic_are_refused() {
    let parameters = NematicParameters {
        particle: false,
        cells: Some([4, 4, 4]),
        ..NematicParameters::default()
    };
    let battery = NematicBattery::new(&parameters, &NematicAccuracy::default()).unwrap();
    let settings = ChargeSettings {
        max_steps: 40,
        ..ChargeSettings::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("charge.checkpoint");
    let charge = |interrupt: &Interrupt| {
        let mut hooks = RunHooks::new(interrupt).with_checkpoint(&path, 1e9);
        battery.charge(&settings, &mut hooks)
    };
    let whole = charge(&Interrupt::new()).unwrap();
    std::fs::remove_file(&path).unwrap();
    let stopped = Interrupt::new();
    stopped.request();
    charge(&stopped).unwrap();
    let sound = std::fs::read(&path).unwrap();
    for k in 0..200 {
        let at = k * sound.len() / 200;
        let mut broken = sound.clone();
        broken[at] ^= 1 << (k % 8);
        for bytes in [&broken[..], &sound[..at]] {
            std::fs::write(&path, bytes).unwrap();
            let refused = charge(&Interrupt::new()).map(|charged| charged.report().n_steps);
            let named = matches!(
                refused,
                Err(NematicError::File(
                    FileError::Corrupt { .. }
                        | FileError::Truncated { .. }
                        | FileError::NotACheckpoint { .. }
                        | FileError::Version { .. }
                ))
            );
            assert!(named, "byte {at}: {refused:?}");
        }
    }
    std::fs::write(&path, &sound).unwrap();
    let resumed = charge(&Interrupt::new()).unwrap();
    assert_eq!(resumed.state(), whole.state());
    assert_eq!(resumed.report().n_steps, whole.report().n_steps);
}
