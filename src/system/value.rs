//! The first evaluator of a program: numbers.
//!
//! If an intermediate result leaves the range of its numbers, as `exp(x)` does in `1/(1 + exp(x))`
//! for large x or `x^20` in `1e298*x^20` for small ones, the program is evaluated once more in
//! [`ExtendedRange`].

use std::ops::Range;
use std::sync::Arc;

use super::kink_sides::KinkSides;
use super::machine_code::CompiledValues;
use super::operation::value_of;
use super::parts::PartwiseEvaluation;
use super::program::{Block, Guard, Op, Program, Register, Singular};
use super::solve::Factored;
use super::{overflow, underflow};
use crate::num::{Analytic, DoubleDouble, ExtendedRange, Kernel, Real, vectorized};

/// Factors beyond 2⁹⁹⁰ overflow where a product of two parts splits them, though their product may not.
const LARGEST_FACTOR: f64 = 1e298;

/// The registers of one program as numbers, in one precision.
#[derive(Clone, Debug)]
pub struct Evaluator<R> {
    program: Arc<Program>,
    registers: Vec<R>,
    blocks: Vec<Factored<R>>,
    right: Vec<R>,
    /// The machine code of its body, if there is any.
    code: CompiledValues,
    parameters: Vec<DoubleDouble>,
    underflow_may_count: bool,
    /// The same in a wider range, once it was needed.
    wide: Option<Box<Evaluator<ExtendedRange>>>,
}

impl<R: Real> Evaluator<R> {
    /// Allocates registers for a program. The parameters must be set before it is evaluated.
    pub fn new(program: Arc<Program>) -> Evaluator<R> {
        let blocks: Vec<_> = program.blocks.iter().map(|b| Factored::new(b.size())).collect();
        let widest = program.blocks.iter().map(super::program::Block::size).max().unwrap_or(0);
        let registers = vec![R::ZERO; program.ops.len()];
        let right = vec![R::ZERO; widest];
        let parameters = Vec::new();
        let underflow_may_count = underflow::may_count(&program, &parameters, |_| 0.0);
        Evaluator {
            program,
            registers,
            blocks,
            right,
            code: CompiledValues::default(),
            parameters,
            underflow_may_count,
            wide: None,
        }
    }

    /// The number of operations of an evaluation.
    pub fn operations(&self) -> usize {
        self.program.live_len()
    }

    /// Sets the parameters and evaluates everything that depends on them alone.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        self.wide = None;
        for &r in &self.program.prologue {
            match self.program.ops[r as usize] {
                Op::Parameter(i) => self.registers[r as usize] = R::of(parameters[i as usize]),
                op => run::<_, false>(&self.program, &mut self.registers, r, op),
            }
        }
        let value = |r: Register| self.registers[r as usize].value();
        self.underflow_may_count = underflow::may_count(&self.program, parameters, value);
    }

    /// Evaluates at a time and at the inputs, one number for each.
    ///
    /// # Errors
    /// Returns the block of equations whose matrix is singular.
    pub fn evaluate(&mut self, time: R, inputs: &[R]) -> Result<(), Singular> {
        let outcome = self.evaluate_here(time, inputs);
        if R::UNBOUNDED {
            return outcome;
        }
        let again = if outcome.is_ok() && self.is_finite() {
            self.underflow_may_count
                && underflow::occurred(&self.program, |r| self.registers[r as usize].value())
        } else {
            self.left_the_range()
        };
        if again { self.evaluate_extended(time, inputs) } else { outcome }
    }

    /// Whether all outputs are finite, and none hides that something else is not.
    fn is_finite(&self) -> bool {
        let mut outputs = self.program.outputs.iter();
        let value = |r: Register| self.registers[r as usize].value();
        outputs.all(|&r| self.registers[r as usize].is_finite())
            && !overflow::occurred(&self.program, &self.program.hiding, value)
    }

    /// Whether the first number that is not finite results from overflow, or from a division by
    /// zero that may be an underflow, rather than from an argument outside a function's domain. The
    /// overflow of a product may leave NaN in a number of two parts.
    fn left_the_range(&self) -> bool {
        let value = |r: &Register| self.registers[*r as usize].value();
        let is_finite = |r: &Register| self.registers[*r as usize].is_finite();
        let first = self.program.body.iter().find(|r| !is_finite(r));
        first.is_some_and(|r| match self.program.ops[*r as usize] {
            Op::Divide(..)
            | Op::Solve(_)
            | Op::Scale(..)
            | Op::Multiply(..)
            | Op::Square(_)
            | Op::Linear { .. }
            | Op::Power(..)
            | Op::ParametricPower(..) => true,
            Op::Call(_, [a, b]) if value(&a).abs().max(value(&b).abs()) > LARGEST_FACTOR => true,
            _ => value(r).is_infinite() && !self.program.inputs.contains(r),
        })
    }

    fn evaluate_extended(&mut self, time: R, inputs: &[R]) -> Result<(), Singular> {
        let wide = self.wide.get_or_insert_with(|| {
            let mut wide = Box::new(Evaluator::new(Arc::clone(&self.program)));
            wide.set_parameters(&self.parameters);
            wide
        });
        let inputs: Vec<ExtendedRange> =
            inputs.iter().map(|x| ExtendedRange::of(x.double())).collect();
        wide.evaluate(ExtendedRange::of(time.double()), &inputs)?;
        for (x, wide) in self.registers.iter_mut().zip(&wide.registers) {
            *x = R::of(wide.double());
        }
        Ok(())
    }

    fn evaluate_here(&mut self, time: R, inputs: &[R]) -> Result<(), Singular> {
        let Evaluator { program, registers, blocks, right, code, .. } = self;
        for (&r, &x) in program.inputs.iter().zip(inputs) {
            registers[r as usize] = x;
        }
        let mut memory = Memory { registers, blocks, right };
        code.evaluate(
            program,
            &mut memory,
            |memory| R::floats(memory.registers),
            |memory, range| memory.interpret(program, time, range),
        )
    }

    /// The value of an output.
    pub fn output(&self, i: usize) -> R {
        self.registers[self.program.outputs[i] as usize]
    }

    /// The values of all outputs.
    pub fn outputs(&self) -> impl Iterator<Item = R> + '_ {
        self.program.outputs.iter().map(|&r| self.registers[r as usize])
    }

    /// The number of switches.
    pub fn switches(&self) -> usize {
        self.program.switches()
    }

    /// The value of a switch.
    pub fn switch(&self, i: usize) -> R {
        self.registers[self.program.switches[i] as usize]
    }

    pub(super) fn register(&self, register: Register) -> R {
        self.registers[register as usize]
    }

    pub(super) fn program(&self) -> &Program {
        &self.program
    }

    /// Whether no underflow may count, and no overflow is hidden, so that numbers that are finite are right.
    pub(super) fn is_ordinary(&self) -> bool {
        !self.underflow_may_count && self.program.hiding.is_empty()
    }

    /// Where the last evaluation lies relative to the kinks.
    pub(super) fn sides(&self) -> KinkSides {
        let value = |r: Register| self.registers[r as usize].value();
        let guards = self.program.guards.iter();
        let is_smooth = |guard: &&Guard| guard.exponent.is_some() && guard.under(value).is_none();
        let guards = guards.filter(|guard| !is_smooth(guard));
        let roots = guards.map(|guard| value(guard.under.unwrap_or(guard.value)));
        KinkSides::new(self.program.switches.iter().map(|&r| value(r)), roots)
    }
}

/// What an evaluator works with.
struct Memory<'a, R> {
    registers: &'a mut [R],
    blocks: &'a mut [Factored<R>],
    right: &'a mut [R],
}

impl<R: Real> Memory<'_, R> {
    /// Evaluates a range of the body of a program.
    fn interpret(
        &mut self,
        program: &Program,
        time: R,
        range: Range<usize>,
    ) -> Result<(), Singular> {
        vectorized(InterpretedRange { memory: self, program, time, range })
    }

    #[inline(always)]
    fn interpret_with<const FUSED: bool>(
        &mut self,
        program: &Program,
        time: R,
        range: Range<usize>,
    ) -> Result<(), Singular> {
        let Memory { registers, blocks, right } = self;
        for &r in &program.body[range] {
            match program.ops[r as usize] {
                Op::Time => registers[r as usize] = time,
                Op::Solve(at) => {
                    let block = &program.blocks[at as usize];
                    if !solve::<_, FUSED>(block, &mut blocks[at as usize], registers, right, r) {
                        return Err(Singular { block: at });
                    }
                }
                op => run::<_, FUSED>(program, registers, r, op),
            }
        }
        Ok(())
    }
}

struct InterpretedRange<'a, 'm, R> {
    memory: &'a mut Memory<'m, R>,
    program: &'a Program,
    time: R,
    range: Range<usize>,
}

impl<R: Real> Kernel for InterpretedRange<'_, '_, R> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), Singular> {
        self.memory.interpret_with::<FUSED>(self.program, self.time, self.range)
    }
}

/// Sets the registers of a block of equations from one on to its solution. Returns false where its matrix is singular.
#[inline(always)]
fn solve<R: Real, const FUSED: bool>(
    block: &Block,
    factored: &mut Factored<R>,
    registers: &mut [R],
    right: &mut [R],
    first: Register,
) -> bool {
    let n = block.size();
    if !factored.factor_with::<FUSED>(|i, j| registers[block.matrix[i * n + j] as usize]) {
        return false;
    }
    for (x, &r) in right.iter_mut().zip(&block.right) {
        *x = registers[r as usize];
    }
    factored.solve_with::<FUSED>(&mut right[..n]);
    registers[first as usize..][..n].copy_from_slice(&right[..n]);
    true
}

/// Sets the register of an operation and that of its companion.
#[inline(always)]
fn run<R: Real, const FUSED: bool>(
    program: &Program,
    registers: &mut [R],
    register: Register,
    op: Op,
) {
    let at = register as usize;
    if let Some((value, companion)) = value_of::<_, FUSED>(program, op, |r| registers[r as usize]) {
        registers[at] = value;
        if let Some(companion) = companion {
            registers[at + 1] = companion;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, FunctionId, Pool};
    use crate::num::Number;

    /// Everything that is compiled, with what is not in the middle: a function, a choice, a live exponent.
    fn program() -> Arc<Program> {
        let mut pool = Pool::new();
        let [x, y, t, n] = ["x", "y", "t", "n"].map(|name| pool.symbol(name));
        let [a, b, time, exponent] = [x, y, t, n].map(|symbol| pool.variable(symbol));
        let mut outputs = Vec::new();
        for (numerator, denominator) in [
            (2, 1),
            (3, 1),
            (7, 1),
            (-1, 1),
            (-5, 1),
            (1, 2),
            (3, 2),
            (5, 2),
            (-1, 2),
            (-7, 2),
            (1, 3),
        ] {
            let exponent = pool.number(Number::ratio(numerator, denominator));
            let base = pool.add(a, exponent);
            let base = pool.mul(base, base);
            outputs.push(pool.pow(base, exponent));
        }
        let sine = pool.call(FunctionId::Sin, &[b]);
        let (product, fading) = (pool.mul(a, b), pool.mul(b, time));
        let sum = pool.linear(
            Number::ratio(1, 3),
            &[(Number::ONE, product), (-Number::ONE, fading), (Number::ratio(2, 7), sine)],
        );
        let quotient = pool.div(sum, b);
        let size = pool.call(FunctionId::Abs, &[quotient]);
        let live = pool.pow(size, exponent);
        let rest = pool.mul(live, sum);
        outputs.extend([sum, quotient, size, rest]);
        let all = outputs.iter().map(|&e| (Number::ONE, e)).collect::<Vec<(Number, Expr)>>();
        outputs.push(pool.linear(Number::ZERO, &all));
        Program::compile(&mut pool, &[n], t, &[x, y], &outputs).expect("all are inputs")
    }

    #[test]
    fn values_have_the_bits_of_the_interpreter() {
        let program = program();
        let exponent = [DoubleDouble::from(1.25)];
        let evaluator = || {
            let mut evaluator: Evaluator<f64> = Evaluator::new(Arc::clone(&program));
            evaluator.set_parameters(&exponent);
            evaluator
        };
        let bits = |evaluator: &Evaluator<f64>| -> Vec<u64> {
            (0..program.ops.len() as u32).map(|r| evaluator.register(r).to_bits()).collect()
        };
        let points = [[0.7, 0.3], [-2.5, 1e-3], [1e5, -4.0], [0.5, f64::INFINITY], [0.25, 0.0]];
        let at = |evaluator: &mut Evaluator<f64>, [x, y]: [f64; 2]| {
            evaluator.evaluate(0.9, &[x, y]).expect("no matrix is singular");
            bits(evaluator)
        };
        let interpreted: Vec<_> = points.iter().map(|&point| at(&mut evaluator(), point)).collect();
        let mut compiled = evaluator();
        for _ in 0..200 {
            at(&mut compiled, points[0]);
        }
        let functions = format!("{compiled:?}").matches("Compiled {").count();
        assert!(functions >= 2 || cfg!(not(target_arch = "x86_64")), "{functions}");
        for (&point, interpreted) in points.iter().zip(&interpreted) {
            assert_eq!(at(&mut compiled, point), *interpreted, "{point:?}");
        }
    }
}
