//! The name by which a user calls the program that draws: what messages and files tell him to run.

use std::sync::OnceLock;

static NAME: OnceLock<&str> = OnceLock::new();

/// The program's name: `topo`, or what [`call_program`] said.
pub fn program() -> &'static str {
    NAME.get_or_init(|| "topo")
}

/// Says by which name the program is called; only the first call counts, and only before anything asked for the name.
pub fn call_program(name: &'static str) {
    let _ = NAME.set(name);
}
