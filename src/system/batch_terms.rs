//! The terms of the conserved quantities of several orbits at once.
//!
//! In: a state and parameters for each lane. Out: the terms that a [`TermWatch`](super::TermWatch) of
//! that orbit alone evaluates, to the last bit; none in lanes whose numbers may leave the range of
//! `f64`. Never here: systems whose terms take the solution of linear equations.

use std::sync::Arc;

use super::compiled::System;
use super::program::{Op, Program};
use super::state::State;
use super::value::{Evaluator, value_of};
use crate::num::{Analytic, BATCH, Batch, Kernel, vectorized};

/// Evaluates the terms of several orbits.
#[derive(Clone, Debug)]
pub struct BatchTerms {
    system: System,
    program: Arc<Program>,
    registers: Vec<Batch>,
    /// What depends on the parameters of one lane alone is computed here.
    single: Evaluator<f64>,
    /// The number of a state that each input of the program is, if any.
    numbers: Vec<Option<usize>>,
    /// Whether no number of a lane leaves the range of `f64` unseen.
    ordinary: [bool; BATCH],
}

impl System {
    /// The terms of the conserved quantities of several orbits, whose states have the native form;
    /// `None` where they have to be evaluated one by one.
    pub fn batch_terms(&self) -> Option<BatchTerms> {
        let program = &self.terms().native;
        let alone = |&r: &u32| {
            let op = program.ops[r as usize];
            matches!(op, Op::Solve(_) | Op::Select { .. } | Op::ParametricPower(..))
        };
        if program.body.iter().any(alone) || self.has_branches() {
            return None;
        }
        let mut quadratures = self.driven_len()..;
        let carried = self.carries().map(|carried| quadratures.next().filter(|_| carried));
        let [action, work] = match carried {
            // the work follows the action only where there is one
            [None, Some(place)] => [None, Some(place - 1)],
            carried => carried,
        };
        let numbers = (0..self.motion_len()).map(Some).chain([action, work]).collect();
        let registers = vec![Batch::ZERO; program.ops.len()];
        let single = Evaluator::new(Arc::clone(program));
        let program = Arc::clone(program);
        let system = self.clone();
        Some(BatchTerms { system, program, registers, single, numbers, ordinary: [false; BATCH] })
    }
}

impl BatchTerms {
    /// Sets the parameters of a lane.
    pub fn set_parameters(&mut self, lane: usize, parameters: &[f64]) {
        self.single.set_parameters(&self.system.inputs(parameters));
        self.ordinary[lane] = self.single.is_ordinary();
        for &r in &self.program.prologue {
            self.registers[r as usize].0[lane] = self.single.register(r);
        }
    }

    /// Evaluates the states of the lanes that have one.
    pub fn look(&mut self, states: [Option<&State>; BATCH]) {
        vectorized(Look { terms: self, states });
    }

    /// The terms of a lane; `None` where they have to be evaluated alone.
    pub fn of_lane(&self, lane: usize) -> Option<impl Iterator<Item = f64>> {
        let outputs = &self.program.outputs;
        let term = move |&r: &u32| self.registers[r as usize].0[lane];
        let regular = self.ordinary[lane] && outputs.iter().map(term).all(f64::is_finite);
        regular.then(|| outputs.iter().map(term))
    }

    /// The work done on the motion of a lane, if states carry it.
    pub fn work(&self, lane: usize) -> f64 {
        let last = self.program.inputs.last();
        last.map_or(0.0, |&r| self.registers[r as usize].0[lane])
    }
}

/// The kernel of the evaluation.
struct Look<'a> {
    terms: &'a mut BatchTerms,
    states: [Option<&'a State>; BATCH],
}

impl Kernel for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let BatchTerms { program, registers, numbers, .. } = self.terms;
        let mut time = Batch::ZERO;
        for (lane, state) in self.states.iter().enumerate() {
            let Some(state) = state else { continue };
            time.0[lane] = state.time;
            for (&r, place) in program.inputs.iter().zip(&*numbers) {
                registers[r as usize].0[lane] = place.map_or(0.0, |place| state.values[place]);
            }
        }
        for &r in &program.body {
            let at = r as usize;
            if let Op::Time = program.ops[at] {
                registers[at] = time;
            } else if let Some((value, companion)) =
                value_of(program, program.ops[at], |r| registers[r as usize])
            {
                registers[at] = value;
                if let Some(companion) = companion {
                    registers[at + 1] = companion;
                }
            }
        }
    }
}
