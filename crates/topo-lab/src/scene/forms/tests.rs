use std::path::Path;

use crate::battery::{Battery, parse_scene, scene_faults};
use crate::{Colloid, Elastic};

const BATTERIES: [&dyn Battery; 2] = [&Elastic, &Colloid];
const ROD: &str = "[rod]\nknot = \"3_1\"\n";
const COLLOID: &str = "[nematic]\nradius = 15\n";
const NUMBERS: &str = "a list of numbers or { from = 1, to = 2, n = 3 }";

/// What is wrong: the scene that has it, the lines with it, what is marked in the last of them, and words of the answer.
type Wrong = (
    &'static str,
    &'static str,
    &'static str,
    &'static [&'static str],
);

#[rustfmt::skip] // a line each
const WRONG: &[Wrong] = &[
    // another type
    (COLLOID, "anchoring = 0.5", "0.5", &["nematic.anchoring = 0.5", "\"strong\"", "{ weak = 1.0 }", "\"free\""]),
    (ROD, "twist = \"2\"", "\"2\"", &["rod.twist = \"2\"", "without quotes: 2", NUMBERS]),
    (ROD, "slenderness = \"long\"", "\"long\"", &["rod.slenderness", "a number above 0", NUMBERS]),
    (ROD, "slenderness = [50, \"a\"]", "\"a\"", &["rod.slenderness = \"a\"", "write a number"]),
    (ROD, "twist = 2024-01-01", "2024-01-01", &["rod.twist", NUMBERS]),
    (ROD, "reading = 2", "2", &["rod.reading = 2", "\"shrunk\"", "\"own-length\""]),
    (ROD, "seed = 1.5", "1.5", &["rod.seed = 1.5", "a whole number"]),
    (ROD, "[accuracy]\nedges = 100.0", "100.0", &["accuracy.edges = 100.0", "write 100 without a point"]),
    (ROD, "[rod.friction]\nrange = 1.1", "1.1", &["rod.friction.range", "{ times-contact = 1.1 }", "\"contact\""]),
    (ROD, "[discharge]\ncuts = true", "true", &["discharge.cuts", "\"argmax\"", "\"all:K\"", "from 0 to below 1"]),
    (ROD, "[discharge.ends]\nconditions = \"clamped\"", "\"clamped\"", &["a list of 2", "[\"clamped\", \"free\"]"]),
    (ROD, "[discharge.ends]\nmotions = {}", "{}", &["discharge.ends.motions", "a list of 2"]),
    (COLLOID, "particle = \"yes\"", "\"yes\"", &["nematic.particle", "true or false"]),
    (COLLOID, "particle = \"true\"", "\"true\"", &["nematic.particle", "without quotes"]),
    (COLLOID, "q = \"two\"", "\"two\"", &["nematic.q", "a whole number from 1 to 10000", NUMBERS]),
    (COLLOID, "cells = [60.0, 60, 50]", "60.0", &["nematic.cells = 60.0", "write 60 without a point"]),
    (COLLOID, "cells = 60", "60", &["nematic.cells = 60", "a list of 3 whole numbers, such as [60, 60, 50]"]),
    (COLLOID, "cell = [6, 6]", "[6, 6]", &["nematic.cell", "a list of 3 numbers"]),
    (COLLOID, "[switch]\nramp = \"1 s\"", "\"1 s\"", &["switch.ramp", "a number above 0"]),
    (COLLOID, "[charge]\nseeds = []", "[]", &["charge.seeds = []", "one value or more"]),
    (COLLOID, "[charge]\nseeds = 0.05", "0.05", &["charge.seeds", "[0.05]"]),
    ("", "[rod]\nknot = 3", "3", &["rod.knot = 3", "a text in quotes such as \"3_1\""]),
    ("budget = 600\n", "[rod]\nknot = \"3_1\"", "", &["line 1: budget = 600", "such as \"10 min\""]),
    ("accuracy = \"good\"\n", "[rod]\nknot = \"3_1\"", "", &["line 1: accuracy = \"good\"", "a number above 0 and up to 1"]),
    // a value instead of a table, and the reverse
    (ROD, "contact = true", "true", &["rod.contact = true", "[rod.contact] on a line of its own"]),
    (ROD, "contact = 20", "20", &["rod.contact = 20", "{ stiffness = 50.0 }"]),
    (ROD, "friction = false", "false", &["rod.friction", "leave the table out"]),
    (COLLOID, "field = [0, 0, 0.1]", "[0, 0, 0.1]", &["nematic.field", "{ vector = [0.0, 0.0, 0.1], anisotropy = 1.0 }"]),
    (COLLOID, "plates = [0, 0, 1]", "[0, 0, 1]", &["nematic.plates", "`director` and `anchoring`"]),
    (COLLOID, "[flow]\ndrive = [1, 0, 0]", "[1, 0, 0]", &["flow.drive", "`body_force`"]),
    (COLLOID, "radius = { value = 15 }", "radius", &["twice"]),
    (COLLOID, "spacing = { value = 1.5 }", "{ value = 1.5 }", &["nematic.spacing", NUMBERS]),
    (COLLOID, "pattern = { planar = [0, 0, 1] }", "[0, 0, 1]", &["nematic.pattern.planar", "{ axis = [0.0, 0.0, 1.0] }"]),
    ("", "rod = 3", "3", &["rod = 3", "[rod] on a line of its own"]),
    ("", "[[rod]]", "[[rod]]", &["rod =", "[rod] on a line of its own"]),
    // forms with a part too few or too many
    (ROD, "twist = { from = 0, to = 1, step = 0.5 }", "{ from = 0, to = 1, step = 0.5 }", &["`step` is not known and `n` is missing", NUMBERS]),
    (ROD, "twist = { start = 0, stop = 1, num = 5 }", "{ start = 0, stop = 1, num = 5 }", &["rod.twist", NUMBERS]),
    (ROD, "twist = { from = 0, to = 1, n = 2.5 }", "2.5", &["rod.twist.n = 2.5", "a whole number from 1 to 100000"]),
    (ROD, "twist = { from = \"a\", to = 1, n = 2 }", "\"a\"", &["rod.twist.from = \"a\"", "write a number"]),
    (COLLOID, "pattern = \"planar\"", "\"planar\"", &["nematic.pattern", "`planar` stands with its value: { planar = { axis = [0.0, 0.0, 1.0] } }"]),
    (COLLOID, "pattern = { planar = { axes = [0, 0, 1] } }", "{ axes = [0, 0, 1] }", &["`axes` is not known and `axis` is missing"]),
    (COLLOID, "pattern = { homeotropic = true }", "{ homeotropic = true }", &["`homeotropic` stands alone"]),
    (COLLOID, "plates = { director = \"planar\" }", "\"planar\"", &["nematic.plates.director", "{ planar = 0.5 }"]),
    (COLLOID, "sides = \"walled\"", "\"walled\"", &["nematic.sides", "{ walled = {} }"]),
    (COLLOID, "field = { vector = [0, 0, 0.1] }", "field", &["nematic.field.anisotropy is missing", "anisotropy = 1.0"]),
    (COLLOID, "[switch]\nto = \"free\"", "\"free\"", &["switch.to", "{ free = \"cut-cell\" }", "\"keep\""]),
    ("", "[rod]", "rod", &["rod.knot is missing", "knot = \"3_1\"", "`curve`"]),
    // words
    (ROD, "reading = \"shrnk\"", "\"shrnk\"", &["did you mean \"shrunk\"?"]),
    (ROD, "[accuracy]\npreset = \"best\"", "\"best\"", &["accuracy.preset = \"best\"", "\"draft\", \"standard\", \"paper\" or \"reference\""]),
    (ROD, "[accuracy]\nintegrator = \"rk4\"", "\"rk4\"", &["accuracy.integrator", "\"ros34pw2\""]),
    (ROD, "[discharge]\ncuts = \"argmx\"", "\"argmx\"", &["discharge.cuts = \"argmx\"", "\"near-ties\""]),
    (ROD, "[discharge.ends]\nconditions = [\"clamp\", \"free\"]", "\"clamp\"", &["did you mean \"clamped\"?"]),
    ("budget = \"soon\"\n", "[rod]\nknot = \"3_1\"", "", &["line 1: budget = \"soon\"", "10 min"]),
    // unknown keys and tables
    (ROD, "slendernes = 40", "slendernes", &["rod.slendernes", "did you mean `slenderness`?"]),
    (ROD, "[friction]", "friction", &["did you mean `rod.friction`?"]),
    (ROD, "[rod.frction]", "frction", &["did you mean `friction`?"]),
    (COLLOID, "[material]\nelastic-constant = 1", "elastic-constant", &["did you mean `elastic_constant`?"]),
    ("", "[rods]", "rods", &["did you mean [rod]?"]),
    // numbers that cannot be
    (ROD, "slenderness = -5", "-5", &["rod.slenderness = -5", "above zero"]),
    (ROD, "slenderness = [50, nan]", "nan", &["rod.slenderness", "finite"]),
    (ROD, "slenderness = inf", "inf", &["rod.slenderness = inf", "finite"]),
    (ROD, "seed = -1", "-1", &["rod.seed = -1", "a whole number from 0 on"]),
    (ROD, "seed = 99999999999999999999", "99999999999999999999", &["rod.seed", "9223372036854775807"]),
    (ROD, "slenderness = 1e999", "1e999", &["rod.slenderness", "1.8e308"]),
    (COLLOID, "pattern = { charge = 3000000000 }", "3000000000", &["nematic.pattern.charge", "from -10000 to 10000"]),
    // no TOML
    (ROD, "twist = 1\ntwist = 2", "twist", &["`twist` is there twice"]),
    (ROD, "twist =", "", &["there is no value after `=`"]),
    (ROD, "twist = 1,5", "", &["a decimal point, 1.5"]),
    (ROD, "twist = two", "two", &["a text in \"quotes\""]),
    (ROD, "twist = [1, 2", "", &["unclosed array"]),
    (ROD, "twist 2", "", &["expected `=`"]),
    (ROD, "[rod.contact", "", &["expected `]`"]),
];

/// Words of programs and their types, which say nothing to who writes a scene.
const FOREIGN: [&str; 18] = [
    "untagged",
    "variant",
    "invalid type",
    "invalid value",
    "enum",
    "struct",
    "f64",
    "usize",
    "u64",
    "i64",
    "i128",
    "visitor",
    "field `",
    "sequence",
    "tuple",
    "None",
    "Some(",
    "serde",
];

fn answer(text: &str) -> String {
    let refused = parse_scene(&BATTERIES, text, Path::new("s.toml")).expect_err(text);
    refused.to_string()
}

/// The text above the marks, and the text of the line.
fn marked(answer: &str) -> (String, String) {
    let lines: Vec<&str> = answer.lines().collect();
    let [.., line, marks] = &lines[..] else {
        panic!("no place in {answer}")
    };
    let first = marks.chars().position(|c| c == '^').expect(answer);
    let n = marks.chars().filter(|c| *c == '^').count();
    let shown = line.split_once("| ").map_or("", |(_, shown)| shown);
    (line.chars().skip(first).take(n).collect(), shown.to_owned())
}

#[test]
fn wrong_scenes_are_answered_in_the_words_of_scenes() {
    assert!(WRONG.len() >= 70);
    for (base, more, place, words) in WRONG {
        let text = format!("{base}{more}\n");
        let answer = answer(&text);
        for word in *words {
            assert!(
                answer.contains(word),
                "{more:?} gives {answer}\nwithout {word:?}"
            );
        }
        let first = answer.lines().next().unwrap();
        for word in FOREIGN {
            assert!(
                !answer.contains(word),
                "{more:?} gives {answer}\nwith {word:?}"
            );
        }
        assert!(!first.split(' ').any(|word| word == "map"), "{answer}");
        let (marks, shown) = marked(&answer);
        assert!(
            text.lines().any(|line| line.trim_end() == shown),
            "{answer}"
        );
        assert!(first.starts_with("s.toml, line "), "{answer}");
        if !place.is_empty() {
            assert_eq!(marks, *place, "{answer}");
        }
    }
}

#[test]
fn scenes_without_a_battery_say_how_to_begin() {
    for text in ["", "\n# nothing\n", "knot = \"3_1\""] {
        let answer = answer(text);
        assert!(
            answer.contains("no table [rod]") && answer.contains("topo scene new"),
            "{answer}"
        );
    }
}

#[test]
fn all_faults_of_a_file_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.toml");
    let found = |text: &[u8]| {
        std::fs::write(&path, text).unwrap();
        let faults = scene_faults(&BATTERIES, &path).unwrap();
        let faults = faults.into_iter().map(|f| (f.line.unwrap_or(0), f.key));
        faults.collect::<Vec<_>>()
    };
    let at = |list: &[(usize, &str)]| -> Vec<(usize, String)> {
        list.iter()
            .map(|(line, key)| (*line, (*key).to_owned()))
            .collect()
    };
    // of form
    let text = "[rod]\nknot = \"3_1\"\ntwits = 2\nreading = \"soft\"\n[rod.contact]\nstiffness = \"20\"\n[accuracy]\nedges = 1.5\n";
    let all = [
        (3, "rod.twits"),
        (4, "rod.reading"),
        (6, "rod.contact.stiffness"),
        (8, "accuracy.edges"),
    ];
    assert_eq!(found(text.as_bytes()), at(&all));
    assert_eq!(found(b"[rod]\n"), at(&[(1, "rod.knot")]));
    // of value, a knot that is not there among them
    let text = "[rod]\nknot = [\"3_1\", \"3_7\"]\nslenderness = -1\nimperfection = 2\n[discharge]\nuntil_released = 2\n[accuracy]\ngamma = 1.0\n";
    let all = [
        (2, "rod.knot"),
        (3, "rod.slenderness"),
        (4, "rod.imperfection"),
        (6, "discharge.until_released"),
        (8, "accuracy.gamma"),
    ];
    assert_eq!(found(text.as_bytes()), at(&all));
    let text = "[nematic]\nradius = -1\n[charge]\ntolerance = 0\n[discharge]\nlongest = -1\n[accuracy]\ntolerance = 1\n";
    let all = [
        (2, "nematic.radius"),
        (4, "charge.tolerance"),
        (6, "discharge.longest"),
        (8, "accuracy.tolerance"),
    ];
    assert_eq!(found(text.as_bytes()), at(&all));
    // no TOML, and no text
    assert_eq!(found(b"[rod]\nknot =\ntwist 2\n"), at(&[(2, ""), (3, "")]));
    assert_eq!(found(b"[rod]\nknot = \"\xff\"\n"), at(&[(2, "")]));
    assert_eq!(found(b"[rod]\nknot = \"3_1\"\n"), at(&[]));
    assert!(scene_faults(&BATTERIES, &folder.path().join("none.toml")).is_err());
}
