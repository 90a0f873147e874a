//! Integers modulo a prime.

/// Mersenne's prime 2^61 - 1: every coefficient of a polynomial met here is far below half of it.
pub(super) const P: u64 = (1 << 61) - 1;

pub(super) fn add(a: u64, b: u64) -> u64 {
    let s = a + b;
    if s >= P { s - P } else { s }
}

pub(super) fn sub(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + P - b }
}

pub(super) fn mul(a: u64, b: u64) -> u64 {
    let wide = u128::from(a) * u128::from(b);
    add((wide as u64) & P, (wide >> 61) as u64)
}

pub(super) fn inverse(a: u64) -> u64 {
    let (mut power, mut result, mut exponent) = (a, 1, P - 2);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = mul(result, power);
        }
        power = mul(power, power);
        exponent >>= 1;
    }
    result
}

/// A power, of a negative exponent too.
pub(super) fn power(a: u64, exponent: i32) -> u64 {
    let base = if exponent < 0 { inverse(a) } else { a };
    (0..exponent.unsigned_abs()).fold(1, |product, _| mul(product, base))
}

/// The remainder of an integer.
pub(super) fn of(c: i64) -> u64 {
    c.rem_euclid(P as i64) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn field_arithmetic_inverts() {
        for a in [1, 2, 12_345, P - 1, P / 3] {
            assert_eq!(mul(a, inverse(a)), 1);
        }
        assert_eq!(sub(add(P - 1, 5), 5), P - 1);
    }
}
