//! The flow from the phase of a stroboscope back to that of the initial values.
//!
//! A motion that is to pass a point of a stroboscope at its first instant begins where the flow of the reversed system carries
//! that point in the time between. No impulse lies between: what it changed is not known before it has acted.
//!
//! In: a system and its reversed twin, a point as a start. Out: the start at the time of the initial values. Never here: which
//! point.

use super::not_in_plane::NotInPlane;
use super::section::{OrbitStatus, SectionPlan, crossings};
use super::start::Start;
use crate::integrate::{Method, OccurrenceKind, Propagator, Reached, Settings};
use crate::system::{State, System};

/// The steps in which a first instant is searched for, and those in which a point is carried back.
const STEPS: u64 = 100_000;

/// The flow back from the first instant of a stroboscope.
pub struct PhaseShift {
    backwards: System,
    method: &'static Method,
    settings: Settings,
    parameters: Vec<f64>,
    /// The time of the first instant, and that of the initial values.
    instant: f64,
    time: f64,
}

impl PhaseShift {
    /// The shift to the start's time from the first instant after it of the stroboscope with this event. `backwards` is the
    /// [reversed](System::reversed) system.
    ///
    /// # Errors
    /// Returns an error if there is no such instant, or an impulse before it.
    pub fn new(
        (system, backwards): (&System, System),
        (method, settings): (&'static Method, Settings),
        start: &Start,
        event: usize,
    ) -> Result<PhaseShift, NotInPlane> {
        let plan =
            SectionPlan { event, count: Some(1), until: None, idle: STEPS, all_channels: false };
        let found = crossings(system, method, settings, start, &plan);
        let (OrbitStatus::Completed, Some(&[instant, ..])) =
            (found.status, found.rows.first().map(Vec::as_slice))
        else {
            return Err(NotInPlane::OtherPhase(start.time));
        };
        let (time, parameters) = (start.time, start.parameters.clone());
        let between = |at: f64| at > time && at <= instant;
        let acts = system.schedule(&parameters).iter().any(|impulse| {
            let first = impulse.interval.map(|interval| time + interval.high);
            impulse.times.iter().map(|at| at.high).chain(first).any(between)
        });
        if acts {
            return Err(NotInPlane::ImpulseBetween { time, instant });
        }
        Ok(PhaseShift { backwards, method, settings, parameters, instant, time })
    }

    /// The start from which a motion comes to these initial values, given at the first instant.
    ///
    /// # Errors
    /// Returns an error if they are no state, or if the motion cannot be followed back or an impulse acts on it.
    pub fn back(&self, system: &System, given: &Start) -> Result<Start, NotInPlane> {
        let parameters = &self.parameters;
        let there = Start { time: self.instant, ..given.clone() }.state(system)?;
        let state = self.carried(&reversed(&there))?;
        let state = system.convert(&state, system.form(), parameters)?;
        let count = 2 * system.degrees();
        let values = state.values.iter().take(count).enumerate();
        let overrides = values.map(|(i, &x)| system.initial_override(i, x)).collect();
        Ok(Start { time: self.time, parameters: parameters.clone(), overrides })
    }

    /// The state of the reversed system at the time of the initial values, dated by that time.
    fn carried(&self, state: &State) -> Result<State, NotInPlane> {
        let parameters = &self.parameters;
        let mut motion = Propagator::new(&self.backwards, self.method, self.settings, parameters)?;
        motion.begin(state, parameters)?;
        let (end, mut budget) = (-self.time, STEPS);
        loop {
            match motion.reach(end, end, &mut budget)? {
                Reached::Arrived => return Ok(reversed(motion.state())),
                Reached::Occurred(occurrence) => match occurrence.kind {
                    OccurrenceKind::Mark
                    | OccurrenceKind::Crossing(_)
                    | OccurrenceKind::StepInTime => {}
                    _ => return Err(self.impulse_between()),
                },
                Reached::OutOfBudget => return Err(NotInPlane::OtherPhase(self.time)),
                Reached::Ended => return Err(self.impulse_between()),
            }
        }
    }

    fn impulse_between(&self) -> NotInPlane {
        NotInPlane::ImpulseBetween { time: self.time, instant: self.instant }
    }
}

/// The same state in the other sense of time.
fn reversed(state: &State) -> State {
    State { time: -state.time, time_carry: -state.time_carry, ..state.clone() }
}
