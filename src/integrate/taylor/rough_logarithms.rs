//! Logarithms of the sizes of coefficients and their inverse, as far as the length of a step needs them.
//!
//! In: numbers. Out: the natural logarithms of their absolute values, to four digits or so; exponentials, to eight. Never
//! here: the rule that reads them.

use super::last_orders::{FAINT, LANES, ROOM};
use crate::num::{FourLanes, padded};

/// The natural logarithms of the absolute values, to four digits or so.
#[inline(always)]
pub(super) fn logarithms<L: FourLanes>(lanes: L, of: &[f64], logs: &mut [f64; ROOM]) {
    let (chunks, rest) = of.as_chunks::<LANES>();
    let places = logs.as_chunks_mut::<LANES>().0;
    // by places, since what is given to an iterator is not always inlined
    for i in 0..chunks.len() {
        places[i] = lanes.to_array(four_logarithms(lanes, lanes.abs(lanes.from_array(chunks[i]))));
    }
    if !rest.is_empty() {
        let rest = lanes.from_array(padded(rest, 0.0));
        places[chunks.len()] = lanes.to_array(four_logarithms(lanes, lanes.abs(rest)));
    }
}

/// The middle of the mantissas, about which their logarithms are power series.
const MIDDLE: f64 = 1.5;
const LN_MIDDLE: f64 = 0.405_465_108_108_164_4;

/// The natural logarithms of positive numbers to four digits or so, by their exponents and a power
/// series about the middle of the mantissas; −∞ for what is as good as zero.
#[inline(always)]
pub(super) fn four_logarithms<L: FourLanes>(lanes: L, x: L::Numbers) -> L::Numbers {
    let (mantissa, exponent) = lanes.mantissa_exponent(x);
    let t = lanes.mul(lanes.sub(mantissa, lanes.splat(MIDDLE)), lanes.splat(1.0 / MIDDLE));
    let even = lanes.mul(t, t);
    let mut first = lanes.splat(1.0 / 7.0);
    let mut second = lanes.splat(1.0 / 6.0);
    for i in 0..3 {
        first = lanes.add(lanes.splat([0.2, 1.0 / 3.0, 1.0][i]), lanes.mul(even, first));
    }
    for i in 0..2 {
        second = lanes.add(lanes.splat([0.25, 0.5][i]), lanes.mul(even, second));
    }
    let series = lanes.sub(lanes.mul(t, first), lanes.mul(even, second));
    let log = lanes.mul(exponent, lanes.splat(std::f64::consts::LN_2));
    let log = lanes.add(lanes.add(log, lanes.splat(LN_MIDDLE)), series);
    lanes.where_below(x, lanes.splat(FAINT), lanes.splat(f64::NEG_INFINITY), log)
}

/// An exponential to eight digits or so: a power of two, and the power series of the rest. Infinite or zero beyond ±709.
#[inline(always)]
pub(super) fn rough_exponential(x: f64) -> f64 {
    const MIDDLE: f64 = 1.5 * (1_u64 << 52) as f64;
    const TERMS: [f64; 7] =
        [1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0];
    const ABOVE: f64 = 709.0;
    // the nearest integer, in the last digits of 1.5 × 2⁵²
    let rounded = x * std::f64::consts::LOG2_E + MIDDLE;
    let t = x - (rounded - MIDDLE) * std::f64::consts::LN_2;
    let power = f64::from_bits((rounded.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
    let mut sum = 0.0;
    for term in TERMS {
        sum = (sum + term) * t;
    }
    let within = power * (1.0 + sum);
    let beyond = if x > 0.0 { f64::INFINITY } else { 0.0 };
    if x.abs() > ABOVE { beyond } else { within }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{ScalarLanes, math};

    #[test]
    fn rough_exponentials_have_eight_digits() {
        for i in -7000..7000 {
            let x = f64::from(i) * 0.10123;
            assert!((rough_exponential(x) / math::exp(x) - 1.0).abs() < 1e-8, "{x}");
        }
        assert_eq!(rough_exponential(710.0), f64::INFINITY);
        assert_eq!(rough_exponential(-710.0), 0.0);
        assert_eq!(rough_exponential(f64::NEG_INFINITY), 0.0);
    }

    #[test]
    fn rough_logarithms_have_four_digits() {
        for i in -2000..2000 {
            let x = math::exp(f64::from(i) * 0.3137);
            let logs = four_logarithms(ScalarLanes, [x; LANES]);
            assert!(logs.iter().all(|log| (log - math::ln(x)).abs() < 1e-4), "{x}");
        }
    }
}
