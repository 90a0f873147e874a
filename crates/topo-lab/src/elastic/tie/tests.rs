use super::*;
use crate::battery::{Battery, parse_scene, scene_faults};
use crate::{Colloid, Elastic};
use topo_knots::{V, write_curves};

const BATTERIES: [&dyn Battery; 2] = [&Elastic, &Colloid];

fn ring(n: usize, centre: f64, upright: bool) -> Polyline {
    let at = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        match upright {
            true => V::new(centre + cos, 0.0, sin),
            false => V::new(centre + cos, sin, 0.0),
        }
    };
    Polyline::new((0..n).map(at).collect(), true).unwrap()
}

/// Writes what wrong and right scenes name, and gives what is said of a scene beside it.
fn said(folder: &Path, rod: &str) -> String {
    let path = folder.join("s.toml");
    std::fs::write(&path, format!("[rod]\n{rod}\n")).unwrap();
    let faults = scene_faults(&BATTERIES, &path).unwrap();
    let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
    faults.join("\n")
}

fn files(folder: &Path) {
    let write = |name: &str, curves: &[Polyline]| write_curves(&folder.join(name), curves).unwrap();
    let hopf = [ring(60, 0.0, false), ring(60, 1.0, true)];
    write("hopf.vect", &hopf);
    // strands that nearly meet, and the same ring twice
    write("near.vect", &[ring(60, 0.0, false), ring(60, 1.97, true)]);
    write("twice.vect", &[ring(60, 0.0, false), ring(60, 0.0, false)]);
    write(
        "many.vect",
        &[ring(10_000, 0.0, false), ring(60, 1.0, true)],
    );
    let plain = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    plain("two.csv", "x,y,z\n0,0,0\n1,0,0\n");
    plain(
        "open.vect",
        "VECT\n1 4 0\n4\n0\n0 0 0\n1 0 0\n1 1 0\n0 1 1\n",
    );
    plain("nan.csv", "x,y,z\n0,0,0\n1,0,0\n0,nan,0\n");
    plain("word.csv", "x,y,z\n0,0,0\n1,a,0\n0,1,0\n");
    plain("a.png", "not a curve");
}

#[test]
fn what_cannot_be_tied_is_refused_with_key_value_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    for (rod, words) in [
        (
            "knot = \"3_1\"\ncurve = \"hopf.vect\"",
            &[
                "rod.curve = \"hopf.vect\"",
                "rod.knot is there too",
                "keep the one",
            ][..],
        ),
        (
            "braid = [1, 1]\nlink = \"hopf\"",
            &["rod.braid = [1, 1]", "rod.link is there too"],
        ),
        (
            "slenderness = 40",
            &["rod.knot is missing", "`link`, `braid` or `curve`"],
        ),
        (
            "curve = \"two.csv\"",
            &["rod.curve = \"two.csv\"", "at least 3 vertices"],
        ),
        (
            "curve = \"hopff.vect\"",
            &[
                "rod.curve = \"hopff.vect\"",
                "no such file",
                "did you mean `hopf.vect`?",
            ],
        ),
        (
            "curve = \"nan.csv\"",
            &["rod.curve = \"nan.csv\"", "line 4"],
        ),
        (
            "curve = \"word.csv\"",
            &["rod.curve = \"word.csv\"", "line 3"],
        ),
        ("curve = \"a.png\"", &["rod.curve = \"a.png\"", ".vect"]),
        ("curve = \".\"", &["rod.curve = \".\"", "folder"]),
        ("curve = 3", &["rod.curve = 3", "a text in quotes"]),
        (
            "curve = \"open.vect\"",
            &["rod.curve = \"open.vect\"", "is open", "negative number"],
        ),
        (
            "curve = \"twice.vect\"",
            &["rod.curve = \"twice.vect\"", "components 1 and 2"],
        ),
        (
            "curve = \"near.vect\"",
            &[
                "rod.slenderness = 50",
                "overlap",
                "thicker",
                "own-length",
                "tighten = true",
            ],
        ),
        (
            "curve = \"near.vect\"\nreading = \"hard\"\nslenderness = 200",
            &["rod.slenderness = 200", "or more"],
        ),
        ("link = \"hopff\"", &["rod.link = \"hopff\"", "hopf"]),
        (
            "link = [\"hopf\", \"L2a1\"]",
            &["rod.link", "L2a1 is there already"],
        ),
        ("link = []", &["rod.link = []", "at least one"]),
        ("braid = \"1 x\"", &["rod.braid = \"1 x\"", "`x`"]),
        ("braid = [1, 0]", &["rod.braid = [1, 0]"]),
        ("braid = []", &["rod.braid = []"]),
        ("braid = [1, 3]", &["rod.braid = [1, 3]", "2"]),
        ("braid = [1.5]", &["rod.braid = 1.5"]),
        ("braid = [99999999999]", &["rod.braid", "99999999999"]),
        (
            "knot = \"3_1\"\ntighten = \"no\"",
            &["rod.tighten = \"no\"", "true or false"],
        ),
    ] {
        let said = said(folder.path(), rod);
        for word in words {
            assert!(
                said.contains(word),
                "{rod:?} gives {said}\nwithout {word:?}"
            );
        }
        assert!(said.contains("s.toml, line "), "{said}");
    }
    for rod in [
        "curve = \"hopf.vect\"",
        "curve = \"hopf.vect\"\ntighten = true",
        "curve = \"near.vect\"\nreading = \"own-length\"",
        "curve = \"near.vect\"\nreading = \"tight\"",
        "curve = \"many.vect\"",
        "link = [\"hopf\", \"L4a1\"]",
        "braid = \"1 1\"",
        "braid = [1, -2, 1, -2]",
        "knot = \"3_1\"\ntighten = false\nslenderness = 200",
    ] {
        assert_eq!(said(folder.path(), rod), "", "{rod}");
    }
}

/// Names and identities come from what is in a file, not from where it is, and a scene with a curve comes back as written.
#[test]
fn a_curve_is_known_by_its_coordinates() {
    let table = KnotTable::builtin();
    let [here, there] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    files(here.path());
    files(there.path());
    std::fs::rename(there.path().join("hopf.vect"), there.path().join("b.vect")).unwrap();
    let scene = |folder: &Path, name: &str, more: &str| {
        let text = format!("[rod]\ncurve = {name:?}\n{more}");
        ElasticScene::parse(&text, &folder.join("s.toml")).unwrap()
    };
    let known = |scene: &ElasticScene| {
        let case = scene.cases(&table).unwrap().remove(0);
        let entry = case.entry(&table).unwrap();
        let mark = crate::elastic::identity::fingerprint(scene, &case, &entry);
        (scene.case_name(&case), case.state(), mark)
    };
    let one = scene(here.path(), "hopf.vect", "");
    assert_eq!(known(&one), known(&scene(there.path(), "b.vect", "")));
    assert!(
        known(&one).0.starts_with("L2a1_curve-"),
        "{}",
        known(&one).0
    );
    let path = here.path().join("hopf.vect");
    let moved = [ring(60, 0.0, false), ring(60, 1.001, true)];
    write_curves(&path, &moved).unwrap();
    let (name, state, mark) = known(&scene(here.path(), "hopf.vect", ""));
    let before = known(&one);
    assert!(name != before.0 && state != before.1 && mark != before.2);
    let tight = known(&scene(here.path(), "hopf.vect", "tighten = true"));
    assert!(tight.0.contains("_tight-curve-") && tight.2 != mark);
    for text in [
        "link = \"hopf\"",
        "link = [\"hopf\"]\ntighten = false\nslenderness = 200",
        "braid = \"1 1\"",
        "knot = \"4_1\"\ntighten = false\nslenderness = 200",
        "curve = \"hopf.vect\"\ntighten = true",
    ] {
        let parse = |text: &str| ElasticScene::parse(text, &here.path().join("s.toml")).unwrap();
        let scene = parse(&format!("[rod]\n{text}\n"));
        assert_eq!(parse(&scene.text()), scene, "{text}");
        assert_eq!(known(&parse(&scene.resolved_text())), known(&scene));
    }
    let both = "[rod]\nknot = \"3_1\"\nlink = \"hopf\"\n";
    let refused = parse_scene(&BATTERIES, both, Path::new("s.toml")).unwrap_err();
    assert!(
        refused.to_string().contains("s.toml, line 3: rod.link"),
        "{refused}"
    );
}
