//! Storage precision of fields: f64 or f32; sums are in f64 with either.

use fearless_simd::{Simd, SimdFloatElement};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number that fields are stored in: `f64` or `f32`.
pub trait Real:
    SimdFloatElement
    + crate::flow::Stored
    + num::Arithmetic
    + Into<f64>
    + Default
    + PartialEq
    + Send
    + Sync
    + std::fmt::Debug
    + 'static
{
    /// Rounds a double to this precision.
    fn of(x: f64) -> Self;
}

mod num {
    use std::ops::{Add, Mul, Sub};

    /// What kernels do with single numbers.
    pub trait Arithmetic:
        Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
    {
    }
    impl Arithmetic for f64 {}
    impl Arithmetic for f32 {}
}

impl Real for f64 {
    fn of(x: f64) -> Self {
        x
    }
}

impl Real for f32 {
    fn of(x: f64) -> Self {
        x as f32
    }
}

/// Precision in which the field is stored while it is advanced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 8 bytes per number.
    #[default]
    Double,
    /// 4 bytes per number: half the memory traffic, rounding errors of 6e-8 S.
    Single,
}

impl Precision {
    /// The name used in tables and scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "f64",
            Self::Single => "f32",
        }
    }

    /// Bytes of a number.
    pub fn n_bytes(self) -> u64 {
        match self {
            Self::Double => 8,
            Self::Single => 4,
        }
    }
}

/// Numbers that a kernel treats at once.
pub(crate) trait Lanes:
    Copy + std::ops::Add<Output = Self> + std::ops::Sub<Output = Self> + std::ops::Mul<Output = Self>
{
    /// One of them.
    type Scalar: Real;
    /// What proves that the processor can.
    type Token: Copy;
    /// How many.
    const N: usize;
    /// The same number in all lanes.
    fn splat(token: Self::Token, x: Self::Scalar) -> Self;
    /// The first N numbers of a slice.
    fn load(token: Self::Token, from: &[Self::Scalar]) -> Self;
    /// Writes the first N numbers of a slice.
    fn store(self, to: &mut [Self::Scalar]);
    /// self * a + b.
    fn mul_add(self, a: Self, b: Self) -> Self;
}

/// As many numbers as the processor's registers hold.
#[derive(Clone, Copy)]
pub(crate) struct Wide<S: Simd, T: SimdFloatElement>(T::Native<S>);

/// One number.
#[derive(Clone, Copy)]
pub(crate) struct One<T>(T);

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<S: Simd, T: SimdFloatElement> std::ops::$trait for Wide<S, T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(std::ops::$trait::$method(self.0, other.0))
            }
        }
        impl<T: Real> std::ops::$trait for One<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(std::ops::$trait::$method(self.0, other.0))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);

impl<S: Simd, T: Real> Lanes for Wide<S, T> {
    type Scalar = T;
    type Token = S;
    const N: usize = <T::Native<S> as fearless_simd::SimdBase<S>>::LEN;

    #[inline(always)]
    fn splat(token: S, x: T) -> Self {
        Self(fearless_simd::SimdBase::splat(token, x))
    }

    #[inline(always)]
    fn load(token: S, from: &[T]) -> Self {
        Self(fearless_simd::SimdBase::from_slice(token, &from[..Self::N]))
    }

    #[inline(always)]
    fn store(self, to: &mut [T]) {
        fearless_simd::SimdBase::store_slice(&self.0, &mut to[..Self::N]);
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(fearless_simd::SimdFloat::mul_add(self.0, a.0, b.0))
    }
}

impl<T: Real> Lanes for One<T> {
    type Scalar = T;
    type Token = ();
    const N: usize = 1;

    #[inline(always)]
    fn splat((): (), x: T) -> Self {
        Self(x)
    }

    #[inline(always)]
    fn load((): (), from: &[T]) -> Self {
        Self(from[0])
    }

    #[inline(always)]
    fn store(self, to: &mut [T]) {
        to[0] = self.0;
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(self.0 * a.0 + b.0)
    }
}
