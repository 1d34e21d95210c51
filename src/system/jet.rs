//! The second evaluator of a program: normalised Taylor coefficients in time, order by order.
//!
//! The caller sets the coefficients of order k of the inputs (and of the time), evaluates order k,
//! and reads the outputs of order k, from which the inputs of order k + 1 follow. A register that
//! depends on parameters only stays zero above order 0. Order 0 is that of the first evaluator; what
//! is done at each later one is the program's [`Schedule`].
//!
//! Rules: À. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99, section 2.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::parametric_power::{self, vanishes};
use super::program::{Block, Op, Program, Register, Singular};
use super::schedule::{Denominator, Direct, Ends, Factor, Relation, Schedule, Step};
use super::solve::Factored;
use super::value::value_of;
use crate::expr::FunctionId;
use crate::num::{DoubleDouble, Kernel, Real, Row, vectorized};

/// The branch that functions with a kink take while a series is built.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// The branch where the switch is positive.
    Positive,
    /// The branch where the switch is negative.
    Negative,
    /// Between the branches: their mean, plus half their difference times a weight in [−1, 1] that
    /// keeps the switch at zero.
    Between,
}

/// The registers of one program as power series, in one precision.
#[derive(Clone, Debug)]
pub struct Jet<R> {
    program: Arc<Program>,
    schedule: Arc<Schedule>,
    tables: Tables<R>,
}

/// What a jet computes with.
#[derive(Clone, Debug)]
struct Tables<R> {
    stride: usize,
    /// The coefficients of all registers, then those of the slopes that enter.
    forward: Vec<R>,
    /// The coefficients of right operands, from the highest order to the lowest.
    reversed: Vec<R>,
    /// The pairs of the schedule, as places in these.
    rows: Vec<Row>,
    /// Their inner products at the present order.
    products: Vec<R>,
    /// All registers at order 0, and at the present order.
    values: Vec<R>,
    now: Vec<R>,
    /// The terms of the program's sums.
    terms: Vec<(Register, R)>,
    blocks: Vec<Factored<R>>,
    right: Vec<R>,
    sides: Vec<Side>,
    /// The weights of the sides [`Side::Between`], one series for each switch.
    weights: Vec<R>,
}

impl<R: Real> Jet<R> {
    /// Allocates registers for a program, up to an order. The parameters must be set before it is
    /// evaluated.
    pub fn new(program: Arc<Program>, order: usize) -> Jet<R> {
        let schedule = Arc::new(Schedule::of(&program));
        Jet::with_schedule(program, schedule, order)
    }

    /// The same for the program of another jet.
    pub(super) fn like<S: Real>(other: &Jet<S>, order: usize) -> Jet<R> {
        Jet::with_schedule(Arc::clone(&other.program), Arc::clone(&other.schedule), order)
    }

    fn with_schedule(program: Arc<Program>, schedule: Arc<Schedule>, order: usize) -> Jet<R> {
        let (stride, registers) = (order + 1, program.ops.len());
        let blocks: Vec<_> = program.blocks.iter().map(|b| Factored::new(b.size())).collect();
        let widest = program.blocks.iter().map(super::program::Block::size).max().unwrap_or(0);
        // the first term of a series takes no part in inner products
        let row = |pair: &super::schedule::Pair| Row {
            forward: pair.forward * stride as u32 + 1,
            reversed: pair.reversed * stride as u32,
        };
        let tables = Tables {
            stride,
            forward: vec![R::ZERO; (registers + schedule.slopes.len()) * stride],
            reversed: vec![R::ZERO; schedule.reversed.len() * stride],
            rows: schedule.pairs.iter().map(row).collect(),
            products: vec![R::ZERO; schedule.pairs.len()],
            values: vec![R::ZERO; registers],
            now: vec![R::ZERO; registers],
            terms: program
                .terms
                .iter()
                .map(|term| (term.register, R::of(term.coefficient)))
                .collect(),
            blocks,
            right: vec![R::ZERO; widest],
            sides: vec![Side::Positive; program.switches.len()],
            weights: vec![R::ZERO; program.switches.len() * stride],
        };
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
                Op::Parameter(i) => tables.set_value(r, R::of(parameters[i as usize])),
                op => tables.evaluate(program, r, op),
            }
        }
    }

    /// Sets a coefficient of an input.
    pub fn set_input(&mut self, input: usize, order: usize, coefficient: R) {
        let register = self.program.inputs[input] as usize;
        self.tables.forward[register * self.tables.stride + order] = coefficient;
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
    pub fn advance(&mut self, k: usize, time: R, scale: f64) -> Result<(), Singular> {
        vectorized(Advance { jet: self, orders: k..=k, time, scale })
    }

    /// The same inside a [`Kernel`].
    #[inline(always)]
    pub(super) fn advance_with<const FUSED: bool>(
        &mut self,
        k: usize,
        time: R,
        scale: f64,
    ) -> Result<(), Singular> {
        let (program, schedule, tables) = (&*self.program, &*self.schedule, &mut self.tables);
        if k == 0 {
            return tables.begin(program, time);
        }
        tables.multiply::<FUSED>(k);
        let rate = if k == 1 { R::ONE * scale } else { R::ZERO };
        tables.finish::<FUSED>(program, schedule, k, rate);
        tables.mirror(schedule, k);
        Ok(())
    }

    /// Evaluates all orders up to one, at a time that advances in units of `scale`. The inputs'
    /// coefficients must have been set.
    pub(super) fn advance_to(&mut self, last: usize, time: R, scale: f64) -> Result<(), Singular> {
        vectorized(Advance { jet: self, orders: 0..=last, time, scale })
    }

    /// The series of an output.
    pub(super) fn output_series(&self, i: usize) -> &[R] {
        self.series(self.program.outputs[i])
    }

    /// A coefficient of an output.
    pub fn output(&self, i: usize, order: usize) -> R {
        self.tables.forward[self.program.outputs[i] as usize * self.tables.stride + order]
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
        self.program.body.iter().filter_map(|&r| match self.program.ops[r as usize] {
            Op::Call(function, [u, _]) => Some((function, self.series(u))),
            _ => None,
        })
    }

    /// The series of any register.
    pub(super) fn series(&self, register: Register) -> &[R] {
        &self.tables.forward[register as usize * self.tables.stride..][..self.tables.stride]
    }

    /// Copies the orders below `orders` from a jet of the same program in another precision, and
    /// factors the matrices that it has factored.
    pub fn take_over<S: Real>(&mut self, other: &Jet<S>, orders: usize) -> Result<(), Singular> {
        self.copy(other, orders);
        let (program, tables) = (&*self.program, &mut self.tables);
        (0..program.blocks.len()).try_for_each(|block| tables.factor(program, block))
    }

    /// Copies the orders below `orders`.
    pub fn copy<S: Real>(&mut self, other: &Jet<S>, orders: usize) {
        let (own, other) = (&mut self.tables, &other.tables);
        for (register, &fixed) in self.program.fixed.iter().enumerate() {
            if !fixed {
                let theirs = &other.forward[register * other.stride..][..orders];
                for (x, y) in own.forward[register * own.stride..].iter_mut().zip(theirs) {
                    *x = R::of(y.double());
                }
                own.values[register] = own.forward[register * own.stride];
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
            own.mirror(&self.schedule, k);
        }
    }
}

/// Some orders of a jet whose inputs are known up to them.
struct Advance<'a, R> {
    jet: &'a mut Jet<R>,
    orders: RangeInclusive<usize>,
    time: R,
    scale: f64,
}

impl<R: Real> Kernel for Advance<'_, R> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), Singular> {
        let Advance { jet, mut orders, time, scale } = self;
        orders.try_for_each(|k| jet.advance_with::<FUSED>(k, time, scale))
    }
}

impl<R: Real> Tables<R> {
    /// Computes all inner products of order `k`.
    #[inline(always)]
    fn multiply<const FUSED: bool>(&mut self, k: usize) {
        let range = (self.stride - k, k - 1);
        let (forward, reversed) = (&self.forward, &self.reversed);
        R::inner_products::<FUSED>(forward, reversed, &self.rows, range, &mut self.products);
    }

    fn set_value(&mut self, register: Register, value: R) {
        self.forward[register as usize * self.stride] = value;
        self.values[register as usize] = value;
    }

    /// Evaluates order 0.
    fn begin(&mut self, program: &Program, time: R) -> Result<(), Singular> {
        for &r in &program.inputs {
            self.values[r as usize] = self.forward[r as usize * self.stride];
        }
        for &r in &program.body {
            match program.ops[r as usize] {
                Op::Time => self.set_value(r, time),
                Op::Solve(block) => {
                    self.factor(program, block as usize)?;
                    let block_of = &program.blocks[block as usize];
                    for (x, &right) in self.right.iter_mut().zip(&block_of.right) {
                        *x = self.values[right as usize];
                    }
                    self.blocks[block as usize].solve(&mut self.right[..block_of.size()]);
                    for i in 0..block_of.size() {
                        self.set_value(r + i as u32, self.right[i]);
                    }
                }
                op => self.evaluate(program, r, op),
            }
        }
        Ok(())
    }

    /// Sets the value of an operation.
    fn evaluate(&mut self, program: &Program, r: Register, op: Op) {
        if let Op::Select { .. } | Op::ParametricPower(..) = op {
            let value = self.alone(program, r, 0);
            self.values[r as usize] = value;
        } else if let Some((value, companion)) = value_of(program, op, |r| self.values[r as usize])
        {
            self.set_value(r, value);
            if let Some(companion) = companion {
                self.set_value(r + 1, companion);
            }
        }
    }

    /// Finishes order `k`, once its inner products are known.
    #[inline(always)]
    fn finish<const FUSED: bool>(
        &mut self,
        program: &Program,
        schedule: &Schedule,
        k: usize,
        rate: R,
    ) {
        let (stride, forward) = (self.stride, &self.forward[..]);
        let now = &mut self.now[..];
        for &r in &program.inputs {
            now[r as usize] = forward[r as usize * stride + k];
        }
        let mut steps = schedule.steps.iter();
        while let Some(step) = self.finish_plainly::<FUSED>(schedule, &mut steps, k, rate) {
            match step {
                Step::Solve { register, block, product } => {
                    self.solve(program, (register, block as usize, product as usize), k);
                }
                Step::Alone(register) => {
                    self.now[register as usize] = self.alone(program, register, k);
                }
                _ => {}
            }
        }
    }

    /// Finishes the operations that are a formula each, up to the first that is not, which is
    /// returned.
    #[inline(always)]
    fn finish_plainly<const FUSED: bool>(
        &mut self,
        schedule: &Schedule,
        steps: &mut std::slice::Iter<'_, Step>,
        k: usize,
        rate: R,
    ) -> Option<Step> {
        // as slices, whose places need not be looked up again after each number that is stored
        let (stride, forward) = (self.stride, &mut self.forward[..]);
        let (values, now) = (&self.values[..], &mut self.now[..]);
        let (products, terms) = (&self.products[..], &self.terms[..]);
        let at = |r: Register| r as usize;
        for &step in steps {
            let (register, x) = match step {
                Step::Time(register) => (register, rate),
                Step::Linear { register, first, count } => {
                    let terms = &terms[first as usize..(first + count) as usize];
                    let sum = terms.iter().fold(R::ZERO, |sum, &(term, factor)| {
                        sum + now[at(term)].times::<FUSED>(factor)
                    });
                    (register, sum)
                }
                Step::Scale { register, fixed, varying } => {
                    (register, values[at(fixed)].times::<FUSED>(now[at(varying)]))
                }
                Step::Product { register, left, right, product } => {
                    let ends = values[at(left)].times::<FUSED>(now[at(right)])
                        + now[at(left)].times::<FUSED>(values[at(right)]);
                    (register, products[at(product)] + ends)
                }
                Step::Square { register, of, product } => {
                    let ends = values[at(of)].times::<FUSED>(now[at(of)]);
                    (register, products[at(product)] + (ends + ends))
                }
                Step::Relation { register, relation } => {
                    let relation = &schedule.relations[at(relation)];
                    let vanishes = |a: Register| {
                        values[at(a)].value() == 0.0
                            && vanishes(&forward[at(a) * stride..][..stride], k)
                    };
                    let x = if relation.vanishing.is_some_and(vanishes) {
                        R::ZERO
                    } else {
                        related::<R, FUSED>(schedule, relation, (values, now, products), k)
                    };
                    (register, x)
                }
                Step::Solve { .. } | Step::Alone(_) => return Some(step),
            };
            now[at(register)] = x;
            forward[at(register) * stride + k] = x;
        }
        None
    }

    /// `M_0 a_k = f_k − Σ_{j≥1} M_j a_{k−j}`.
    fn solve(&mut self, program: &Program, at: (Register, usize, usize), k: usize) {
        let (register, block, mut product) = at;
        let Block { matrix, right, .. } = &program.blocks[block];
        let n = right.len();
        for (i, &right) in right.iter().enumerate() {
            let mut sum = self.now[right as usize];
            for (j, &entry) in matrix[i * n..][..n].iter().enumerate() {
                if !program.fixed[entry as usize] {
                    let last = self.now[entry as usize] * self.values[register as usize + j];
                    sum = sum - (self.products[product] + last);
                    product += 1;
                }
            }
            self.right[i] = sum;
        }
        self.blocks[block].solve(&mut self.right[..n]);
        for i in 0..n {
            self.now[register as usize + i] = self.right[i];
            self.forward[(register as usize + i) * self.stride + k] = self.right[i];
        }
    }

    /// The coefficient of order `k` of an operation that has no place in the batch. It is also
    /// written.
    fn alone(&mut self, program: &Program, register: Register, k: usize) -> R {
        let (stride, at) = (self.stride, register as usize);
        let (below, own) = self.forward.split_at_mut(at * stride);
        let series = |r: Register| &below[r as usize * stride..][..stride];
        own[k] = match program.ops[at] {
            Op::ParametricPower(a, exponent) => parametric_power::coefficient(
                series(a),
                series(exponent)[0].double(),
                own,
                k,
                stride,
            ),
            Op::Select { switch, mode, positive, negative } => {
                let (positive, negative) = (series(positive), series(negative));
                let side = match mode {
                    Some(mode) => self.sides[mode as usize],
                    None if series(switch)[0].value() > 0.0 => Side::Positive,
                    None if series(switch)[0].value() < 0.0 => Side::Negative,
                    None => Side::Between,
                };
                match side {
                    Side::Positive => positive[k],
                    Side::Negative => negative[k],
                    Side::Between => {
                        let weights = match mode {
                            Some(mode) => &self.weights[mode as usize * stride..][..stride],
                            None => &[],
                        };
                        let half = (0..=k).zip(weights).fold(R::ZERO, |sum, (j, &w)| {
                            sum + w * (positive[k - j] - negative[k - j])
                        });
                        (positive[k] + negative[k] + half) * 0.5
                    }
                }
            }
            _ => return own[k],
        };
        own[k]
    }

    /// Stores order `k` once more where inner products read it.
    #[inline(always)]
    fn mirror(&mut self, schedule: &Schedule, k: usize) {
        let (stride, registers) = (self.stride, self.values.len());
        let (forward, reversed) = (&mut self.forward[..], &mut self.reversed[..]);
        for (slot, &r) in schedule.reversed.iter().enumerate() {
            reversed[slot * stride + stride - 1 - k] = forward[r as usize * stride + k];
        }
        for (slot, &r) in schedule.slopes.iter().enumerate() {
            let slope = forward[r as usize * stride + k] * k as f64;
            forward[(registers + slot) * stride + k] = slope;
        }
    }

    fn factor(&mut self, program: &Program, at: usize) -> Result<(), Singular> {
        let block = &program.blocks[at];
        let n = block.size();
        let entry = |i, j| self.values[block.matrix[i * n + j] as usize];
        if self.blocks[at].factor(entry) { Ok(()) } else { Err(Singular { block: at as u32 }) }
    }
}

/// The coefficient of order `k` that follows from a relation, from all registers at order 0, those
/// at order k that are known, and the inner products.
#[inline(always)]
fn related<R: Real, const FUSED: bool>(
    schedule: &Schedule,
    relation: &Relation,
    (values, now, products): (&[R], &[R], &[R]),
    k: usize,
) -> R {
    let at = |r: Register| r as usize;
    let times = |factor: Factor, x: R| match factor {
        Factor::Plus => x,
        Factor::Minus => -x,
        Factor::Times(factor) => x.times::<FUSED>(R::of(factor)),
    };
    let mut sum = match relation.direct {
        Direct::None => R::ZERO,
        Direct::Coefficient(a) => now[at(a)],
        Direct::Slope(factor, a) => times(factor, now[at(a)] * k as f64),
    };
    let range = relation.first as usize..(relation.first + relation.count) as usize;
    for summand in &schedule.summands[range] {
        let product = summand.product.map_or(R::ZERO, |i| products[i as usize]);
        let whole = match summand.ends {
            Ends::None => product,
            Ends::Last(a, b) => product + now[at(a)].times::<FUSED>(values[at(b)]),
            Ends::LastSlope(a, b) => product + now[at(a)].times::<FUSED>(values[at(b)]) * k as f64,
            Ends::Both(a, b) => {
                product
                    + (values[at(a)].times::<FUSED>(now[at(b)])
                        + now[at(a)].times::<FUSED>(values[at(b)]))
            }
        };
        sum = sum + times(summand.factor, whole);
    }
    match relation.denominator {
        Denominator::One => sum,
        Denominator::Order => sum.over(k),
        Denominator::Value(a) => sum / values[at(a)],
        Denominator::OrderTimes(a) => (sum / values[at(a)]).over(k),
        Denominator::Twice(a) => sum / (values[at(a)] * 2.0),
    }
}
