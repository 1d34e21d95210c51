//! Overflow that no result shows: a quotient by what has overflowed is 0, although its dividend may be as large, as in
//! `x^60/sqrt(1 + x^120)` at 400.
//!
//! In: a program, the values of its registers. Out: whether to evaluate once more in a wider range. Never here: that
//! evaluation.

use super::program::{Op, Program, Register};
use crate::expr::FunctionId;

/// What is divided counts up to this size as nothing beside numbers that overflow.
const NOTHING: f64 = 1e100;

/// A divisor of at most this degree overflows only where the numbers of a state are beyond 10¹⁹.
const LOW_DEGREE: f64 = 16.0;

/// The degree by which exponentials count.
const EXPONENTIAL: f64 = 1e3;

/// The operations whose results may be finite although an operand has overflowed, while the numbers of a state are moderate: their
/// operands are high powers or exponentials.
pub(super) fn hiding(program: &Program) -> Vec<Register> {
    let degrees = degrees(program);
    let is_high = |r: Register| degrees[r as usize] > LOW_DEGREE;
    let hides = |r: &Register| match program.ops[*r as usize] {
        // below that degree the dividend is nothing
        Op::Divide(a, b) => is_high(b) && degrees[a as usize] * 3.0 > LOW_DEGREE,
        Op::Power(a, exponent) => program.constants[exponent as usize].high < 0.0 && is_high(a),
        Op::ParametricPower(a, _) => is_high(a),
        Op::Call(FunctionId::Atan2, arguments) => arguments.into_iter().any(is_high),
        _ => false,
    };
    program.body.iter().copied().filter(hides).collect()
}

/// Whether a result of these operations hides that an operand has overflowed.
pub(super) fn occurred(
    program: &Program,
    hiding: &[Register],
    value: impl Fn(Register) -> f64,
) -> bool {
    hiding.iter().any(|&r| match program.ops[r as usize] {
        Op::Divide(a, b) => value(b).is_infinite() && value(a).abs() > NOTHING,
        Op::Power(a, _) | Op::ParametricPower(a, _) => value(a).is_infinite() && value(r) == 0.0,
        Op::Call(_, [a, b]) => {
            let sizes = [value(a).abs(), value(b).abs()];
            sizes.contains(&f64::INFINITY) && sizes.iter().all(|&size| size > NOTHING)
        }
        _ => false,
    })
}

/// How every register grows with the numbers of a state, as a power of them.
fn degrees(program: &Program) -> Vec<f64> {
    let mut degrees: Vec<f64> = Vec::with_capacity(program.ops.len());
    for (r, op) in program.ops.iter().enumerate() {
        let of = |register: Register| degrees[register as usize];
        let degree = match *op {
            _ if program.fixed[r] => 0.0,
            Op::Time | Op::Input(_) => 1.0,
            Op::Constant(_) | Op::Parameter(_) => 0.0,
            Op::Linear { first, count, .. } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                terms.iter().map(|term| of(term.register)).fold(0.0, f64::max)
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => of(a) + of(b),
            Op::Square(a) => 2.0 * of(a),
            Op::Divide(a, _) => of(a),
            Op::Root(a) => of(a) / 2.0,
            Op::Power(a, exponent) => of(a) * program.constants[exponent as usize].high.max(0.0),
            Op::ParametricPower(..)
            | Op::Call(FunctionId::Exp | FunctionId::Sinh | FunctionId::Cosh, _) => EXPONENTIAL,
            Op::Call(_, [a, b]) => of(a).max(of(b)),
            Op::Select { positive, negative, .. } => of(positive).max(of(negative)),
            Op::Solve(block) => {
                let right = &program.blocks[block as usize].right;
                right.iter().map(|&r| of(r)).fold(0.0, f64::max)
            }
            Op::Written => r.checked_sub(1).map_or(0.0, |before| degrees[before]),
        };
        degrees.push(degree);
    }
    degrees
}

#[cfg(test)]
mod tests {
    use super::{NOTHING, hiding, occurred};
    use crate::num::DoubleDouble;
    use crate::system::program::{Op, Program};

    /// A quotient of powers of the input.
    fn quotient(above: f64, below: f64) -> Program {
        let constants = vec![DoubleDouble::from(above), DoubleDouble::from(below)];
        let ops = vec![Op::Input(0), Op::Power(0, 0), Op::Power(0, 1), Op::Divide(1, 2)];
        let (body, fixed) = (vec![1, 2, 3], vec![false; 4]);
        Program { ops, constants, fixed, body, ..Program::default() }
    }

    #[test]
    fn an_overflow_counts_where_what_is_divided_by_it_is_large() {
        let program = quotient(60.0, 120.0);
        let hiding = hiding(&program);
        assert_eq!(hiding, [3]);
        let at = |above: f64, below: f64| move |r: u32| if r == 2 { below } else { above };
        assert!(occurred(&program, &hiding, at(1.01 * NOTHING, f64::INFINITY)));
        assert!(!occurred(&program, &hiding, at(0.99 * NOTHING, f64::INFINITY)));
        assert!(!occurred(&program, &hiding, at(1.01 * NOTHING, f64::MAX)));
    }

    #[test]
    fn high_powers_overflow_where_a_state_is_moderate() {
        let counts = |above: f64, below: f64| !hiding(&quotient(above, below)).is_empty();
        assert!(counts(60.0, 120.0) && counts(5.4, 16.1));
        assert!(!counts(5.3, 16.1) && !counts(60.0, 16.0) && !counts(1.0, 3.0));
    }
}
