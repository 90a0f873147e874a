//! Texts that are no TOML, in the words of their writers.

use std::path::Path;
use std::string::FromUtf8Error;

use super::fault::SceneFault;

/// What a value may be, for texts in which none can be found.
const VALUES: &str = "a value is a number, true, false, a text in \"quotes\", a list in [brackets] or a table in {braces}";

/// Messages of the parser where it finds no value.
const NO_VALUE: [&str; 2] = ["string values must be quoted", "invalid boolean"];

/// The fault of a text at the place where it is no TOML.
pub(super) fn fault(text: &str, path: &Path, error: &toml::de::Error) -> SceneFault {
    let place = error.span().unwrap_or_default();
    let marked = text.get(place.clone()).unwrap_or_default();
    let begin = text
        .get(..place.start)
        .and_then(|t| t.rfind('\n'))
        .map_or(0, |k| k + 1);
    let line = text[begin..].lines().next().unwrap_or_default().trim();
    let after = text.get(place.start..).unwrap_or_default();
    let expected = match error.message() {
        "duplicate key" => format!("`{marked}` is there twice, keep one"),
        m if NO_VALUE.iter().any(|begin| m.starts_with(begin)) => match marked.is_empty() {
            true => format!("there is no value after `=`; {VALUES}"),
            false => VALUES.to_owned(),
        },
        m if after.starts_with(',') && m.starts_with("unexpected key or value") => {
            "a number has a decimal point, 1.5, and a list brackets, [1, 5]".to_owned()
        }
        m => m.trim_end_matches(", expected nothing").to_owned(),
    };
    let found = match line {
        "" => "the end of the text".to_owned(),
        line => format!("`{line}` is no TOML"),
    };
    SceneFault::of_file(path, found, expected).at(text, &place)
}

/// The fault of a number that no value can be.
pub(super) fn too_large(path: &Path, found: String) -> SceneFault {
    let most = i64::MAX;
    let expected = format!(
        "write a whole number up to {most}, or a number up to {:.1e}",
        f64::MAX
    );
    SceneFault::of_file(path, found, expected)
}

/// The fault of a file that is no text.
pub(super) fn no_text(path: &Path, error: &FromUtf8Error) -> SceneFault {
    let good = error.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(error.as_bytes());
    let end = good + text[good..].chars().next().map_or(0, char::len_utf8);
    let expected = "a scene is a text in UTF-8: save it so";
    SceneFault::of_file(path, "a byte that is no text", expected).at(&text, &(good..end))
}

/// The fault of a text of which nothing is known but that it cannot be read.
pub(super) fn unreadable(path: &Path) -> SceneFault {
    SceneFault::of_file(path, "the text", "a scene is a text in TOML")
}
