//! Processor time of the calling thread.

use std::time::Instant;

/// Measures the processor time of the thread that started it; elapsed time where the system does not tell.
#[derive(Debug, Clone)]
pub struct CpuClock {
    start: Option<f64>,
    instant: Instant,
}

impl CpuClock {
    /// Starts now, for this thread.
    pub fn start() -> Self {
        Self {
            start: thread_seconds(),
            instant: Instant::now(),
        }
    }

    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        match (self.start, thread_seconds()) {
            (Some(start), Some(now)) => now - start,
            _ => self.instant.elapsed().as_secs_f64(),
        }
    }
}

fn thread_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
