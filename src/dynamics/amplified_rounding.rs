//! The rounding errors of the steps of a flow map, each amplified by the flow after it.
//!
//! In: M(t) after each step. Out: what these errors may leave of M, and of M𝕁Mᵀ − 𝕁. A step adds ΔM to M, whose entries are computed with
//! a relative error of ε/2; at the end that error is Φ δ, where Φ = M(T) M(t)⁻¹ is the flow from there on, and may be far
//! larger than what M(T) is rounded by. Errors of different steps are independent, so their squares are added. Never here:
//! the motion, errors of the method.
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., §§ 2.8, 3.1.

use nalgebra::DMatrix;

/// The most instants that are remembered; beyond, neighbours are put together.
const MOST: usize = 1024;

/// What is known of the steps so far.
pub(super) struct AmplifiedRounding {
    last: DMatrix<f64>,
    steps: Vec<StepGroup>,
    /// How many steps are put together in one, and how many the last one still lacks.
    together: usize,
    open: usize,
}

/// Some steps: M and the time at their end, and the squares of what they added to M.
struct StepGroup {
    end: DMatrix<f64>,
    time: f64,
    squares: DMatrix<f64>,
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
        let added = (matrix - &self.last).map(|x| x * x);
        self.last.clone_from(matrix);
        match self.steps.last_mut() {
            Some(last) if self.open > 0 => {
                last.squares += added;
                last.end.clone_from(matrix);
                last.time = time;
                self.open -= 1;
            }
            _ => {
                self.steps.push(StepGroup { end: matrix.clone(), time, squares: added });
                self.open = self.together - 1;
            }
        }
        if self.steps.len() > MOST && self.open == 0 {
            let pairs = std::mem::take(&mut self.steps);
            let mut pairs = pairs.into_iter();
            while let Some(first) = pairs.next() {
                self.steps.push(match pairs.next() {
                    Some(next) => StepGroup { squares: first.squares + next.squares, ..next },
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
        let mut squares = (&self.last * (0.5 * f64::EPSILON)).map(|x| x * x);
        let (mut worst, mut most) = (0.0, 0.0);
        for steps in &self.steps {
            let Some(inverse) = inverse(&steps.end) else { continue };
            let flow = (&self.last * inverse).abs();
            let left = flow * steps.squares.map(f64::sqrt) * (0.5 * f64::EPSILON);
            if left.iter().any(|x| !x.is_finite()) {
                continue;
            }
            if left.amax() > most {
                (worst, most) = (steps.time, left.amax());
            }
            squares += left.map(|x| x * x);
        }
        MapRounding { error: squares.map(f64::sqrt), worst }
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
        let mut squares = DMatrix::zeros(size, size);
        for steps in &self.steps {
            let Some(inverse) = inverse(&steps.end) else { continue };
            let flow = (&self.last * inverse).abs();
            let left = flow * steps.squares.map(f64::sqrt) * &after;
            let both = &left + left.transpose();
            squares += both.map(|x| x * x);
        }
        squares.map(f64::sqrt)
    }
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
}
