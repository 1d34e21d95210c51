//! Powers whose exponent depends on parameters only, as Taylor series.
//!
//! In: the series of the base, the exponent, the registers of the power. Out: a coefficient. An
//! integer exponent is done by repeated squaring, which also works at the zeros of the base: the
//! registers after that of the power contain, for each bit of the exponent, the square and the
//! product of the factors so far.

use super::program::PARAMETRIC_POWER_BITS;
use crate::num::{DoubleDouble, Real};

/// The coefficient of order `k` of `a^exponent`. `own` begins with the register of the power.
pub(super) fn coefficient<R: Real>(
    a: &[R],
    exponent: DoubleDouble,
    own: &mut [R],
    k: usize,
    stride: usize,
) -> R {
    let n = exponent.high;
    if exponent.low != 0.0 || n.fract() != 0.0 || n.abs() >= f64::from(1 << PARAMETRIC_POWER_BITS) {
        return power(a, exponent, own, k);
    }
    let size = n.abs() as u32;
    let mut last: Option<usize> = None;
    for bit in 0..PARAMETRIC_POWER_BITS {
        let (squares, products) = (stride * (1 + 2 * bit), stride * (2 + 2 * bit));
        if size >> bit == 0 {
            break;
        }
        let squared = match bit {
            0 => a[k],
            _ => square(&own[squares - 2 * stride..][..stride], k),
        };
        own[squares + k] = squared;
        let this = &own[squares..][..stride];
        own[products + k] = match (size >> bit & 1, last) {
            (1, Some(last)) => product(this, &own[last..][..stride], k),
            (1, None) => this[k],
            (_, Some(last)) => own[last + k],
            (_, None) => continue,
        };
        last = Some(products);
    }
    let whole = match last {
        Some(last) => &own[last..][..stride],
        None => return if k == 0 { R::ONE } else { R::ZERO },
    };
    if n > 0.0 {
        whole[k]
    } else {
        let one = if k == 0 { R::ONE } else { R::ZERO };
        quotient(one, whole, own, k)
    }
}

/// `Σ_{j=0}^{k} a_j b_{k−j}`.
fn product<R: Real>(a: &[R], b: &[R], k: usize) -> R {
    (0..=k).fold(R::ZERO, |sum, j| sum + a[j] * b[k - j])
}

/// The same for `b = a`.
fn square<R: Real>(a: &[R], k: usize) -> R {
    let pairs = (0..k.div_ceil(2)).fold(R::ZERO, |sum, j| sum + a[j] * a[k - j]) * 2.0;
    if k.is_multiple_of(2) { pairs + a[k / 2] * a[k / 2] } else { pairs }
}

/// `y = a/b`: `y_k = (a_k − Σ_{j=1}^{k} b_j y_{k−j}) / b_0`.
fn quotient<R: Real>(a_k: R, b: &[R], y: &[R], k: usize) -> R {
    (1..=k).fold(a_k, |sum, j| sum - b[j] * y[k - j]) / b[0]
}

/// `y = a^α`: `y_k = Σ_{j=0}^{k−1} (α (k − j) − j) a_{k−j} y_j / (k a_0)`.
fn power<R: Real>(a: &[R], exponent: DoubleDouble, y: &[R], k: usize) -> R {
    if k == 0 {
        return a[0].power(exponent);
    }
    if vanishes(a, k) && exponent.high > 0.0 {
        return R::ZERO;
    }
    let alpha = R::of(exponent);
    let sum = (0..k).fold(R::ZERO, |sum, j| {
        let factor = alpha * (k - j) as f64 - R::ONE * j as f64;
        sum + factor * a[k - j] * y[j]
    });
    sum / (a[0] * k as f64)
}

/// Whether a series is identically zero as far as it is known.
fn vanishes<R: Real>(a: &[R], k: usize) -> bool {
    a[..=k].iter().all(|c| c.value() == 0.0)
}
