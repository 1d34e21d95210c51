//! Roots of the functions' series, corrected by the functions themselves, whose values in double-double have twice the
//! digits of the series.
//!
//! In: a root of the series of one function on a piece of a step. Out: where the function crosses zero there, if it does.
//! Never here: how the roots of the series are found.
//!
//! About a root of order m the series is no more than rounding over an interval as wide as the m-th root of that. Newton's
//! iteration does not converge there, and the root is bracketed by the signs of the function.

use super::DenseOutput;
use super::polynomial::StepPolynomial;
use super::probe::Probe;
use super::series_piece::SeriesPiece;
use crate::num::{DoubleDouble, math};
use crate::system::MotionError;

/// The maximal number of corrections of a root by the value of the function there.
const CORRECTIONS: u32 = 3;

/// A correction larger than this part of a piece is rejected: the root is of a higher order.
const SMALL: f64 = 1e-6;

/// At a simple root each correction is less than this part of the one before.
const CONVERGES: f64 = 1e-3;

/// A correction below this part of the piece is none.
const NOTHING: f64 = 1e-20;

/// A root is simple where the slope times the piece is this part of the function's terms: it has ten digits there and more. A
/// correction below the second part of the piece that is not much less than the one before is then rounding of the function.
const SIMPLE: f64 = 1e-3;
const ROUNDING: f64 = 1e-14;

/// The first distance of a bracket from the root of the series, as a part of the piece, and how often it is doubled: up
/// to a tenth of the piece.
const NEAREST: f64 = 1e-16;
const DOUBLINGS: i32 = 50;

/// The halvings of a bracket, down to the digits of a double-double.
const HALVINGS: u32 = 110;

/// A root of the series where the function is less than this part of its terms is a root of the function, or rounding.
const VANISHES: f64 = 1e-6;

/// The function that the roots belong to.
pub(super) struct RootCorrection<'a> {
    pub(super) probe: &'a mut Probe,
    pub(super) motion: &'a mut dyn DenseOutput,
    pub(super) event: usize,
    pub(super) polynomial: &'a StepPolynomial,
    pub(super) piece: &'a SeriesPiece,
}

impl RootCorrection<'_> {
    /// The value of the function at a time after the beginning of the piece.
    fn value(&mut self, x: DoubleDouble) -> Result<DoubleDouble, MotionError> {
        let time = self.time(x);
        self.probe.exactly_at(self.motion, self.event, time)
    }

    fn time(&self, x: DoubleDouble) -> DoubleDouble {
        self.piece.from + x * self.piece.unit
    }

    /// The time of the root near `x` after which the function is on `side`; none if the function only touches zero there.
    pub(super) fn correct(
        &mut self,
        x: f64,
        side: f64,
    ) -> Result<Option<DoubleDouble>, MotionError> {
        match newton(self.polynomial, x, |x| self.value(x))? {
            Some(root) => Ok(Some(self.time(root))),
            None => self.bracketed(x, side),
        }
    }

    /// The root between two points on both sides of `x` where the function has both signs, the nearest such points.
    pub(super) fn bracketed(
        &mut self,
        x: f64,
        side: f64,
    ) -> Result<Option<DoubleDouble>, MotionError> {
        let length = self.piece.length;
        for k in 0..DOUBLINGS {
            let distance = NEAREST * length * math::powi(2.0, k);
            let (low, high) = ((x - distance).max(0.0), (x + distance).min(length));
            let (low, high) = (DoubleDouble::from(low), DoubleDouble::from(high));
            if self.value(low)?.high * side < 0.0 && self.value(high)?.high * side > 0.0 {
                let root = self.halved(low, high, side)?;
                return Ok(Some(self.time(root)));
            }
        }
        let value = self.value(DoubleDouble::from(x))?.high.abs();
        if value <= VANISHES * self.polynomial.size() {
            return Ok(None);
        }
        // the function is not what the series represents
        Ok(Some(self.time(DoubleDouble::from(x))))
    }

    /// The change of sign between two points.
    fn halved(
        &mut self,
        mut low: DoubleDouble,
        mut high: DoubleDouble,
        side: f64,
    ) -> Result<DoubleDouble, MotionError> {
        for _ in 0..HALVINGS {
            let middle = (low + high) * 0.5;
            if middle == low || middle == high {
                break;
            }
            let value = self.value(middle)?.high;
            if value == 0.0 {
                return Ok(middle);
            }
            if value * side > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok((low + high) * 0.5)
    }
}

/// The root of a function near `x`, as exact as its values, by its series' slope there; none where that does not converge, as about a
/// root of a higher order.
fn newton(
    series: &StepPolynomial,
    x: f64,
    mut value: impl FnMut(DoubleDouble) -> Result<DoubleDouble, MotionError>,
) -> Result<Option<DoubleDouble>, MotionError> {
    let (slope, length) = (series.slope(x), series.length);
    let (mut root, mut before) = (DoubleDouble::from(x), f64::INFINITY);
    for _ in 0..CORRECTIONS {
        let correction = value(root)? / slope;
        let size = correction.high.abs();
        if size.is_nan() || size >= SMALL * length {
            return Ok(None);
        }
        if size > CONVERGES * before {
            let is_simple = slope.abs() * length >= SIMPLE * series.size();
            return Ok((is_simple && size <= ROUNDING * length).then(|| root - correction));
        }
        root = root - correction;
        if size <= NOTHING * length {
            break;
        }
        before = size;
    }
    Ok(Some(root))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What Newton's iteration from `x` finds of a function whose values have errors of this size.
    fn found(coefficients: &[f64], x: f64, error: f64) -> Option<DoubleDouble> {
        let series =
            StepPolynomial { coefficients: coefficients.to_vec(), length: 1.0, soonest: 0.0 };
        let mut errors = [1.0, -0.8, 0.7].map(|part| error * part).into_iter();
        let root = newton(&series, x, |x| {
            let terms = coefficients.iter().rev().map(|&c| DoubleDouble::from(c));
            let exact = terms.fold(DoubleDouble::ZERO, |sum, c| sum * x + c);
            Ok(exact + DoubleDouble::from(errors.next().expect("three are enough")))
        });
        root.expect("it has values")
    }

    #[test]
    fn a_simple_root_is_as_exact_as_the_values_of_the_function() {
        // (x − 1/4) (x + 2)
        let simple = [-0.5, 1.75, 1.0];
        for error in [0.0, 1e-19, 1e-17, 1e-16, 1e-15] {
            let root = found(&simple, 0.25 + 1e-15, error).expect("the root is simple");
            let off = (root - DoubleDouble::from(0.25)).high;
            assert!(off.abs() <= 2.0 * error / 2.25 + 1e-30, "{error:e}: {off:e}");
        }
        // errors as large as those of another function
        assert_eq!(found(&simple, 0.25, 1e-12), None);
    }

    #[test]
    fn a_root_of_a_higher_order_is_none_that_the_slope_finds() {
        // (x − 1/4)² and (x − 1/4)³
        let (double, triple) = ([0.0625, -0.5, 1.0], [-0.015625, 0.1875, -0.75, 1.0]);
        for (coefficients, off) in [(&double[..], 1e-8), (&triple[..], 1e-6)] {
            for error in [0.0, 1e-17] {
                assert_eq!(found(coefficients, 0.25 + off, error), None, "{coefficients:?}");
            }
        }
    }
}
