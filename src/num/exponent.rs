//! The exponent of two of a number of any size.
//!
//! In and out: whole numbers, exact up to 2¹⁷². Never here: mantissas.
//!
//! A moderate exponent is an `i128`. That of e^u is as large as u itself: beyond 2¹²⁰ it is a number of
//! `f64` and a rest, so that what is finite beside it, as the factor u′ of the slope of e^u, is kept to
//! the last bit and remains where the large part cancels, as in the slope of ln(1 + e^u).

use super::double_double::DoubleDouble;

/// The whole number `far + near`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Exponent {
    near: i128,
    /// Zero, or a whole number beyond what `near` holds; infinite beyond what an `f64` holds, and a NaN where it is not
    /// known.
    far: f64,
}

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

/// A difference larger than this counts as this.
const APART: i128 = 1 << 100;

impl Exponent {
    pub(super) const ZERO: Exponent = Exponent::of(0);

    pub(super) const fn of(near: i128) -> Exponent {
        Exponent { near, far: 0.0 }
    }

    /// The whole number nearest to a large one.
    pub(super) fn nearest(x: DoubleDouble) -> Exponent {
        let rest = if x.low.abs() < REST { x.low.round() as i128 } else { 0 };
        Exponent { near: rest, far: x.high }.settled()
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
        if !(self.far + other.far).is_finite() {
            return Exponent { near: 0, far: self.far + other.far };
        }
        let sum = DoubleDouble::sum(self.far, other.far);
        let rest = if sum.low.abs() < REST { Some(sum.low as i128) } else { None };
        let largest = self.far.abs().max(other.far.abs());
        if largest > EXACT && sum.high != 0.0 && sum.high.abs() < ROUNDED * largest {
            return Exponent { near: 0, far: f64::NAN };
        }
        Exponent { near: near + rest.unwrap_or(0), far: sum.high }.settled()
    }

    pub(super) fn minus(self, other: Exponent) -> Exponent {
        self.plus(Exponent { near: -other.near, far: -other.far })
    }

    /// Half of it, and what is left over of an odd one.
    pub(super) fn halved(self) -> (Exponent, i128) {
        // a large part is a multiple of a high power of two
        let odd = self.near.rem_euclid(2);
        (Exponent { near: (self.near - odd) / 2, far: 0.5 * self.far }.settled(), odd)
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

    /// Its value, to twice the digits of `f64`.
    pub(super) fn value(self) -> DoubleDouble {
        let high = self.near as f64;
        let low = (self.near - high as i128) as f64;
        DoubleDouble::from(self.far) + DoubleDouble::sum(high, low)
    }

    /// The same number with its large part where it belongs.
    fn settled(self) -> Exponent {
        let Exponent { mut near, mut far } = self;
        if far != 0.0 && far.abs() < NEAR {
            (near, far) = (near + far as i128, 0.0);
        }
        if near.abs() > FAR {
            let large = near as f64;
            let sum = DoubleDouble::sum(far, large);
            let rest = if sum.low.abs() < REST { sum.low as i128 } else { 0 };
            (near, far) = (near - large as i128 + rest, sum.high);
        }
        Exponent { near, far }
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
        assert_eq!(largest.plus(largest).beyond(), f64::INFINITY);
        assert_eq!(Exponent::ZERO.minus(largest).minus(largest).beyond(), f64::NEG_INFINITY);
    }
}
