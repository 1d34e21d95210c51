//! The orders of a jet above zero, one after another.
//!
//! In: the orders below, the inputs at this one. Out: all registers at this order. Never here: what a jet
//! is asked for.

use super::operands::OperandSlices;
use super::series_index::SeriesIndex;
use super::side::Side;
use crate::num::{Analytic, Real};
use crate::system::finishing_pass::{
    Integral, LinearSolve, LinearSum, OperationRun, Product, Related, Scaling, TermSign,
};
use crate::system::parametric_power;
use crate::system::program::{Op, Program, Register};
use crate::system::schedule::{ConvolutionFactor, Denominator, Direct, Ends, Relation, Schedule};
use crate::system::solve::Factored;

/// A coefficient of a power series.
pub trait Coefficient: Analytic {
    /// A matrix of linear equations.
    type Factored: FactoredMatrix<Self>;

    /// The coefficient of order `k` of an operation that is evaluated by itself.
    fn alone(orders: &mut Orders<'_, Self>, program: &Program, register: u32, k: usize) -> Self;
}

/// A matrix that is factored, to solve linear equations with.
pub trait FactoredMatrix<R>: Clone + Send + Sync + std::fmt::Debug {
    /// Room for a matrix of this size.
    fn new(size: usize) -> Self;
    /// Factors the matrix whose entries `entry` gives by row and column. Returns false if it is
    /// singular. With `FUSED` this and what follows must be inlined into a kernel.
    #[must_use]
    fn factor<const FUSED: bool>(&mut self, entry: impl Fn(usize, usize) -> R) -> bool;
    /// Solves for a right-hand side, in place.
    fn solve<const FUSED: bool>(&mut self, right: &mut [R]);
    /// The same for one of many, by [shared](crate::num::Analytic::divided_by_shared) divisors.
    fn solve_again<const FUSED: bool>(&mut self, right: &mut [R]);
}

impl<R: Real> FactoredMatrix<R> for Factored<R> {
    fn new(size: usize) -> Factored<R> {
        Factored::new(size)
    }
    #[inline(always)]
    fn factor<const FUSED: bool>(&mut self, entry: impl Fn(usize, usize) -> R) -> bool {
        self.factor_with::<FUSED>(entry)
    }
    #[inline(always)]
    fn solve<const FUSED: bool>(&mut self, right: &mut [R]) {
        self.solve_with::<FUSED>(right);
    }
    #[inline(always)]
    fn solve_again<const FUSED: bool>(&mut self, right: &mut [R]) {
        Factored::solve_again::<FUSED>(self, right, R::divided_by_shared::<FUSED>);
    }
}

impl<R: Real> Coefficient for R {
    type Factored = Factored<R>;

    fn alone(orders: &mut Orders<'_, R>, program: &Program, register: u32, k: usize) -> R {
        orders.alone(program, register, k)
    }
}

/// The tables of a jet as slices, whose places need not be looked up again after each number that is stored.
pub struct Orders<'a, R: Coefficient> {
    pub(super) stride: usize,
    pub(super) width: usize,
    pub(super) rows: &'a mut [R],
    pub(super) series: &'a mut [R],
    pub(super) index: &'a SeriesIndex,
    pub(super) operands: OperandSlices<'a, R>,
    pub(super) terms: &'a [(Register, R)],
    pub(super) blocks: &'a mut [R::Factored],
    pub(super) vector: &'a mut [R],
    pub(super) sides: &'a [Side],
    pub(super) weights: &'a [R],
}

impl<R: Coefficient> Orders<'_, R> {
    /// Evaluates all registers at order `k`, which is above zero. The lower orders must have been evaluated, and the
    /// inputs' coefficients of order `k` set.
    #[inline(always)]
    pub(super) fn advance<const FUSED: bool>(
        &mut self,
        program: &Program,
        schedule: &Schedule,
        k: usize,
        scale: R::Unit,
    ) {
        self.operands.multiply::<FUSED>(k);
        let rate = if k == 1 { R::ONE.scaled(scale) } else { R::ZERO };
        self.finish::<FUSED>(program, schedule, k, rate);
        self.hand_on::<FUSED>(schedule, k);
        self.keep(k);
    }

    /// Finishes order `k`, once its inner products are known.
    #[inline(always)]
    pub(super) fn finish<const FUSED: bool>(
        &mut self,
        program: &Program,
        schedule: &Schedule,
        k: usize,
        rate: R,
    ) {
        let mut runs = schedule.runs.iter();
        while let Some(run) = self.finish_plainly::<FUSED>(schedule, &mut runs, k, rate) {
            match *run {
                OperationRun::Solution(solution) => {
                    self.solve::<FUSED>(program, schedule, solution, k);
                }
                OperationRun::Alone(register) => {
                    let coefficient = R::alone(&mut self.again(), program, register, k);
                    self.rows[k * self.width + register as usize] = coefficient;
                }
                _ => {}
            }
        }
    }

    /// Finishes the operations that are a formula each, up to the first that is not, which is
    /// returned.
    #[inline(always)]
    fn finish_plainly<'a, const FUSED: bool>(
        &mut self,
        schedule: &Schedule,
        runs: &mut std::slice::Iter<'a, OperationRun>,
        k: usize,
        rate: R,
    ) -> Option<&'a OperationRun> {
        let width = self.width;
        let (below, now) = self.rows.split_at_mut(k * width);
        let (values, now) = (&below[..width], &mut now[..width]);
        let (products, terms) = (&*self.operands.products, self.terms);
        let at = |r: Register| r as usize;
        for run in runs {
            match run {
                OperationRun::Time(register) => now[at(*register)] = rate,
                OperationRun::Scales(run) => {
                    for &Scaling { register, fixed, varying } in run {
                        now[at(register)] =
                            values[at(fixed)].times_unnormalized::<FUSED>(now[at(varying)]);
                    }
                }
                OperationRun::Products(run) => {
                    for &Product { register, left, right, inner } in run {
                        let first = values[at(left)].times_unnormalized::<FUSED>(now[at(right)]);
                        let last = now[at(left)].times_unnormalized::<FUSED>(values[at(right)]);
                        let ends = first.plus_unnormalized(last);
                        now[at(register)] =
                            products[at(inner)].plus_unnormalized(ends).renormalized();
                    }
                }
                OperationRun::Related(run) => {
                    for &Related { register, relation } in run {
                        let relation = &schedule.relations[at(relation)];
                        let x = related::<R, FUSED>(schedule, relation, (values, now, products), k);
                        now[at(register)] = match relation.vanishing.map(at) {
                            Some(a) => {
                                let below = (0..k).map(|j| below[j * width + a]);
                                x.unless_vanishing(std::iter::once(now[a]).chain(below))
                            }
                            None => x,
                        };
                    }
                }
                OperationRun::Integrals(run) => {
                    for &Integral { register, sign, slope, factor, inner } in run {
                        let last = now[at(slope)].times_unnormalized::<FUSED>(values[at(factor)]);
                        let sum = products[at(inner)].plus_unnormalized(last.multiple::<FUSED>(k));
                        let sum = if sign == TermSign::Minus { -sum } else { sum };
                        now[at(register)] = sum.over::<FUSED>(k).renormalized();
                    }
                }
                OperationRun::Sums(run) => {
                    for &LinearSum { register, first, count } in run {
                        let terms = &terms[first as usize..][..count as usize];
                        let multiple = |&(term, factor): &(Register, R)| {
                            now[at(term)].times_unnormalized::<FUSED>(factor)
                        };
                        let Some((first, others)) = terms.split_first() else { continue };
                        let mut sum = multiple(first);
                        for term in others {
                            sum = sum.plus_unnormalized(multiple(term));
                        }
                        now[at(register)] = sum.renormalized();
                    }
                }
                OperationRun::Solution(_) | OperationRun::Alone(_) => return Some(run),
            }
        }
        None
    }

    /// `M_0 a_k = f_k − Σ_{j≥1} M_j a_{k−j}`.
    #[inline(always)]
    fn solve<const FUSED: bool>(
        &mut self,
        program: &Program,
        schedule: &Schedule,
        solution: LinearSolve,
        k: usize,
    ) {
        let LinearSolve { register, block, first, count, inner } = solution;
        let (width, block) = (self.width, block as usize);
        let (below, now) = self.rows.split_at_mut(k * width);
        let (unknowns, now) = (&below[register as usize..width], &mut now[..width]);
        let right = &program.blocks[block].right[..];
        let sums = &mut self.vector[..right.len()];
        for (sum, &right) in sums.iter_mut().zip(right) {
            *sum = now[right as usize];
        }
        let entries = &schedule.entries[first as usize..][..count as usize];
        let products = &self.operands.products[inner as usize..][..entries.len()];
        for (entry, &product) in entries.iter().zip(products) {
            let last = now[entry.register as usize]
                .times_unnormalized::<FUSED>(unknowns[entry.column as usize]);
            let sum = &mut sums[entry.row as usize];
            *sum = sum.plus_unnormalized(-product.plus_unnormalized(last));
        }
        self.blocks[block].solve_again::<FUSED>(sums);
        now[register as usize..][..sums.len()].copy_from_slice(sums);
    }

    /// Stores order `k` once more where inner products read it.
    #[inline(always)]
    pub(super) fn hand_on<const FUSED: bool>(&mut self, schedule: &Schedule, k: usize) {
        let now = &mut self.rows[k * self.width..][..self.width];
        let (registers, slopes) = now.split_at_mut(self.width - schedule.slopes.len());
        for (place, slope) in slopes.iter_mut().enumerate() {
            *slope = registers[schedule.slopes[place] as usize].multiple::<FUSED>(k);
        }
        self.operands.store(now, k);
    }

    /// Stores order `k` once more where whole series are read.
    #[inline(always)]
    pub(super) fn keep(&mut self, k: usize) {
        let now = &self.rows[k * self.width..][..self.width];
        for &(register, place) in &self.index.copies {
            self.series[place as usize * self.stride + k] = now[register as usize];
        }
    }

    /// Gives the series of a state, which are as long as the registers' and lie one after another, their coefficients of
    /// order `k + 1`, each made from that of order `k` of an output, and sets those of the first `count` inputs to them.
    #[inline(always)]
    pub(super) fn give_out(
        &mut self,
        program: &Program,
        (state, count): (&mut [R], usize),
        k: usize,
        made: impl Fn(R) -> R,
    ) {
        let (stride, width) = (self.stride, self.width);
        let (now, next) = self.rows[k * width..][..2 * width].split_at_mut(width);
        let driving = count.min(program.outputs.len()).min(program.inputs.len());
        let (outputs, inputs) = (&program.outputs[..driving], &program.inputs[..driving]);
        // counted along, since to divide a table into chunks takes a division
        let mut place = k + 1;
        // by places, since iterators over two lists are not always inlined
        for i in 0..driving {
            let coefficient = made(now[outputs[i] as usize]);
            next[inputs[i] as usize] = coefficient;
            state[place] = coefficient;
            place += stride;
        }
        for &output in &program.outputs[driving..] {
            let Some(coefficient) = state.get_mut(place) else { break };
            *coefficient = made(now[output as usize]);
            place += stride;
        }
    }

    /// The same slices, to be given away: what is given to a function that is not inlined must lie in memory.
    #[inline(always)]
    fn again(&mut self) -> Orders<'_, R> {
        Orders {
            stride: self.stride,
            width: self.width,
            rows: &mut *self.rows,
            series: &mut *self.series,
            index: self.index,
            operands: self.operands.again(),
            terms: self.terms,
            blocks: &mut *self.blocks,
            vector: &mut *self.vector,
            sides: self.sides,
            weights: self.weights,
        }
    }
}

impl<R: Real> Orders<'_, R> {
    /// The coefficient of order `k` of an operation that has no place in the batch.
    pub(super) fn alone(&mut self, program: &Program, register: Register, k: usize) -> R {
        let (stride, width) = (self.stride, self.width);
        let row = |k: usize| &self.rows[k * width..][..width];
        match program.ops[register as usize] {
            Op::ParametricPower(a, exponent) => {
                let exponent = self.rows[exponent as usize].double();
                let [a_starts, own_starts] = [a, register].map(|r| self.index.start(r, stride));
                self.series[a_starts + k] = row(k)[a as usize];
                let (below, own) = self.series.split_at_mut(own_starts);
                let base = &below[a_starts..][..stride];
                own[k] = parametric_power::coefficient(base, exponent, own, k, stride);
                own[k]
            }
            Op::Select { switch, mode, positive, negative } => {
                let (positive, negative) = (positive as usize, negative as usize);
                let first = row(0)[switch as usize].value();
                let side = match mode {
                    Some(mode) => self.sides[mode as usize],
                    None if first > 0.0 => Side::Positive,
                    None if first < 0.0 => Side::Negative,
                    None => Side::Between,
                };
                match side {
                    Side::Positive => row(k)[positive],
                    Side::Negative => row(k)[negative],
                    Side::Level => (row(k)[positive] + row(k)[negative]) * 0.5,
                    Side::Between => {
                        let weights = match mode {
                            Some(mode) => &self.weights[mode as usize * stride..][..stride],
                            None => &[],
                        };
                        let half = (0..=k).zip(weights).fold(R::ZERO, |sum, (j, &w)| {
                            sum + w * (row(k - j)[positive] - row(k - j)[negative])
                        });
                        (row(k)[positive] + row(k)[negative] + half) * 0.5
                    }
                }
            }
            _ => row(k)[register as usize],
        }
    }
}

/// The coefficient of order `k` that follows from a relation, from all registers at order 0, those
/// at order k that are known, and the inner products.
#[inline(always)]
fn related<R: Analytic, const FUSED: bool>(
    schedule: &Schedule,
    relation: &Relation,
    (values, now, products): (&[R], &[R], &[R]),
    k: usize,
) -> R {
    let at = |r: Register| r as usize;
    let times = |factor: ConvolutionFactor, x: R| match factor {
        ConvolutionFactor::Plus => x,
        ConvolutionFactor::Minus => -x,
        ConvolutionFactor::Times(factor) => x.times_unnormalized::<FUSED>(R::of(factor)),
    };
    let last = |a: Register, b: Register| now[at(a)].times_unnormalized::<FUSED>(values[at(b)]);
    let mut sum = match relation.direct {
        Direct::None => None,
        Direct::Coefficient(a) => Some(now[at(a)]),
        Direct::Slope(factor, a) => Some(times(factor, now[at(a)].multiple::<FUSED>(k))),
    };
    let range = relation.first as usize..(relation.first + relation.count) as usize;
    for summand in &schedule.summands[range] {
        let product = summand.product.map_or(R::ZERO, |i| products[i as usize]);
        let whole = match summand.ends {
            Ends::None => product,
            Ends::Last(a, b) => product.plus_unnormalized(last(a, b)),
            Ends::LastSlope(a, b) => product.plus_unnormalized(last(a, b).multiple::<FUSED>(k)),
            Ends::Both(a, b) => {
                let first = values[at(a)].times_unnormalized::<FUSED>(now[at(b)]);
                product.plus_unnormalized(first.plus_unnormalized(last(a, b)))
            }
        };
        let whole = times(summand.factor, whole);
        sum = Some(sum.map_or(whole, |sum: R| sum.plus_unnormalized(whole)));
    }
    let sum = sum.unwrap_or(R::ZERO);
    let coefficient = match relation.denominator {
        Denominator::One => sum,
        Denominator::Order => sum.over::<FUSED>(k),
        Denominator::Value(a) => sum.divided_by_shared::<FUSED>(values[at(a)]),
        Denominator::OrderTimes(a) => {
            sum.divided_by_shared::<FUSED>(values[at(a)]).over::<FUSED>(k)
        }
        Denominator::Twice(a) => sum.divided_by_shared::<FUSED>(values[at(a)].multiple::<FUSED>(2)),
    };
    coefficient.renormalized()
}
