//! What a command prints: lines for a reader or, with `--json`, one object for a program.
//!
//! Commands note here what they leave behind, wherever in them it comes to be; only with `--json` it is kept, and printed at the end.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use serde_json::{Map, Value, json};
use topo_lab::FailedCase;

use crate::error::CliError;

/// What was noted of the command that runs; `None` without `--json`.
static NOTED: Mutex<Option<Noted>> = Mutex::new(None);

#[derive(Debug, Default)]
struct Noted {
    command: String,
    out: Option<String>,
    tables: Vec<String>,
    failed: Vec<FailedCase>,
    warnings: Vec<String>,
    data: Map<String, Value>,
    /// Keys that stand beside these.
    beside: Map<String, Value>,
}

// A thread that panicked while noting leaves a list that is still good.
fn noted() -> MutexGuard<'static, Option<Noted>> {
    NOTED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn note_that(add: impl FnOnce(&mut Noted)) {
    if let Some(noted) = noted().as_mut() {
        add(noted);
    }
}

/// From now on nothing but one object is printed, of the command of this name.
pub fn as_json(command: &str) {
    *noted() = Some(Noted {
        command: command.to_owned(),
        ..Noted::default()
    });
}

/// Whether lines for a reader go nowhere.
pub fn is_json() -> bool {
    noted().is_some()
}

/// The folder that the command writes to.
pub fn out(folder: &Path) {
    note_that(|n| n.out = Some(folder.display().to_string()));
}

/// A table that was written.
pub fn table(path: &Path) {
    note_that(|n| {
        let path = path.display().to_string();
        if !n.tables.contains(&path) {
            n.tables.push(path);
        }
    });
}

/// A case that failed.
pub fn failed(case: &FailedCase) {
    note_that(|n| n.failed.push(case.clone()));
}

/// Something that the reader of the results should know.
pub fn warning(text: impl Into<String>) {
    note_that(|n| n.warnings.push(text.into()));
}

/// What a command finds, under a name of its own.
pub fn data(name: &str, value: impl Serialize) {
    note_that(|n| {
        let value = serde_json::to_value(value).unwrap_or(Value::Null);
        n.data.insert(name.to_owned(), value);
    });
}

/// One more of what a command finds several of.
pub fn one_more(name: &str, value: impl Serialize) {
    note_that(|n| {
        let value = serde_json::to_value(value).unwrap_or(Value::Null);
        let list = n.data.entry(name).or_insert_with(|| json!([]));
        if let Value::Array(list) = list {
            list.push(value);
        }
    });
}

/// Keys of a finding that programs read from the object itself.
pub fn beside(finding: &Value) {
    note_that(|n| {
        n.beside
            .extend(finding.as_object().cloned().unwrap_or_default())
    });
}

/// Prints the object, if one was asked for.
pub fn finish(error: Option<&CliError>) {
    let Some(noted) = noted().take() else {
        return;
    };
    let message = error.map(|e| (e.to_string(), e.exit_code()));
    let object = object(noted, message);
    let text = serde_json::to_string_pretty(&object).unwrap_or_default();
    print_line(&text);
}

fn object(noted: Noted, error: Option<(String, u8)>) -> Value {
    let mut all = noted.beside;
    let own = [
        ("command", json!(noted.command)),
        ("out", json!(noted.out)),
        ("tables", json!(noted.tables)),
        ("failed", json!(noted.failed)),
        ("warnings", json!(noted.warnings)),
        ("data", Value::Object(noted.data)),
    ];
    all.extend(own.map(|(key, value)| (key.to_owned(), value)));
    if let Some((message, exit_code)) = error {
        let error = json!({ "message": message, "exit_code": exit_code });
        all.insert("error".to_owned(), error);
    }
    Value::Object(all)
}

/// Prints the object of a command line that was refused.
pub fn refused(command: &str, message: &str, exit_code: u8) {
    let noted = Noted {
        command: command.to_owned(),
        ..Noted::default()
    };
    let object = object(noted, Some((message.to_owned(), exit_code)));
    print_line(&format!("{object:#}"));
}

/// A line on the standard output; a reader that has gone (`| head`) is no fault.
fn print_line(text: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stdout(), "{text}");
}
