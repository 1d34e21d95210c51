//! The programs of the arguments of exponential functions in a law, and of what its negative powers divide by.
//!
//! In: a law. Out: its programs. Never here: states.

use std::sync::Arc;

use super::observables;
use super::program::Program;
use super::rhs::ProgramBuilder;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, keeps_its_sign};

/// The least degree of a divisor behind which a thin barrier may stand: c/u has the force c/u², c/√u that of u^−1.5.
const LEAST_DEGREE: f64 = 1.5;

/// The program of the divisors, of the same inputs.
pub(super) fn divisors(builder: &mut ProgramBuilder<'_>) -> Result<Arc<Program>, Symbol> {
    of_divisors(builder, |_, _| true)
}

/// The program of those divisors that may change their sign.
pub(super) fn signed_divisors(builder: &mut ProgramBuilder<'_>) -> Result<Arc<Program>, Symbol> {
    of_divisors(builder, |pool, e| !keeps_its_sign(pool, e))
}

fn of_divisors(
    builder: &mut ProgramBuilder<'_>,
    is_wanted: fn(&mut Pool, Expr) -> bool,
) -> Result<Arc<Program>, Symbol> {
    let law = builder.equations.flow.expressions();
    let moving = builder.equations.moving();
    let mut divisors: Vec<Option<Expr>> = Vec::new();
    for part in builder.pool.reachable(&law) {
        let Node::Product(_, factors) = builder.pool.node(part).clone() else { continue };
        for (base, power) in factors {
            let is_one = power.value() <= -LEAST_DEGREE;
            if is_one
                && builder.pool.depends_on_any(base, &moving)
                && is_wanted(&mut builder.pool, base)
                && !divisors.contains(&Some(base))
            {
                divisors.push(Some(base));
            }
        }
    }
    observables::program(builder, &divisors)
}

/// The program of the arguments, functions of (q, native rates, action, work).
pub(super) fn program(builder: &mut ProgramBuilder<'_>) -> Result<Arc<Program>, Symbol> {
    let law = builder.equations.flow.expressions();
    let moving = builder.equations.moving();
    let mut arguments: Vec<Option<Expr>> = Vec::new();
    for part in builder.pool.reachable(&law) {
        let argument = match builder.pool.node(part) {
            Node::Call(
                FunctionId::Exp | FunctionId::Tanh | FunctionId::Sinh | FunctionId::Cosh,
                argument,
            ) => argument[0],
            _ => continue,
        };
        if builder.pool.depends_on_any(argument, &moving) && !arguments.contains(&Some(argument)) {
            arguments.push(Some(argument));
        }
    }
    observables::program(builder, &arguments)
}
