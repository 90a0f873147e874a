//! Progress on the terminal: a bar with the time left, or plain lines where there is none.

mod work;

use crate::duration::duration;
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::io::IsTerminal;
use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};
use topo_lab::Estimate;
use work::Work;

/// Shortest time between two plain lines.
const PAUSE: Duration = Duration::from_secs(5);
/// Longest time that passes without a word on what is going on.
const SILENCE: Duration = Duration::from_secs(1);
/// Shortest time between two messages of the bar about parts at work.
const SHORT_PAUSE: Duration = Duration::from_millis(100);
/// Shortest time between two plain lines about a part at work.
const LONG_PAUSE: Duration = Duration::from_secs(20);

/// Progress of a stage with a known number of parts; shared between threads.
#[derive(Debug)]
pub struct Progress {
    label: String,
    bar: Option<ProgressBar>,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    work: Work,
    start: Instant,
    said: Instant,
}

impl Progress {
    /// Starts a stage of `n` parts of which nothing is known.
    pub fn start(label: &str, n: usize) -> Self {
        Self::expecting(label, n, &Estimate::default())
    }

    /// Starts a stage of `n` parts that are expected to take what the estimate says.
    pub fn expecting(label: &str, n: usize, estimate: &Estimate) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(n as u64);
            let style = "{prefix:>12} [{bar:32}] {pos}/{len}  {wide_msg}";
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_prefix(label.to_owned());
            bar.enable_steady_tick(Duration::from_millis(250));
            bar
        });
        if bar.is_none() && n > 0 {
            note!("{label}: 0/{n}");
        }
        let now = Instant::now();
        Self {
            label: label.to_owned(),
            bar,
            state: Mutex::new(State {
                work: Work::new(n, estimate),
                start: now,
                said: now,
            }),
        }
    }

    // A thread that panicked while printing leaves a count that is still good.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|e| e.into_inner())
    }

    /// The parts begin only now: what came before them says nothing about the time that they take.
    pub fn restart(&self) {
        let mut state = self.state();
        if state.work.n_done() == 0 {
            state.start = Instant::now();
        }
    }

    /// One part is done; `what` names it.
    pub fn done(&self, what: &str) {
        self.done_of(what, 0.0);
    }

    /// One part is done that was expected to take so many seconds on the estimate's reference machine.
    pub fn done_of(&self, what: &str, expected: f64) {
        let mut state = self.state();
        state.work.add(expected);
        let text = state.text(what);
        match &self.bar {
            Some(bar) => {
                bar.set_message(text);
                bar.inc(1);
            }
            None if state.said.elapsed() >= PAUSE || state.work.is_done() => {
                state.said = Instant::now();
                note!("{}: {}, {text}", self.label, state.work);
            }
            None => {}
        }
    }

    /// How far a part at work is; most of what steps report comes too soon after the last and is not even put into words.
    pub fn working(&self, name: &str, far: &dyn Display) {
        let mut state = self.state();
        let pause = match self.bar {
            Some(_) => SHORT_PAUSE,
            None => LONG_PAUSE,
        };
        if state.said.elapsed() < pause {
            return;
        }
        state.said = Instant::now();
        let text = state.text(&format!("{name}: {far}"));
        match &self.bar {
            Some(bar) => bar.set_message(text),
            None => note!("{}: {}, {text}", self.label, state.work),
        }
    }

    /// Says something beside the progress.
    pub fn note(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => note!("{text}"),
        }
    }

    /// Ends the stage and returns its seconds.
    pub fn finish(self) -> f64 {
        let state = self.state();
        let seconds = state.start.elapsed().as_secs_f64();
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
            note!("{:>12} {} in {seconds:.1} s", self.label, state.work.n());
        }
        seconds
    }
}

/// Does work of which nothing is seen meanwhile; when that takes longer than a second, `what` says what is going on.
pub fn waiting<T>(what: &str, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (done, waits) = std::sync::mpsc::channel::<()>();
        scope.spawn(move || {
            if waits.recv_timeout(SILENCE) == Err(RecvTimeoutError::Timeout) {
                note!("{what}");
            }
        });
        let result = work();
        drop(done);
        result
    })
}

impl State {
    /// The time left, if it is known, and what is done.
    fn text(&self, what: &str) -> String {
        match self.work.left(self.start.elapsed().as_secs_f64()) {
            Some(left) => format!("{} left, {what}", duration(left)),
            None => what.to_owned(),
        }
    }
}
