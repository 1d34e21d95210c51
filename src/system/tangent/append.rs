//! Operations appended to a program that is extended by derivatives; equal ones share a register.
//!
//! In: registers, coefficients. Out: the register of the result. Never here: rules of differentiation.

use super::super::program::{LinearTerm, Op, Register};
use super::{Builder, Delta};
use crate::num::DoubleDouble;

impl Builder {
    pub(super) fn product(&mut self, a: Register, delta: Delta) -> Delta {
        let delta = delta?;
        let op = if self.program.fixed[a as usize] {
            Op::Scale(a, delta)
        } else {
            Op::Multiply(a.min(delta), a.max(delta))
        };
        Some(self.push(op))
    }

    pub(super) fn quotient(&mut self, delta: Delta, b: Register) -> Delta {
        Some(self.push(Op::Divide(delta?, b)))
    }

    pub(super) fn combination(&mut self, terms: &[(f64, Delta)]) -> Delta {
        let terms: Vec<LinearTerm> = terms
            .iter()
            .filter_map(|&(c, delta)| {
                Some(LinearTerm { coefficient: DoubleDouble::from(c), register: delta? })
            })
            .collect();
        self.sum(&terms)
    }

    pub(super) fn sum(&mut self, terms: &[LinearTerm]) -> Delta {
        match terms {
            [] => None,
            [only] if only.coefficient == DoubleDouble::ONE => Some(only.register),
            _ => Some(self.linear(0.0, terms)),
        }
    }

    pub(super) fn linear(&mut self, constant: f64, terms: &[LinearTerm]) -> Register {
        let first = self.program.terms.len() as u32;
        self.program.terms.extend_from_slice(terms);
        let constant = self.constant_index(DoubleDouble::from(constant));
        self.push(Op::Linear { constant, first, count: terms.len() as u32 })
    }

    pub(super) fn constant(&mut self, x: f64) -> Register {
        let index = self.constant_index(DoubleDouble::from(x));
        self.push(Op::Constant(index))
    }

    pub(super) fn constant_index(&mut self, x: DoubleDouble) -> u32 {
        let alike = |c: &DoubleDouble| {
            (c.high.to_bits(), c.low.to_bits()) == (x.high.to_bits(), x.low.to_bits())
        };
        let constants = &mut self.program.constants;
        let index = constants.iter().position(alike).unwrap_or_else(|| {
            constants.push(x);
            constants.len() - 1
        });
        index as u32
    }

    pub(super) fn input(&mut self) -> Register {
        let register = self.push(Op::Input(self.program.inputs.len() as u32));
        self.program.inputs.push(register);
        register
    }

    pub(super) fn push(&mut self, op: Op) -> Register {
        if let (Some(&register), false) = (self.written.get(&op), op == Op::Written) {
            return register;
        }
        let program = &mut self.program;
        let register = program.ops.len() as Register;
        let fixed = match op {
            Op::Constant(_) => true,
            Op::Linear { first, count, .. } => program.terms
                [first as usize..(first + count) as usize]
                .iter()
                .all(|term| program.fixed[term.register as usize]),
            Op::Square(a) | Op::Root(a) | Op::Power(a, _) => program.fixed[a as usize],
            Op::Scale(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) | Op::ParametricPower(a, b) => {
                program.fixed[a as usize] && program.fixed[b as usize]
            }
            Op::Select { switch, positive, negative, .. } => {
                [switch, positive, negative].iter().all(|&r| program.fixed[r as usize])
            }
            Op::Written => program.fixed[register as usize - 1],
            _ => false,
        };
        program.ops.push(op);
        program.fixed.push(fixed);
        match (op, fixed) {
            (Op::Written | Op::Input(_), _) => {}
            (_, true) => program.prologue.push(register),
            (_, false) => program.body.push(register),
        }
        if op != Op::Written {
            self.written.insert(op, register);
        }
        register
    }
}
