//! Power series of several orbits at once.
//!
//! In: matrices and right-hand sides of several orbits. Out: the solution of each. Never here: operations that
//! depend on the size of a number, which programs of several orbits do not have.

use super::orders::{Coefficient, FactoredMatrix, Orders};
use crate::num::{BATCH, Batch};
use crate::system::program::Program;
use crate::system::solve::Factored;

/// A matrix for each orbit, whose pivots are its own. Where it is singular its solutions are NaN,
/// and the other orbits continue.
#[derive(Clone, Debug)]
pub struct FactoredBatch {
    lanes: [Factored<f64>; BATCH],
    singular: [bool; BATCH],
    right: Vec<f64>,
}

impl FactoredMatrix<Batch> for FactoredBatch {
    fn new(size: usize) -> FactoredBatch {
        FactoredBatch {
            lanes: std::array::from_fn(|_| Factored::new(size)),
            singular: [false; BATCH],
            right: vec![0.0; size],
        }
    }

    fn factor<const FUSED: bool>(&mut self, entry: impl Fn(usize, usize) -> Batch) -> bool {
        for (lane, factored) in self.lanes.iter_mut().enumerate() {
            self.singular[lane] = !factored.factor(|i, j| entry(i, j).0[lane]);
        }
        true
    }

    fn solve<const FUSED: bool>(&mut self, right: &mut [Batch]) {
        self.solve_by(right, Factored::solve);
    }

    #[inline(always)]
    fn solve_again<const FUSED: bool>(&mut self, right: &mut [Batch]) {
        self.solve_by(right, |factored, right| {
            factored.solve_again::<FUSED>(right, |x, pivot| x / pivot);
        });
    }
}

impl FactoredBatch {
    /// Solves for each orbit by itself.
    #[inline(always)]
    fn solve_by(&mut self, right: &mut [Batch], solve: impl Fn(&mut Factored<f64>, &mut [f64])) {
        for (lane, factored) in self.lanes.iter_mut().enumerate() {
            if self.singular[lane] {
                for x in right.iter_mut() {
                    x.0[lane] = f64::NAN;
                }
                continue;
            }
            for (own, x) in self.right.iter_mut().zip(&*right) {
                *own = x.0[lane];
            }
            solve(factored, &mut self.right);
            for (x, own) in right.iter_mut().zip(&self.right) {
                x.0[lane] = *own;
            }
        }
    }
}

impl Coefficient for Batch {
    type Factored = FactoredBatch;

    /// NaN: programs with such operations are not evaluated for several orbits at once.
    fn alone(_: &mut Orders<'_, Batch>, _: &Program, _: u32, _: usize) -> Batch {
        Batch::splat(f64::NAN)
    }
}
