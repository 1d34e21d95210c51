//! The values of a program at one point by machine code, as far as they are arithmetic.
//!
//! In: a program, its registers in `f64` with the inputs. Out: parts of its body, in order: functions that write the registers of
//! theirs, and operations that are left to the interpreter. Never here: functions of analysis, matrices, choices, series.

use std::ops::Range;
use std::sync::Arc;

use super::allocation::assemble;
use super::arithmetic::{Arithmetic, Code};
use super::basic_block::{MachineInstruction, Operand, Operation, Width};
use super::function::{CompiledFunction, NotCompiled, Stretches, Values, WorkMemory};
use super::layout::{Address, Area};
use super::plain::Plain;
use crate::num::DoubleDouble;
use crate::system::parts::PartwiseEvaluation;
use crate::system::program::{Op, Program, Register};

/// A program is compiled when its values are wanted so often: short motions end before it pays.
const COMPILE_THRESHOLD: usize = 64;

/// Fewer operations than this in a row are left to the interpreter.
const FEWEST: usize = 3;

/// More operations than this in a row are not one function.
const MOST: usize = 4096;

/// Exponents beyond this are left to the interpreter.
const GREATEST_EXPONENT: f64 = 64.0;

/// A part of a program's body.
#[derive(Debug)]
enum Part {
    Compiled {
        function: CompiledFunction,
        work: WorkMemory,
    },
    /// Operations of the body by their places.
    Interpreted(Range<usize>),
}

/// The parts of one evaluator, with the memory that they work with.
#[derive(Clone, Debug, Default)]
pub(in crate::system) struct CompiledValues {
    parts: Option<Arc<Vec<Part>>>,
    work: Vec<WorkMemory>,
}

impl PartwiseEvaluation for CompiledValues {
    #[inline]
    fn evaluate<S, E>(
        &mut self,
        program: &Program,
        memory: &mut S,
        registers: impl Fn(&mut S) -> Option<&mut [f64]>,
        interpret: impl Fn(&mut S, Range<usize>) -> Result<(), E>,
    ) -> Result<(), E> {
        if self.parts.is_none() && registers(memory).is_some() {
            self.ask(program);
        }
        let Some(parts) = &self.parts else { return interpret(memory, 0..program.body.len()) };
        let mut work = self.work.iter_mut();
        for part in parts.iter() {
            match part {
                Part::Interpreted(range) => interpret(memory, range.clone())?,
                Part::Compiled { function, .. } => {
                    if let (Some(registers), Some(work)) = (registers(memory), work.next()) {
                        let (values, series) = (Values::Plain(&[]), &mut [][..]);
                        let (exact_series, exact_state) = (&mut [][..], &mut [][..]);
                        let state = registers;
                        let memory =
                            Stretches { values, work, series, state, exact_series, exact_state };
                        function.call(memory);
                    }
                }
            }
        }
        Ok(())
    }
}

impl CompiledValues {
    #[cold]
    fn ask(&mut self, program: &Program) {
        self.parts = program.values.get(COMPILE_THRESHOLD, || parts_of(program));
        let parts = self.parts.iter().flat_map(|parts| parts.iter());
        let works = parts.filter_map(|part| match part {
            Part::Compiled { work, .. } => Some(work.clone()),
            Part::Interpreted(_) => None,
        });
        self.work = works.collect();
    }
}

fn parts_of(program: &Program) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut interpreted = 0;
    let mut next = 0;
    while next < program.body.len() {
        let first = next;
        let compilable = |&r: &Register| is_arithmetic(program, program.ops[r as usize]);
        next += program.body[first..].iter().take(MOST).take_while(|r| compilable(r)).count();
        let compiled =
            if next - first < FEWEST { None } else { compile(program, first..next).ok() };
        if let Some(compiled) = compiled {
            if interpreted < first {
                parts.push(Part::Interpreted(interpreted..first));
            }
            parts.push(compiled);
            interpreted = next;
        } else {
            next = next.max(first + 1);
        }
    }
    if interpreted < program.body.len() {
        parts.push(Part::Interpreted(interpreted..program.body.len()));
    }
    parts
}

/// Whether an operation is arithmetic alone.
fn is_arithmetic(program: &Program, op: Op) -> bool {
    match op {
        Op::Linear { .. }
        | Op::Scale(..)
        | Op::Multiply(..)
        | Op::Square(_)
        | Op::Divide(..)
        | Op::Root(_)
        // were written before
        | Op::Input(_)
        | Op::Written => true,
        Op::Power(_, exponent) => HalfInteger::of(program.constants[exponent as usize]).is_some(),
        Op::Constant(_)
        | Op::Parameter(_)
        | Op::Time
        | Op::ParametricPower(..)
        | Op::Call(..)
        | Op::Select { .. }
        | Op::Solve(_) => false,
    }
}

/// The function of operations of a body.
fn compile(program: &Program, range: Range<usize>) -> Result<Part, NotCompiled> {
    let code = Code::new(Width::One);
    let mut writer = ValueWriter { program, code, now: vec![None; program.ops.len()] };
    for &register in &program.body[range] {
        if let Some(value) = writer.value(program.ops[register as usize])? {
            let value = Plain::in_register(&mut writer.code, value);
            Plain::store(&mut writer.code, value, place(register));
            writer.now[register as usize] = Some(value);
        }
    }
    let Code { block, layout, .. } = writer.code;
    let mut first_work = layout.first_work();
    let (bytes, work) = assemble(&block, first_work.len(), 1);
    first_work.resize(work, 0.0);
    let length = |area| match area {
        Area::State => program.ops.len(),
        Area::Work => work,
        Area::Values | Area::Series | Area::ExactSeries | Area::ExactState => 0,
    };
    let mut accesses = block.instructions.iter().flat_map(MachineInstruction::memory).flatten();
    if accesses.any(|(at, count)| at.offset + count > length(at.area)) {
        return Err(NotCompiled);
    }
    let function = CompiledFunction::of(&bytes, Width::One, length)?;
    Ok(Part::Compiled { function, work: WorkMemory::of(&first_work) })
}

fn place(register: Register) -> Address {
    Address { area: Area::State, offset: register as usize }
}

/// Operations as instructions whose results have the bits of the interpreter.
struct ValueWriter<'a> {
    program: &'a Program,
    code: Code,
    /// The registers that were written here.
    now: Vec<Option<Operand>>,
}

impl ValueWriter<'_> {
    fn get(&self, register: Register) -> Operand {
        self.now[register as usize].unwrap_or(Operand::At(place(register)))
    }

    /// The value of an operation; `None` where it is known.
    fn value(&mut self, op: Op) -> Result<Option<Operand>, NotCompiled> {
        let program = self.program;
        Ok(Some(match op {
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let constant = program.constants[constant as usize];
                let mut sum = Plain::constant(&mut self.code, constant);
                for term in terms {
                    let number = self.get(term.register);
                    let coefficient = DoubleDouble::from(term.coefficient.high);
                    sum = if coefficient == DoubleDouble::ONE {
                        Plain::sum(&mut self.code, sum, number)
                    } else if coefficient == -DoubleDouble::ONE {
                        Plain::difference(&mut self.code, sum, number)
                    } else {
                        let multiple = Plain::times(&mut self.code, number, coefficient);
                        Plain::sum(&mut self.code, sum, multiple)
                    };
                }
                sum
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => {
                let (a, b) = (self.get(a), self.get(b));
                Plain::product(&mut self.code, a, b)
            }
            Op::Square(a) => {
                let a = self.in_register(a);
                Plain::product(&mut self.code, a, a)
            }
            Op::Divide(a, b) => {
                let (a, b) = (self.get(a), self.get(b));
                Plain::over_shared(&mut self.code, a, b)
            }
            Op::Root(a) => {
                let a = self.in_register(a);
                self.root(a)
            }
            Op::Power(a, exponent) => {
                let exponent = HalfInteger::of(program.constants[exponent as usize]);
                let a = self.in_register(a);
                self.power(a, exponent.ok_or(NotCompiled)?)
            }
            Op::Input(_) | Op::Written => return Ok(None),
            _ => return Err(NotCompiled),
        }))
    }

    fn in_register(&mut self, register: Register) -> Operand {
        let number = self.get(register);
        Plain::in_register(&mut self.code, number)
    }

    fn root(&mut self, a: Operand) -> Operand {
        self.code.binary(Operation::Root, Width::One, a, a)
    }

    /// A power as [`Analytic::power`](crate::num::Analytic::power) multiplies it.
    fn power(
        &mut self,
        a: Operand,
        HalfInteger { whole, root, reciprocal }: HalfInteger,
    ) -> Operand {
        let mut power = (whole > 0).then(|| self.whole_power(a, whole));
        if root {
            let root = self.root(a);
            power = Some(match power {
                Some(power) => Plain::product(&mut self.code, root, power),
                None => root,
            });
        }
        let one = Plain::constant(&mut self.code, DoubleDouble::ONE);
        match power {
            Some(power) if reciprocal => Plain::over_shared(&mut self.code, one, power),
            Some(power) => power,
            None => one,
        }
    }

    /// A power as [`powi`](crate::num::math::powi) multiplies it.
    fn whole_power(&mut self, a: Operand, exponent: u32) -> Operand {
        let (mut power, mut square, mut left) = (None, a, exponent);
        loop {
            if left & 1 == 1 {
                power = Some(match power {
                    Some(power) => Plain::product(&mut self.code, power, square),
                    None => square,
                });
            }
            left >>= 1;
            if left == 0 {
                return power.unwrap_or(square);
            }
            square = Plain::product(&mut self.code, square, square);
        }
    }
}

/// An exponent: `whole`, and one half where there is a `root`, of the reciprocal.
#[derive(Clone, Copy, Debug)]
struct HalfInteger {
    whole: u32,
    root: bool,
    reciprocal: bool,
}

impl HalfInteger {
    fn of(exponent: DoubleDouble) -> Option<HalfInteger> {
        let size = exponent.high.abs();
        let is_half_integer = exponent.low == 0.0 && (2.0 * size).fract() == 0.0;
        (is_half_integer && size <= GREATEST_EXPONENT).then_some(HalfInteger {
            whole: size as u32,
            root: size.fract() != 0.0,
            reciprocal: exponent.high < 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_integers_are_compiled_up_to_sixty_four() {
        let of = |x: f64| {
            HalfInteger::of(DoubleDouble::from(x)).map(|e| (e.whole, e.root, e.reciprocal))
        };
        assert_eq!(of(-3.5), Some((3, true, true)));
        assert_eq!(of(64.0), Some((64, false, false)));
        assert_eq!(of(64.5), None);
        assert_eq!(of(0.25), None);
        assert!(HalfInteger::of(DoubleDouble { high: 2.0, low: 1e-20 }).is_none());
    }
}
