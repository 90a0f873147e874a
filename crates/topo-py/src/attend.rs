//! Work on a thread of its own, while the calling thread hears what it says and whether Ctrl-C was pressed.

use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use topo_core::{Interrupt, RunHooks};

use crate::refusal::Refusal;

/// Longest time until Ctrl-C is noticed.
const PAUSE: Duration = Duration::from_millis(40);
/// Notices that may wait for the interpreter; then the work waits, so that memory stays bounded.
const WAITING: usize = 64;
/// Stack of the thread, that of a main thread.
const STACK: usize = 8 << 20;

enum Message<W, T> {
    Notice(W),
    End(Result<T, Refusal>),
}

/// What a computation gives, with the seconds that it took on the wall: what a call takes beyond them is its overhead.
pub fn timed<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<(T, f64), E> {
    let start = Instant::now();
    let value = work()?;
    Ok((value, start.elapsed().as_secs_f64()))
}

/// What work says while it goes on; notices are dropped once nobody listens.
pub struct Reporter<W, T>(SyncSender<Message<W, T>>);

impl<W, T> Reporter<W, T> {
    pub fn report(&self, notice: W) {
        // nobody listens any more once an interrupt came
        let _ = self.0.send(Message::Notice(notice));
    }
}

/// What to do with work that was asked to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leave {
    /// Wait until it has written what it has.
    WhenKept,
    /// Go: it ends by itself, and nobody needs what it has.
    AtOnce,
}

/// Runs `work` without the interpreter's lock; `listen` gets its notices, on the calling thread and with the lock.
///
/// Ctrl-C, and an exception of `listen`, raise the interrupt and are given back.
pub fn attend<W, T>(
    py: Python<'_>,
    interrupt: &Interrupt,
    leave: Leave,
    mut listen: impl FnMut(Python<'_>, W) -> PyResult<()>,
    work: impl FnOnce(&Reporter<W, T>) -> Result<T, Refusal> + Send + 'static,
) -> PyResult<T>
where
    W: Send + 'static,
    T: Send + 'static,
{
    let (sender, mut notices) = sync_channel(WAITING);
    let run = move || {
        let reporter = Reporter(sender);
        let end = work(&reporter);
        let _ = reporter.0.send(Message::End(end));
    };
    let worker = thread::Builder::new().stack_size(STACK).spawn(run)?;
    let stopped = loop {
        let next;
        (notices, next) = py.detach(move || {
            let next = notices.recv_timeout(PAUSE);
            (notices, next)
        });
        let outcome = match next {
            Ok(Message::End(end)) => return end.map_err(PyErr::from),
            Ok(Message::Notice(notice)) => listen(py, notice),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => Err(PyRuntimeError::new_err(
                "the computation ended in a fault of the program, printed above: please report it",
            )),
        };
        if let Err(error) = outcome.and_then(|()| py.check_signals()) {
            break error;
        }
    };
    interrupt.request();
    drop(notices);
    if leave == Leave::WhenKept {
        // a worker that panicked has said so
        let _ = py.detach(|| worker.join());
    }
    Err(stopped)
}

/// A file for checkpoints and the seconds between them.
pub type Checkpoint = Option<(PathBuf, f64)>;

/// Hooks of a run that an interrupt stops and that keeps its checkpoints in a file, if there is one.
pub fn hooks<'a, F: ?Sized>(interrupt: &Interrupt, file: &Checkpoint) -> RunHooks<'a, F> {
    let hooks = RunHooks::new(interrupt);
    match file {
        Some((path, seconds)) => hooks.with_checkpoint(path, *seconds),
        None => hooks,
    }
}

/// The same for work that says nothing and leaves nothing behind.
pub fn quietly<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Interrupt) -> Result<T, Refusal> + Send + 'static,
) -> PyResult<T> {
    let interrupt = Interrupt::new();
    let token = interrupt.clone();
    let silent = |_: Python<'_>, (): ()| Ok(());
    attend(py, &interrupt, Leave::AtOnce, silent, move |_| work(&token))
}
