//! Progress on the terminal: a bar with the time left, or plain lines where there is none.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Shortest time between two plain lines.
const PAUSE: Duration = Duration::from_secs(5);
/// Shortest time between two plain lines about a part at work.
const LONG_PAUSE: Duration = Duration::from_secs(20);

/// Progress of a stage with a known number of parts; shared between threads.
#[derive(Debug)]
pub struct Progress {
    label: String,
    n: u64,
    start: Instant,
    bar: Option<ProgressBar>,
    plain: Mutex<Plain>,
}

#[derive(Debug)]
struct Plain {
    done: u64,
    said: Instant,
}

impl Progress {
    /// Starts a stage of `n` parts.
    pub fn start(label: &str, n: usize) -> Self {
        let n = n as u64;
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(n);
            let style = "{prefix:>12} [{bar:32}] {pos}/{len} {eta} left  {wide_msg}";
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_prefix(label.to_owned());
            bar.enable_steady_tick(Duration::from_millis(250));
            bar
        });
        let now = Instant::now();
        let plain = Mutex::new(Plain { done: 0, said: now });
        Self {
            label: label.to_owned(),
            n,
            start: now,
            bar,
            plain,
        }
    }

    /// One part is done; `what` names it.
    pub fn done(&self, what: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(what.to_owned());
            bar.inc(1);
            return;
        }
        // A thread that panicked while printing leaves a count that is still good.
        let mut plain = self.plain.lock().unwrap_or_else(|e| e.into_inner());
        plain.done += 1;
        if plain.said.elapsed() >= PAUSE || plain.done == self.n {
            plain.said = Instant::now();
            eprintln!(
                "{}",
                line(&self.label, plain.done, self.n, self.start.elapsed(), what)
            );
        }
    }

    /// Where a long part is.
    pub fn working(&self, what: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(what.to_owned());
            return;
        }
        let mut plain = self.plain.lock().unwrap_or_else(|e| e.into_inner());
        if plain.said.elapsed() >= LONG_PAUSE {
            plain.said = Instant::now();
            eprintln!("{}: {what}", self.label);
        }
    }

    /// Says something beside the progress.
    pub fn note(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => eprintln!("{text}"),
        }
    }

    /// Ends the stage and returns its seconds.
    pub fn finish(self) -> f64 {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
            eprintln!(
                "{:>12} {} in {:.1} s",
                self.label,
                self.n,
                self.start.elapsed().as_secs_f64()
            );
        }
        self.start.elapsed().as_secs_f64()
    }
}

fn line(label: &str, done: u64, n: u64, elapsed: Duration, what: &str) -> String {
    let left = elapsed.as_secs_f64() / done.max(1) as f64 * n.saturating_sub(done) as f64;
    format!("{label}: {done}/{n}, {left:.0} s left, {what}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_is_in_proportion() {
        let text = line("charge", 2, 10, Duration::from_secs(4), "7_4");
        assert_eq!(text, "charge: 2/10, 16 s left, 7_4");
        assert!(line("x", 10, 10, Duration::from_secs(4), "").contains("0 s left"));
    }
}
