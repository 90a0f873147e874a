//! Natural shapes of scenes: what is read, refused, and kept apart.

use std::path::Path;

use topo_knots::KnotTable;

use super::*;
use crate::elastic::identity::{fingerprint, starts_from_two_images};
use crate::elastic::{ElasticCase, ElasticScene};

const KNOT: &str = "[rod]\nknot = \"3_1\"\ntwist = 1.0\n";

fn scene(rest: &str, folder: &Path) -> Result<ElasticScene, LabError> {
    let text = format!("{KNOT}[rod.rest]\n{rest}\n");
    ElasticScene::parse(&text, &folder.join("scene.toml"))
}

fn case_of(scene: &ElasticScene) -> ElasticCase {
    scene.cases(&KnotTable::builtin()).unwrap().remove(0)
}

fn rest_of(rest: &str) -> Rest {
    let case = case_of(&scene(rest, Path::new("")).unwrap());
    case.rest.unwrap().as_ref().clone()
}

/// The identity of the numbers of the first case of a scene.
fn identity_of(scene: &ElasticScene) -> String {
    let case = case_of(scene);
    let table = KnotTable::builtin();
    let entry = case.entry(&table).unwrap();
    fingerprint(scene, &case, &entry)
}

const PROFILE: &str =
    "# of a bent tube\ns,curvature_2,curvature_1\n0,0,0.1\n0.25,0.2,0.3\n0.5,0,-0.1\n1,0,0.1\n";

#[test]
fn a_profile_is_linear_between_its_rows() {
    let profile = RestProfile::parse(PROFILE, CURVATURES).unwrap();
    for (s, [a, b]) in [
        (0.0, [0.1, 0.0]),
        (0.125, [0.2, 0.1]),
        (0.25, [0.3, 0.2]),
        (0.375, [0.1, 0.1]),
        (0.75, [0.0, 0.0]),
        (1.0, [0.1, 0.0]),
        (1.0 + 1e-12, [0.1, 0.0]),
    ] {
        let found = profile.at(s);
        let miss = (found[0] - a).abs() + (found[1] - b).abs();
        assert!(miss < 1e-14, "{s}: {found:?}");
    }
}

/// Of two rings, one twice as long as the other, each has the whole profile.
#[test]
fn a_profile_runs_once_around_each_component() {
    let ring = |n: usize, radius: f64| {
        let angle = |i: usize| i as f64 / n as f64 * std::f64::consts::TAU;
        let point = |i: usize| {
            let (sin, cos) = angle(i).sin_cos();
            topo_core::Vector3::new(radius * cos, radius * sin, 3.0 * radius)
        };
        topo_core::Polyline::new((0..n).map(point).collect(), true).unwrap()
    };
    let rod = topo_rod::RodParameters {
        n_edges: 60,
        ..Default::default()
    };
    let rings = [ring(20, 4.0), ring(40, 8.0)];
    let (accuracy, guards) = (Default::default(), Default::default());
    let battery = RodBattery::link(&rod, &accuracy, guards, &rings).unwrap();
    let profile = RestProfile::parse(PROFILE, CURVATURES).unwrap();
    let rest = Rest {
        curvature: Some(Along::Profile(profile.clone())),
        twist: Some(Along::Same([0.3])),
    };
    let battery = rest.of(battery).unwrap();
    let found = battery.start().rest().unwrap();
    let places = (0..20).map(|i| i as f64 / 20.0);
    let places = places.chain((0..40).map(|i| i as f64 / 40.0));
    for (i, s) in places.enumerate() {
        let (a, b) = (found.curvature[i], profile.at(s));
        let miss = (a[0] - b[0]).abs() + (a[1] - b[1]).abs();
        assert!(miss < 1e-12, "{i}: {a:?} {b:?}");
        assert_eq!(found.twist[i], 0.3);
    }
}

#[test]
fn profiles_say_what_is_wrong_with_them() {
    for (text, words) in [
        ("", ["empty", "s,twist"]),
        ("s,twist\n", ["0 rows", "s = 0 and s = 1"]),
        ("s,twist\n0,1\n", ["1 rows", "at least 2"]),
        (
            "s,torsion\n0,1\n1,1",
            ["\"torsion\" is not known", "s,twist"],
        ),
        ("s\n0\n1", ["twist is missing", "s,twist"]),
        ("s,s,twist\n0,0,1", ["s is there 2 times", "s,twist"]),
        (
            "s,twist\n0,1\n0.5\n1,1",
            ["line 3: 1 cells", "s,twist are 2"],
        ),
        ("s,twist\n0,1\n0.5,NaN\n1,1", ["line 3: \"NaN\"", "finite"]),
        ("s,twist\n0,1\nhalf,2\n1,1", ["line 3: \"half\"", "finite"]),
        (
            "s,twist\n0,1\n\n0.6,1\n0.5,2\n1,1",
            ["line 5: s = 0.5 is not above 0.6", "sort"],
        ),
        ("s,twist\n0,1\n0.5,1\n0.5,2\n1,1", ["line 4", "not above"]),
        ("s,twist\n0,1\n50,1", ["from 0 to 50", "s/L"]),
        ("s,twist\n0.1,1\n1,1", ["from 0.1 to 1", "from 0 to 1"]),
        (
            "s,twist\n0,1\n1,1.1",
            ["1 at s = 0 and 1.1 at s = 1", "closed"],
        ),
    ] {
        let message = RestProfile::parse(text, TWISTS).unwrap_err();
        for word in words {
            assert!(message.contains(word), "{text:?} gives {message:?}");
        }
    }
}

#[test]
fn shapes_that_cannot_be_are_refused_with_file_key_value_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("open.csv"), "s,twist\n0,1\n1,2\n").unwrap();
    std::fs::write(
        here.join("tight.csv"),
        "s,curvature_1,curvature_2\n0,3,0\n1,3,0\n",
    )
    .unwrap();
    for (rest, words) in [
        (
            "curvature = nan",
            ["scene.toml, line 5: rod.rest.curvature", "finite"],
        ),
        ("curvature = 1.5", ["rod.rest.curvature = 1.5", "at most 1"]),
        (
            "curvature = [0.9, 0.9]",
            ["rod.rest.curvature = [0.9, 0.9]", "at most 1"],
        ),
        ("curvature = [0.9]", ["rod.rest.curvature = [0.9]", "write"]),
        ("curvature = true", ["rod.rest.curvature = true", "write"]),
        (
            "curvature = \"nowhere.csv\"",
            ["\"nowhere.csv\"", "s,curvature_1,curvature_2"],
        ),
        ("curvature = \"tight.csv\"", ["\"tight.csv\"", "at most 1"]),
        (
            "curvature = \"open.csv\"",
            ["\"twist\" is not known", "s,curvature_1,curvature_2"],
        ),
        ("twist = inf", ["line 5: rod.rest.twist = inf", "finite"]),
        (
            "twist = \"open.csv\"",
            ["rod.rest.twist = \"open.csv\"", "closed"],
        ),
        ("torsion = 1", ["rod.rest.torsion", "twist"]),
        ("", ["rod.rest", "leave the table out"]),
    ] {
        let text = format!("{KNOT}[rod.rest]\n{rest}\n");
        let faults = ElasticScene::faults(&text, &here.join("scene.toml"));
        assert_eq!(faults.len(), 1, "{rest}: {faults:?}");
        let message = faults[0].to_string();
        for word in words {
            assert!(message.contains(word), "{rest} gives {message}");
        }
    }
    // without a model of twist there is none at rest
    let text = "[rod]\nknot = \"3_1\"\n[rod.rest]\ntwist = 0.1\n";
    let message = ElasticScene::parse(text, Path::new("scene.toml")).unwrap_err();
    assert!(
        message.to_string().contains("no twist is modelled"),
        "{message}"
    );
}

/// A case is that of the numbers of its file, wherever that lies and whatever it is called.
#[test]
fn cases_are_told_apart_by_the_numbers_of_their_shape() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("a.csv"), PROFILE).unwrap();
    std::fs::write(
        here.join("b.csv"),
        PROFILE.replace("# of a bent tube\n", "\n"),
    )
    .unwrap();
    std::fs::write(here.join("c.csv"), PROFILE.replace("0.3", "0.31")).unwrap();
    let scenes: Vec<ElasticScene> = ["a.csv", "b.csv", "c.csv"]
        .map(|file| scene(&format!("curvature = \"{file}\""), here).unwrap())
        .into();
    let [a, b, c] = [0, 1, 2].map(|k| identity_of(&scenes[k]));
    assert_eq!(a, b);
    assert_ne!(a, c);
    let constants = [
        "curvature = 0.1",
        "curvature = [0.1, 0.2]",
        "curvature = [0.1, -0.2]",
        "twist = 0.1",
        "curvature = 0.1\ntwist = 0.1",
        "curvature = 0.10000000000000002",
    ];
    let constants = constants.map(|rest| scene(rest, here).unwrap());
    let plain = ElasticScene::parse(KNOT, &here.join("scene.toml")).unwrap();
    let all: Vec<&ElasticScene> = scenes[1..]
        .iter()
        .chain(&constants)
        .chain([&plain])
        .collect();
    let mut names: Vec<String> = all.iter().map(|s| s.case_name(&case_of(s))).collect();
    let mut states: Vec<String> = all.iter().map(|s| case_of(s).state()).collect();
    println!("{names:#?}");
    assert!(
        names.iter().any(|n| n.contains("rest-curvature0.1x0.2")),
        "{names:?}"
    );
    assert!(!names.last().unwrap().contains("rest"));
    for all_of_them in [&mut names, &mut states] {
        all_of_them.sort();
        all_of_them.dedup();
        assert_eq!(all_of_them.len(), all.len());
    }
    // what is written is read again, from anywhere
    for scene in all {
        let again = ElasticScene::parse(&scene.text(), &here.join("scene.toml")).unwrap();
        assert_eq!(again, *scene);
        let kept = ElasticScene::parse(&scene.resolved_text(), Path::new("elsewhere/scene.toml"));
        assert_eq!(case_of(&kept.unwrap()).rest, case_of(scene).rest);
    }
}

/// A shape without a hand is that of its mirror image, so that one start is enough.
#[test]
fn shapes_with_a_hand_start_from_both_images() {
    for (rest, chiral) in [
        ("curvature = 0.1", false),
        ("curvature = [0.1, 0.0]", false),
        ("curvature = [0.1, 0.1]", true),
        ("twist = 0.1", true),
        ("twist = 0.0", false),
    ] {
        assert_eq!(rest_of(rest).is_chiral(), chiral, "{rest}");
        let text = format!("[rod]\nknot = \"4_1\"\ntwist = 0.0\n[rod.rest]\n{rest}\n");
        let scene = ElasticScene::parse(&text, Path::new("scene.toml")).unwrap();
        let case = case_of(&scene);
        let entry = case.entry(&KnotTable::builtin()).unwrap().into_owned();
        assert_eq!(
            starts_from_two_images(&scene, &case, &entry),
            chiral,
            "{rest}"
        );
    }
}
