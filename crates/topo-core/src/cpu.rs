//! Processor time of the calling thread.

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;

/// Measures the processor time of the thread that started it; elapsed time where the system does not provide it.
#[derive(Debug, Clone)]
pub struct CpuClock {
    start: Option<Duration>,
    instant: Instant,
}

impl CpuClock {
    /// Starts now, for this thread.
    pub fn start() -> Self {
        Self {
            start: thread_time(),
            instant: Instant::now(),
        }
    }

    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        let elapsed = match (self.start, thread_time()) {
            (Some(start), Some(now)) => now.saturating_sub(start),
            _ => self.instant.elapsed(),
        };
        elapsed.as_secs_f64()
    }
}

fn thread_time() -> Option<Duration> {
    ThreadTime::try_now().ok().map(|time| time.as_duration())
}
