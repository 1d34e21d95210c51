//! The second evaluator of a program: normalised Taylor coefficients in time, order by order.
//!
//! The caller sets the coefficients of order k of the inputs (and of the time), evaluates order k,
//! and reads the outputs of order k, from which the inputs of order k + 1 follow. A register that
//! depends on parameters only stays zero above order 0. Order 0 is that of the first evaluator; what
//! is done at each later one is the program's [`Schedule`].
//!
//! Rules: À. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99, section 2.

mod batch;
mod operands;
mod orders;
#[cfg(target_arch = "x86_64")]
mod outline;
mod series_index;
mod side;
mod tables;

use std::ops::{Range, RangeInclusive};
use std::sync::Arc;

use super::parts::{Interpreted, PartwiseEvaluation};
use super::program::{Op, Program, Register, Singular};
use super::schedule::Schedule;
use crate::expr::FunctionId;
use crate::num::{Analytic, Batch, DoubleDouble, Kernel, Real, vectorized};
pub(super) use orders::Coefficient;
#[cfg(target_arch = "x86_64")]
pub(super) use outline::JetPlan;
use series_index::{PoleDegree, SeriesIndex};
pub use side::Side;
use tables::Tables;

/// The registers of one program as power series, in one precision.
#[derive(Clone, Debug)]
pub struct Jet<R: Coefficient> {
    program: Arc<Program>,
    schedule: Arc<Schedule>,
    tables: Tables<R>,
}

impl<R: Coefficient> Jet<R> {
    /// Allocates registers for a program, up to an order. The parameters must be set before it is
    /// evaluated.
    pub fn new(program: Arc<Program>, order: usize) -> Jet<R> {
        Jet::with_index(program, order, true)
    }

    /// The same if the series of the outputs are not read.
    pub(super) fn without_outputs(program: Arc<Program>, order: usize) -> Jet<R> {
        Jet::with_index(program, order, false)
    }

    fn with_index(program: Arc<Program>, order: usize, outputs: bool) -> Jet<R> {
        let schedule = Arc::new(Schedule::of(&program));
        let index = Arc::new(SeriesIndex::of(&program, outputs));
        Jet::with_schedule(program, schedule, index, order)
    }

    /// The same for the program of another jet.
    pub(super) fn like<S: Coefficient>(other: &Jet<S>, order: usize) -> Jet<R> {
        let (program, schedule) = (Arc::clone(&other.program), Arc::clone(&other.schedule));
        Jet::with_schedule(program, schedule, Arc::clone(&other.tables.index), order)
    }

    fn with_schedule(
        program: Arc<Program>,
        schedule: Arc<Schedule>,
        index: Arc<SeriesIndex>,
        order: usize,
    ) -> Jet<R> {
        let tables = Tables::new(&program, &schedule, index, order);
        Jet { program, schedule, tables }
    }

    /// The highest order there is room for.
    pub fn order(&self) -> usize {
        self.tables.stride - 1
    }

    /// Sets the parameters and evaluates everything that depends on them alone.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        let (program, tables) = (&*self.program, &mut self.tables);
        for &r in &program.prologue {
            match program.ops[r as usize] {
                Op::Parameter(i) => tables.rows[r as usize] = R::of(parameters[i as usize]),
                op => tables.evaluate(program, r, op),
            }
        }
    }

    /// Sets a coefficient of an input.
    pub fn set_input(&mut self, input: usize, order: usize, coefficient: R) {
        let register = self.program.inputs[input] as usize;
        self.tables.rows[order * self.tables.width + register] = coefficient;
    }

    /// Sets the coefficients of order `k` of the first `count` inputs, whose series of the length of
    /// the registers' lie one after another.
    #[inline(always)]
    pub(super) fn take_in(&mut self, series: &[R], count: usize, k: usize) {
        let Tables { rows, stride, width, .. } = &mut self.tables;
        let now = &mut rows[k * *width..][..*width];
        let mut place = k;
        for &register in self.program.inputs.iter().take(count) {
            now[register as usize] = series[place];
            place += *stride;
        }
    }

    /// Chooses the branch at a switch.
    pub fn set_side(&mut self, switch: usize, side: Side) {
        self.tables.sides[switch] = side;
    }

    /// The branch taken at a switch.
    pub fn side(&self, switch: usize) -> Side {
        self.tables.sides[switch]
    }

    /// The number of switches.
    pub fn switches(&self) -> usize {
        self.tables.sides.len()
    }

    /// Sets a coefficient of the weight at a switch whose side is [`Side::Between`].
    pub fn set_weight(&mut self, switch: usize, order: usize, coefficient: R) {
        self.tables.weights[switch * self.tables.stride + order] = coefficient;
    }

    /// Evaluates all registers at order `k`, at a time that advances in units of `scale`. The lower
    /// orders must have been evaluated, and the inputs' coefficients of order `k` set.
    ///
    /// # Errors
    /// Returns the block of equations whose matrix is singular.
    pub fn advance(&mut self, k: usize, time: R, scale: R::Unit) -> Result<(), Singular> {
        vectorized(Advance { jet: self, orders: k..=k, time, scale })
    }

    /// The same inside a [`Kernel`].
    #[inline(always)]
    pub(super) fn advance_with<const FUSED: bool>(
        &mut self,
        k: usize,
        time: R,
        scale: R::Unit,
    ) -> Result<(), Singular> {
        if k == 0 {
            self.begin(time)?;
        } else {
            let Jet { program, schedule, tables } = self;
            tables.orders().advance::<FUSED>(program, schedule, k, scale);
        }
        Ok(())
    }

    /// Evaluates all registers at order 0.
    #[inline(always)]
    pub(super) fn begin(&mut self, time: R) -> Result<(), Singular> {
        self.begin_by(&mut Interpreted, time)
    }

    #[inline(always)]
    pub(super) fn begin_by(
        &mut self,
        parts: &mut impl PartwiseEvaluation,
        time: R,
    ) -> Result<(), Singular> {
        let Jet { program, tables, .. } = self;
        parts.evaluate(
            program,
            tables,
            |tables| R::floats(&mut tables.rows[..program.ops.len()]),
            |tables, range| tables.begin(program, time, range),
        )?;
        self.tables.orders().keep(0);
        Ok(())
    }

    /// Computes the orders of the series of a state above the first of `orders` and up to their end, each from the one before.
    /// The series are as long as the registers' and lie one after another. Before each order `ends` is asked whether to stop,
    /// and false is returned where that is so.
    #[inline(always)]
    pub(super) fn grow<const FUSED: bool>(
        &mut self,
        (state, count): (&mut [R], usize),
        orders: Range<usize>,
        (time, scale): (R, R::Unit),
        ends: impl Fn() -> bool,
    ) -> Result<bool, Singular> {
        self.take_in(state, count, orders.start);
        let mut next = orders.start;
        if next == 0 && orders.end > 0 && !ends() {
            self.begin(time)?;
        }
        let Jet { program, schedule, tables } = self;
        let mut tables = tables.orders();
        while next < orders.end {
            if ends() {
                return Ok(false);
            }
            let k = next;
            next += 1;
            if k > 0 {
                tables.advance::<FUSED>(program, schedule, k, scale);
            }
            let made = |x: R| x.integrated::<FUSED>(scale, next);
            tables.give_out(program, (&mut *state, count), k, made);
        }
        Ok(true)
    }

    /// Gives the series of a state, of the length of the registers', their coefficients of order `k + 1`, each made from
    /// that of order `k` of an output, and sets those of the first `count` inputs to them.
    #[inline(always)]
    pub(super) fn give_out(&mut self, state: (&mut [R], usize), k: usize, made: impl Fn(R) -> R) {
        self.tables.orders().give_out(&self.program, state, k, made);
    }

    /// Evaluates all orders up to one, at a time that advances in units of `scale`. The inputs'
    /// coefficients must have been set.
    pub(super) fn advance_to(
        &mut self,
        last: usize,
        time: R,
        scale: R::Unit,
    ) -> Result<(), Singular> {
        vectorized(Advance { jet: self, orders: 0..=last, time, scale })
    }

    pub(super) fn output_series(&self, i: usize) -> &[R] {
        self.series(self.program.outputs[i])
    }

    /// A coefficient of an output.
    pub fn output(&self, i: usize, order: usize) -> R {
        self.tables.rows[order * self.tables.width + self.program.outputs[i] as usize]
    }

    /// The series of a switch.
    pub fn switch(&self, i: usize) -> &[R] {
        self.series(self.program.switches[i])
    }

    /// The series of the weight at a switch.
    pub fn weight(&self, i: usize) -> &[R] {
        &self.tables.weights[i * self.tables.stride..][..self.tables.stride]
    }

    /// The series of the arguments of all functions that are not constant.
    pub fn arguments(&self) -> impl Iterator<Item = (FunctionId, &[R])> {
        self.tables.index.arguments.iter().map(|&(function, u)| (function, self.series(u)))
    }

    /// The series of the angles atan2(y, x) of points that are not constant.
    pub(super) fn angles_of_points(&self) -> impl Iterator<Item = &[R]> {
        self.program.body.iter().filter_map(|&r| match self.program.ops[r as usize] {
            Op::Call(FunctionId::Atan2, _) => Some(self.series(r)),
            _ => None,
        })
    }

    /// The high negative powers c/u^n: n, c, and the series of u.
    pub fn steep_poles(&self) -> impl Iterator<Item = (R, R, &[R])> {
        self.tables.index.steep_poles.iter().map(|pole| {
            let degree = match pole.degree {
                PoleDegree::Number(n) => R::of(DoubleDouble::from(n)),
                PoleDegree::Parameter(exponent) => -self.value(exponent),
            };
            (degree, pole.above.map_or(R::ONE, |above| self.value(above)), self.series(pole.base))
        })
    }

    /// The series of what is divided by.
    pub fn divisors(&self) -> impl Iterator<Item = &[R]> {
        self.tables.index.divisors.iter().map(|&u| self.series(u))
    }

    /// The series of the arguments of tangents, each with what is to be taken from it to have the pole at π/2.
    pub fn tangents(&self) -> impl Iterator<Item = (&[R], f64)> {
        self.tables.index.tangents.iter().map(|&(u, zero)| (self.series(u), -zero))
    }

    pub(super) fn series(&self, register: Register) -> &[R] {
        let Tables { series, stride, index, .. } = &self.tables;
        &series[index.start(register, *stride)..][..*stride]
    }

    /// The first coefficient of any register.
    pub(super) fn value(&self, register: Register) -> R {
        self.tables.rows[register as usize]
    }
}

impl<R: Real> Jet<R> {
    /// Copies the orders below `orders` from a jet of the same program in another precision, and
    /// the matrices that it has factored.
    pub fn take_over<S: Real>(&mut self, other: &Jet<S>, orders: usize) {
        self.copy(other, orders);
        for (own, other) in self.tables.blocks.iter_mut().zip(&other.tables.blocks) {
            own.take_over(other);
        }
    }

    /// Copies the orders below `orders`.
    pub fn copy<S: Real>(&mut self, other: &Jet<S>, orders: usize) {
        let (own, other) = (&mut self.tables, &other.tables);
        let fixed = &self.program.fixed;
        let rows = own.rows.chunks_exact_mut(own.width);
        let mut rows = rows.zip(other.rows.chunks_exact(other.width)).take(orders);
        if let Some((own, other)) = rows.next() {
            for ((x, y), _) in own.iter_mut().zip(other).zip(fixed).filter(|(_, fixed)| !**fixed) {
                *x = R::of(y.double());
            }
        }
        // above order 0 what depends on parameters alone is zero in both
        for (own, other) in rows {
            own.iter_mut().zip(other).for_each(|(x, y)| *x = R::of(y.double()));
        }
        let stretches = own.series.chunks_exact_mut(own.stride);
        let theirs = other.series.chunks_exact(other.stride);
        for ((own, other), &register) in stretches.zip(theirs).zip(&own.index.registers) {
            if !fixed[register as usize] {
                own.iter_mut().zip(other).take(orders).for_each(|(x, y)| *x = R::of(y.double()));
                if S::UNBOUNDED && other[..orders].iter().any(|y| !y.value().is_finite()) {
                    copy_in_proportion(&mut own[..orders], &other[..orders]);
                }
            }
        }
        for switch in 0..own.sides.len() {
            own.sides[switch] = other.sides[switch];
            let weights = &other.weights[switch * other.stride..][..orders];
            for (x, y) in own.weights[switch * own.stride..].iter_mut().zip(weights) {
                *x = R::of(y.double());
            }
        }
        for k in 1..orders {
            own.orders().hand_on::<false>(&self.schedule, k);
        }
    }
}

impl Jet<Batch> {
    /// Takes what depends on parameters alone, in one lane, from a jet of the same program.
    pub(super) fn take_parameters(&mut self, lane: usize, from: &Jet<f64>) {
        let registers = self.tables.rows.iter_mut().zip(&from.tables.rows);
        for ((own, other), _) in registers.zip(&self.program.fixed).filter(|(_, fixed)| **fixed) {
            own.0[lane] = *other;
        }
    }
}

/// Copies a series with terms beyond the range of the copy in a unit of its own: as an argument, at which its function is its
/// limit to every digit, it is asked only how fast it changes in proportion to itself.
fn copy_in_proportion<R: Real, S: Real>(own: &mut [R], other: &[S]) {
    let larger = |a: S, b: S| if (b / a).value().abs() <= 1.0 { a } else { b };
    let Some(largest) = other.iter().copied().reduce(larger) else { return };
    let unit = LARGEST_COPIED.copysign(largest.value());
    for (x, &y) in own.iter_mut().zip(other) {
        let part = (y / largest).double();
        if part.is_finite() {
            *x = R::of(part.scaled(unit));
        }
    }
}

/// The size of the largest term of such a copy: 2¹⁰⁰⁰.
const LARGEST_COPIED: f64 = f64::from_bits((1023 + 1000) << 52);

/// Some orders of a jet whose inputs are known up to them.
struct Advance<'a, R: Coefficient> {
    jet: &'a mut Jet<R>,
    orders: RangeInclusive<usize>,
    time: R,
    scale: R::Unit,
}

impl<R: Coefficient> Kernel for Advance<'_, R> {
    type Output = Result<(), Singular>;
    const OF_SEVERAL: bool = R::OF_SEVERAL;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), Singular> {
        let Advance { jet, mut orders, time, scale } = self;
        orders.try_for_each(|k| jet.advance_with::<FUSED>(k, time, scale))
    }
}
