//! The exponent of two of a number of any size.
//!
//! In and out: whole numbers, exact up to 2¹⁷². Never here: mantissas.
//!
//! A moderate exponent is an `i128`. That of e^u is as large as u itself: beyond 2¹²⁰ it is a number of
//! `f64` and a rest, so that what is finite beside it, as the factor u′ of the slope of e^u, is kept to
//! the last bit and remains where the large part cancels, as in the slope of ln(1 + e^u).

use super::double_double::DoubleDouble;
use super::real::Analytic;

/// The whole number `far · 2^(512 scale) + near`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Exponent {
    near: i128,
    /// Zero, or a whole number beyond what `near` holds; infinite beyond all range, and a NaN where it is not known.
    far: f64,
    /// How often 2⁵¹² is taken out of it: that of e^(e^u) is e^u.
    scale: i128,
}

/// 2⁵¹², and where it is taken out or put back.
const UNIT: f64 = f64::from_bits((1023 + 512) << 52);
const LARGEST: f64 = f64::from_bits((1023 + 1000) << 52);
const SMALLEST: f64 = f64::from_bits((1023 + 300) << 52);

/// A number in units of a power of 2⁵¹² that are farther apart than this is nothing beside another.
const DIFFERENT: i128 = 2;

/// Beyond this the large part of an exponent is stored in `far`.
const FAR: i128 = 1 << 122;

/// Below this it is stored in `near` again.
const NEAR: f64 = (1_i128 << 121) as f64;

/// A rest up to this size is kept.
const REST: f64 = (1_i128 << 119) as f64;

/// Beyond this the rest of a sum may be larger: 2¹⁷².
const EXACT: f64 = REST * (1_i128 << 53) as f64;

/// Where so small a part of two rounded exponents is left it is nothing but their rounding.
const ROUNDED: f64 = 1e-12;

/// 2¹⁰⁰.
pub(super) const FAR_UNIT: f64 = (1_i128 << 100) as f64;

/// A difference larger than this counts as this.
const APART: i128 = 1 << 100;

impl Exponent {
    pub(super) const ZERO: Exponent = Exponent::of(0);

    pub(super) const fn of(near: i128) -> Exponent {
        Exponent { near, far: 0.0, scale: 0 }
    }

    /// The whole number nearest to a large one.
    pub(super) fn nearest(x: DoubleDouble) -> Exponent {
        let rest = if x.low.abs() < REST { x.low.round() as i128 } else { 0 };
        Exponent { near: rest, far: x.high, scale: 0 }.settled()
    }

    /// The number `x · 2^power`, where that is beyond the range of `f64`; infinite where the power is itself out of range.
    pub(super) fn beyond_range(x: f64, power: Exponent) -> Exponent {
        let moderate = power.moderate();
        if power.far != 0.0 || moderate.abs() >= APART / 2 {
            return Exponent { near: 0, far: f64::INFINITY.copysign(x), scale: 0 };
        }
        let scale = moderate.div_euclid(512);
        let rest = f64::from_bits(((1023 + moderate - 512 * scale) as u64) << 52);
        Exponent { near: 0, far: x * rest, scale }.settled()
    }

    /// Zero, or an infinite number or a NaN where it is beyond all range or not known.
    pub(super) fn beyond(self) -> f64 {
        if self.far.is_finite() { 0.0 } else { self.far }
    }

    pub(super) fn plus(self, other: Exponent) -> Exponent {
        let near = self.near + other.near;
        if self.far == 0.0 && other.far == 0.0 {
            return Exponent::of(near).settled();
        }
        if !(self.far.is_finite() && other.far.is_finite()) {
            return Exponent { near: 0, far: self.far + other.far, scale: 0 };
        }
        if self.scale > 0 || other.scale > 0 {
            return self.plus_beyond_range(other);
        }
        let sum = DoubleDouble::sum(self.far, other.far);
        let rest = if sum.low.abs() < REST { Some(sum.low as i128) } else { None };
        let largest = self.far.abs().max(other.far.abs());
        if largest > EXACT && sum.high != 0.0 && sum.high.abs() < ROUNDED * largest {
            return Exponent { near: 0, far: f64::NAN, scale: 0 };
        }
        Exponent { near: near + rest.unwrap_or(0), far: sum.high, scale: 0 }.settled()
    }

    /// The sum of two of which one is beyond the range of `f64`.
    fn plus_beyond_range(self, other: Exponent) -> Exponent {
        let scale = self.scale.max(other.scale);
        let part = |x: Exponent| match scale - x.scale {
            0 => x.far,
            apart if apart < DIFFERENT => x.far / UNIT,
            _ => 0.0,
        };
        let (own, others) = (part(self), part(other));
        let far = own + others;
        if far == 0.0 {
            return Exponent::of(self.near + other.near).settled();
        }
        if far.abs() < ROUNDED * own.abs().max(others.abs()) {
            return Exponent { near: 0, far: f64::NAN, scale: 0 };
        }
        Exponent { near: self.near + other.near, far, scale }.settled()
    }

    pub(super) fn minus(self, other: Exponent) -> Exponent {
        self.plus(Exponent { near: -other.near, far: -other.far, scale: other.scale })
    }

    /// Half of it, and what is left over of an odd one.
    pub(super) fn halved(self) -> (Exponent, i128) {
        // a large part is a multiple of a high power of two
        let odd = self.near.rem_euclid(2);
        (Exponent { near: (self.near - odd) / 2, far: 0.5 * self.far, ..self }.settled(), odd)
    }

    /// The number itself, or one beyond ±2¹⁰⁰ with its sign.
    pub(super) fn moderate(self) -> i128 {
        let far = self.far.clamp(-REST, REST) as i128;
        (self.near.clamp(-APART, APART) + far).clamp(-APART, APART)
    }

    /// Whether it is the difference of two that are too large for their difference to be known.
    pub(super) fn is_unknown(self) -> bool {
        self.far.is_nan()
    }

    /// Its value, to twice the digits of `f64`, in units of a power of two, and the exponent of that.
    pub(super) fn value(self) -> (DoubleDouble, Exponent) {
        if self.scale > 0 {
            return (DoubleDouble::from(self.far), Exponent::of(512 * self.scale));
        }
        let high = self.near as f64;
        let low = (self.near - high as i128) as f64;
        let value = DoubleDouble::from(self.far) + DoubleDouble::sum(high, low);
        (value.scaled(FAR_UNIT.recip()), Exponent::of(100))
    }

    /// The same number with its large part where it belongs.
    fn settled(self) -> Exponent {
        let Exponent { mut near, mut far, mut scale } = self;
        while far.is_finite() && far.abs() > LARGEST {
            (far, scale) = (far / UNIT, scale + 1);
        }
        while scale > 0 && far.abs() < SMALLEST {
            (far, scale) = (far * UNIT, scale - 1);
        }
        if scale > 0 {
            return Exponent { near, far, scale };
        }
        if far != 0.0 && far.abs() < NEAR {
            (near, far) = (near + far as i128, 0.0);
        }
        if near.abs() > FAR {
            let large = near as f64;
            let sum = DoubleDouble::sum(far, large);
            let rest = if sum.low.abs() < REST { sum.low as i128 } else { 0 };
            (near, far) = (near - large as i128 + rest, sum.high);
        }
        Exponent { near, far, scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_small_beside_a_large_exponent_is_not_lost() {
        for size in [1e10, 1e30, 1e36, 1e38, 1e45] {
            let large = Exponent::nearest(DoubleDouble::from(size));
            let small = Exponent::of(120);
            assert_eq!(large.plus(small).minus(large).moderate(), 120, "{size:e}");
            let thrice = large.plus(large).plus(large);
            assert_eq!(thrice.minus(large).minus(large).minus(large).moderate(), 0, "{size:e}");
            assert_eq!(large.minus(small).minus(large.plus(large)).plus(large).moderate(), -120);
            let (half, odd) = large.plus(large).halved();
            assert_eq!((half.minus(large).moderate(), odd), (0, 0), "{size:e}");
        }
    }

    #[test]
    fn where_only_rounding_is_left_nothing_is_known() {
        let whole = Exponent::nearest(DoubleDouble::from(1e60));
        let beside = Exponent::nearest(DoubleDouble::from(1e60_f64.next_up()));
        assert!(beside.minus(whole).beyond().is_nan());
        assert_eq!((whole.minus(whole).moderate(), whole.minus(whole).beyond()), (0, 0.0));
        // from a part of 1e-12 on it is more than that
        let nearer = Exponent::nearest(DoubleDouble::from(1e60 * (1.0 + 0.8e-12)));
        let farther = Exponent::nearest(DoubleDouble::from(1e60 * (1.0 + 1.25e-12)));
        assert!(nearer.minus(whole).beyond().is_nan());
        assert_eq!(farther.minus(whole).beyond(), 0.0);
        let third = Exponent::nearest(DoubleDouble::from(1e60 / 3.0));
        assert_eq!(whole.plus(third).minus(whole).beyond(), 0.0);
        let largest = Exponent::nearest(DoubleDouble::from(1e308));
        let twice = largest.plus(largest);
        assert_eq!((twice.beyond(), twice.minus(largest)), (0.0, largest));
        assert_eq!(largest.minus(twice).minus(largest).plus(twice).moderate(), 0);
    }

    #[test]
    fn exponents_beyond_the_range_of_numbers_are_sums_too() {
        // 3 · 2^(10⁶), and half of it, and 3 · 2^(2⁹⁸)
        for power in [1_000_000, 1 << 98] {
            let large = Exponent::beyond_range(3.0, Exponent::of(power));
            let half = Exponent::beyond_range(1.5, Exponent::of(power));
            assert_eq!((half.plus(half), large.beyond()), (large, 0.0));
            assert_eq!(large.minus(half), half);
            assert_eq!(large.halved(), (half, 0));
            assert_eq!(large.minus(half).minus(half).moderate(), 0);
        }
        let large = Exponent::beyond_range(3.0, Exponent::of(1_000_000));
        let half = Exponent::beyond_range(1.5, Exponent::of(1_000_000));
        // what is small beside it remains where it cancels
        let small = Exponent::of(12);
        assert_eq!(large.plus(small).minus(large).moderate(), 12);
        let moderate = Exponent::nearest(DoubleDouble::from(1e200));
        assert_eq!(large.plus(moderate), large);
        assert!(large.minus(half).moderate() > 0 && half.minus(large).moderate() < 0);
        assert_eq!(Exponent::beyond_range(-1.0, large).beyond(), f64::NEG_INFINITY);
    }
}
