//! Enclosures of a law over a box of times and states: whether anything in it is narrower than the box.
//!
//! A high power, what is divided by, and the argument of an exponential function may change by orders of magnitude between
//! two states, so that neither shows what lies between them, as a thin barrier or a steep wall. Interval arithmetic bounds each of
//! them over the box.
//!
//! In: intervals of the time and of the numbers of a state. Out: whether all is resolved, the rounding of rates. Never here: steps.
//!
//! Source: R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis (SIAM, 2009).

mod functions;
mod narrow;
mod resolved;
mod rounding;

use std::sync::Arc;

use functions::of_function;
use narrow::{Narrow, narrow};

use super::compiled::System;
use super::program::{Op, Program, Register};
use crate::num::{DoubleDouble, Interval};

/// Encloses the registers of the law of a system.
#[derive(Clone, Debug)]
pub struct Enclosure {
    program: Arc<Program>,
    narrow: Vec<Narrow>,
    /// Of which of these nothing can be told, not even at a point.
    unknown: Vec<bool>,
    registers: Vec<Interval>,
    /// By how much each register may change without an effect.
    harmless: Vec<f64>,
    /// The rounding of each register.
    rounding: Vec<f64>,
}

impl System {
    /// Allocates the enclosure of the motion's law, whose inputs are the numbers of a state in [`System::form`].
    pub fn enclosure(&self) -> Enclosure {
        let program = Arc::clone(&self.motion().native);
        let count = program.ops.len();
        let narrow = narrow(&program);
        Enclosure {
            unknown: vec![false; narrow.len()],
            narrow,
            registers: vec![Interval::ALL; count],
            harmless: vec![0.0; count],
            rounding: vec![0.0; count],
            program,
        }
    }
}

impl Enclosure {
    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        let program = Arc::clone(&self.program);
        for &r in &program.prologue {
            match program.ops[r as usize] {
                Op::Parameter(i) => {
                    self.registers[r as usize] = Interval::of(parameters[i as usize]);
                }
                op => self.evaluate(&program, r, op),
            }
        }
    }

    /// Encloses all registers over an interval of times, and one of each number that the rates depend on.
    pub fn enclose(&mut self, time: Interval, numbers: impl Iterator<Item = Interval>) {
        let program = Arc::clone(&self.program);
        for (&r, x) in program.inputs.iter().zip(numbers) {
            self.registers[r as usize] = x;
        }
        for &r in &program.body {
            match program.ops[r as usize] {
                Op::Time => self.registers[r as usize] = time,
                op => self.evaluate(&program, r, op),
            }
        }
    }

    fn at(&self, r: Register) -> Interval {
        self.registers[r as usize]
    }

    fn evaluate(&mut self, program: &Program, r: Register, op: Op) {
        let at = |r: Register| self.registers[r as usize];
        let value = match op {
            Op::Constant(c) => Interval::of(program.constants[c as usize]),
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let constant = Interval::of(program.constants[constant as usize]);
                terms.iter().fold(constant, |sum, term| {
                    sum + Interval::of(term.coefficient) * at(term.register)
                })
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => at(a) * at(b),
            Op::Square(a) => at(a).square(),
            Op::Divide(a, b) => at(a) * at(b).recip(),
            Op::Root(a) => at(a).root(),
            Op::Power(a, exponent) => at(a).power(program.constants[exponent as usize].high),
            Op::ParametricPower(a, exponent) => at(a).power(at(exponent).low),
            Op::Call(function, [a, b]) => {
                let (value, companion) = of_function(function, at(a), at(b));
                self.registers[r as usize + 1] = companion;
                value
            }
            Op::Select { switch, positive, negative, .. } => match at(switch) {
                // a function is continuous up to its kink, or has a step there
                side if side.low >= 0.0 && side.high > 0.0 => at(positive),
                side if side.high <= 0.0 && side.low < 0.0 => at(negative),
                _ => at(positive).hull(at(negative)),
            },
            Op::Solve(block) => {
                let n = program.blocks[block as usize].size();
                self.registers[r as usize..][..n].fill(Interval::ALL);
                return;
            }
            Op::Parameter(_) | Op::Time | Op::Input(_) | Op::Written => return,
        };
        self.registers[r as usize] = value;
    }
}
