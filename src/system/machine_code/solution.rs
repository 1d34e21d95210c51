//! The solution of linear equations at one order as code, by a matrix that was factored at order 0.
//!
//! In: the right-hand side, the inner products of varying entries. Out: the unknowns, with the bits of
//! [`Factored`](crate::system::solve::Factored). Never here: factoring; which row is which pivot's is read from memory.

use cranelift_codegen::ir::{InstBuilder, MemFlags, Value, types};

use super::emitter::Emitter;
use super::function::NotCompiled;
use super::layout::{Address, Area};
use crate::system::finishing_pass::LinearSolution;

impl Emitter<'_> {
    /// `M_0 a_k = f_k − Σ_{j≥1} M_j a_{k−j}` by the factored M_0.
    pub(super) fn solution(&mut self, solution: LinearSolution) -> Result<(), NotCompiled> {
        let LinearSolution { register, block, first, count, inner } = solution;
        let (plan, k) = (self.plan, self.k);
        let place = self.layout.factored[block as usize];
        let n = place.size;
        let work = |offset: usize| Address { area: Area::Work, offset };
        let right = plan.program.blocks[block as usize].right.iter();
        let mut sums = right.map(|&r| self.now(r)).collect::<Result<Vec<_>, _>>()?;
        let entries = &plan.schedule.entries[first as usize..][..count as usize];
        for (i, entry) in (0..).zip(entries) {
            let last = self.now(entry.register)?;
            let last = self.times_value(last, register + entry.column);
            let product = self.product(inner + i)?;
            let whole = self.builder.ins().fadd(product, last);
            let sum = &mut sums[entry.row as usize];
            *sum = self.builder.ins().fsub(*sum, whole);
        }
        for (i, &sum) in sums.iter().enumerate() {
            self.store(sum, work(place.right + i));
        }
        let mut partial = Vec::with_capacity(n);
        for i in 0..n {
            let mut sum = self.load_row(place.right, work(place.rows + i));
            for (j, &known) in partial.iter().enumerate() {
                sum = self.less_product(sum, known, work(place.entries + i * n + j));
            }
            partial.push(sum);
        }
        for i in (0..n).rev() {
            let mut sum = partial[i];
            for j in i + 1..n {
                sum = self.less_product(sum, partial[j], work(place.entries + i * n + j));
            }
            let pivot = self.load(work(place.entries + i * n + i));
            partial[i] = self.builder.ins().fdiv(sum, pivot);
        }
        for (i, x) in (0..).zip(partial) {
            self.set(register + i, k, x);
        }
        Ok(())
    }

    /// A sum less a product with a number in memory.
    fn less_product(&mut self, sum: Value, known: Value, entry: Address) -> Value {
        let entry = self.load(entry);
        let product = self.builder.ins().fmul(entry, known);
        self.builder.ins().fsub(sum, product)
    }

    /// The entry of a right-hand side whose offset in bytes is at an address.
    fn load_row(&mut self, right: usize, row: Address) -> Value {
        let (work, at) = (self.pointer(Area::Work), 8 * row.offset as i32);
        let row = self.builder.ins().load(types::I64, MemFlags::trusted(), work, at);
        let there = self.builder.ins().iadd(work, row);
        self.builder.ins().load(types::F64, MemFlags::trusted(), there, 8 * right as i32)
    }
}
