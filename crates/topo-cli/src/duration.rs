//! Times and counts in words.

use std::time::Duration;

use indicatif::HumanDuration;

/// Seconds as a reader says them.
pub fn duration(seconds: f64) -> String {
    let time = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    match time.as_millis() {
        0..500 => "less than a second".to_owned(),
        _ => HumanDuration(time).to_string(),
    }
}

/// So many of `what`, whose plural ends in s.
pub fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}
