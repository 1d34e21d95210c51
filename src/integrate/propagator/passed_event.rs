//! Impulses at events that do not turn the motion back: a ball whose restitution is 0 falls through its floor.
//!
//! In: the states before and after an impulse that an event caused, and where the next step leads. Out: the first such event. Never here:
//! the impulse itself, or what should be there instead.

use super::Propagator;
use crate::system::{Form, State};

/// Rates are compared to this part of them.
const ALIKE: f64 = 1e-9;

/// The rate of an event's function is seen over a displacement by this part of the coordinates and 1.
const DISPLACED: f64 = 1e-6;

/// An event whose impulse slowed the motion and did not turn it back.
#[derive(Clone, Copy, Debug)]
struct SlowedEvent {
    event: usize,
    time: f64,
    /// The sign that its function was about to have.
    side: f64,
}

/// What is known of such events along one motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PassedEvents {
    /// The last one, until a step has shown to which side it leads.
    open: Option<SlowedEvent>,
    /// The first after which the motion went on to the other side.
    first: Option<SlowedEvent>,
}

impl Propagator {
    /// The name of the event whose impulse was the first to slow the motion without turning it back, so that it went on to the side it
    /// came to, and the time.
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
        let rates = [before, after].map(|state| self.event_rate(event, state));
        let [Some(before), Some(rate)] = rates else { return };
        let (side, size) = (before.signum(), before.abs());
        let slowed = rate * side > -ALIKE * size && rate * side < (1.0 - ALIKE) * size;
        if size > 0.0 && slowed {
            self.passed.open = Some(SlowedEvent { event, time: after.time, side });
        }
    }

    /// Records the end of a step.
    pub(super) fn note_side(&mut self) {
        let Some(open) = self.passed.open.take() else { return };
        let value = self.crossings.as_mut().and_then(|c| c.value(open.event, self.stepper.state()));
        if value.is_some_and(|value| value * open.side > 0.0) {
            self.passed.first = Some(open);
        }
    }

    /// The rate of an event's function along the velocities of a state.
    fn event_rate(&mut self, event: usize, state: &State) -> Option<f64> {
        let state = self.system.convert(state, Form::Velocity, &self.parameters).ok()?;
        let n = self.system.degrees();
        let (places, speeds) = state.values.get(..2 * n)?.split_at(n);
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let speed = largest(speeds);
        if speed == 0.0 {
            return Some(0.0);
        }
        let interval = DISPLACED * (1.0 + largest(places)) / speed;
        let crossings = self.crossings.as_mut()?;
        let [later, earlier] = [interval, -interval].map(|after| {
            let mut there = state.clone();
            there.time += after;
            for i in 0..n {
                there.values[i] += after * state.values[n + i];
            }
            crossings.value(event, &there)
        });
        Some((later? - earlier?) / (2.0 * interval))
    }
}
