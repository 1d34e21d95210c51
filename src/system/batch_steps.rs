//! Equal steps of several orbits at once, each from its own state, in its own step and with its own parameters.
//!
//! In: a state, a step and parameters for each lane. Out: states after many steps, those that the orbit alone has, to the
//! last bit. Never here: counting, limits in time.

use super::state::State;
use crate::num::{BATCH, Batch};

/// The steps of one method.
pub trait BatchSteps {
    /// Sets the parameters of a lane. Returns false if its numbers may leave the range of `f64`, so
    /// that the orbit must be followed by itself.
    #[must_use]
    fn set_parameters(&mut self, lane: usize, parameters: &[f64]) -> bool;

    /// Sets the step of a lane.
    fn set_step(&mut self, lane: usize, step: f64);

    /// Sets the numbers of a lane.
    fn set_state(&mut self, lane: usize, state: &State);

    /// Takes `count` steps, at least one, in all lanes; `times` are those at which each of them begins.
    fn advance(&mut self, count: u64, times: impl Fn(u64) -> Batch);

    /// Whether the numbers of each lane are finite.
    fn are_finite(&self) -> [bool; BATCH];

    /// Writes the numbers of a lane into `out`, and those before the last step into `before`.
    fn write(&self, lane: usize, out: &mut State, before: &mut State);
}
