//! The numbers of a jet, and how they begin.
//!
//! In: a program, the inputs at order 0. Out: all registers at that order. Never here: the orders above.

use std::ops::Range;
use std::sync::Arc;

use super::operands::Operands;
use super::orders::{Coefficient, FactoredMatrix, Orders};
use super::series_index::SeriesIndex;
use super::side::Side;
use crate::num::{Kernel, vectorized};
use crate::system::operation::value_of;
use crate::system::program::{Block, Op, Program, Register, Singular};
use crate::system::schedule::Schedule;

#[derive(Clone, Debug)]
pub(super) struct Tables<R: Coefficient> {
    /// The number of orders.
    pub(super) stride: usize,
    /// The number of registers and slopes.
    pub(super) width: usize,
    /// The coefficients of all registers and slopes, order by order.
    pub(super) rows: Vec<R>,
    /// Those of the registers that are read as whole series, one register after another.
    pub(super) series: Vec<R>,
    pub(super) index: Arc<SeriesIndex>,
    operands: Operands<R>,
    /// The terms of the program's sums.
    terms: Vec<(Register, R)>,
    pub(super) blocks: Vec<R::Factored>,
    /// The right-hand side of a system of linear equations, then its solution.
    vector: Vec<R>,
    pub(super) sides: Vec<Side>,
    /// The weights of the sides [`Side::Between`], one series for each switch.
    pub(super) weights: Vec<R>,
}

impl<R: Coefficient> Tables<R> {
    /// Zeros, and the constants of the program.
    pub(super) fn new(
        program: &Program,
        schedule: &Schedule,
        index: Arc<SeriesIndex>,
        order: usize,
    ) -> Tables<R> {
        let (stride, width) = (order + 1, program.ops.len() + schedule.slopes.len());
        let blocks = program.blocks.iter().map(|block| R::Factored::new(block.size())).collect();
        let widest = program.blocks.iter().map(Block::size).max().unwrap_or(0);
        Tables {
            stride,
            width,
            rows: vec![R::ZERO; width * stride],
            series: vec![R::ZERO; index.registers.len() * stride],
            index,
            operands: Operands::new(&schedule.pairs, stride),
            terms: program
                .terms
                .iter()
                .map(|term| (term.register, R::of(term.coefficient)))
                .collect(),
            blocks,
            vector: vec![R::ZERO; widest],
            sides: vec![Side::Positive; program.switches.len()],
            weights: vec![R::ZERO; program.switches.len() * stride],
        }
    }

    /// What the orders above zero are computed with.
    #[inline(always)]
    pub(super) fn orders(&mut self) -> Orders<'_, R> {
        Orders {
            stride: self.stride,
            width: self.width,
            rows: &mut self.rows,
            series: &mut self.series,
            index: &self.index,
            operands: self.operands.slices(),
            terms: &self.terms,
            blocks: &mut self.blocks,
            vector: &mut self.vector,
            sides: &self.sides,
            weights: &self.weights,
        }
    }

    /// Evaluates a range of the body of a program at order 0.
    pub(super) fn begin(
        &mut self,
        program: &Program,
        time: R,
        range: Range<usize>,
    ) -> Result<(), Singular> {
        vectorized(FirstOrder { tables: self, program, time, range })
    }

    #[inline(always)]
    fn begin_with<const FUSED: bool>(
        &mut self,
        program: &Program,
        time: R,
        range: Range<usize>,
    ) -> Result<(), Singular> {
        for &r in &program.body[range] {
            match program.ops[r as usize] {
                Op::Time => self.rows[r as usize] = time,
                Op::Solve(block) => {
                    self.factor::<FUSED>(program, block as usize)?;
                    let block_of = &program.blocks[block as usize];
                    for (x, &right) in self.vector.iter_mut().zip(&block_of.right) {
                        *x = self.rows[right as usize];
                    }
                    let solution = &mut self.vector[..block_of.size()];
                    self.blocks[block as usize].solve::<FUSED>(solution);
                    self.rows[r as usize..][..block_of.size()].copy_from_slice(solution);
                }
                op => self.evaluate_with::<FUSED>(program, r, op),
            }
        }
        Ok(())
    }

    /// Sets the value of an operation.
    pub(super) fn evaluate(&mut self, program: &Program, r: Register, op: Op) {
        self.evaluate_with::<false>(program, r, op);
    }

    #[inline(always)]
    fn evaluate_with<const FUSED: bool>(&mut self, program: &Program, r: Register, op: Op) {
        if let Op::Select { .. } | Op::ParametricPower(..) = op {
            let value = R::alone(&mut self.orders(), program, r, 0);
            self.rows[r as usize] = value;
        } else if let Some((value, companion)) =
            value_of::<_, FUSED>(program, op, |r| self.rows[r as usize])
        {
            self.rows[r as usize] = value;
            if let Some(companion) = companion {
                self.rows[r as usize + 1] = companion;
            }
        }
    }

    #[inline(always)]
    fn factor<const FUSED: bool>(&mut self, program: &Program, at: usize) -> Result<(), Singular> {
        let block = &program.blocks[at];
        let n = block.size();
        let entry = |i, j| self.rows[block.matrix[i * n + j] as usize];
        if self.blocks[at].factor::<FUSED>(entry) {
            Ok(())
        } else {
            Err(Singular { block: at as u32 })
        }
    }
}

/// A range of the body of a program, to be evaluated at order 0.
struct FirstOrder<'a, R: Coefficient> {
    tables: &'a mut Tables<R>,
    program: &'a Program,
    time: R,
    range: Range<usize>,
}

impl<R: Coefficient> Kernel for FirstOrder<'_, R> {
    type Output = Result<(), Singular>;
    const OF_SEVERAL: bool = R::OF_SEVERAL;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), Singular> {
        self.tables.begin_with::<FUSED>(self.program, self.time, self.range)
    }
}
