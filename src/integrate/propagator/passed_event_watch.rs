//! How impulses that stop a motion and do not hold it are seen.
//!
//! In: the states before and after an impulse that an event caused, and where the next step leads. Out: the first such event. Never here:
//! the impulse itself, or what should be there instead.

use super::Propagator;
use super::passed_event::StoppedEvent;
use crate::system::{Form, State};

/// A rate below this part of that before is none.
const STOPPED: f64 = 1e-6;

/// The rate of an event's function is seen over a displacement by this part of the coordinates and 1.
const DISPLACED: f64 = 1e-6;

impl Propagator {
    /// The name of the event whose impulse was the first to stop the motion towards a side to which it continued all the same, and the time.
    pub fn passed_event(&self) -> Option<(&str, f64)> {
        let passed = self.passed.first?;
        let event = self.system.discontinuities().events.get(passed.event)?;
        Some((&event.name, passed.time))
    }

    /// Records an impulse of an event between two states.
    pub(super) fn note_impulse(&mut self, event: usize, before: &State, after: &State) {
        self.passed.open = None;
        if self.passed.first.is_some() {
            return;
        }
        // what the impulse itself changes, as a function of the velocities, is no place that is passed
        let values = [before, after].map(|state| self.search.value(event, state));
        if values[0] != values[1] {
            return;
        }
        let rates = [before, after].map(|state| self.event_rate(event, state));
        let [Some(before), Some(rate)] = rates else { return };
        let (side, size) = (before.signum(), before.abs());
        // one that only slows it, as a brake at a gate does, is meant to let it through
        if size > 0.0 && rate.abs() <= STOPPED * size {
            self.passed.open = Some(StoppedEvent { event, time: after.time, side });
        }
    }

    pub(super) fn note_side(&mut self) {
        let Some(open) = self.passed.open.take() else { return };
        let value = self.search.value(open.event, self.stepper.state());
        if value.is_some_and(|value| value * open.side > 0.0) {
            self.passed.first = Some(open);
        }
    }

    /// The rate of an event's function along the velocities of a state.
    fn event_rate(&mut self, event: usize, state: &State) -> Option<f64> {
        if state.form == Form::Variables {
            return None;
        }
        let state = self.system.convert(state, Form::Velocity, &self.parameters).ok()?;
        let n = self.system.degrees();
        let (places, speeds) = state.values.get(..2 * n)?.split_at(n);
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let speed = largest(speeds);
        if speed == 0.0 {
            return Some(0.0);
        }
        let interval = DISPLACED * (1.0 + largest(places)) / speed;
        let events = self.search.events.as_mut()?;
        let [later, earlier] = [interval, -interval].map(|after| {
            let mut there = state.clone();
            there.time += after;
            for i in 0..n {
                there.values[i] += after * state.values[n + i];
            }
            events.value(event, &there)
        });
        Some((later? - earlier?) / (2.0 * interval))
    }
}
