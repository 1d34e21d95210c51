//! The code of all orders of a series: what [`Schedule`](crate::system::schedule::Schedule) says for one order, written out for
//! each of them.
//!
//! In: a program and its schedule, the orders in one precision. Out: instructions. Never here: arithmetic, bytes, numbers.
//!
//! Every sum has the order of [`Orders`](crate::system::jet), so the bits are the same. What is left out changes none: a term
//! that is zero, a factor 1, the low part of a power of two.

use super::arithmetic::{Arithmetic, Code, SIDE};
use super::basic_block::Operand;
use super::function::NotCompiled;
use super::layout::SeriesPlaces;
use super::plain::Plain;
use crate::num::DoubleDouble;
use crate::system::finishing_pass::{LinearSum, OperationRun, TermSign};
use crate::system::jet::JetPlan;
use crate::system::program::Register;
use crate::system::schedule::{ConvolutionFactor, Denominator, Direct, Ends, Pair, Relation};

/// The orders of a series in one precision.
pub(super) struct Emitter<'a, A: Arithmetic> {
    pub(super) plan: &'a JetPlan<'a>,
    pub(super) code: &'a mut Code,
    pub(super) places: &'a SeriesPlaces,
    /// Where the orders are written as `f64` as well.
    copies: Option<&'a SeriesPlaces>,
    /// The numbers of the state, and those of them that the rates depend on.
    numbers: usize,
    inputs: usize,
    /// The order that is written, and the registers at it.
    pub(super) k: usize,
    now: Vec<Option<A::Number>>,
    /// The inner products at it, where they are not stored.
    cached: Vec<CachedProducts<A::Number>>,
    divisors: Vec<(SharedDivisor, A::Number)>,
    /// The matrices whose entries right of the pivots were divided by these.
    pub(super) scaled: Vec<bool>,
}

/// Up to so many groups of inner products are kept in registers until they are read: a number that was just stored is read later
/// than one in a register.
const CACHED: usize = 3;

/// A group of inner products side by side, and those that were taken from it.
#[derive(Clone, Copy)]
struct CachedProducts<T> {
    products: T,
    lanes: [Option<T>; SIDE],
}

/// What several numbers are divided by.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum SharedDivisor {
    /// The value of a register, or twice that.
    Value(Register),
    Twice(Register),
    Pivot(u32, u32),
}

impl<'a, A: Arithmetic> Emitter<'a, A> {
    /// For the numbers of a state and those that the rates depend on. The orders are written into `copies` as `f64` as
    /// well.
    pub(super) fn new(
        plan: &'a JetPlan<'a>,
        code: &'a mut Code,
        (places, copies): (&'a SeriesPlaces, Option<&'a SeriesPlaces>),
        (numbers, inputs): (usize, usize),
    ) -> Emitter<'a, A> {
        Emitter {
            now: vec![None; plan.program.ops.len()],
            scaled: vec![false; plan.program.blocks.len()],
            plan,
            code,
            places,
            copies,
            numbers,
            inputs,
            k: 0,
            cached: Vec::new(),
            divisors: Vec::new(),
        }
    }

    /// Writes the orders above `first` of the state, up to `last`.
    pub(super) fn write(&mut self, first: usize, last: usize) -> Result<(), NotCompiled> {
        let program = self.plan.program;
        if first == 0 {
            self.give_out()?;
        } else {
            for (i, &input) in program.inputs.iter().take(self.inputs).enumerate() {
                let coefficient = A::in_register(self.code, A::at(self.places.of_state(i, first)));
                self.now[input as usize] = Some(coefficient);
            }
        }
        for k in first.max(1)..last {
            self.k = k;
            self.multiply();
            self.finish()?;
            self.hand_on(k + 1 < last)?;
            self.keep()?;
            self.give_out()?;
        }
        Ok(())
    }

    /// The inner products of one order.
    fn multiply(&mut self) {
        let places = self.places;
        let groups = self.plan.schedule.pairs.len().div_ceil(A::SIDE);
        self.cached.clear();
        for group in 0..groups {
            // b_{k−1} is met by a_1
            let operands = (places.left(group, 1), places.right(group, self.k - 1));
            let products = A::inner_products(self.code, operands, self.k - 1);
            if groups <= CACHED {
                self.cached.push(CachedProducts { products, lanes: [None; SIDE] });
            } else {
                A::store_inner_products(self.code, products, places.products(group));
            }
        }
    }

    /// The operations of one order.
    fn finish(&mut self) -> Result<(), NotCompiled> {
        let (plan, k) = (self.plan, self.k);
        for run in &plan.schedule.runs {
            match run {
                OperationRun::Time(register) => {
                    let scale = Operand::At(self.code.layout.scale);
                    let one = A::constant(self.code, DoubleDouble::ONE);
                    let rate = if k == 1 { A::scaled(self.code, one, scale) } else { self.zero() };
                    self.set(*register, rate);
                }
                OperationRun::Scales(run) => {
                    for step in run {
                        let varying = self.now(step.varying)?;
                        let scaled = A::product(self.code, self.value(step.fixed), varying);
                        self.set(step.register, scaled);
                    }
                }
                OperationRun::Products(run) => {
                    for step in run {
                        let ends = self.both_ends(step.left, step.right)?;
                        let inner = self.product(step.inner);
                        let coefficient = A::sum(self.code, inner, ends);
                        let coefficient = A::renormalized(self.code, coefficient);
                        self.set(step.register, coefficient);
                    }
                }
                OperationRun::Related(run) => {
                    for step in run {
                        let relation = &plan.schedule.relations[step.relation as usize];
                        let coefficient = self.related(relation)?;
                        self.set(step.register, coefficient);
                    }
                }
                OperationRun::Integrals(run) => {
                    for step in run {
                        let last = self.last(step.slope, step.factor)?;
                        let last = self.multiple(last, k);
                        let inner = self.product(step.inner);
                        let sum = A::sum(self.code, inner, last);
                        let negative = step.sign == TermSign::Minus;
                        let sum = if negative { A::opposite(self.code, sum) } else { sum };
                        let coefficient = A::over(self.code, sum, k);
                        let coefficient = A::renormalized(self.code, coefficient);
                        self.set(step.register, coefficient);
                    }
                }
                OperationRun::Sums(run) => {
                    for sum in run {
                        let coefficient = self.sum(sum)?;
                        self.set(sum.register, coefficient);
                    }
                }
                OperationRun::Solution(solution) => self.solution(*solution)?,
                OperationRun::Alone(_) => return Err(NotCompiled),
            }
        }
        Ok(())
    }

    /// Stores this order where inner products read it, those of this precision where some follow.
    fn hand_on(&mut self, goes_on: bool) -> Result<(), NotCompiled> {
        let k = self.k;
        let registers = self.plan.program.ops.len() as u32;
        let (mut slopes, mut nearest_slopes) = (Vec::new(), Vec::new());
        for &register in &self.plan.schedule.slopes {
            let number = self.now(register)?;
            slopes.push(self.multiple(number, k));
            if self.copies.is_some() {
                // of the nearest `f64`, as a series in that precision has it
                nearest_slopes.push(multiple::<Plain>(self.code, A::nearest(number), k));
            }
        }
        for (group, pairs) in self.plan.schedule.pairs.chunks(A::SIDE).enumerate() {
            // the last group is filled up
            let pairs: Vec<Pair> =
                (0..A::SIDE).map(|lane| pairs[lane.min(pairs.len() - 1)]).collect();
            let slope_of = |pair: &Pair| pair.left.checked_sub(registers).map(|i| i as usize);
            let (mut left, mut right) = (Vec::new(), Vec::new());
            for pair in &pairs {
                right.push(self.now(pair.right)?);
                left.push(match slope_of(pair) {
                    Some(slope) => slopes[slope],
                    None => self.now(pair.left)?,
                });
            }
            if goes_on {
                A::side_by_side(self.code, &left, self.places.left(group, k));
                A::side_by_side(self.code, &right, self.places.right(group, k));
            }
            if let Some(copies) = self.copies {
                let right: Vec<_> = right.into_iter().map(A::nearest).collect();
                let nearest =
                    left.into_iter().zip(&pairs).map(|(left, pair)| match slope_of(pair) {
                        Some(slope) => nearest_slopes[slope],
                        None => A::nearest(left),
                    });
                let nearest: Vec<_> = nearest.collect();
                Plain::side_by_side(self.code, &nearest, copies.left(group, k));
                Plain::side_by_side(self.code, &right, copies.right(group, k));
            }
        }
        Ok(())
    }

    /// Stores this order where whole series are read.
    fn keep(&mut self) -> Result<(), NotCompiled> {
        for &(register, place) in self.plan.copies {
            let coefficient = self.now(register)?;
            let place = place as usize;
            A::store(self.code, coefficient, self.places.of_series(place, self.k));
            if let Some(copies) = self.copies {
                let nearest = A::nearest(coefficient);
                Plain::store(self.code, nearest, copies.of_series(place, self.k));
            }
        }
        Ok(())
    }

    /// The next coefficient of every number of the state.
    fn give_out(&mut self) -> Result<(), NotCompiled> {
        let (program, next) = (self.plan.program, self.k + 1);
        let mut coefficients = Vec::with_capacity(self.numbers);
        for (i, &output) in program.outputs.iter().take(self.numbers).enumerate() {
            let rate = if self.k == 0 { self.value(output) } else { self.now(output)? };
            let made = A::integrated(self.code, rate, next);
            let made = A::in_register(self.code, made);
            A::store(self.code, made, self.places.of_state(i, next));
            if let Some(copies) = self.copies {
                Plain::store(self.code, A::nearest(made), copies.of_state(i, next));
            }
            coefficients.push(made);
        }
        self.now.fill(None);
        for (&input, &coefficient) in program.inputs.iter().take(self.inputs).zip(&coefficients) {
            self.set(input, coefficient);
        }
        Ok(())
    }

    /// The coefficient that follows from a relation.
    fn related(&mut self, relation: &Relation) -> Result<A::Number, NotCompiled> {
        let (plan, k) = (self.plan, self.k);
        let mut sum = match relation.direct {
            Direct::None => None,
            Direct::Coefficient(a) => Some(self.now(a)?),
            Direct::Slope(factor, a) => {
                let slope = self.now(a)?;
                let slope = self.multiple(slope, k);
                Some(self.times_factor(slope, factor))
            }
        };
        let range = relation.first as usize..(relation.first + relation.count) as usize;
        for summand in &plan.schedule.summands[range] {
            let product = match summand.product {
                Some(inner) => self.product(inner),
                None => self.zero(),
            };
            let ends = match summand.ends {
                Ends::None => None,
                Ends::Last(a, b) => Some(self.last(a, b)?),
                Ends::LastSlope(a, b) => {
                    let last = self.last(a, b)?;
                    Some(self.multiple(last, k))
                }
                Ends::Both(a, b) => Some(self.both_ends(a, b)?),
            };
            let whole = ends.map_or(product, |ends| A::sum(self.code, product, ends));
            sum = Some(match (summand.factor, sum) {
                (ConvolutionFactor::Minus, Some(sum)) => A::difference(self.code, sum, whole),
                (factor, Some(sum)) => {
                    let whole = self.times_factor(whole, factor);
                    A::sum(self.code, sum, whole)
                }
                (factor, None) => self.times_factor(whole, factor),
            });
        }
        let sum = sum.unwrap_or_else(|| self.zero());
        let coefficient = match relation.denominator {
            Denominator::One => sum,
            Denominator::Order => A::over(self.code, sum, k),
            Denominator::Value(a) => {
                let divisor = self.shared(SharedDivisor::Value(a), self.value(a));
                A::over_shared(self.code, sum, divisor)
            }
            Denominator::OrderTimes(a) => {
                let divisor = self.shared(SharedDivisor::Value(a), self.value(a));
                let quotient = A::over_shared(self.code, sum, divisor);
                A::over(self.code, quotient, k)
            }
            Denominator::Twice(a) => {
                let divisor = self.shared(SharedDivisor::Twice(a), self.value(a));
                A::over_shared(self.code, sum, divisor)
            }
        };
        Ok(A::renormalized(self.code, coefficient))
    }

    /// What is divided by, as [`Arithmetic::over_shared`] takes it; computed once, from a number that lies in memory.
    pub(super) fn shared(&mut self, divisor: SharedDivisor, number: A::Number) -> A::Number {
        if let Some(&(_, known)) = self.divisors.iter().find(|(known, _)| *known == divisor) {
            return known;
        }
        let twice = matches!(divisor, SharedDivisor::Twice(_));
        let number = if twice { self.multiple(number, 2) } else { number };
        let shared = A::shared(self.code, number);
        self.divisors.push((divisor, shared));
        shared
    }

    /// A sum of multiples.
    fn sum(&mut self, sum: &LinearSum) -> Result<A::Number, NotCompiled> {
        let program = self.plan.program;
        let terms = &program.terms[sum.first as usize..][..sum.count as usize];
        // zeros above order 0: one that is not −0, wherever it is added, makes −0 to 0 and changes nothing else
        let fixed = terms.iter().filter(|term| program.fixed[term.register as usize]);
        if fixed.clone().any(|term| !term.coefficient.is_finite()) {
            return Err(NotCompiled);
        }
        let mut total = fixed.clone().any(|term| term.coefficient.high > 0.0).then(|| self.zero());
        for term in terms.iter().filter(|term| !program.fixed[term.register as usize]) {
            let factor = term.coefficient;
            let number = self.now(term.register)?;
            total = Some(match total {
                Some(total) if factor == DoubleDouble::ONE => A::sum(self.code, total, number),
                Some(total) if factor == -DoubleDouble::ONE => {
                    A::difference(self.code, total, number)
                }
                Some(total) => {
                    let multiple = A::times(self.code, number, factor);
                    A::sum(self.code, total, multiple)
                }
                None if factor == DoubleDouble::ONE => number,
                None if factor == -DoubleDouble::ONE => A::opposite(self.code, number),
                None => A::times(self.code, number, factor),
            });
        }
        let total = total.unwrap_or_else(|| self.zero());
        Ok(A::renormalized(self.code, total))
    }

    /// An inner product of this order.
    pub(super) fn product(&mut self, inner: u32) -> A::Number {
        let (group, lane) = (inner as usize / A::SIDE, inner as usize % A::SIDE);
        let Some(CachedProducts { products, lanes }) = self.cached.get_mut(group) else {
            return A::inner_product(self.places.products(group), lane);
        };
        *lanes[lane].get_or_insert_with(|| A::lane(self.code, *products, lane))
    }

    /// `a_0 b_k + a_k b_0`.
    fn both_ends(&mut self, a: Register, b: Register) -> Result<A::Number, NotCompiled> {
        let first = self.last(b, a)?;
        if a == b {
            return Ok(A::twice(self.code, first));
        }
        let last = self.last(a, b)?;
        Ok(A::sum(self.code, first, last))
    }

    /// `a_k b_0`.
    pub(super) fn last(&mut self, a: Register, b: Register) -> Result<A::Number, NotCompiled> {
        let a = self.now(a)?;
        Ok(A::product(self.code, a, self.value(b)))
    }

    fn times_factor(&mut self, number: A::Number, factor: ConvolutionFactor) -> A::Number {
        match factor {
            ConvolutionFactor::Plus => number,
            ConvolutionFactor::Minus => A::opposite(self.code, number),
            ConvolutionFactor::Times(factor) => A::times(self.code, number, factor),
        }
    }

    fn multiple(&mut self, number: A::Number, n: usize) -> A::Number {
        multiple::<A>(self.code, number, n)
    }

    /// A register at this order.
    pub(super) fn now(&mut self, register: Register) -> Result<A::Number, NotCompiled> {
        if self.plan.program.fixed[register as usize] {
            return Ok(self.zero());
        }
        self.now[register as usize].ok_or(NotCompiled)
    }

    /// Gives a register its coefficient of this order.
    pub(super) fn set(&mut self, register: Register, coefficient: A::Number) {
        self.now[register as usize] = Some(coefficient);
    }

    pub(super) fn zero(&mut self) -> A::Number {
        A::constant(self.code, DoubleDouble::ZERO)
    }

    /// A register at order 0.
    pub(super) fn value(&self, register: Register) -> A::Number {
        A::at(self.places.value(register as usize))
    }
}

/// An integer multiple.
fn multiple<A: Arithmetic>(code: &mut Code, number: A::Number, n: usize) -> A::Number {
    if n == 1 {
        return number;
    }
    A::multiple(code, number, n)
}
