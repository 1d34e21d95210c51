//! The order of work by which a program is evaluated as Taylor series.
//!
//! In: a program. Out: for each order above zero, what is done in two phases. Never here: numbers.
//!
//! ```text
//!   orders 0 … k−1 of all registers          order k of the inputs
//!          │                                        │
//!   1. inner products: every convolution     2. finishing pass, run by run of one kind:
//!      Σ_{j=1}^{k−1} a_j b_{k−j}, all in         the products left over, a_0 b_k + a_k b_0,
//!      one batch of equal length        ──▶      sums, divisions, solutions of linear equations
//! ```
//!
//! The first phase needs nothing of order k, so no number is loaded right after it was stored. Where
//! the slope of the left operand of a convolution enters, its terms are j a_j.

use rustc_hash::FxHashMap;

use super::finishing_pass::{
    Integral, LinearSolve, LinearSum, OperationRun, Product, Related, Scaling, Sorter, Step,
    TermSign,
};
use super::program::{Block, Op, Program, Register};
use crate::expr::{BilinearEquation, Divisor, Rule, SeriesOperand};
use crate::num::DoubleDouble;

/// An inner product of the first phase.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Pair {
    /// A register, or a slope, which are counted behind all registers.
    pub(super) left: u32,
    pub(super) right: Register,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum ConvolutionFactor {
    Plus,
    Minus,
    Times(DoubleDouble),
}

impl ConvolutionFactor {
    /// The sign that it is, if it is no more.
    fn sign(self) -> Option<TermSign> {
        match self {
            ConvolutionFactor::Plus => Some(TermSign::Plus),
            ConvolutionFactor::Minus => Some(TermSign::Minus),
            ConvolutionFactor::Times(_) => None,
        }
    }
}

/// What the inner product leaves out of a convolution at order k.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ends {
    /// Nothing that is known.
    None,
    /// `a_k b_0`.
    Last(Register, Register),
    /// `k a_k b_0`.
    LastSlope(Register, Register),
    /// `a_0 b_k + a_k b_0`.
    Both(Register, Register),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Summand {
    pub(super) factor: ConvolutionFactor,
    /// The inner product, unless one of the operands is constant.
    pub(super) product: Option<u32>,
    pub(super) ends: Ends,
}

/// What a k-th coefficient is divided by.
#[derive(Clone, Copy, Debug)]
pub(super) enum Denominator {
    One,
    Order,
    Value(Register),
    OrderTimes(Register),
    Twice(Register),
}

/// `denominator · f_k = direct + Σ summand`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relation {
    /// `a_k` or `± k a_k`.
    pub(super) direct: Direct,
    /// A range of the table of summands.
    pub(super) first: u32,
    pub(super) count: u32,
    pub(super) denominator: Denominator,
    /// Where this series is identically zero, so is f, although it is divided by zero.
    pub(super) vanishing: Option<Register>,
}

/// The term of a relation that is no convolution.
#[derive(Clone, Copy, Debug)]
pub(super) enum Direct {
    None,
    /// `a_k`.
    Coefficient(Register),
    /// `± k a_k`.
    Slope(ConvolutionFactor, Register),
}

/// An entry of a matrix that is not constant, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct VaryingEntry {
    pub(super) row: u32,
    pub(super) column: u32,
    pub(super) register: Register,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Schedule {
    pub(super) pairs: Vec<Pair>,
    /// The operations of the finishing pass.
    pub(super) runs: Vec<OperationRun>,
    pub(super) relations: Vec<Relation>,
    pub(super) summands: Vec<Summand>,
    pub(super) entries: Vec<VaryingEntry>,
    /// The registers whose slope enters an inner product.
    pub(super) slopes: Vec<Register>,
}

impl Schedule {
    pub(super) fn of(program: &Program) -> Schedule {
        let mut writer = ScheduleWriter {
            program,
            schedule: Schedule::default(),
            sorter: Sorter::new(program.ops.len()),
            pairs: FxHashMap::default(),
            slopes: FxHashMap::default(),
        };
        for &register in &program.body {
            writer.write(register);
        }
        Schedule { runs: writer.sorter.runs(), ..writer.schedule }
    }
}

struct ScheduleWriter<'a> {
    program: &'a Program,
    schedule: Schedule,
    sorter: Sorter,
    /// The places of pairs and of slopes.
    pairs: FxHashMap<Pair, u32>,
    slopes: FxHashMap<Register, u32>,
}

/// The place of a register in a list, to which it is added where it is new.
fn place(
    list: &mut Vec<Register>,
    known: &mut FxHashMap<Register, u32>,
    register: Register,
) -> u32 {
    *known.entry(register).or_insert_with(|| {
        list.push(register);
        list.len() as u32 - 1
    })
}

impl ScheduleWriter<'_> {
    fn write(&mut self, register: Register) {
        let step = match self.program.ops[register as usize] {
            Op::Time => Step::Time(register),
            Op::Linear { first, count, .. } => Step::Sum(LinearSum { register, first, count }),
            Op::Scale(fixed, varying) => Step::Scale(Scaling { register, fixed, varying }),
            Op::Multiply(left, right) => match self.product(false, left, right) {
                Some(inner) => Step::Product(Product { register, left, right, inner }),
                None => {
                    let summand =
                        self.summand(ConvolutionFactor::Plus, false, (left, right), register);
                    self.relation(register, Direct::None, &[summand], Denominator::One, None)
                }
            },
            Op::Square(of) => match self.product(false, of, of) {
                Some(inner) => Step::Product(Product { register, left: of, right: of, inner }),
                None => return,
            },
            Op::Divide(a, b) => {
                let summand =
                    self.summand(ConvolutionFactor::Minus, false, (b, register), register);
                let (direct, denominator) = (Direct::Coefficient(a), Denominator::Value(b));
                self.relation(register, direct, &[summand], denominator, None)
            }
            Op::Root(a) => {
                let summand =
                    self.summand(ConvolutionFactor::Minus, false, (register, register), register);
                let (direct, denominator) = (Direct::Coefficient(a), Denominator::Twice(register));
                self.relation(register, direct, &[summand], denominator, Some(a))
            }
            Op::Power(a, exponent) => {
                // y = a^α: a y′ = α a′ y
                let exponent = self.program.constants[exponent as usize];
                let (factor, minus) =
                    (ConvolutionFactor::Times(exponent), ConvolutionFactor::Minus);
                let summands = [
                    self.summand(factor, true, (a, register), register),
                    self.summand(minus, true, (register, a), register),
                ];
                let vanishing = (exponent.high > 0.0).then_some(a);
                let denominator = Denominator::OrderTimes(a);
                self.relation(register, Direct::None, &summands, denominator, vanishing)
            }
            Op::Call(function, arguments) => {
                let Rule::Series(recurrence) = &function.row().rule else { return };
                let forms =
                    [(register, Some(recurrence.value)), (register + 1, recurrence.companion)];
                let order = if recurrence.companion_first { [1, 0] } else { [0, 1] };
                for (own, form) in order.map(|i| forms[i]) {
                    if let Some(form) = form {
                        let step = self.form(own, register, arguments, &form);
                        self.add(step, register, 1);
                    }
                }
                return;
            }
            Op::Solve(block) => {
                let solution = Step::Solution(self.solution(register, block));
                self.add(solution, register, self.program.blocks[block as usize].size());
                return;
            }
            Op::ParametricPower(..) | Op::Select { .. } => Step::Alone(register),
            Op::Constant(_) | Op::Parameter(_) | Op::Input(_) | Op::Written => return,
        };
        self.add(step, register, 1);
    }

    /// Adds a step of an operation that writes `count` registers.
    fn add(&mut self, step: Step, operation: Register, count: usize) {
        let mut needs = Vec::new();
        self.program.each_operand(operation, &mut |operand| needs.push(operand));
        if let Op::Call(..) = self.program.ops[operation as usize] {
            // a function and its companion may need each other
            needs.extend([operation, operation + 1]);
        }
        self.sorter.add(step, count, needs);
    }

    /// The recurrence of a function or of its companion, `register`; `value` is the function.
    fn form(
        &mut self,
        register: Register,
        value: Register,
        arguments: [Register; 2],
        equation: &BilinearEquation,
    ) -> Step {
        let of = |operand: SeriesOperand| match operand {
            SeriesOperand::First => arguments[0],
            SeriesOperand::Second => arguments[1],
            SeriesOperand::Value => value,
            SeriesOperand::Companion => value + 1,
        };
        let factor =
            |sign: f64| if sign < 0.0 { ConvolutionFactor::Minus } else { ConvolutionFactor::Plus };
        let direct = match equation.slope {
            Some((sign, operand)) => Direct::Slope(factor(sign), of(operand)),
            None => Direct::None,
        };
        let denominator = match equation.divisor {
            Divisor::One => Denominator::One,
            Divisor::Order => Denominator::Order,
            Divisor::OrderTimes(operand) => Denominator::OrderTimes(of(operand)),
            Divisor::Twice(operand) => Denominator::Twice(of(operand)),
        };
        let sums = equation.sums.iter();
        let summands: Vec<Summand> = sums
            .map(|c| {
                let pair = (of(c.left), of(c.right));
                self.summand(factor(c.sign), c.of_slope, pair, register)
            })
            .collect();
        self.relation(register, direct, &summands, denominator, None)
    }

    fn relation(
        &mut self,
        register: Register,
        direct: Direct,
        summands: &[Summand],
        denominator: Denominator,
        vanishing: Option<Register>,
    ) -> Step {
        let schedule = &mut self.schedule;
        let plain = (direct, denominator, vanishing);
        if let ((Direct::None, Denominator::Order, None), [only]) = (plain, summands)
            && let (Some(inner), Ends::LastSlope(slope, factor)) = (only.product, only.ends)
            && let Some(sign) = only.factor.sign()
        {
            return Step::Integral(Integral { register, sign, slope, factor, inner });
        }
        let (first, count) = (schedule.summands.len() as u32, summands.len() as u32);
        schedule.summands.extend_from_slice(summands);
        let relation = schedule.relations.len() as u32;
        schedule.relations.push(Relation { direct, first, count, denominator, vanishing });
        Step::Related(Related { register, relation })
    }

    /// A convolution in the recurrence of `own`.
    fn summand(
        &mut self,
        factor: ConvolutionFactor,
        of_slope: bool,
        (left, right): (Register, Register),
        own: Register,
    ) -> Summand {
        let ends = match (of_slope, left == own, right == own) {
            (_, true, _) => Ends::None,
            (true, false, _) => Ends::LastSlope(left, right),
            (false, false, true) => Ends::Last(left, right),
            (false, false, false) => Ends::Both(left, right),
        };
        Summand { factor, product: self.product(of_slope, left, right), ends }
    }

    /// The inner product of two series, unless one of them is constant.
    fn product(&mut self, of_slope: bool, left: Register, right: Register) -> Option<u32> {
        if self.program.fixed[left as usize] || self.program.fixed[right as usize] {
            return None;
        }
        let schedule = &mut self.schedule;
        let left = if of_slope {
            self.program.ops.len() as u32 + place(&mut schedule.slopes, &mut self.slopes, left)
        } else {
            left
        };
        let pair = Pair { left, right };
        Some(*self.pairs.entry(pair).or_insert_with(|| {
            schedule.pairs.push(pair);
            schedule.pairs.len() as u32 - 1
        }))
    }

    /// Linear equations whose unknowns begin at a register, with the inner products of the varying entries of the matrix
    /// and these.
    fn solution(&mut self, register: Register, block: u32) -> LinearSolve {
        let (program, schedule) = (self.program, &mut self.schedule);
        let Block { matrix, right, .. } = &program.blocks[block as usize];
        let (inner, first) = (schedule.pairs.len() as u32, schedule.entries.len() as u32);
        for (row, entries) in (0..).zip(matrix.chunks(right.len())) {
            for (column, &entry) in (0..).zip(entries) {
                if !program.fixed[entry as usize] {
                    schedule.pairs.push(Pair { left: entry, right: register + column });
                    schedule.entries.push(VaryingEntry { row, column, register: entry });
                }
            }
        }
        let count = schedule.entries.len() as u32 - first;
        LinearSolve { register, block, first, count, inner }
    }
}
