//! Where the functions of events keep their signs along several orbits at once.
//!
//! In: the series of a step of each orbit. Out: for each lane whether all functions surely keep their signs over the step,
//! as [`EventFunctions::keep_signs`](super::EventFunctions::keep_signs) finds for one orbit. Never here: zeros.

use std::sync::Arc;

use super::System;
use super::batch_series::BatchSeries;
use super::jet::Jet;
use super::program::{Op, Program};
use super::sign_bound::{shows_end, signs_unchanged, stay};
use crate::expr::FunctionId;
use crate::num::{Analytic, Batch, DoubleDouble, Kernel, vectorized};

/// The functions of one system.
#[derive(Clone, Debug)]
pub struct BatchEventSigns {
    functions: Functions,
    count: usize,
}

/// How the functions follow from the motion.
#[derive(Clone, Debug)]
enum Functions {
    Numbers(Vec<usize>),
    Program {
        jet: Box<Jet<Batch>>,
        /// What depends on the parameters of one lane alone is computed here.
        single: Box<Jet<f64>>,
        /// Whether the functions read each of the numbers of the motion.
        read: Vec<bool>,
        outputs: usize,
        /// Their degree as polynomials in these and the time, if they are polynomials.
        degree: Option<usize>,
    },
}

impl System {
    /// Room for the signs of the events' functions, expanded up to an order; `None` where an orbit's functions may take
    /// another course than its neighbours'.
    pub fn batch_event_signs(&self, order: usize) -> Option<BatchEventSigns> {
        let program = &self.discontinuities().variation;
        let count = self.discontinuities().events.len();
        let functions = match program.outputs_as_inputs().filter(|_| program.switches() == 0) {
            Some(numbers) if numbers.iter().all(|&i| i < self.motion_len()) => {
                Functions::Numbers(numbers)
            }
            _ => self.expanded_functions(program, order)?,
        };
        Some(BatchEventSigns { functions, count })
    }

    fn expanded_functions(&self, program: &Arc<Program>, order: usize) -> Option<Functions> {
        let alone = |&r: &u32| {
            let op = program.ops[r as usize];
            matches!(
                op,
                Op::Select { .. }
                    | Op::ParametricPower(..)
                    | Op::Call(FunctionId::Atan | FunctionId::Atan2, _)
            )
        };
        let smooth = program.switches() == 0 && program.guards.is_empty();
        let mut read = program.inputs_read();
        let auxiliary = read[self.motion_len()..].contains(&true);
        if !smooth || auxiliary || program.body.iter().any(alone) {
            return None;
        }
        read.truncate(self.motion_len());
        let jet = Jet::new(Arc::clone(program), order);
        Some(Functions::Program {
            single: Box::new(Jet::like(&jet, 0)),
            jet: Box::new(jet),
            read,
            outputs: program.outputs(),
            degree: program.degree(),
        })
    }
}

impl BatchEventSigns {
    /// Sets the parameters of a lane.
    pub fn set_parameters(&mut self, lane: usize, parameters: &[DoubleDouble]) {
        if let Functions::Program { jet, single, .. } = &mut self.functions {
            single.set_parameters(parameters);
            jet.take_parameters(lane, single);
        }
    }

    /// One in each lane where every function surely has its sign from the origin of the series up to a time after it, in
    /// its unit, on which its expansion represents it up to a part `cut_off` of its size; else zero.
    pub fn keep_signs(
        &mut self,
        series: &BatchSeries,
        signs: &[Batch],
        (cut_off, time): (f64, Batch),
    ) -> Batch {
        let mut is_whole = true;
        if let Functions::Program { jet, read, degree, .. } = &mut self.functions {
            let mut taken = 1;
            for (place, _) in read.iter().enumerate().filter(|(_, read)| **read) {
                let coefficients = series.coefficients(place);
                for (k, &c) in coefficients.iter().enumerate() {
                    jet.set_input(place, k, c);
                }
                let last = coefficients.iter().rposition(|c| *c != Batch::ZERO);
                taken = taken.max(last.unwrap_or(0));
            }
            is_whole = degree.is_some_and(|degree| degree.saturating_mul(taken) <= series.order());
            if jet.advance_to(series.order(), series.start(), series.scale()).is_err() {
                return Batch::ZERO;
            }
        }
        vectorized(KeepSigns { functions: self, series, signs, cut_off, time, is_whole })
    }
}

/// The kernel of [`BatchEventSigns::keep_signs`].
struct KeepSigns<'a> {
    functions: &'a BatchEventSigns,
    series: &'a BatchSeries,
    signs: &'a [Batch],
    cut_off: f64,
    time: Batch,
    /// Whether the functions are the polynomials that were found, with nothing cut off.
    is_whole: bool,
}

impl Kernel for KeepSigns<'_> {
    type Output = Batch;
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Batch {
        let KeepSigns { functions, series, signs, cut_off, time, is_whole } = self;
        let mut all = Batch::ONE;
        for (event, &sign) in signs.iter().enumerate() {
            let (c, cut_off) = match &functions.functions {
                // a number of the motion is its polynomial
                Functions::Numbers(numbers) => (series.coefficients(numbers[event]), f64::INFINITY),
                Functions::Program { jet, .. } => (jet.output_series(event), cut_off),
            };
            all = all * (c[0] * sign).is_above(Batch::ZERO) * signs_unchanged(c, cut_off, time);
            if !is_whole {
                all = all * shows_end(c, time);
            }
        }
        if let Functions::Program { jet, outputs, .. } = &functions.functions {
            for argument in functions.count..*outputs {
                all = all * stay(jet.output_series(argument), time);
            }
        }
        all
    }
}
