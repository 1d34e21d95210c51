//! The solution of linear equations at one order as code, by a matrix that was factored at order 0.
//!
//! In: the right-hand side, the inner products of varying entries. Out: the unknowns, with the bits of
//! [`Factored`](crate::system::solve::Factored). Never here: factoring; which row is which pivot's is read from memory.

use super::arithmetic::Arithmetic;
use super::basic_block::Width;
use super::emitter::{Emitter, SharedDivisor};
use super::function::NotCompiled;
use super::layout::{Address, Area};
use crate::system::finishing_pass::LinearSolve;

impl<A: Arithmetic> Emitter<'_, A> {
    /// `M_0 a_k = f_k − Σ_{j≥1} M_j a_{k−j}` by the factored M_0.
    pub(super) fn solution(&mut self, solution: LinearSolve) -> Result<(), NotCompiled> {
        let LinearSolve { register, block, first, count, inner } = solution;
        let plan = self.plan;
        let place = self.places.factored[block as usize];
        let n = place.size;
        if self.code.lanes != Width::One && n > 1 {
            // each orbit has pivots of its own
            return Err(NotCompiled);
        }
        let work = |offset: usize| Address { area: Area::Work, offset };
        let entry = |i: usize, j: usize| A::at(work(place.entries + (i * n + j) * A::SIZE));
        let right = plan.program.blocks[block as usize].right.iter();
        let mut sums = right.map(|&r| self.now(r)).collect::<Result<Vec<_>, _>>()?;
        let entries = &plan.schedule.entries[first as usize..][..count as usize];
        for (i, entry) in (0..).zip(entries) {
            let last = self.last(entry.register, register + entry.column)?;
            let product = self.product(inner + i);
            let whole = A::sum(self.code, product, last);
            let sum = &mut sums[entry.row as usize];
            *sum = A::difference(self.code, *sum, whole);
        }
        if n > 1 {
            for (i, &sum) in sums.iter().enumerate() {
                A::store_for_now(self.code, sum, work(place.right + i * A::SIZE));
            }
        }
        let mut partial = Vec::with_capacity(n);
        for i in 0..n {
            let mut sum = match n {
                1 => sums[0],
                _ => A::behind(self.code, work(place.right), work(place.rows + i)),
            };
            for (j, &known) in partial.iter().enumerate() {
                sum = self.less_product(sum, entry(i, j), known);
            }
            partial.push(A::renormalized(self.code, sum));
        }
        let upper = |i: usize, j: usize| work(place.upper + (i * n + j) * A::SIZE);
        let scales = !std::mem::replace(&mut self.scaled[block as usize], true);
        for (i, sum) in partial.iter_mut().enumerate() {
            // a matrix of one number is that number, also in lanes
            let number = match &plan.program.blocks[block as usize].matrix[..] {
                &[only] => self.value(only),
                _ => entry(i, i),
            };
            let pivot = self.shared(SharedDivisor::Pivot(block, i as u32), number);
            *sum = A::over_shared(self.code, *sum, pivot);
            for j in if scales { i + 1..n } else { 0..0 } {
                let scaled = A::over_shared(self.code, entry(i, j), pivot);
                A::store(self.code, scaled, upper(i, j));
            }
        }
        for i in (0..n).rev() {
            let mut sum = partial[i];
            for j in (i + 1..n).rev() {
                sum = self.less_product(sum, A::at(upper(i, j)), partial[j]);
            }
            partial[i] = A::renormalized(self.code, sum);
        }
        for (i, x) in (0..).zip(partial) {
            self.set(register + i, x);
        }
        Ok(())
    }

    fn less_product(&mut self, sum: A::Number, a: A::Number, b: A::Number) -> A::Number {
        let product = A::product(self.code, b, a);
        A::difference(self.code, sum, product)
    }
}
