//! The code of all orders of a series: what [`Schedule`](crate::system::schedule::Schedule) says for one order, written out for
//! each of them.
//!
//! In: a program and its schedule, the orders. Out: a function in Cranelift's intermediate form, and where its numbers
//! lie. Never here: machine code, numbers.
//!
//! Every sum has the order of [`Tables`](crate::system::jet), so the bits are the same. What is left out changes none: a term
//! that is zero, a factor 1, a first zero where what is added to it is never −0.

use cranelift_codegen::ir::{Function, InstBuilder, MemFlags, Value, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};

use super::function::{self, CompiledFunction, NotCompiled};
use super::layout::{Address, Area, Layout};
use crate::system::finishing_pass::{LinearSum, OperationRun, TermSign};
use crate::system::jet::JetPlan;
use crate::system::program::{Op, Register};
use crate::system::schedule::{ConvolutionFactor, Denominator, Direct, Ends, Relation};

/// No more instructions are generated than about this many: more would be slower to read than the loops of a jet.
const LARGEST: usize = 60_000;

/// Which orders of how many numbers are computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Extent {
    /// The orders from this one on, of which the numbers of the state are known.
    pub(super) first: usize,
    /// The numbers of the state, and those of them that the rates depend on.
    pub(super) numbers: usize,
    pub(super) inputs: usize,
}

pub(super) struct Emitter<'a> {
    pub(super) plan: &'a JetPlan<'a>,
    extent: Extent,
    pub(super) layout: Layout,
    pub(super) builder: FunctionBuilder<'a>,
    pointers: [Value; 4],
    scale: Value,
    /// The order that is written, and the registers at it.
    pub(super) k: usize,
    now: Vec<Option<Value>>,
    /// The inner products of the order that were needed already.
    products: Vec<Option<Value>>,
    /// The place among the slopes of each register.
    slopes: Vec<Option<usize>>,
}

/// Compiles the orders of a series.
pub(super) fn compile(plan: &JetPlan<'_>, extent: Extent) -> Result<CompiledFunction, NotCompiled> {
    let program = plan.program;
    let alone = |op: &Op| matches!(op, Op::Select { .. } | Op::ParametricPower(..));
    if program.ops.iter().any(alone) || program.switches() > 0 || size(plan) > LARGEST {
        return Err(NotCompiled);
    }
    let module = function::module()?;
    let mut function = Function::new();
    function.signature = function::signature(&module);
    let mut context = FunctionBuilderContext::new();
    let builder = FunctionBuilder::new(&mut function, &mut context);
    let layout = Emitter::new(plan, extent, builder)?.write()?;
    CompiledFunction::of(module, function, layout)
}

/// About how many instructions there will be.
fn size(plan: &JetPlan<'_>) -> usize {
    let (pairs, operations) = (plan.schedule.pairs.len(), plan.program.body.len());
    (1..plan.stride).map(|k| pairs * (3 * k / 2 + 8) + operations * 6).sum()
}

impl<'a> Emitter<'a> {
    fn new(
        plan: &'a JetPlan<'a>,
        extent: Extent,
        mut builder: FunctionBuilder<'a>,
    ) -> Result<Emitter<'a>, NotCompiled> {
        let registers = plan.program.ops.len();
        let mut slopes = vec![None; registers];
        for (i, &register) in plan.schedule.slopes.iter().enumerate() {
            slopes[register as usize] = Some(i);
        }
        let block = builder.create_block();
        builder.append_block_params_for_function_params(block);
        builder.switch_to_block(block);
        builder.seal_block(block);
        let &[values, work, series, state, scale] = builder.block_params(block) else {
            return Err(NotCompiled);
        };
        Ok(Emitter {
            plan,
            extent,
            layout: Layout::of(plan, extent.numbers),
            builder,
            pointers: [values, work, series, state],
            scale,
            k: 0,
            now: vec![None; registers],
            products: vec![None; plan.schedule.pairs.len()],
            slopes,
        })
    }

    fn write(mut self) -> Result<Layout, NotCompiled> {
        let program = self.plan.program;
        if self.extent.first == 0 {
            self.give_out()?;
        } else {
            self.k = self.extent.first;
            for (i, &input) in program.inputs.iter().take(self.extent.inputs).enumerate() {
                let offset = i * self.layout.stride + self.k;
                let coefficient = self.load(Address { area: Area::State, offset });
                self.set(input, self.k, coefficient);
            }
        }
        for k in self.extent.first.max(1)..self.layout.stride - 1 {
            self.k = k;
            self.products.fill(None);
            self.finish()?;
            self.give_out()?;
        }
        self.builder.ins().return_(&[]);
        self.builder.finalize();
        Ok(self.layout)
    }

    /// The operations of one order.
    fn finish(&mut self) -> Result<(), NotCompiled> {
        let (plan, k) = (self.plan, self.k);
        for run in &plan.schedule.runs {
            match run {
                OperationRun::Time(register) => {
                    let rate = if k == 1 { self.scale } else { self.zero() };
                    self.set(*register, k, rate);
                }
                OperationRun::Scales(run) => {
                    for step in run {
                        let varying = self.now(step.varying)?;
                        let scaled = self.times_value(varying, step.fixed);
                        self.set(step.register, k, scaled);
                    }
                }
                OperationRun::Products(run) => {
                    for step in run {
                        let ends = self.both_ends(step.left, step.right)?;
                        let inner = self.product(step.inner)?;
                        let coefficient = self.builder.ins().fadd(inner, ends);
                        self.set(step.register, k, coefficient);
                    }
                }
                OperationRun::Related(run) => {
                    for step in run {
                        let relation = &plan.schedule.relations[step.relation as usize];
                        let coefficient = self.related(relation)?;
                        self.set(step.register, k, coefficient);
                    }
                }
                OperationRun::Integrals(run) => {
                    for step in run {
                        let slope = self.now(step.slope)?;
                        let last = self.times_value(slope, step.factor);
                        let last = self.multiple(last, k);
                        let inner = self.product(step.inner)?;
                        let mut sum = self.builder.ins().fadd(inner, last);
                        if step.sign == TermSign::Minus {
                            let zero = self.zero();
                            sum = self.builder.ins().fsub(zero, sum);
                        }
                        let coefficient = self.over(sum, k);
                        self.set(step.register, k, coefficient);
                    }
                }
                OperationRun::Sums(run) => {
                    for sum in run {
                        let coefficient = self.sum(sum)?;
                        self.set(sum.register, k, coefficient);
                    }
                }
                OperationRun::Solution(solution) => self.solution(*solution)?,
                OperationRun::Alone(_) => return Err(NotCompiled),
            }
        }
        Ok(())
    }

    /// The next coefficient of every number of the state.
    fn give_out(&mut self) -> Result<(), NotCompiled> {
        let (program, next) = (self.plan.program, self.k + 1);
        let Extent { numbers, inputs, .. } = self.extent;
        let mut coefficients = Vec::with_capacity(numbers);
        for (i, &output) in program.outputs.iter().take(numbers).enumerate() {
            let rate = if self.k == 0 { self.value(output) } else { self.now(output)? };
            let made = self.builder.ins().fmul(rate, self.scale);
            let made = self.over(made, next);
            let offset = i * self.layout.stride + next;
            self.store(made, Address { area: Area::State, offset });
            coefficients.push(made);
        }
        self.now.fill(None);
        for (&input, &coefficient) in program.inputs.iter().take(inputs).zip(&coefficients) {
            self.set(input, next, coefficient);
        }
        Ok(())
    }

    /// The coefficient that follows from a relation.
    fn related(&mut self, relation: &Relation) -> Result<Value, NotCompiled> {
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
                Some(inner) => self.product(inner)?,
                None => self.zero(),
            };
            let ends = match summand.ends {
                Ends::None => None,
                Ends::Last(a, b) => {
                    let last = self.now(a)?;
                    Some(self.times_value(last, b))
                }
                Ends::LastSlope(a, b) => {
                    let last = self.now(a)?;
                    let last = self.times_value(last, b);
                    Some(self.multiple(last, k))
                }
                Ends::Both(a, b) => Some(self.both_ends(a, b)?),
            };
            let whole = ends.map_or(product, |ends| self.builder.ins().fadd(product, ends));
            sum = Some(match (summand.factor, sum) {
                // neither an inner product nor what it is added to is −0
                (ConvolutionFactor::Plus, None) => whole,
                (ConvolutionFactor::Minus, _) => {
                    let sum = sum.unwrap_or_else(|| self.zero());
                    self.builder.ins().fsub(sum, whole)
                }
                (factor, _) => {
                    let sum = sum.unwrap_or_else(|| self.zero());
                    let whole = self.times_factor(whole, factor);
                    self.builder.ins().fadd(sum, whole)
                }
            });
        }
        let sum = sum.unwrap_or_else(|| self.zero());
        Ok(match relation.denominator {
            Denominator::One => sum,
            Denominator::Order => self.over(sum, k),
            Denominator::Value(a) => {
                let a = self.value(a);
                self.builder.ins().fdiv(sum, a)
            }
            Denominator::OrderTimes(a) => {
                let a = self.value(a);
                let quotient = self.builder.ins().fdiv(sum, a);
                self.over(quotient, k)
            }
            Denominator::Twice(a) => {
                let a = self.value(a);
                let twice = self.builder.ins().fadd(a, a);
                self.builder.ins().fdiv(sum, twice)
            }
        })
    }

    /// A sum of multiples.
    fn sum(&mut self, sum: &LinearSum) -> Result<Value, NotCompiled> {
        let program = self.plan.program;
        let terms = &program.terms[sum.first as usize..][..sum.count as usize];
        let mut total = self.zero();
        for term in terms {
            let factor = term.coefficient.high;
            if program.fixed[term.register as usize] {
                // zero above order 0
                if factor.is_finite() {
                    continue;
                }
                return Err(NotCompiled);
            }
            let number = self.now(term.register)?;
            total = if factor == 1.0 {
                self.builder.ins().fadd(total, number)
            } else if factor == -1.0 {
                self.builder.ins().fsub(total, number)
            } else {
                let address = self.layout.constant(factor);
                let factor = self.load(address);
                let multiple = self.builder.ins().fmul(number, factor);
                self.builder.ins().fadd(total, multiple)
            };
        }
        Ok(total)
    }

    /// An inner product of this order.
    pub(super) fn product(&mut self, inner: u32) -> Result<Value, NotCompiled> {
        if let Some(known) = self.products[inner as usize] {
            return Ok(known);
        }
        let pair = self.plan.schedule.pairs[inner as usize];
        let left = self.layout.left[pair.left as usize].ok_or(NotCompiled)?;
        let right = self.layout.right[pair.right as usize].ok_or(NotCompiled)?;
        let product = self.inner_product(left, right, self.k);
        self.products[inner as usize] = Some(product);
        Ok(product)
    }

    /// `a_0 b_k + a_k b_0`.
    fn both_ends(&mut self, a: Register, b: Register) -> Result<Value, NotCompiled> {
        let (a_now, b_now) = (self.now(a)?, self.now(b)?);
        let first = self.times_value(b_now, a);
        if a == b {
            return Ok(self.builder.ins().fadd(first, first));
        }
        let last = self.times_value(a_now, b);
        Ok(self.builder.ins().fadd(first, last))
    }

    fn times_factor(&mut self, number: Value, factor: ConvolutionFactor) -> Value {
        match factor {
            ConvolutionFactor::Plus => number,
            ConvolutionFactor::Minus => self.builder.ins().fneg(number),
            ConvolutionFactor::Times(factor) => {
                let address = self.layout.constant(factor.high);
                let factor = self.load(address);
                self.builder.ins().fmul(number, factor)
            }
        }
    }

    pub(super) fn times_value(&mut self, number: Value, register: Register) -> Value {
        let value = self.value(register);
        self.builder.ins().fmul(number, value)
    }

    fn multiple(&mut self, number: Value, k: usize) -> Value {
        if k == 1 {
            return number;
        }
        let order = self.load(Layout::order(k));
        self.builder.ins().fmul(number, order)
    }

    fn over(&mut self, number: Value, k: usize) -> Value {
        if k == 1 {
            return number;
        }
        let order = self.load(Layout::order(k));
        self.builder.ins().fdiv(number, order)
    }

    /// A register at this order.
    pub(super) fn now(&mut self, register: Register) -> Result<Value, NotCompiled> {
        if self.plan.program.fixed[register as usize] {
            return Ok(self.zero());
        }
        self.now[register as usize].ok_or(NotCompiled)
    }

    /// Gives a register its coefficient of an order, also where it is read later.
    pub(super) fn set(&mut self, register: Register, k: usize, coefficient: Value) {
        self.now[register as usize] = Some(coefficient);
        if k + 1 >= self.layout.stride {
            return;
        }
        let copies: Vec<Address> = self.layout.copies(register, k).collect();
        for address in copies {
            self.store(coefficient, address);
        }
        if let Some(i) = self.slopes[register as usize]
            && let Some(left) = self.layout.left[self.plan.program.ops.len() + i]
        {
            let slope = self.multiple(coefficient, k);
            self.store(slope, left.plus(k));
        }
    }

    pub(super) fn zero(&mut self) -> Value {
        self.builder.ins().f64const(0.0)
    }

    /// A register at order 0.
    fn value(&mut self, register: Register) -> Value {
        self.load(Address { area: Area::Values, offset: register as usize })
    }

    pub(super) fn pointer(&self, area: Area) -> Value {
        self.pointers[area as usize]
    }

    pub(super) fn load(&mut self, address: Address) -> Value {
        let (pointer, offset) = (self.pointer(address.area), 8 * address.offset as i32);
        self.builder.ins().load(types::F64, MemFlags::trusted(), pointer, offset)
    }

    /// Two numbers side by side, which need not begin at an even place.
    pub(super) fn load_pair(&mut self, address: Address) -> Value {
        let (pointer, offset) = (self.pointer(address.area), 8 * address.offset as i32);
        let flags = MemFlags::new().with_notrap();
        self.builder.ins().load(types::F64X2, flags, pointer, offset)
    }

    pub(super) fn store(&mut self, number: Value, address: Address) {
        let (pointer, offset) = (self.pointer(address.area), 8 * address.offset as i32);
        self.builder.ins().store(MemFlags::trusted(), number, pointer, offset);
    }
}
