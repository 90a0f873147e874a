//! The instruction sets that kernels are compiled for.

/// Runs an expression compiled for the widest vectors of the processor: of 64 bytes (AVX-512), of 32 (AVX2) or of 16.
///
/// The macro of the same name in `fearless_simd` adds SSE4.2, whose vectors are no wider than those that each x86-64
/// processor has: a quarter more to compile, for processors made before 2013.
#[cfg(target_arch = "x86_64")]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $work:expr) => {{
        let level: fearless_simd::Level = $level;
        if let Some($simd) = level.as_avx512() {
            fearless_simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $work,
            )
        } else if let Some($simd) = level.as_avx2() {
            fearless_simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $work,
            )
        } else if let Some($simd) = level.as_sse2() {
            fearless_simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $work,
            )
        } else {
            unreachable!("SSE2 belongs to x86-64")
        }
    }};
}

#[cfg(not(target_arch = "x86_64"))]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $work:expr) => {
        fearless_simd::dispatch!($level, $simd => $work)
    };
}

pub(crate) use dispatch;
