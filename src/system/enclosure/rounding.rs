//! The rounding of the rates of a law at a point, followed from the numbers of a state through its operations (N. J. Higham, Accuracy
//! and Stability of Numerical Algorithms, SIAM 2002, § 3.3).

use std::sync::Arc;

use super::functions::largest_slope;
use super::{Enclosure, Program, Register};
use crate::system::program::Op;

/// The rounding of one operation, in parts of its result.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Enclosure {
    /// The rounding of a rate at a point that was enclosed last, where the numbers have these errors.
    pub fn rounding(&mut self, errors: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
        let program = Arc::clone(&self.program);
        for (&r, error) in program.inputs.iter().zip(errors) {
            self.rounding[r as usize] = error;
        }
        for &r in &program.body {
            self.round(&program, r);
        }
        let Enclosure { program, rounding, .. } = self;
        program.outputs.iter().map(|&r| rounding[r as usize])
    }

    /// Finds the rounding of a register from those of what it is computed from.
    fn round(&mut self, program: &Program, r: Register) {
        let size = |r: Register| self.registers[r as usize].magnitude();
        let error = |r: Register| self.rounding[r as usize];
        let own = ROUNDING * size(r);
        let passed_on = match program.ops[r as usize] {
            Op::Linear { first, count, .. } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let part = |register: Register| error(register) + ROUNDING * size(register);
                terms.iter().map(|t| t.coefficient.high.abs() * part(t.register)).sum()
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => size(a) * error(b) + size(b) * error(a),
            Op::Square(a) => 2.0 * size(a) * error(a),
            Op::Divide(a, b) => (error(a) + size(r) * error(b)) / size(b),
            Op::Root(a) => 0.5 * error(a) / size(r),
            Op::Power(a, exponent) => {
                program.constants[exponent as usize].high.abs() * size(r) * error(a) / size(a)
            }
            Op::ParametricPower(a, exponent) => size(exponent) * size(r) * error(a) / size(a),
            Op::Call(function, [a, b]) => {
                let (u, v) = (self.at(a), self.at(b));
                let slope = largest_slope(function, u, v, self.at(r));
                let passed_on = slope * (error(a) + error(b));
                self.rounding[r as usize + 1] = passed_on + ROUNDING * size(r + 1);
                passed_on
            }
            Op::Select { positive, negative, .. } => error(positive).max(error(negative)),
            Op::Solve(block) => {
                // what rounding does in a system of equations is not known here
                let n = program.blocks[block as usize].size();
                self.rounding[r as usize..][..n].fill(0.0);
                return;
            }
            Op::Written | Op::Input(_) => return,
            Op::Parameter(_) | Op::Constant(_) | Op::Time => 0.0,
        };
        let all: f64 = own + passed_on;
        self.rounding[r as usize] = if all.is_nan() { 0.0 } else { all };
    }
}
