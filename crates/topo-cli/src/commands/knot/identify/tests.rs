use super::*;
use std::path::{Path, PathBuf};
use topo_knots::{braid_closure, closed_braid, write_curve, write_curves};

fn args(file: PathBuf) -> IdentifyArgs {
    IdentifyArgs {
        file,
        open: false,
        closed: false,
        closures: 20,
        frame: None,
        format: None,
    }
}

fn named(args: &IdentifyArgs) -> (serde_json::Value, String, ExitCode) {
    let (report, text) = look(args, &KnotTable::builtin()).unwrap_or_else(|e| panic!("{e}"));
    let code = exit_code(&report);
    (serde_json::to_value(report).unwrap(), text, code)
}

fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

/// A trefoil of six sticks.
const STICKS: &str = "-2 2 1\n4 0 3\n-4 -4 -4\n1 3 3\n3 0 3\n0 2 0\n";

#[test]
fn files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("knot.vect");
    write_curve(&path, &closed_braid(&[-1, -1, -1]).unwrap()).unwrap();
    let mut args = args(path);
    let (json, text, code) = named(&args);
    assert!(
        text.starts_with("m3_1, the mirror image of 3_1 (certain)\n"),
        "{text}"
    );
    assert_eq!(code, ExitCode::SUCCESS);
    assert_eq!(
        (&json["name"], &json["handedness"]),
        (&"m3_1".into(), &"mirrored".into())
    );
    args.open = true;
    let (json, text, _) = named(&args);
    assert!(
        text.starts_with("m3_1 in ") && text.contains("--open leaves its closing edge out"),
        "{text}"
    );
    assert_eq!(json["closures"][0]["name"], "m3_1");
    args.open = false;
    args.file = write(
        folder.path(),
        "two.xyz",
        "0 0 0\n1 0 0\n0 1 0\n\n9 9 9\n9 8 9\n8 9 9\n",
    );
    let (json, text, code) = named(&args);
    assert!(
        text.starts_with("a split link of 2 components; component 1: 0_1 (certain)")
            && text.contains("component 2: 0_1"),
        "{text}"
    );
    assert_eq!(
        (&json["name"], code),
        (&"0_1+0_1".into(), ExitCode::SUCCESS)
    );
    assert_eq!(json["components"][1]["name"], "0_1");
    assert_eq!(
        (&json["link"]["split"], &json["certain"]),
        (&true.into(), &true.into())
    );
    args.open = true;
    let (json, text, _) = named(&args);
    assert!(
        text.contains("2 components, some of them open: how they are linked is not found"),
        "{text}"
    );
    assert_eq!(
        (&json["name"], &json["link"]),
        (&serde_json::Value::Null, &serde_json::Value::Null)
    );
    args.open = false;
    args.file = write(folder.path(), "nan.xyz", "0 0 0\n0 nan 0\n");
    let error = look(&args, &KnotTable::builtin()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("nan.xyz: line 2: y: `nan` is not finite"),
        "{error}"
    );
    assert_eq!(error.exit_code(), 2);
    args.file = write(folder.path(), "short.xyz", "0 0 0\n\n1 0 0\n1 1 0\n2 1 0\n");
    let error = look(&args, &KnotTable::builtin()).unwrap_err().to_string();
    assert!(
        error.contains("short.xyz: component 1: a closed curve needs"),
        "{error}"
    );
}

#[test]
fn a_repeated_first_vertex_closes_every_closure() {
    let folder = tempfile::tempdir().unwrap();
    let mut args = args(write(
        folder.path(),
        "sticks.xyz",
        &format!("{STICKS}-2 2 1\n"),
    ));
    assert_eq!(named(&args).0["name"], "3_1");
    args.open = true;
    let (json, text, code) = named(&args);
    assert_eq!(
        json["closures"],
        serde_json::json!([{"name": "3_1", "share": 1.0}]),
        "{text}"
    );
    assert_eq!(
        (&json["handedness"], code),
        (&"tabulated".into(), ExitCode::SUCCESS)
    );
}

#[test]
fn far_ends_are_said_to_be_open() {
    let folder = tempfile::tempdir().unwrap();
    // An arch, which the closing edge does not touch.
    let vertex = |k: i32| format!("{k} {} {}\n", k % 2, f64::from(k * (29 - k)) / 10.0);
    let chain: String = (0..30).map(vertex).collect();
    let mut args = args(write(folder.path(), "chain.xyz", &chain));
    let (json, text, _) = named(&args);
    assert_eq!(json["components"][0]["closed"], false);
    assert!(
        text.contains("note: taken for open: the ends are 9.250 times"),
        "{text}"
    );
    args.closed = true;
    let (json, text, _) = named(&args);
    assert_eq!(json["components"][0]["closed"], true);
    assert!(text.starts_with("0_1, the unknot (certain)\n"), "{text}");
}

#[test]
fn frames_are_named_with_their_times() {
    let folder = tempfile::tempdir().unwrap();
    let knot = |time: &str| -> String {
        let row = |line: &str| format!("0.5,{time},0,{},1,0\n", line.replace(' ', ","));
        STICKS.lines().map(row).collect()
    };
    let text = format!(
        "cut,time,s,x,y,z,energy_density,twist\n{}{}",
        knot("0"),
        knot("2.5")
    );
    let mut args = args(write(folder.path(), "snapshots.csv", &text));
    let (json, text, _) = named(&args);
    assert_eq!(json["name"], "3_1");
    assert_eq!(
        json["frame"],
        serde_json::json!({"number": 2, "of": 2, "label": "cut 0.5, time 2.5"})
    );
    assert!(
        text.contains("note: frame 2 of 2 (cut 0.5, time 2.5); this is the last one"),
        "{text}"
    );
    args.frame = Some(FrameChoice::Number(1));
    assert_eq!(named(&args).0["frame"]["number"], 1);
    args.frame = Some(FrameChoice::Number(9));
    assert!(
        look(&args, &KnotTable::builtin())
            .unwrap_err()
            .to_string()
            .contains("no frame 9")
    );
}

#[test]
fn links_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solomon.vect");
    write_curves(&path, &braid_closure(&[-1; 4]).unwrap()).unwrap();
    let (json, text, code) = named(&args(path.clone()));
    assert!(
        text.starts_with("mL4a1 (certain), a link of 2 components\n  4 crossings"),
        "{text}"
    );
    assert!(
        text.contains("linking numbers -2,") && text.contains("component 2: 0_1, the unknot"),
        "{text}"
    );
    assert_eq!((&json["name"], code), (&"mL4a1".into(), ExitCode::SUCCESS));
    let link = serde_json::json!({
        "split": false,
        "linking_numbers": [[0, -2], [-2, 0]],
        "parts": [{"components": [1, 2], "candidates": ["mL4a1"], "certain": true, "crossings": 4}],
    });
    assert_eq!(json["link"], link);
    // More crossings than those up to which all links are compared.
    write_curves(&path, &braid_closure(&[1, 1, 2, 2, 3, 3, 4, 4]).unwrap()).unwrap();
    let (json, text, code) = named(&args(path.clone()));
    assert!(
        text.starts_with("consistent with chain(5), a link"),
        "{text}"
    );
    assert_eq!((&json["certain"], code), (&false.into(), ExitCode::from(3)));
    let ring = braid_closure(&[1, 1]).unwrap().swap_remove(0);
    write_curves(&path, &[ring.clone(), ring]).unwrap();
    let error = look(&args(path), &KnotTable::builtin())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("solomon.vect: components 1 and 2 coincide"),
        "{error}"
    );
}

/// Other programs read these keys: none may go, none may change its kind.
#[test]
fn the_json_keeps_its_keys() {
    let folder = tempfile::tempdir().unwrap();
    let (json, _, _) = named(&args(write(folder.path(), "sticks.xyz", STICKS)));
    assert_eq!(
        json,
        serde_json::json!({
            "file": folder.path().join("sticks.xyz").display().to_string(),
            "frame": null,
            "name": "3_1",
            "candidates": ["3_1"],
            "certain": true,
            "certain_to": 10,
            "handedness": "tabulated",
            "crossings": 3,
            "closures": [],
            "determinant": 3,
            "signature": -2,
            "alexander": "1 -1 1",
            "jones": "t + t^3 - t^4",
            "components": [{
                "closed": true,
                "vertices": 6,
                "name": "3_1",
                "candidates": ["3_1"],
                "certain": true,
                "certain_to": 10,
                "handedness": "tabulated",
                "crossings": 3,
                "closures": [],
                "determinant": 3,
                "signature": -2,
                "alexander": "1 -1 1",
                "jones": "t + t^3 - t^4",
            }],
            "warnings": [],
        })
    );
}
