//! The values of the events' functions at a state, and their series along a step.
//!
//! In: states of one system, or the series of a step. Out: values of `when`, and coefficients. Never here: how zeros are
//! found, and what follows from them.

use std::borrow::Cow;
use std::sync::Arc;

use super::discontinuities::CompiledEvent;
use super::expansion::Expansion;
use super::native_states::NativeStates;
use super::program::Op;
use super::resolution::Resolution;
use super::step_series::StepSeries;
use super::value::Evaluator;
use super::{MotionError, State, System};
use crate::expr::FunctionId;
use crate::model::EventAction;
use crate::num::DoubleDouble;

/// Evaluates the events' functions of one system at one set of parameters.
#[derive(Clone, Debug)]
pub struct EventFunctions {
    system: System,
    native: NativeStates,
    quick: Evaluator<f64>,
    exact: Evaluator<DoubleDouble>,
    resolution: Resolution,
    /// Expands the functions along a step whose series is known. Created at the first such step.
    expansion: Option<Expansion>,
    rounded: Vec<f64>,
    inputs: Vec<DoubleDouble>,
}

impl EventFunctions {
    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let inputs = self.system.inputs(parameters);
        self.native.set_parameters(parameters, &inputs);
        self.quick.set_parameters(&inputs);
        self.exact.set_parameters(&inputs);
        self.resolution.set_parameters(&inputs);
        self.expansion = None;
    }

    /// Whether the zeros of an event's function are more than rounding: the function is neither constant along the motion
    /// nor kept at zero by an active constraint.
    pub fn may_cross(&self, event: usize) -> bool {
        let is_active = |constraint: usize| !self.system.is_released(constraint);
        self.system.discontinuities().events[event].may_cross(is_active)
    }

    /// Whether the functions have branches that a switch chooses, as `sign` does: they may jump from one to the other.
    pub fn may_jump(&self) -> bool {
        self.system.discontinuities().variation.switches() > 0
    }

    /// Whether there are angles in the functions, which jump at their cuts.
    pub fn have_cuts(&self) -> bool {
        let is_angle = |op: &Op| matches!(op, Op::Call(FunctionId::Atan | FunctionId::Atan2, _));
        self.quick.program().ops.iter().any(is_angle)
    }

    /// Expands the functions along a step whose series is known, about a time `x` after the series'
    /// origin, in its unit. Returns how far beyond it, up to the second of `within`, the expansions represent the
    /// functions up to a part of their size, the first of `within`, or `None` if there are none.
    pub fn expand(&mut self, series: &dyn StepSeries, x: f64, within: (f64, f64)) -> Option<f64> {
        let reach = self.expansion(series.order()).expand(series, x, within);
        Some(reach).filter(|reach| !reach.is_nan())
    }

    /// Whether every function surely has this sign from the origin of a series up to a time after it, in its unit, on
    /// which its expansion represents it up to a part `cut_off` of its size.
    pub fn keep_signs(
        &mut self,
        series: &dyn StepSeries,
        signs: &[f64],
        within: (f64, f64),
    ) -> bool {
        self.expansion(series.order()).keep_signs(series, signs, within)
    }

    fn expansion(&mut self, order: usize) -> &mut Expansion {
        let (system, parameters) = (&self.system, self.native.parameters());
        if self.expansion.as_ref().is_some_and(|known| known.order() != order) {
            self.expansion = None;
        }
        self.expansion.get_or_insert_with(|| {
            let discontinuities = system.discontinuities();
            let (program, functions) =
                (Arc::clone(&discontinuities.variation), discontinuities.events.len());
            let mut new = Expansion::new(system, program, functions, order);
            new.set_parameters(&system.inputs(parameters));
            new
        })
    }

    /// The coefficients of an event's function from the last [expansion](EventFunctions::expand).
    pub fn expanded(&self, event: usize) -> Vec<f64> {
        self.expansion.as_ref().map_or_else(Vec::new, |known| known.function(event).to_vec())
    }

    /// Whether the expanded functions have branches that no switch shows: those of roots, which have kinks where they vanish,
    /// and of inverse functions.
    pub fn has_branches(&self) -> bool {
        self.expansion.as_ref().is_some_and(Expansion::has_branches)
    }

    /// Series beyond whose first zero the expanded functions are others.
    pub fn expanded_branch_signs(&self) -> impl Iterator<Item = Cow<'_, [f64]>> {
        self.expansion.iter().flat_map(Expansion::branch_signs)
    }

    /// The time after a state over which the functions are simple enough that samples at the ends,
    /// and at the points where these do not predict them, detect every turning point. It is
    /// infinite for polynomials, and `None` if it cannot be estimated. `near` is a time comparable
    /// to the time scale of the motion.
    pub fn resolved(&mut self, state: &State, near: f64) -> Option<f64> {
        let native = self.native.of(state).ok()?;
        self.resolution.after(&native, near)
    }

    /// Writes the value of every event's function at a state into `out`, one for each event.
    ///
    /// # Errors
    /// Returns an error if the state has no velocities or momenta that a function needs.
    pub fn observe(&mut self, state: &State, out: &mut [f64]) -> Result<(), MotionError> {
        self.native.write(state, &mut self.inputs)?;
        for (rounded, x) in self.rounded.iter_mut().zip(&self.inputs) {
            *rounded = x.high;
        }
        let found = self.quick.evaluate(state.time, &self.rounded);
        found.map_err(|why| {
            let program = &self.system.discontinuities().when;
            self.system.singular(program, why, state.time, &state.values)
        })?;
        for (i, x) in out.iter_mut().enumerate() {
            *x = self.quick.output(i);
        }
        Ok(())
    }

    /// The value of one event's function, in double-double.
    ///
    /// # Errors
    /// Returns an error if the state has no velocities or momenta that the function needs.
    pub fn exactly(&mut self, event: usize, state: &State) -> Result<DoubleDouble, MotionError> {
        self.native.write(state, &mut self.inputs)?;
        let found = self.exact.evaluate(state.exact_time(), &self.inputs);
        found.map_err(|why| {
            let program = &self.system.discontinuities().when;
            self.system.singular(program, why, state.time, &state.values)
        })?;
        Ok(self.exact.output(event))
    }
}

impl System {
    /// This system for motions whose events and crossings without effect nobody observes: these are located only where
    /// others are.
    #[must_use]
    pub fn without_marks(&self) -> System {
        let mark = |event: &CompiledEvent| {
            matches!(event.action.written(), Some(EventAction::Mark | EventAction::Section(_)))
        };
        let mut system = self.clone();
        system.unmarked = self.discontinuities().events.iter().all(mark);
        system
    }

    pub(super) fn locates_events(&self) -> bool {
        !self.unmarked && !self.discontinuities().events.is_empty()
    }

    /// Returns the evaluator of the events' functions, or `None` if there are no events.
    pub fn event_functions(&self, parameters: &[f64]) -> Option<EventFunctions> {
        if !self.locates_events() {
            return None;
        }
        let program = &self.discontinuities().when;
        let inputs = self.motion_len() + 2;
        let mut event_functions = EventFunctions {
            system: self.clone(),
            native: NativeStates::new(self),
            quick: Evaluator::new(Arc::clone(program)),
            exact: Evaluator::new(Arc::clone(program)),
            resolution: Resolution::new(
                self,
                Arc::clone(&self.discontinuities().variation),
                self.discontinuities().events.len(),
            ),
            expansion: None,
            rounded: vec![0.0; inputs],
            inputs: vec![DoubleDouble::ZERO; inputs],
        };
        event_functions.set_parameters(parameters);
        Some(event_functions)
    }
}
