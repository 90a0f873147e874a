//! Texts on the terminal.

use crate::output;
use std::io::Write as _;

/// Writes to the terminal, nowhere with `--json`; a closed pipe (`| head`) is no fault.
pub fn print(text: &str) {
    if output::is_json() {
        return;
    }
    let _ = std::io::stdout().write_all(text.as_bytes());
}
