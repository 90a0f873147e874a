//! docs/tutorial.md, typed word by word.

mod page;

use page::{blocks, folder, read, topo};

/// How far a number of the page may be off: another processor may round otherwise.
const NEAR: f64 = 0.02;

/// Whether a printed line says what the page shows: the same words, numbers within [`NEAR`], further columns at the end.
fn is_shown(shown: &str, printed: &str) -> bool {
    let (mut shown, mut printed) = (shown.split_whitespace(), printed.split_whitespace());
    shown.all(|word| {
        let found = printed.next().unwrap_or_default();
        match (word.parse::<f64>(), found.parse::<f64>()) {
            (Ok(a), Ok(b)) => (a - b).abs() <= NEAR * a.abs(),
            _ => word == found,
        }
    })
}

#[test]
fn the_page_says_what_its_commands_print() {
    let page = read("docs/tutorial.md");
    let (_kept, place) = folder();
    let (mut printed, mut n_shown, mut n_run) = (String::new(), 0, 0);
    for block in blocks(&page) {
        match block.language {
            "toml" if block.name == "Cargo.toml" => {}
            "toml" => {
                assert!(block.name.ends_with(".toml"), "{}", block.text);
                std::fs::write(place.join(block.name), block.text).unwrap();
            }
            "sh" => {
                printed.clear();
                for command in block.text.lines() {
                    let mut words = command.split_whitespace();
                    if words.next() == Some("topo") {
                        printed += &topo(&place, words);
                        n_run += 1;
                    } else {
                        assert!(command.starts_with("cargo install"), "{command}");
                    }
                }
            }
            "text" => {
                for line in block.text.lines() {
                    assert!(
                        printed.lines().any(|p| is_shown(line, p)),
                        "the page shows\n{line}\nand the program prints\n{printed}"
                    );
                    n_shown += 1;
                }
            }
            _ => {}
        }
    }
    assert!(n_run >= 8 && n_shown >= 10, "{n_run} {n_shown}");
    for picture in ["results/first", "results/sweep"] {
        assert!(place.join(picture).join("figures/index.html").exists());
    }
}

#[test]
fn lines_are_compared_by_words_and_numbers() {
    assert!(is_shown("3_1 +2.0 t99", "3_1  2.01 t99 further"));
    assert!(!is_shown("3_1 +2.0 t99", "3_1  2.2 t99"));
    assert!(!is_shown("3_1 +2.0 t99", "m3_1  2.0 t99"));
    assert!(!is_shown("3_1 +2.0 t99", "3_1  2.0"));
}
