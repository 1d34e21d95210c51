//! The values of a program at the inputs of several orbits, or of several points, side by side.
//!
//! In: parameters, a time and inputs for each lane. Out: the values that an [`Evaluator`] in `f64` has in that lane alone, to the
//! last bit, and the lanes in which that is known. Never here: programs that take another course from lane to lane, or the
//! solution of linear equations.

use std::sync::Arc;

use super::operation::value_of;
use super::program::{Op, Program, Register};
use super::value::Evaluator;
use crate::num::{Analytic, BATCH, Batch, DoubleDouble, Kernel, vectorized};

/// The registers of one program in several lanes.
#[derive(Clone, Debug)]
pub(super) struct BatchValues {
    program: Arc<Program>,
    registers: Vec<Batch>,
    /// Zero in the lanes where all outputs of the last evaluation are finite.
    finite: Batch,
    /// What depends on the parameters of one lane alone is computed here.
    single: Evaluator<f64>,
    /// Whether no number of a lane leaves the range of `f64` unseen.
    ordinary: [bool; BATCH],
}

impl BatchValues {
    /// Allocates registers; `None` where the lanes have to be evaluated one by one. The parameters of each lane must be set before
    /// it is evaluated.
    pub(super) fn new(program: &Arc<Program>) -> Option<BatchValues> {
        let alone = |&r: &Register| {
            let op = program.ops[r as usize];
            matches!(op, Op::Solve(_) | Op::Select { .. } | Op::ParametricPower(..))
        };
        (!program.body.iter().any(alone)).then(|| BatchValues {
            program: Arc::clone(program),
            registers: vec![Batch::ZERO; program.ops.len()],
            finite: Batch::ZERO,
            single: Evaluator::new(Arc::clone(program)),
            ordinary: [false; BATCH],
        })
    }

    /// Sets the parameters of a lane.
    pub(super) fn set_parameters(&mut self, lane: usize, parameters: &[DoubleDouble]) {
        self.single.set_parameters(parameters);
        self.ordinary[lane] = self.single.is_ordinary();
        for &r in &self.program.prologue {
            self.registers[r as usize].0[lane] = self.single.register(r);
        }
    }

    /// Sets the same parameters in all lanes.
    pub(super) fn set_parameters_of_all(&mut self, parameters: &[DoubleDouble]) {
        self.single.set_parameters(parameters);
        self.ordinary = [self.single.is_ordinary(); BATCH];
        for &r in &self.program.prologue {
            self.registers[r as usize] = Batch::splat(self.single.register(r));
        }
    }

    /// Evaluates at the times and inputs of all lanes.
    pub(super) fn evaluate(&mut self, times: Batch, inputs: impl Iterator<Item = Batch>) {
        for (&r, input) in self.program.inputs.iter().zip(inputs) {
            self.registers[r as usize] = input;
        }
        let program = Arc::clone(&self.program);
        vectorized(ValuesKernel { values: self, times, body: &program.body });
    }

    /// Evaluates once more with another number for one input: the operations of [`Program::body_of_input`] for it.
    pub(super) fn evaluate_with(&mut self, (input, x): (usize, Batch), body: &[Register]) {
        if let Some(&r) = self.program.inputs.get(input) {
            self.registers[r as usize] = x;
        }
        // none of these is the time
        vectorized(ValuesKernel { values: self, times: Batch::ZERO, body });
    }

    /// The lanes whose values need not be evaluated alone.
    pub(super) fn regular_lanes(&self) -> [bool; BATCH] {
        let mut regular = self.ordinary;
        for lane in 0..BATCH {
            regular[lane] &= self.finite.0[lane] == 0.0;
        }
        regular
    }

    /// Whether no lane has to be evaluated alone.
    pub(super) fn is_regular(&self) -> bool {
        let mut sum = 0.0;
        for lane in 0..BATCH {
            sum += self.finite.0[lane];
        }
        sum == 0.0 && self.ordinary == [true; BATCH]
    }

    /// The values of the outputs from one on.
    pub(super) fn outputs_from(&self, first: usize) -> impl Iterator<Item = Batch> + '_ {
        let outputs = self.program.outputs.get(first..).unwrap_or_default();
        outputs.iter().map(|&r| self.registers[r as usize])
    }
}

struct ValuesKernel<'a> {
    values: &'a mut BatchValues,
    times: Batch,
    /// What is evaluated.
    body: &'a [Register],
}

impl Kernel for ValuesKernel<'_> {
    type Output = ();
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let BatchValues { program, registers, finite, .. } = self.values;
        for &r in self.body {
            let at = r as usize;
            if let Op::Time = program.ops[at] {
                registers[at] = self.times;
            } else if let Some((value, companion)) =
                value_of::<_, FUSED>(program, program.ops[at], |r| registers[r as usize])
            {
                registers[at] = value;
                if let Some(companion) = companion {
                    registers[at + 1] = companion;
                }
            }
        }
        *finite = Batch::ZERO;
        for &r in &program.outputs {
            // zero times anything that is not finite is NaN
            *finite = *finite + registers[r as usize] * 0.0;
        }
    }
}
