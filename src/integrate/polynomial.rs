//! Crossings as roots of the functions' own power series, for steps that are power series.
//!
//! In: the coefficients of a function about the beginning of a piece of the step. Out: every point
//! of the piece where it changes its sign; points where it only touches zero do not count. Never
//! here: which crossing counts first, how long a piece is.

use super::roots::{sign_changes, value_and_slope};

/// The sign of a value below this part of the terms of its polynomial is not trusted.
const SIGNLESS: f64 = 1e-13;

/// With a slope below this part of the terms a value may be rounding over many digits of the time.
const FLAT: f64 = 1e-6;

/// Two changes of sign between which a polynomial stays below this part of its terms count as a
/// touch.
const TOUCH: f64 = 1e-14;

/// A function on a piece of a step, as a polynomial in the time after the beginning of the piece.
pub(super) struct StepPolynomial {
    pub(super) coefficients: Vec<f64>,
    pub(super) length: f64,
    /// The time that counts as equal to the beginning.
    pub(super) soonest: f64,
}

/// The behaviour of a function on a piece.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct SignCourse {
    /// The sign at the beginning of the piece; zero for a function that vanishes identically.
    pub(super) side: f64,
    /// The sign changes, in order.
    pub(super) changes: Vec<PieceSignChange>,
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct PieceSignChange {
    /// The time after the beginning of the piece.
    pub(super) x: f64,
    /// The sign after it.
    pub(super) side: f64,
}

impl StepPolynomial {
    /// The size of all terms at the end of the piece.
    pub(super) fn size(&self) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * self.length + c.abs())
    }

    /// Whether the value at the beginning may be rounding.
    pub(super) fn begins_at_zero(&self) -> bool {
        self.coefficients[0].abs() <= SIGNLESS * self.size()
    }

    /// Whether the value at the end may be rounding, while the function leaves this side through
    /// zero.
    pub(super) fn ends_at_zero(&self, side: f64) -> bool {
        let (value, slope) = value_and_slope(&self.coefficients, self.length);
        value.abs() <= SIGNLESS * self.size() && slope * side < 0.0
    }

    /// Whether the slope at the end is so small that a value there which may be rounding may still belong to times far from
    /// a root.
    pub(super) fn ends_flat(&self) -> bool {
        self.slope(self.length).abs() * self.length <= FLAT * self.size()
    }

    /// Whether it is no more than rounding from a root to the end, as beside a root of a higher order at the end: then its sign
    /// there is not that of the function.
    pub(super) fn is_rounding_after(&self, root: f64) -> bool {
        self.ends_flat() && self.only_touches(root, self.length) && {
            let (value, _) = value_and_slope(&self.coefficients, self.length);
            value.abs() <= TOUCH * self.size()
        }
    }

    pub(super) fn slope(&self, x: f64) -> f64 {
        value_and_slope(&self.coefficients, x).1
    }

    /// Follows the function; `known` is its last known sign, zero if unknown. A value at the
    /// beginning that may be a rounding error, of the function or of the time, is ignored unless it
    /// agrees with `known`.
    pub(super) fn follow(&self, known: f64) -> SignCourse {
        let c = &self.coefficients[..];
        let doubtful = known == 0.0 || c[0] * known <= 0.0;
        let soon = value_and_slope(c, self.soonest).0;
        let (rest, from) = match doubtful {
            true if self.begins_at_zero() => (&c[1..], self.soonest),
            true if soon * known > 0.0 => (c, self.soonest),
            _ => (c, 0.0),
        };
        let soon = value_and_slope(rest, from).0;
        let first = [soon].into_iter().chain(rest.iter().copied()).find(|x| *x != 0.0);
        let side = first.map_or(0.0, f64::signum);
        let found = sign_changes(rest, self.length).filter(|change| change.x > from);
        let mut changes: Vec<PieceSignChange> = Vec::new();
        for change in found {
            let side = if change.rises { 1.0 } else { -1.0 };
            match changes.last() {
                Some(last) if self.only_touches(last.x, change.x) => drop(changes.pop()),
                _ => changes.push(PieceSignChange { x: change.x, side }),
            }
        }
        SignCourse { side, changes }
    }

    /// Whether the polynomial is no more than rounding between two of its roots.
    fn only_touches(&self, a: f64, b: f64) -> bool {
        let (value, _) = value_and_slope(&self.coefficients, 0.5 * (a + b));
        value.abs() <= TOUCH * self.size()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(coefficients: &[f64], known: f64) -> SignCourse {
        let coefficients = coefficients.to_vec();
        StepPolynomial { coefficients, length: 1.0, soonest: 1e-15 }.follow(known)
    }

    fn places(course: &SignCourse) -> Vec<f64> {
        course.changes.iter().map(|change| change.x).collect()
    }

    #[test]
    fn every_pair_of_crossings_is_found_and_a_touch_is_none() {
        // (x − ½)² − d²
        for d in [0.4, 1e-3, 1e-6] {
            let pair = course(&[0.25 - d * d, -1.0, 1.0], 1.0);
            let right = [0.5 - d, 0.5 + d];
            let found = places(&pair);
            assert_eq!(found.len(), 2, "{d}: {pair:?}");
            assert!(found.iter().zip(right).all(|(x, y)| (x - y).abs() < 1e-9), "{d}: {pair:?}");
        }
        assert_eq!(course(&[0.25, -1.0, 1.0], 1.0), SignCourse { side: 1.0, changes: Vec::new() });
        assert_eq!(course(&[-0.25, 1.0, -1.0], 0.0).side, -1.0);
    }

    #[test]
    fn a_function_that_leaves_zero_is_on_the_side_it_goes_to() {
        // a ball thrown up falls back on the ground, however soon
        for speed in [0.5, 1e-5, 1e-10] {
            let thrown = course(&[1e-17, speed, -1.0], 0.0);
            assert_eq!((thrown.side, places(&thrown).len()), (1.0, 1), "{speed}");
            assert!((places(&thrown)[0] - speed).abs() < 1e-12 * speed);
        }
        // a known sign is not doubted because of rounding
        let passed = course(&[-1e-17, 1.0, 0.1], 1.0);
        assert_eq!(passed, SignCourse { side: 1.0, changes: Vec::new() });
        // a crossing between two pieces is detected
        assert_eq!(course(&[1e-17, -1.0, 0.1], 1.0).changes.len(), 1);
        assert_eq!(course(&[-1e-17, -1.0, 0.1], 1.0).side, -1.0);
        // the time of a crossing has been rounded to one just before it
        let steep = course(&[-5e-12, 1e4, -1e3], 1.0);
        assert_eq!(steep, SignCourse { side: 1.0, changes: Vec::new() });
    }

    /// (x − 1 − δ)² ends beside its double root, with a rounding of d² below zero: a root of (x − 1 − δ)² − d² is not one of
    /// the function. A simple root at the end is, and a double one farther away.
    #[test]
    fn what_follows_a_root_of_a_higher_order_at_the_end_may_be_rounding() {
        let polynomial =
            |coefficients: Vec<f64>| StepPolynomial { coefficients, length: 1.0, soonest: 1e-15 };
        let near = |end: f64, d: f64| polynomial(vec![end * end - d * d, -2.0 * end, 1.0]);
        assert!(near(1.0 + 1e-9, 1e-8).is_rounding_after(1.0 - 1e-8));
        assert!(!near(1.0 - 1e-3, 1e-8).is_rounding_after(1.0 - 1e-3));
        assert!(!near(1.0, 1e-3).is_rounding_after(1.0 - 1e-3));
        assert!(!polynomial(vec![1.0 - 1e-15, -1.0]).is_rounding_after(1.0 - 1e-15));
    }

    #[test]
    fn roots_at_the_halves_of_the_piece_are_not_lost_between_them() {
        // (x − ¼)(x − ½)(x − ¾)
        let found = course(&[-0.09375, 0.6875, -1.5, 1.0], -1.0);
        let error = |(x, y): (&f64, f64)| (x - y).abs();
        let errors: Vec<f64> = places(&found).iter().zip([0.25, 0.5, 0.75]).map(error).collect();
        assert!(errors.len() == 3 && errors.iter().all(|x| *x < 1e-15), "{found:?}");
    }
}
