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
        let (slope, length) = (self.polynomial.slope(x), self.piece.length);
        let (mut root, mut before) = (DoubleDouble::from(x), f64::INFINITY);
        for _ in 0..CORRECTIONS {
            let correction = self.value(root)? / slope;
            let size = correction.high.abs();
            if size.is_nan() || size >= SMALL * length || size > CONVERGES * before {
                return self.bracketed(x, side);
            }
            root = root - correction;
            if size <= NOTHING * length {
                break;
            }
            before = size;
        }
        Ok(Some(self.time(root)))
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
