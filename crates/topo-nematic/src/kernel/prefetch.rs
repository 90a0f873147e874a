//! Prefetches data before they are needed.
//!
//! A pass reads and writes up to forty rows side by side, more streams than the processor prefetches by itself: without these
//! calls it waits for memory a third of the time.

/// Prefetches the cache line of `array` that is `BYTES` beyond element `at`. Only a hint: it may be beyond the end.
#[inline(always)]
pub(crate) fn prefetch<T, const BYTES: usize>(array: &[T], at: usize) {
    let place = array
        .as_ptr()
        .wrapping_add(at)
        .cast::<i8>()
        .wrapping_add(BYTES);
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        // SAFETY: the instruction belongs to the base set of the architecture, reads nothing and faults at no address.
        #[allow(unsafe_code)]
        unsafe {
            _mm_prefetch::<_MM_HINT_T1>(place);
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}
