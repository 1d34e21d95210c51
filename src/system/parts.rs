//! A way to evaluate the body of a program in parts.
//!
//! In: a program, the memory that it is evaluated in. Out: its body evaluated, part by part. Never here: what computes a part
//! that is not interpreted.

use std::ops::Range;

use super::program::Program;

/// A way to evaluate a body.
pub(super) trait PartwiseEvaluation {
    /// Evaluates it: `interpret` evaluates a range of its operations; what is not interpreted works on `registers`, where these
    /// are `f64`.
    ///
    /// # Errors
    /// Those of `interpret`.
    fn evaluate<M, E>(
        &mut self,
        program: &Program,
        memory: &mut M,
        registers: impl Fn(&mut M) -> Option<&mut [f64]>,
        interpret: impl Fn(&mut M, Range<usize>) -> Result<(), E>,
    ) -> Result<(), E>;
}

#[derive(Clone, Debug, Default)]
pub(super) struct Interpreted;

impl PartwiseEvaluation for Interpreted {
    #[inline(always)]
    fn evaluate<M, E>(
        &mut self,
        program: &Program,
        memory: &mut M,
        _: impl Fn(&mut M) -> Option<&mut [f64]>,
        interpret: impl Fn(&mut M, Range<usize>) -> Result<(), E>,
    ) -> Result<(), E> {
        interpret(memory, 0..program.body.len())
    }
}
