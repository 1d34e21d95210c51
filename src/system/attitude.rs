//! The attitude matrix of a state, restored to a rotation after a step.
//!
//! In: a state that carries the nine entries of A. Out: the same state with A Aᵀ = 1 to rounding.
//! Never here: how A changes in time.

use super::{State, System};
use crate::num::DoubleDouble;

impl System {
    /// Moves the attitude of a state, if it carries one, towards the nearest rotation by one step
    /// of Newton's iteration for the polar factor, A ← ½ A (3 − AᵀA), which converges quadratically
    /// (N. J. Higham, Functions of Matrices, SIAM 2008, §8.3).
    pub fn orthonormalise(&self, state: &mut State) {
        let Some(first) = self.attitude_place() else { return };
        let a = |i: usize, j: usize| state.exact(first + 3 * i + j);
        let product =
            |i: usize, j: usize| (0..3).fold(DoubleDouble::ZERO, |sum, k| sum + a(k, i) * a(k, j));
        let mut turned = [[DoubleDouble::ZERO; 3]; 3];
        for (i, row) in turned.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let auxiliary =
                    (0..3).fold(DoubleDouble::ZERO, |sum, k| sum + a(i, k) * product(k, j));
                *entry = (a(i, j) * 3.0 - auxiliary) * 0.5;
            }
        }
        for (place, entry) in turned.iter().flatten().enumerate() {
            state.set(first + place, *entry);
        }
    }
}
