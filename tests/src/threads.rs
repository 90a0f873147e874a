//! Work on a given number of threads, whatever the machine has.

/// Calls `work` in a pool of `n` threads: on one processor too, several take turns.
///
/// # Panics
/// When the pool cannot be made.
pub fn on_threads<R: Send>(n: usize, work: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
    pool.expect("a pool of threads").install(|| {
        assert_eq!(rayon::current_num_threads(), n);
        work()
    })
}
