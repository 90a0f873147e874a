use std::path::Path;

use super::KeyRow;
use crate::battery::{Battery, parse_scene};
use crate::elastic::ROD_KEYS;
use crate::nematic::COLLOID_KEYS;
use crate::{Colloid, Elastic};

const BATTERIES: [&dyn Battery; 2] = [&Elastic, &Colloid];

/// Scenes that keys are put into.
const BASES: [&str; 2] = [
    "[rod]\nknot = \"3_1\"\ntwist = 1.0\n[rod.contact]\n[rod.friction]\n",
    "[nematic]\nradius = 15\n",
];

/// What a key needs beside it, and what it stands in the place of.
const BESIDE: &[(&str, &str)] = &[
    ("accuracy.gamma", "accuracy.integrator = \"ros2w\""),
    (
        "discharge.ends.motions",
        "discharge.ends.conditions = [\"clamped\", \"clamped\"]",
    ),
    (
        "discharge.ends.motions.velocity",
        "discharge.ends.conditions = [\"pinned\", \"free\"]",
    ),
    (
        "discharge.ends.motions.rotation_rate",
        "discharge.ends.conditions = [\"clamped\", \"free\"]",
    ),
    (
        "discharge.ends.motions.force",
        "discharge.ends.conditions = [\"free\", \"clamped\"]",
    ),
    (
        "discharge.ends.motions.torque",
        "discharge.ends.conditions = [\"free\", \"clamped\"]",
    ),
    (
        "discharge.load.between",
        "discharge.ends.conditions = [\"clamped\", \"free\"]",
    ),
    ("discharge.load.between", "discharge.load.dashpot = 1.0"),
    ("discharge.load.spring", "discharge.load.dashpot = 1.0"),
    ("discharge.load.dashpot", "discharge.load.spring = 1.0"),
    ("discharge.load.rest_length", "discharge.load.spring = 1.0"),
    (
        "discharge.load.direction",
        "discharge.ends.conditions = [\"clamped\", \"free\"]",
    ),
    ("discharge.load.direction", "discharge.load.spring = 1.0"),
    (
        "discharge.load.direction",
        "discharge.load.rest_length = 1.0",
    ),
    (
        "discharge.load.direction",
        "discharge.load.between = \"last\"",
    ),
    ("pull.duration", "pull.grips = [{}, {}]"),
    ("pull.outputs", "pull.grips = [{}, {}]"),
    ("pull.outputs", "pull.duration = 2.0"),
    ("pull.grips", "pull.duration = 2.0"),
    ("charge.twisting.torque", "charge.twisting.over = 5.0"),
    ("charge.twisting.torque.to", "charge.twisting.over = 5.0"),
    ("charge.twisting.torque.over", "charge.twisting.over = 5.0"),
    ("charge.break.criterion", "charge.break.threshold = 0.8"),
    (
        "charge.break.threshold",
        "charge.break.criterion = \"energy\"",
    ),
    ("si.radius", "si.bending_modulus = 1e7"),
    ("si.radius", "si.viscosity = 1e4"),
    ("si.bending_modulus", "si.radius = 1e-3"),
    ("si.bending_modulus", "si.viscosity = 1e4"),
    ("si.viscosity", "si.radius = 1e-3"),
    ("si.viscosity", "si.bending_modulus = 1e7"),
    ("si.density", "si.radius = 1e-3"),
    ("si.density", "si.bending_modulus = 1e7"),
    ("si.density", "si.viscosity = 1e4"),
    ("nematic.particle", "switch.to = \"keep\""),
    ("material.flow_alignment", "flow = {}"),
    ("material.viscosity", "flow = {}"),
    ("nematic.field.vector", "nematic.field.anisotropy = 1.0"),
    (
        "nematic.field.anisotropy",
        "nematic.field.vector = [0, 0, 1]",
    ),
    ("flow.q", "nematic.q = [2, 3]"),
    ("flow.solver_tolerance", "flow.solver = \"sparse\""),
    ("flow.drive.mean_velocity", "nematic.periodic = true"),
];

/// A scene with a line of a table, given as the text of a file with dotted keys.
fn with(base: &str, key: &str, table: &str, line: &str) -> String {
    let mut scene: toml::Table = toml::from_str(base).unwrap();
    let beside = BESIDE
        .iter()
        .filter(|(of, _)| *of == key)
        .map(|(_, line)| ("", *line));
    for (table, line) in beside.chain([(table, line)]) {
        let dotted = match table {
            "" => line.to_owned(),
            table => format!("{table}.{line}"),
        };
        merge(
            &mut scene,
            toml::from_str(&dotted).unwrap_or_else(|e| panic!("{dotted}: {e}")),
        );
    }
    if key.starts_with("pull.") {
        crate::scene::remove("rod.knot", &mut scene);
        merge(
            &mut scene,
            toml::from_str("rod.curve = \"open.csv\"").unwrap(),
        );
    }
    // what is tied is said once
    if ["rod.link", "rod.braid", "rod.curve"].contains(&key) {
        crate::scene::remove("rod.knot", &mut scene);
    }
    toml::to_string(&scene).unwrap()
}

fn merge(into: &mut toml::Table, more: toml::Table) {
    for (key, value) in more {
        match (into.get_mut(&key), value) {
            (Some(toml::Value::Table(inner)), toml::Value::Table(more)) => merge(inner, more),
            (_, value) => {
                into.insert(key, value);
            }
        }
    }
}

fn rows(battery: &dyn Battery) -> Vec<KeyRow> {
    battery.keys().unwrap().rows()
}

fn parsed(text: &str) -> Result<String, String> {
    let scene = parse_scene(&BATTERIES, text, Path::new("s.toml"));
    scene.map(|s| format!("{s:?}")).map_err(|e| e.to_string())
}

#[test]
fn examples_and_defaults_of_the_reference_are_what_it_says() {
    for (battery, base) in BATTERIES.into_iter().zip(BASES) {
        let mut n_defaults = 0;
        for row in rows(battery) {
            let key = row.key();
            // what a grip does, it does together with its condition: the example of the whole shows it
            if key.starts_with("pull.grips.") {
                continue;
            }
            let text = with(base, &key, &row.table, &row.example);
            let example = parsed(&text).unwrap_or_else(|e| panic!("{key}: {e}"));
            // what stands in a form has no default of its own
            if !row.has_default || row.name.contains('.') {
                continue;
            }
            // what is left out is as if the default were written
            // the table itself may say that something is modelled
            let line = match row.table.as_str() {
                "" => String::new(),
                table => format!("{table} = {{}}"),
            };
            let mut bare: toml::Table = toml::from_str(&with(base, &key, "", &line)).unwrap();
            crate::scene::remove(&key, &mut bare);
            let bare = toml::to_string(&bare).unwrap();
            let line = format!("{} = {}", row.name, row.default);
            match parsed(&with(base, &key, &row.table, &line)) {
                Ok(written) => assert_eq!(parsed(&bare).unwrap(), written, "{key}"),
                Err(e) => assert!(e.contains("changes nothing"), "{key}: {e}"),
            }
            assert_ne!(
                parsed(&bare),
                Ok(example),
                "the example of {key} is the default"
            );
            n_defaults += 1;
        }
        assert!(n_defaults > 10);
    }
}

/// Least and largest of a range are taken by those who check, and what lies beyond is refused.
#[test]
fn ranges_of_the_reference_are_those_that_are_checked() {
    let mut n = 0;
    for (battery, base) in BATTERIES.into_iter().zip(BASES) {
        for row in rows(battery).iter().filter(|row| !row.name.contains('.')) {
            let schema = battery.keys().unwrap().schema();
            let parts = row.key().replace('.', "/properties/");
            let Some(node) = schema.pointer(&format!("/properties/{parts}")) else {
                continue;
            };
            let kinds = super::alternatives(node);
            let Some(kind) = kinds.into_iter().find(|kind| super::is(kind, "number")) else {
                continue;
            };
            for (bound, outside) in [
                ("minimum", -1.0),
                ("exclusiveMinimum", 0.0),
                ("maximum", 1.0),
            ] {
                let Some(limit) = kind.get(bound).and_then(serde_json::Value::as_f64) else {
                    continue;
                };
                let beyond = limit + outside * (1e-9 * limit.abs() + 1e-12);
                let line = format!("{} = {beyond:?}", row.name);
                let refused = parsed(&with(base, &row.key(), &row.table, &line));
                assert!(refused.is_err(), "{} = {beyond} is taken", row.key());
                n += 1;
            }
            for (bound, inside) in [("minimum", 0.0), ("maximum", 0.0)] {
                let Some(limit) = kind.get(bound).and_then(serde_json::Value::as_f64) else {
                    continue;
                };
                let line = format!("{} = {:?}", row.name, limit + inside);
                match parsed(&with(base, &row.key(), &row.table, &line)) {
                    Ok(_) => {}
                    Err(e) => println!("{} = {limit}: {e}", row.key()),
                }
            }
        }
    }
    assert!(n > 20, "{n}");
}

#[test]
fn every_key_that_may_have_several_values_is_in_the_reference() {
    let rods = ROD_KEYS
        .iter()
        .map(|key| (&Elastic as &dyn Battery, key.key));
    let colloids = COLLOID_KEYS
        .iter()
        .map(|key| (&Colloid as &dyn Battery, key.key));
    for (battery, key) in rods.chain(colloids) {
        let row = rows(battery).into_iter().find(|row| row.key() == key);
        let row = row.unwrap_or_else(|| panic!("{key} is not in the reference"));
        assert!(row.is_several, "{key}");
    }
}

#[test]
fn every_key_has_a_meaning_and_every_number_a_unit() {
    for row in BATTERIES.into_iter().flat_map(rows) {
        let key = row.key();
        let is_inner = row.name.contains('.');
        assert!(is_inner || !row.meaning.is_empty(), "{key} means nothing");
        let is_number = row.forms.contains("number");
        assert!(
            !is_number || !row.unit.is_empty() || row.forms.contains('{'),
            "{key} has no unit"
        );
        assert!(
            row.has_default || row.is_required || is_inner || !row.default.is_empty(),
            "{key} left out"
        );
    }
}

#[test]
fn scenes_to_begin_with_say_what_they_leave_out() {
    for (battery, _) in BATTERIES.into_iter().zip(BASES) {
        let text = battery.keys().unwrap().new_scene(battery.first_scene());
        println!("{text}");
        let scene = parsed(&text).unwrap_or_else(|e| panic!("{e}"));
        let keys: Vec<String> = battery
            .first_scene()
            .iter()
            .map(|(k, v)| format!("{k} = {v}"))
            .collect();
        assert_eq!(scene, parsed(&keys.join("\n")).unwrap());
        for row in rows(battery).iter().filter(|row| !row.name.contains('.')) {
            let line = format!("{} = ", row.name);
            assert!(
                text.lines()
                    .any(|l| l.trim_start_matches("# ").starts_with(&line)),
                "{line}"
            );
        }
    }
}

#[test]
fn the_shipped_scenes_fit_their_keys() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path());
    let mut n = 0;
    for path in files.filter(|p| p.extension().is_some_and(|e| e == "toml")) {
        assert_eq!(
            crate::scene_faults(&BATTERIES, &path).unwrap(),
            [],
            "{}",
            path.display()
        );
        n += 1;
    }
    assert!(n >= 9, "{n}");
}
