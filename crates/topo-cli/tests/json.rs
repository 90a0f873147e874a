//! `--json`: exactly one object on the standard output, whatever the command and however it ends.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

const SCENE: &str = "[rod]\nknot = \"3_1\"\ntwist = [0.0, 1.0]\n[rod.contact]\n[charge]\nduration = 0.02\n[discharge]\nuntil_released = 0.6\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";
/// A trefoil of six sticks.
const STICKS: &str = "-2 2 1\n4 0 3\n-4 -4 -4\n1 3 3\n3 0 3\n0 2 0\n";

/// The object that a command prints, and its exit code; the keys of every command are there.
fn object(folder: &Path, arguments: &[&str]) -> (Value, i32) {
    let output = Command::new(env!("CARGO_BIN_EXE_topo"))
        .args(arguments)
        .arg("--json")
        .current_dir(folder)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let value: Value =
        serde_json::from_str(&said).unwrap_or_else(|e| panic!("{arguments:?}: {e}: {said}"));
    let code = output.status.code().unwrap();
    assert!(value["command"].is_string(), "{arguments:?}: {value}");
    assert!(value["out"].is_string() || value["out"].is_null());
    for list in ["tables", "failed", "warnings"] {
        assert!(value[list].is_array(), "{arguments:?}: {list}: {value}");
    }
    assert!(value["data"].is_object(), "{arguments:?}: {value}");
    let is_fault = !matches!(code, 0 | 3);
    assert_eq!(
        value.get("error").is_some(),
        is_fault,
        "{arguments:?}: {value}"
    );
    if is_fault {
        assert_eq!(value["error"]["exit_code"], code, "{arguments:?}");
        assert!(!value["error"]["message"].as_str().unwrap().is_empty());
    }
    for table in value["tables"].as_array().unwrap() {
        let path = folder.join(table.as_str().unwrap());
        assert!(path.exists(), "{arguments:?}: {}", path.display());
    }
    (value, code)
}

#[test]
fn a_sweep_is_reported_from_its_run_to_its_pictures() {
    let dir = tempfile::tempdir().unwrap();
    let here = dir.path();
    std::fs::write(here.join("mine.toml"), SCENE).unwrap();
    let (run, code) = object(here, &["run", "mine.toml"]);
    assert_eq!((run["command"].as_str(), code), (Some("run"), 0), "{run}");
    assert_eq!(run["out"], "results/mine");
    assert_eq!(run["tables"][0], "results/mine/sweep.csv");
    let table = std::fs::read_to_string(here.join("results/mine/sweep.csv")).unwrap();
    let case = table.lines().nth(1).unwrap().split(',').next().unwrap();

    let (drawn, code) = object(here, &["figures", "results/mine"]);
    assert_eq!(code, 0, "{drawn}");
    let pictures = drawn["data"]["pictures"].as_array().unwrap();
    let names: Vec<&str> = pictures.iter().filter_map(Value::as_str).collect();
    for stem in ["over-twist", "curves", "shapes"] {
        let png = format!("results/mine/figures/{stem}.png");
        assert!(names.contains(&png.as_str()), "{names:?}");
        assert!(here.join(png).exists());
    }
    assert!(here.join(drawn["data"]["page"].as_str().unwrap()).exists());

    let folder = format!("results/mine/{case}");
    let (export, code) = object(here, &["export", &folder]);
    assert_eq!(code, 0, "{export}");
    let files = export["data"]["files"].as_array().unwrap();
    assert!(files.len() > 3 && here.join(files[0].as_str().unwrap()).exists());

    let (same, code) = object(here, &["compare", "results", "results"]);
    assert_eq!(
        (same["data"]["differences"].as_array().unwrap().len(), code),
        (0, 0)
    );
    std::fs::create_dir(here.join("empty")).unwrap();
    let (other, code) = object(here, &["compare", "results", "empty"]);
    assert!(code == 1 && !other["data"]["differences"].as_array().unwrap().is_empty());
}

#[test]
fn knots_are_shown_with_all_that_is_known_of_them() {
    let dir = tempfile::tempdir().unwrap();
    let here = dir.path();
    let (shown, _) = object(here, &["knot", "show", "8_19"]);
    assert_eq!(shown["command"], "knot show");
    let knot = &shown["data"]["knot"];
    assert_eq!(
        (&knot["name"], &knot["determinant"]),
        (&"8_19".into(), &3.into())
    );
    let (list, _) = object(here, &["knot", "list"]);
    let knots = list["data"]["knots"].as_array().unwrap();
    assert!(
        knots
            .iter()
            .any(|k| k["name"] == "7_4" && k["crossing_number"] == 7)
    );
    std::fs::write(here.join("sticks.xyz"), STICKS).unwrap();
    let (named, code) = object(here, &["knot", "identify", "sticks.xyz"]);
    assert_eq!(
        (named["data"]["finding"]["name"].as_str(), code),
        (Some("3_1"), 0)
    );
    // where earlier programs read them
    assert_eq!(
        (&named["name"], &named["certain"]),
        (&"3_1".into(), &true.into())
    );
    let (tight, code) = object(here, &["knot", "tighten", "3_1", "--quality", "draft"]);
    assert_eq!(code, 0, "{tight}");
    let length = tight["data"]["knots"][0]["length_over_radius"]
        .as_f64()
        .unwrap();
    assert!((length / 32.7436 - 1.0).abs() < 0.01, "{length}");
}

#[test]
fn errors_are_objects_with_the_exit_code_of_always() {
    let dir = tempfile::tempdir().unwrap();
    let here = dir.path();
    for (arguments, code, word) in [
        (&["run", "nowhere.toml"][..], 2, "nowhere.toml"),
        (&["figures", "nowhere"], 2, "no such folder"),
        (&["figures", "--only", "nothing"], 2, "no such figure"),
        (&["export", "nowhere"], 2, "no such folder"),
        (&["knot", "show", "99_1"], 2, "99_1"),
        (&["knot", "identify", "nowhere.xyz"], 2, "nowhere.xyz"),
        (&["knot", "tighten", "99_1"], 2, "99_1"),
        (&["compare", "nowhere", "nowhere"], 2, "nowhere"),
        // refused before there is a command
        (&["tradeoff", "--quality", "best"], 2, "best"),
        (&["extremes", "--only", "everything"], 2, "everything"),
        (&["cost", "--quality", "best"], 2, "best"),
        (
            &["figures", "results", "--only", "knots-table"],
            2,
            "--only",
        ),
    ] {
        let (value, found) = object(here, arguments);
        assert_eq!(found, code, "{arguments:?}: {value}");
        let message = value["error"]["message"].as_str().unwrap();
        assert!(message.contains(word), "{arguments:?}: {message}");
        assert_eq!(
            value["command"].as_str().unwrap().split(' ').next(),
            Some(arguments[0])
        );
    }
}

#[test]
#[ignore = "long: minutes of measurements"]
fn long_measurements_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    for (command, table) in [("tradeoff", "knots"), ("extremes", "knots")] {
        let (value, code) = object(dir.path(), &[command, "--only", table]);
        assert_eq!(
            (value["command"].as_str(), code),
            (Some(command), 0),
            "{value}"
        );
        assert!(value["tables"][0].as_str().unwrap().ends_with("knots.csv"));
        assert!(value["data"]["report"].is_string());
    }
    let (cost, code) = object(dir.path(), &["cost"]);
    assert_eq!(code, 0);
    assert!(cost["data"]["terms"].as_array().unwrap().len() > 4);
}

#[test]
fn help_and_completions_are_what_they_are() {
    let said = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_topo"))
            .args(arguments)
            .output()
            .unwrap();
        assert!(output.status.success(), "{arguments:?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let help = said(&["completions", "--help"]);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(
            help.contains(&format!("topo completions {shell} >")),
            "{shell}: {help}"
        );
        let text = said(&["completions", shell]);
        for word in ["tighten", "extremes", "budget", "completions"] {
            assert!(text.contains(word), "{shell}: {word}");
        }
    }
    assert_eq!(
        said(&["extremes", "--help"]),
        said(&["stability", "--help"])
    );
}

#[test]
fn drawing_what_is_not_there_says_so_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_topo"))
        .args(["figures", "--as-is", "--only", "knots-table"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("knots/table.csv") && said.contains("--as-is"),
        "{said}"
    );
    assert!(!said.contains("estimate"), "{said}");
    assert!(!dir.path().join("results").exists());
    // what is there is offered
    let folder = dir.path().join("results/elastic/a");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("run.json"), "{}").unwrap();
    let (value, _) = object(
        dir.path(),
        &[
            "figures",
            "--as-is",
            "--only",
            "knots-table",
            "--only",
            "elastic-charging",
        ],
    );
    let message = value["error"]["message"].as_str().unwrap();
    assert!(
        message.contains("--only elastic-charging") && !message.contains("elastic/sweep.csv"),
        "{message}"
    );
}
