//! Compensated sums: what rounding cuts off from a sum is kept beside it and added with the next
//! summand.
//!
//! In: a number with its carry, a summand. Out: both after the addition. Never here: what is summed.
//!
//! Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, VIII.5.

use super::DoubleDouble;

/// Adds `by` to `value + carry`, a number of two parts. Nothing is done for a summand of zero, so
/// that the sign of a zero stays.
#[inline(always)]
pub fn accumulate(value: &mut f64, carry: &mut f64, by: f64) {
    let sum = DoubleDouble::sum(*value, by);
    let low = sum.low + *carry;
    *value = sum.high + low;
    *carry = low - (*value - sum.high);
}
