//! What is known of the events' functions after the state jumped, or a constraint let go.
//!
//! In: the states before and after. Out: sides that are kept, and functions that leave their zeros. Never here: the search.

use super::EventLocator;
use crate::integrate::located_event::{EventRole, is_same_time};
use crate::integrate::sampling::SIGNLESS;
use crate::num::DoubleDouble;
use crate::system::{MotionError, State};

impl EventLocator {
    /// Records an impulse from one state to another, caused by the given event or by none.
    /// The sides of functions that jumped with it become unknown, as they did not cross zero.
    pub(in crate::integrate) fn after_impulse(
        &mut self,
        before: &State,
        after: &State,
        event: Option<usize>,
    ) -> Result<(), MotionError> {
        let old = self.probe.of(before)?.to_vec();
        let new = self.probe.of(after)?;
        for (i, (old, new)) in old.iter().zip(new).enumerate() {
            // the event that caused it, and those that saw its time as one of their zeros, at an impulse before it too, which they
            // have not left yet
            let is_seen = is_same_time(before.time, self.last[i])
                || self.beside.crossing.contains(&i)
                || self.sides[i] == 0.0 && self.leaving[i].is_some();
            let leaves =
                event == Some(i) || event.is_some() && self.roles[i] == EventRole::Sees && is_seen;
            self.leaving[i] = leaves.then_some([old.abs(), 0.0]);
            self.last[i] = if leaves { before.time } else { f64::NAN };
            if leaves || (old - new).abs() > 1e-12 * (old.abs() + new.abs()) {
                self.sides[i] = 0.0;
            }
        }
        self.fresh = true;
        self.probe.begin(Some(after.exact_time()));
        self.simple = None;
        Ok(())
    }

    /// The motion must not be evaluated before this time, at which it begins.
    pub(in crate::integrate) fn begin_at(&mut self, time: DoubleDouble) {
        self.probe.begin(Some(time));
    }

    /// Records the release of a constraint at a state. Functions that did not jump with it keep the
    /// side given by `known`.
    pub(in crate::integrate) fn inherit(
        &mut self,
        mut known: EventLocator,
        state: &State,
    ) -> Result<(), MotionError> {
        let (old, new) = (known.probe.of(state)?, self.probe.of(state)?);
        for (i, (old, new)) in old.iter().zip(new).enumerate() {
            let same = (old - new).abs() <= 1e-12 * (old.abs() + new.abs());
            self.sides[i] = if same { known.sides[i] } else { 0.0 };
            let is_freed = !known.may_cross[i] && self.may_cross[i];
            self.leaving[i] = is_freed.then_some([old.abs(), SIGNLESS]);
        }
        self.fresh = true;
        Ok(())
    }
}
