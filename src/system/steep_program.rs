//! The program of the arguments of exponential functions in a law.
//!
//! In: a law. Out: its program. Never here: states.

use std::sync::Arc;

use super::observables;
use super::program::Program;
use super::rhs::ProgramBuilder;
use crate::expr::{Expr, FunctionId, Node, Symbol};

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
