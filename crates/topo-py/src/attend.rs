//! Work on a thread of its own, while the calling thread hears what it says and whether Ctrl-C was pressed.

use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use topo_core::Interrupt;

use crate::refusal::Refusal;

/// Longest time until Ctrl-C is noticed.
const PAUSE: Duration = Duration::from_millis(40);
/// Words that may wait for the interpreter; then the work waits, so that memory stays bounded.
const WAITING: usize = 64;
/// Stack of the thread, that of a main thread.
const STACK: usize = 8 << 20;

enum Said<W, T> {
    Word(W),
    End(Result<T, Refusal>),
}

/// What work says while it goes on; words are dropped once nobody listens.
pub struct Teller<W, T>(SyncSender<Said<W, T>>);

impl<W, T> Teller<W, T> {
    pub fn tell(&self, word: W) {
        // nobody listens any more once an interrupt came
        let _ = self.0.send(Said::Word(word));
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

/// Runs `work` without the interpreter's lock; `hear` gets its words, on the calling thread and with the lock.
///
/// Ctrl-C, and an exception of `hear`, raise the interrupt and are given back.
pub fn attend<W, T>(
    py: Python<'_>,
    interrupt: &Interrupt,
    leave: Leave,
    mut hear: impl FnMut(Python<'_>, W) -> PyResult<()>,
    work: impl FnOnce(&Teller<W, T>) -> Result<T, Refusal> + Send + 'static,
) -> PyResult<T>
where
    W: Send + 'static,
    T: Send + 'static,
{
    let (sender, mut words) = sync_channel(WAITING);
    let run = move || {
        let teller = Teller(sender);
        let end = work(&teller);
        let _ = teller.0.send(Said::End(end));
    };
    let worker = thread::Builder::new().stack_size(STACK).spawn(run)?;
    let stopped = loop {
        let next;
        (words, next) = py.detach(move || {
            let next = words.recv_timeout(PAUSE);
            (words, next)
        });
        let heard = match next {
            Ok(Said::End(end)) => return end.map_err(PyErr::from),
            Ok(Said::Word(word)) => hear(py, word),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => Err(PyRuntimeError::new_err(
                "the computation ended in a fault of the program, printed above: please report it",
            )),
        };
        if let Err(error) = heard.and_then(|()| py.check_signals()) {
            break error;
        }
    };
    interrupt.request();
    drop(words);
    if leave == Leave::WhenKept {
        // a worker that panicked has said so
        let _ = py.detach(|| worker.join());
    }
    Err(stopped)
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
