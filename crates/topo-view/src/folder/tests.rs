//! Folders of artificial results, drawn and refused.

use super::{Made, draw, find};
use crate::error::ViewError;
use crate::shown::Shown;
use crate::synthetic;
use serde_json::json;
use std::path::Path;
use topo_core::Interrupt;
use topo_lab::{Battery, Colloid, Elastic};

const BATTERIES: [&dyn Shown; 2] = [&Elastic, &Colloid];

fn drawn(folder: &Path) -> Result<Made, ViewError> {
    draw(&find(folder, &BATTERIES)?, &Interrupt::new(), &|_| {})
}

/// Marks every case of a sweep as one of a battery.
fn mark(folder: &Path, battery: &dyn Battery) {
    let run = json!({ "schema": battery.schema(), "versions": { "results": battery.results() } });
    for case in crate::sweeps::cases::folders(folder) {
        std::fs::write(case.join("run.json"), run.to_string()).unwrap();
    }
}

/// Results of two knots at three twists, and of colloids.
fn results() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    synthetic::results(dir.path(), 2, &[-1.0, 0.0, 1.0]);
    synthetic::nematic(dir.path());
    for variant in ["elastic-contact-range", "elastic-breaking", "elastic-work"] {
        std::fs::remove_dir_all(dir.path().join(variant)).unwrap();
    }
    mark(&dir.path().join("elastic"), &Elastic);
    mark(&dir.path().join("nematic"), &Colloid);
    dir
}

fn refusal(folder: &Path) -> String {
    match find(folder, &BATTERIES).map(|_| ()) {
        Err(error @ ViewError::Case { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_sweep_of_a_folder_is_drawn_on_one_page() {
    let dir = results();
    let made = drawn(dir.path()).unwrap();
    let stems = [
        "elastic-over-twist",
        "elastic-curves",
        "elastic-shapes",
        "nematic-over-q",
        "nematic-curves",
        "nematic-rings",
        "nematic-slices",
    ];
    let page = std::fs::read_to_string(&made.page).unwrap();
    for stem in stems {
        for extension in ["png", "svg", "csv"] {
            let file = dir.path().join(format!("figures/{stem}.{extension}"));
            assert!(made.files.contains(&file), "{stem}: {:?}", made.files);
            assert!(std::fs::metadata(file).unwrap().len() > 100);
        }
        assert!(page.contains(&format!("src=\"{stem}.png\"")), "{stem}");
    }
    // a gallery of published figures stays as it is
    assert!(!dir.path().join("index.html").exists());
    assert!(made.notes.is_empty() && made.failed.is_empty(), "{made:?}");
}

#[test]
fn a_line_a_knot_goes_through_the_numbers_of_the_table() {
    let dir = results();
    let folder = dir.path().join("elastic");
    let made = drawn(&folder).unwrap();
    let text = std::fs::read_to_string(folder.join("figures/over-twist.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows: Vec<(String, String, f64, f64, f64, f64)> =
        reader.deserialize().map(Result::unwrap).collect();
    let table = crate::data::Sweep::of_folder(&folder).unwrap();
    for (knot, name) in [("3_1", "3₁"), ("4_1", "4₁")] {
        for twist in [-1.0, 0.0, 1.0] {
            let case = table.at(knot, twist).unwrap().first();
            for (column, value) in [
                ("t50", case.t50),
                ("t99", case.t99),
                ("energy", Some(case.energy)),
            ] {
                let is_it = |r: &&(String, String, f64, f64, f64, f64)| {
                    r.0 == column && r.1 == name && r.2 == twist
                };
                let found = rows.iter().find(is_it).unwrap();
                assert!((found.3 - value.unwrap()).abs() < 1e-12, "{found:?}");
            }
        }
    }
    let svg = std::fs::read_to_string(folder.join("figures/over-twist.svg")).unwrap();
    assert!(svg.contains("Twist density θ′") && svg.contains("3₁") && svg.contains("4₁"));
    assert!(
        made.drawn[0].starts_with("elastic: a knotted fibre, 6 discharges"),
        "{:?}",
        made.drawn
    );
}

#[test]
fn what_failed_or_is_not_there_is_named() {
    let dir = results();
    let folder = dir.path().join("elastic");
    let cases = crate::sweeps::cases::folders(&folder);
    std::fs::write(
        folder.join("failed.csv"),
        "case,reason\n5_1_bad,it burst & broke\n",
    )
    .unwrap();
    std::fs::create_dir(folder.join("5_2_begun")).unwrap();
    std::fs::write(folder.join("5_2_begun/charge-1.checkpoint"), "").unwrap();
    std::fs::remove_dir_all(&cases[0]).unwrap();
    // numbers of another version are drawn, and that is said
    let old = json!({ "schema": Elastic.schema(), "versions": { "results": 1 } });
    std::fs::write(cases[1].join("run.json"), old.to_string()).unwrap();
    // what another program left below is not drawn
    let foreign = dir.path().join("springs");
    std::fs::create_dir_all(foreign.join("a")).unwrap();
    std::fs::write(foreign.join("a/run.json"), "{\"schema\":\"spring/1\"}").unwrap();
    let made = drawn(dir.path()).unwrap();
    assert_eq!(made.failed.len(), 1);
    let notes = made.notes.join("\n");
    let gone = cases[0].file_name().unwrap().to_string_lossy();
    let page = std::fs::read_to_string(&made.page).unwrap();
    for text in [&notes, &page] {
        for word in ["5_2_begun", &gone, "results version 1", "spring/1"] {
            assert!(text.contains(word), "{word}: {text}");
        }
    }
    assert!(page.contains("5_1_bad: it burst &amp; broke"));
}

#[test]
fn a_run_in_progress_is_drawn_as_far_as_it_is() {
    let dir = results();
    let folder = dir.path().join("elastic");
    let table = crate::data::Sweep::of_folder(&folder).unwrap();
    std::fs::remove_file(folder.join("sweep.csv")).unwrap();
    // no case says its rows yet
    let error = drawn(&folder).unwrap_err().to_string();
    assert!(
        error.contains("no case is finished") && error.contains("run the scene again"),
        "{error}"
    );
    for case in &table.cases[..2] {
        let row = serde_json::to_value(case.first()).unwrap();
        let run = json!({ "schema": Elastic.schema(), "versions": { "results": Elastic.results() }, "rows": [row] });
        std::fs::write(folder.join(case.folder()).join("run.json"), run.to_string()).unwrap();
    }
    let made = drawn(&folder).unwrap();
    assert!(made.drawn[0].contains("2 discharges"), "{:?}", made.drawn);
    assert!(made.notes[0].contains("not finished"), "{:?}", made.notes);
}

#[test]
fn one_case_alone_is_drawn_with_its_parts() {
    let dir = tempfile::tempdir().unwrap();
    synthetic::results(dir.path(), 1, &[1.0]);
    let folder = dir.path().join("elastic");
    mark(&folder, &Elastic);
    let first = drawn(&folder).unwrap();
    // drawn again, what was made is not taken for results
    let second = drawn(&folder).unwrap();
    assert_eq!((first.files, first.notes), (second.files, second.notes));
    for stem in ["curves", "parts", "shapes"] {
        assert!(
            folder.join(format!("figures/{stem}.png")).exists(),
            "{stem}"
        );
    }
}

#[test]
fn folders_without_a_sweep_are_refused_with_what_would_be_right() {
    let dir = results();
    let right = "name the folder of a scene that `topo run` wrote";
    let nowhere = refusal(&dir.path().join("nowhere"));
    assert!(
        nowhere.contains("no such folder") && nowhere.contains(right),
        "{nowhere}"
    );
    let table = refusal(&dir.path().join("elastic/sweep.csv"));
    assert!(table.contains("a file"), "{table}");
    let case = &crate::sweeps::cases::folders(&dir.path().join("elastic"))[0];
    let one = refusal(case);
    assert!(
        one.contains("one case of a sweep") && one.contains("topo export"),
        "{one}"
    );
    let empty = dir.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    assert!(refusal(&empty).contains(right));
    std::fs::create_dir(empty.join("a")).unwrap();
    std::fs::write(empty.join("a/run.json"), "{\"schema\":\"spring/1\"}").unwrap();
    let foreign = refusal(&empty);
    assert!(
        foreign.contains("spring/1") && foreign.contains("topo-elastic-case/1"),
        "{foreign}"
    );
    assert!(!empty.join("figures").exists());
}

#[test]
fn a_stop_leaves_nothing_half_drawn() {
    let dir = results();
    let stop = Interrupt::new();
    stop.request();
    let found = find(dir.path(), &BATTERIES).unwrap();
    let error = draw(&found, &stop, &|_| {}).unwrap_err();
    assert!(matches!(error, ViewError::Interrupted));
    assert!(!dir.path().join("figures").exists());
}
