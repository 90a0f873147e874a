//! Lines on the terminal. A reader that has gone (`| head`, a closed window) is no fault: what cannot be written is dropped, and the
//! work goes on.

/// Writes a line to the standard output; with `--json` it goes nowhere.
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => {{
        if !$crate::output::is_json() {
            use std::io::Write as _;
            let _ = writeln!(std::io::stdout(), $($text)*);
        }
    }};
}

/// Writes a line to the standard error.
#[macro_export]
macro_rules! note {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($text)*);
    }};
}
