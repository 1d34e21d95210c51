//! Whether all that may be narrow in a law is resolved over the box that an [`Enclosure`] was last asked for.
//!
//! It is if it changes by no more than a factor, or if all its changes together are nothing beside what they are added to: that is
//! followed from the rates backwards, as derivatives are.

use std::sync::Arc;

use super::functions::largest_slope;
use super::narrow::Narrow;
use super::{Enclosure, Register};
use crate::expr::FunctionId;
use crate::num::Interval;
use crate::system::program::Op;

/// A change by this part is none, to all digits of double-double.
const NOTHING: f64 = 1e-32;

impl Enclosure {
    /// Asks for everything narrow again.
    pub fn ask_all(&mut self) {
        self.unknown.fill(false);
    }

    /// Gives up what is not even resolved at the point that was enclosed last, as quotients of what is beyond the range of numbers.
    pub fn give_up(&mut self) {
        for i in 0..self.narrow.len() {
            self.unknown[i] = !self.narrow[i].is_resolved(&self.registers);
        }
    }

    /// Whether everything narrow is resolved over the box that was enclosed last, where the rates may change by so much each
    /// without an effect.
    pub fn is_resolved(&mut self, harmless: impl Iterator<Item = f64>) -> bool {
        let known = self.narrow.iter().zip(&self.unknown).filter(|(_, unknown)| !**unknown);
        let known = known.map(|(narrow, _)| *narrow);
        if known.clone().all(|narrow| narrow.is_resolved(&self.registers)) {
            return true;
        }
        self.find_harmless(harmless);
        let registers = &self.registers;
        let known = self.narrow.iter().zip(&self.unknown).filter(|(_, unknown)| !**unknown);
        known.map(|(narrow, _)| *narrow).all(|narrow| {
            let register = match narrow {
                Narrow::Size(r) | Narrow::ParametricPower(r, _) => r,
                Narrow::Function(function, value, argument) => {
                    let has_companion = matches!(function, FunctionId::Sin | FunctionId::Sinh);
                    let beside = value + Register::from(has_companion);
                    let is_harmless = |r: Register| is_harmless(registers, &self.harmless, r);
                    if is_harmless(value) && is_harmless(beside) {
                        return true;
                    }
                    argument
                }
            };
            narrow.is_resolved(registers) || is_harmless(registers, &self.harmless, register)
        })
    }

    /// Follows what has no effect on the rates back to all registers.
    fn find_harmless(&mut self, outputs: impl Iterator<Item = f64>) {
        let program = Arc::clone(&self.program);
        self.harmless.fill(f64::INFINITY);
        for (&r, x) in program.outputs.iter().zip(outputs) {
            let own = &mut self.harmless[r as usize];
            *own = own.min(x);
        }
        for &r in program.body.iter().rev() {
            let value = self.at(r);
            let own = self.harmless[r as usize];
            let change = own.max(NOTHING * value.mignitude());
            let mut lower = |r: Register, x: f64| {
                let part = &mut self.harmless[r as usize];
                *part = part.min(if x.is_nan() { 0.0 } else { x });
            };
            let at = |r: Register| self.registers[r as usize];
            match program.ops[r as usize] {
                Op::Linear { first, count, .. } => {
                    for term in &program.terms[first as usize..(first + count) as usize] {
                        lower(term.register, change / term.coefficient.high.abs());
                    }
                }
                Op::Scale(a, b) | Op::Multiply(a, b) => {
                    lower(a, change / at(b).magnitude());
                    lower(b, change / at(a).magnitude());
                }
                Op::Square(a) => lower(a, change / (2.0 * at(a).magnitude())),
                Op::Divide(a, b) if at(a).is_zero() => {
                    lower(a, change * at(b).mignitude());
                }
                Op::Divide(a, b) => {
                    lower(a, change * at(b).mignitude());
                    lower(b, change * at(b).mignitude() / value.magnitude());
                }
                Op::Root(a) => lower(a, (2.0 * change * value.mignitude()).max(change * change)),
                Op::Power(a, exponent) => {
                    let n = program.constants[exponent as usize].high.abs();
                    lower(a, change * at(a).mignitude() / (n * value.magnitude()));
                }
                Op::ParametricPower(a, exponent) => {
                    let n = at(exponent).magnitude();
                    lower(a, change * at(a).mignitude() / (n * value.magnitude()));
                }
                Op::Call(function, [a, b]) => {
                    let beside = self.harmless_companion(function, r);
                    let slope = largest_slope(function, at(a), at(b), value);
                    for argument in [a, b] {
                        lower_of(&mut self.harmless, argument, change.min(beside) / slope);
                    }
                }
                Op::Select { switch, positive, negative, .. } => {
                    lower(switch, 0.0);
                    lower(positive, change);
                    lower(negative, change);
                }
                Op::Solve(block) => {
                    let block = &program.blocks[block as usize];
                    for &part in block.matrix.iter().chain(&block.right) {
                        lower(part, NOTHING * at(part).mignitude());
                    }
                }
                Op::Parameter(_) | Op::Constant(_) | Op::Time | Op::Input(_) | Op::Written => {}
            }
        }
    }

    /// By how much the companion of a function may change: the cosine beside the sine, and that of the hyperbolic ones.
    fn harmless_companion(&self, function: FunctionId, r: Register) -> f64 {
        match function {
            FunctionId::Sin | FunctionId::Sinh => {
                self.harmless[r as usize + 1].max(NOTHING * self.at(r + 1).mignitude())
            }
            _ => f64::INFINITY,
        }
    }
}

fn lower_of(harmless: &mut [f64], r: Register, x: f64) {
    let part = &mut harmless[r as usize];
    *part = part.min(if x.is_nan() { 0.0 } else { x });
}

fn is_harmless(registers: &[Interval], harmless: &[f64], r: Register) -> bool {
    let (value, harmless) = (registers[r as usize], harmless[r as usize]);
    harmless == f64::INFINITY || value.width() <= harmless || value.magnitude() <= harmless
}
