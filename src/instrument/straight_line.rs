//! The straight line of least squares through points.
//!
//! In: points. Out: the line, its slope with a standard error, the slope in words. Never here: what the points are.

use std::f64::consts::LN_10;

use crate::num::{math, significant};

/// A line needs at least this many points.
const FEWEST: usize = 8;

#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct StraightLine {
    pub(super) slope: f64,
    /// The standard error of the slope, as if the distances from the line were independent of each other.
    pub(super) error: f64,
    /// The mean of the points, through which the line goes.
    mean: [f64; 2],
}

impl StraightLine {
    /// The line of least squares through those points that are finite; `None` where they do not determine one.
    pub(super) fn through(points: &[[f64; 2]]) -> Option<Self> {
        let finite = || points.iter().filter(|at| at.iter().all(|x| x.is_finite()));
        let count = finite().count();
        if count < FEWEST {
            return None;
        }
        let n = count as f64;
        let mean = [0, 1].map(|axis| finite().map(|at| at[axis]).sum::<f64>() / n);
        let (mut square, mut product) = (0.0, 0.0);
        for [x, y] in finite() {
            let across = x - mean[0];
            square += across * across;
            product += across * (y - mean[1]);
        }
        let slope = product / square;
        let line = Self { slope, error: 0.0, mean };
        let left: f64 = finite().map(|&[x, y]| (y - line.at(x)) * (y - line.at(x))).sum();
        let error = (left / (n - 2.0) / square).sqrt();
        slope.is_finite().then_some(Self { error, ..line })
    }

    pub(super) fn at(&self, x: f64) -> f64 {
        self.mean[1] + self.slope * (x - self.mean[0])
    }

    /// The slope and its error, to the digits that the error leaves.
    pub(super) fn in_words(&self) -> String {
        let digits = 1 - (math::ln(self.error) / LN_10).floor().clamp(-6.0, 1.0) as i32;
        let digits = usize::try_from(digits).unwrap_or(0);
        let slope = format!("{:.digits$}", self.slope).replace('-', "−");
        format!("slope {slope} ± {} (least squares)", significant(self.error, 2, 1e-3..1e5))
    }
}

#[cfg(test)]
mod tests {
    use super::StraightLine;

    /// Anscombe's first set: 3.0001 + 0.5001 x, standard error of the slope 0.1179 (F. J. Anscombe, 1973).
    #[test]
    fn a_published_regression() {
        let x = [10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0];
        let y = [8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68];
        let points: Vec<[f64; 2]> = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
        let line = StraightLine::through(&points).expect("eleven points");
        assert!((line.slope - 0.5001).abs() < 5e-5, "{}", line.slope);
        assert!((line.error - 0.1179).abs() < 5e-5, "{}", line.error);
        assert!((line.at(0.0) - 3.0001).abs() < 5e-5, "{}", line.at(0.0));
        assert_eq!(line.in_words(), "slope 0.50 ± 0.12 (least squares)");
    }

    #[test]
    fn what_determines_no_line() {
        assert_eq!(StraightLine::through(&[[0.0, 1.0], [1.0, 2.0]]), None);
        assert_eq!(StraightLine::through(&[[1.0, 2.0]; 20]), None);
    }
}
