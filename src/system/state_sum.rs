//! The numbers of a state as the sums of their series.
//!
//! In: the coefficients of each number, in its unit, and a time. Out: the state then. Never here: how coefficients are computed.

use super::state::State;
use crate::num::{Analytic, DoubleDouble, Kernel, Polynomial, tail};

/// The polynomials of a state, at a time in the unit of the series.
pub(super) struct StateSum<'a, Low, High> {
    /// The terms of low order of each number, in double-double, as many for all.
    pub(super) low: Low,
    /// All terms of each number.
    pub(super) high: High,
    pub(super) units: &'a [f64],
    pub(super) x: DoubleDouble,
    pub(super) out: &'a mut State,
}

impl<'a, Low, High> Kernel for StateSum<'a, Low, High>
where
    Low: Fn(usize) -> &'a [DoubleDouble],
    High: Fn(usize) -> &'a [f64],
{
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let StateSum { low, high, units, x, out } = self;
        for i in 0..units.len() {
            let unit = units[i];
            let low = low(i);
            let high = &high(i)[low.len()..];
            let number = Polynomial { low, high, x }.with_tail::<FUSED>(tail(high, x.high));
            out.set(i, if unit == 1.0 { number } else { in_unit(number, unit) });
        }
    }
}

/// A number in a small unit. Below the numbers that keep all their digits it is zero: what decays comes to
/// an end.
fn in_unit(number: DoubleDouble, unit: f64) -> DoubleDouble {
    let number = number.scaled(unit);
    if number.high.is_normal() { number } else { DoubleDouble::ZERO }
}
