//! The rounding errors of the steps of a flow map, each amplified by the flow after it.
//!
//! In: M(t) after each step. Out: what these errors may leave of M, and of M𝕁Mᵀ − 𝕁. A step adds ΔM to M, whose entries are computed with
//! a relative error of ε/2; at the end that error is Φ δ, where Φ = M(T) M(t)⁻¹ is the flow from there on, and may be far
//! larger than what M(T) is rounded by. Errors of different steps are independent, so their squares are added. Never here:
//! the motion, errors of the method.
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., §§ 2.8, 3.1.

use nalgebra::DMatrix;

use crate::num::math;

/// The most instants that are remembered; beyond, neighbours are put together.
const MOST: usize = 1024;

pub(super) struct AmplifiedRounding {
    last: DMatrix<f64>,
    steps: Vec<StepGroup>,
    /// How many steps are put together in one, and how many the last one still lacks.
    together: usize,
    open: usize,
}

/// Some steps: M and the time at their end, and the root of the sum of squares of what they added to M.
struct StepGroup {
    end: DMatrix<f64>,
    time: f64,
    added: DMatrix<f64>,
}

/// What rounding may leave of each entry of M, and when the steps were taken that leave the most.
#[derive(Clone, Debug)]
pub struct MapRounding {
    /// The error of each entry.
    pub error: DMatrix<f64>,
    /// The end of the steps that contribute the most.
    pub worst: f64,
}

impl AmplifiedRounding {
    /// At the beginning, where M is the unit matrix.
    pub(super) fn new(dimension: usize) -> Self {
        let last = DMatrix::identity(dimension, dimension);
        Self { last, steps: Vec::new(), together: 1, open: 0 }
    }

    /// Takes in M after a step, and the time at its end.
    pub(super) fn step(&mut self, matrix: &DMatrix<f64>, time: f64) {
        let added = (matrix - &self.last).abs();
        self.last.clone_from(matrix);
        match self.steps.last_mut() {
            Some(last) if self.open > 0 => {
                last.added = both(&last.added, &added);
                last.end.clone_from(matrix);
                last.time = time;
                self.open -= 1;
            }
            _ => {
                self.steps.push(StepGroup { end: matrix.clone(), time, added });
                self.open = self.together - 1;
            }
        }
        if self.steps.len() > MOST && self.open == 0 {
            let pairs = std::mem::take(&mut self.steps);
            let mut pairs = pairs.into_iter();
            while let Some(first) = pairs.next() {
                self.steps.push(match pairs.next() {
                    Some(next) => StepGroup { added: both(&first.added, &next.added), ..next },
                    None => first,
                });
            }
            self.together *= 2;
        }
    }

    /// What the errors of all steps may leave of each entry of M, with M where it is now; `inverse` is M⁻¹ of an M.
    pub(super) fn of_map(
        &self,
        inverse: &dyn Fn(&DMatrix<f64>) -> Option<DMatrix<f64>>,
    ) -> MapRounding {
        let mut error = (&self.last * (0.5 * f64::EPSILON)).abs();
        let (mut worst, mut most) = (0.0, 0.0);
        for steps in &self.steps {
            let Some(inverse) = inverse(&steps.end) else { continue };
            let flow = (&self.last * inverse).abs();
            let left = known(&(flow * (&steps.added * (0.5 * f64::EPSILON))));
            if left.amax() > most {
                (worst, most) = (steps.time, left.amax());
            }
            error = both(&error, &left);
        }
        MapRounding { error, worst }
    }

    /// What the errors of all steps may leave of each entry of |M𝕁Mᵀ − 𝕁|, with M where it is now; `inverse` is M⁻¹ of an M.
    pub(super) fn left(
        &self,
        inverse: &dyn Fn(&DMatrix<f64>) -> Option<DMatrix<f64>>,
    ) -> DMatrix<f64> {
        let size = self.last.nrows();
        let n = size / 2;
        let unit =
            DMatrix::from_fn(size, size, |i, j| f64::from(u8::from(j == i + n || i == j + n)));
        let after = unit * self.last.abs().transpose() * (0.5 * f64::EPSILON);
        let mut error = DMatrix::zeros(size, size);
        for steps in &self.steps {
            let Some(inverse) = inverse(&steps.end) else { continue };
            let flow = (&self.last * inverse).abs();
            let left = flow * &steps.added * &after;
            error = both(&error, &known(&(&left + left.transpose())));
        }
        error
    }
}

/// The root of the sum of the squares, entry by entry, which is in range wherever both are.
fn both(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    a.zip_map(b, math::hypot)
}

/// An error whose entries are infinite where nothing is known of them.
fn known(error: &DMatrix<f64>) -> DMatrix<f64> {
    error.map(|x| if x.is_finite() { x } else { f64::INFINITY })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A shear by s in each of many steps: what the k-th step adds is carried on by the others.
    #[test]
    fn steps_that_are_put_together_leave_what_they_leave_alone() {
        let shear = |s: f64| DMatrix::from_row_slice(2, 2, &[1.0, s, 0.0, 1.0]);
        let left = |count: usize| {
            let mut rounding = AmplifiedRounding::new(2);
            for k in 1..=count {
                let time = k as f64 / count as f64;
                rounding.step(&shear(time), time);
            }
            assert!(rounding.steps.len() <= MOST + 1);
            rounding.left(&|m| m.clone().try_inverse())[(0, 0)] * (count as f64).sqrt()
        };
        // the squares of the parts go as 1/count, whatever is put together
        let (few, many) = (left(1000), left(6000));
        assert!((few / many - 1.0).abs() < 1e-2, "{few:e} {many:e}");
        assert!(few > 0.0);
    }

    /// In other units a map has entries whose squares are out of range; its errors are the same, and none is left out.
    #[test]
    fn units_change_no_error() {
        let error = |unit: f64| {
            let map = |t: f64| DMatrix::from_row_slice(2, 2, &[1.0, t * unit, -t / unit, 1.0]);
            let mut rounding = AmplifiedRounding::new(2);
            for k in 1..=8 {
                rounding.step(&map(f64::from(k)), f64::from(k));
            }
            let inverse = |m: &DMatrix<f64>| {
                let det = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
                Some(
                    DMatrix::from_row_slice(2, 2, &[m[(1, 1)], -m[(0, 1)], -m[(1, 0)], m[(0, 0)]])
                        / det,
                )
            };
            let error = rounding.of_map(&inverse).error;
            [error[(0, 0)], error[(0, 1)] / unit, error[(1, 0)] * unit, error[(1, 1)]]
        };
        let plain = error(1.0);
        for unit in [1e180, 1e-180] {
            let other = error(unit);
            let near = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() < 1e-12;
            assert!(plain.iter().zip(&other).all(near), "{plain:?} {other:?}");
        }
    }

    /// What is out of range on the way to the end is not known, and not nothing.
    #[test]
    fn what_is_out_of_range_is_not_left_out() {
        let mut rounding = AmplifiedRounding::new(2);
        let of = |x: f64| DMatrix::from_row_slice(2, 2, &[x, 0.0, 0.0, 1.0 / x]);
        rounding.step(&of(1e-200), 1.0);
        rounding.step(&of(1e200), 2.0);
        let found = rounding.of_map(&|m| m.clone().try_inverse());
        assert!(found.error.iter().any(|x| x.is_infinite()), "{}", found.error);
        assert!(!found.error.iter().any(|x| x.is_nan()), "{}", found.error);
    }
}
