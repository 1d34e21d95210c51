//! The logarithms of a law, whose rates of change are defined where they have no value.
//!
//! In: states. Out: whether every logarithm of the energy has a positive argument. The derivative of ln u, u'/u, is
//! finite below zero too, so that a step of any method may end there. Other functions have no derivative where they
//! have no value. Never here: where within a step the domain was left.

use std::sync::Arc;

use super::program::{Op, Program, Register};
use super::value::Evaluator;
use super::{State, System};
use crate::expr::FunctionId;

/// The logarithms of one system. It owns its registers.
#[derive(Clone, Debug)]
pub struct Logarithms {
    system: System,
    parameters: Vec<f64>,
    energy: Evaluator<f64>,
    arguments: Vec<Register>,
    numbers: Vec<f64>,
}

impl System {
    /// Whether the energy contains logarithms of what moves.
    pub(super) fn has_logarithms(&self) -> bool {
        arguments(&self.shared.energy).next().is_some()
    }

    /// The logarithms of the energy, or `None` if there are none.
    pub fn logarithms(&self, parameters: &[f64]) -> Option<Logarithms> {
        let program = &self.shared.energy;
        let arguments: Vec<Register> = arguments(program).collect();
        if arguments.is_empty() {
            return None;
        }
        let mut energy = Evaluator::new(Arc::clone(program));
        energy.set_parameters(&self.inputs(parameters));
        let numbers = vec![0.0; self.moving()];
        let (system, parameters) = (self.clone(), parameters.to_vec());
        Some(Logarithms { system, parameters, energy, arguments, numbers })
    }
}

/// The arguments that may be negative.
fn arguments(program: &Program) -> impl Iterator<Item = Register> {
    let never_negative = never_negative(program);
    program.body.iter().filter_map(move |&register| match program.ops[register as usize] {
        Op::Call(FunctionId::Ln, [argument, _]) if !never_negative[argument as usize] => {
            Some(argument)
        }
        _ => None,
    })
}

/// Which values are shown by their form not to be negative, such as 0.1 + x² + y²/q².
fn never_negative(program: &Program) -> Vec<bool> {
    let mut known: Vec<bool> = Vec::with_capacity(program.ops.len());
    for op in &program.ops {
        let of = |register: Register| known[register as usize];
        let found = match *op {
            Op::Constant(index) => program.constants[index as usize].high >= 0.0,
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                program.constants[constant as usize].high >= 0.0
                    && terms.iter().all(|term| term.coefficient.high >= 0.0 && of(term.register))
            }
            Op::Scale(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) => of(a) && of(b),
            Op::Square(_) | Op::Root(_) | Op::Call(FunctionId::Exp | FunctionId::Abs, _) => true,
            _ => false,
        };
        known.push(found);
    }
    known
}

impl Logarithms {
    /// Whether no logarithm has a negative argument in a state. Also true if the velocities of the state cannot be found,
    /// which is reported as an error of its own.
    pub fn have_values(&mut self, state: &State) -> bool {
        let Ok(native) = self.system.convert(state, self.system.form(), &self.parameters) else {
            return true;
        };
        self.numbers.copy_from_slice(&native.values[..self.system.moving()]);
        if self.energy.evaluate(native.time, &self.numbers).is_err() {
            return true;
        }
        // what is not a number is found elsewhere
        !self.arguments.iter().any(|&argument| self.energy.register(argument) < 0.0)
    }
}
