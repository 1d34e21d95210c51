//! The work of a short step to or from an instant at which its rate grows without bound, as that of a drive |t|^p with p < 1 at
//! t = 0: by its definition, the change of the energy. No series of its rate converges there, and the powers in it may be any.
//!
//! In: the states at both ends of such a step. Out: the work at its end. Never here: the work where its rate has a value, which is
//! integrated, so that a gauge can hold it against the energy. Of these steps it sees nothing; they are vanishing, or held against
//! the same step in two parts (`collocation_step`).

use super::Taylor;
use crate::system::{MotionError, State};

/// A rate that is so many times that at the other end of a short step grows without bound.
const GROWN: f64 = 64.0;

impl Taylor {
    /// The rate of the work at a state, of which there may be no work, or no rate.
    fn work_rate(&mut self, state: &State) -> Option<f64> {
        let place = self.system.work_place()?;
        let numbers: Vec<_> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        self.rates.evaluate(state.exact_time(), &numbers).ok()?;
        Some(self.rates.rate(place).high.abs())
    }

    /// Whether the rate of the work grows without bound at a state, from that at the other end of a short step; the state is at the
    /// instant to the last digit of its time.
    fn is_work_singular(&mut self, state: &State, other: &State) -> bool {
        let rates = [state, other].map(|state| self.work_rate(state));
        let [Some(here), Some(there)] = rates else { return false };
        !here.is_finite() || here > GROWN * there
    }

    /// Takes the work of the last step, which has led from a state to such an instant. The law is that before it, where it also has
    /// a step in time there.
    pub(super) fn take_work_of_arrival(&mut self, from: &State) -> Result<(), MotionError> {
        let there = self.state.clone();
        if self.is_work_singular(&there, from) {
            let size = (there.exact_time() - from.exact_time()).high;
            let jump = self.system.across_step_in_time(&there, &self.parameters, size)?;
            self.take_work(from, jump.map_or(there, |(before, _)| before));
        }
        Ok(())
    }

    /// Takes the work of the last step, which has led away from such an instant.
    pub(super) fn take_work_of_departure(&mut self, from: &State) {
        let to = self.state.clone();
        if self.is_work_singular(from, &to) {
            self.take_work(from, to);
        }
    }

    /// Takes the change of the energy as work, if it has a value at both ends.
    fn take_work(&mut self, from: &State, to: State) {
        if let (Some(place), Ok(done)) =
            (self.system.work_place(), self.system.with_work((from, to), &self.parameters))
        {
            self.state.set(place, done.exact(place));
        }
    }
}
