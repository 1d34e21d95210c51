//! A motion beside the main one, on its way.
//!
//! In: a state, parameters, a method; the times at which the main motion was recorded. Out: rows at the same times, and
//! the distance from the main motion. Never here: which companions there are, see `companions`.

use std::collections::VecDeque;
use std::sync::Arc;

use super::Trail;
use super::companion::{Companion, CompanionOrigin};
use super::companion_record::{CompanionRecord, DueRow, RecordSeen};
use super::step_log::{LoggedState, StepLog};
use crate::analysis::DistanceHistory;
use crate::integrate::{Method, OccurrenceKind, Propagator, Reached, Settings, Stepping};
use crate::num::short;
use crate::system::{MotionError, Observer, State, System};

/// The most rows of the main motion that a companion may be behind; beyond it, it skips every second one.
const MOST_DUE: usize = 16_384;

/// The most steps from a row to a time before the next one.
const MOST_STEPS_BACK: u64 = 100_000;

/// The greatest ratio of a step to the previous one.
const GROWTH: f64 = 8.0;

/// What a companion has yet to meet on its way, at a time of the main motion.
enum Upcoming {
    /// A row of the main motion.
    Row(DueRow),
    /// Another law or method.
    Change(f64, CompanionChange),
}

/// What of the main motion a companion takes over, if it follows it.
#[derive(Clone)]
pub(super) enum CompanionChange {
    /// Other parameters; q and p stay.
    Parameters(Vec<f64>),
    /// Another method, which suits the system because the main motion has it.
    Method(&'static Method, Settings),
}

pub(super) struct CompanionMotion {
    pub(super) number: usize,
    pub(super) origin: CompanionOrigin,
    pub(super) parameters: Vec<f64>,
    motion: Propagator,
    observer: Observer,
    active_set_changes: u64,
    record: CompanionRecord,
    due: VecDeque<Upcoming>,
    /// Where it was at the rows of the main motion, so that it can be carried back.
    log: StepLog,
    message: Option<String>,
}

impl CompanionMotion {
    /// A companion that has yet to [begin](CompanionMotion::begin); its rows take at most `numbers` numbers, and so do its states
    /// at their times.
    ///
    /// # Errors
    /// Returns an error if the method does not suit the system.
    pub(super) fn new(
        system: &System,
        (method, settings): (&'static Method, Settings),
        (number, origin): (usize, CompanionOrigin),
        parameters: &[f64],
        numbers: usize,
    ) -> Result<CompanionMotion, crate::integrate::MethodError> {
        Ok(CompanionMotion {
            number,
            origin,
            parameters: parameters.to_vec(),
            motion: Propagator::new(system, method, settings, parameters)?,
            observer: system.observer(parameters),
            active_set_changes: 0,
            record: CompanionRecord::new(system, numbers),
            due: VecDeque::new(),
            log: StepLog::bounded(numbers),
            message: None,
        })
    }

    /// Begins at a state. Nothing of what was recorded remains.
    pub(super) fn begin(&mut self, state: Result<State, MotionError>) {
        for upcoming in std::mem::take(&mut self.due) {
            if let Upcoming::Change(_, CompanionChange::Method(method, settings)) = upcoming {
                let suits = self.motion.change_method(method, settings).is_ok();
                debug_assert!(suits, "the main motion has it");
            }
        }
        self.clear(state.as_ref().map_or(0.0, |state| state.time));
        self.carry_on_from(state, true);
    }

    /// Begins on the way: at a state of a motion that began at `start`, from which impulses are counted, with these constraints
    /// released and, if steps are fixed and it is known, with this step.
    pub(super) fn begin_underway(
        &mut self,
        (state, step): (&State, Option<f64>),
        (start, released): (f64, &[usize]),
    ) {
        self.clear(state.time);
        let begun = match step {
            Some(step) => self.motion.restore_with_step(state, step, (start, released)),
            None => self.motion.restore(state, &self.parameters, start, released),
        };
        self.note_begun(begun);
    }

    /// Whether a step that a method of this name has chosen is one of this motion: none was set, and the method is the same.
    pub(super) fn may_have_chosen(&self, method: Option<&str>) -> bool {
        let own = self.motion.method().name;
        self.motion.settings().step.is_none() && method.is_none_or(|method| method == own)
    }

    fn clear(&mut self, time: f64) {
        self.record.clear(time);
        self.due.clear();
        self.log.clear();
    }

    fn note_begun(&mut self, begun: Result<(), MotionError>) {
        self.take_observer();
        self.message = begun.and_then(|()| self.observe()).err().map(|error| error.to_string());
        self.log_state();
    }

    /// Goes on from a state, with its parameters.
    fn carry_on_from(&mut self, state: Result<State, MotionError>, anew: bool) {
        let begun = state.and_then(|state| {
            if anew {
                self.motion.begin(&state, &self.parameters)
            } else {
                self.motion.continue_from(&state, &self.parameters)
            }
        });
        self.note_begun(begun);
    }

    fn log_state(&mut self) {
        let (steps, step) = (self.motion.steps(), self.motion.step_size().abs());
        self.log.push(self.motion.state(), steps, step);
    }

    /// The main motion has changed at a time, where this one does as well once it is there.
    pub(super) fn expect_change(&mut self, time: f64, change: CompanionChange) {
        let is_there = self.due.is_empty() && self.motion.state().time >= time;
        if is_there || self.message.is_some() {
            self.take(change);
        } else {
            self.due.push_back(Upcoming::Change(time, change));
        }
    }

    fn take(&mut self, change: CompanionChange) {
        let state = match change {
            CompanionChange::Parameters(parameters) => {
                let old = std::mem::replace(&mut self.parameters, parameters);
                self.record.crossings.clear();
                let system = self.motion.system();
                system.change_parameters(self.motion.state(), &old, &self.parameters)
            }
            CompanionChange::Method(method, settings) => {
                if self.motion.change_method(method, settings).is_err() {
                    return;
                }
                Ok(self.motion.state().clone())
            }
        };
        if self.message.is_none() {
            // what came before has another law
            self.log.clear();
            self.carry_on_from(state, false);
        }
    }

    /// The main motion was carried back to a time: rows after it are yet to come.
    pub(super) fn forget_rows_after(&mut self, time: f64) {
        self.due.retain(|upcoming| match upcoming {
            Upcoming::Row((row, _)) => *row <= time,
            Upcoming::Change(..) => true,
        });
    }

    /// From a time on, at which it was before, the main motion is another one: the distances after it are gone.
    pub(super) fn forget_distances_after(&mut self, time: f64) {
        Arc::make_mut(&mut self.record.separation).rewind(time);
    }

    /// Carries it back to a time at which it was before, of a motion that began at `start`. What was recorded after that time is
    /// gone.
    pub(super) fn go_back(&mut self, time: f64, start: f64) {
        if self.motion.state().time <= time {
            return;
        }
        self.record.rewind(time);
        self.due.clear();
        let Some(LoggedState { state, steps, step, .. }) = self.log.back_to(time) else {
            let first = self.log.first().unwrap_or(f64::NAN);
            self.message = Some(format!("nothing is known of it before t = {}", short(first)));
            return;
        };
        let begun = self.retrace((&state, step, steps), time, start);
        self.note_begun(begun);
    }

    /// Goes from a state of before to a time after it.
    fn retrace(
        &mut self,
        (state, step, steps): (&State, f64, u64),
        time: f64,
        start: f64,
    ) -> Result<(), MotionError> {
        let released = self.released();
        self.motion.restore_with_step(state, step, (start, &released))?;
        self.motion.set_steps(steps);
        let mut budget = MOST_STEPS_BACK;
        while let Reached::Occurred(_) = self.motion.reach(time, time, &mut budget)? {}
        Ok(())
    }

    /// Forgets the crossings of surfaces of section.
    pub(super) fn forget_crossings(&mut self) {
        self.record.crossings.clear();
    }

    /// Prepends what the main motion has recorded.
    pub(super) fn precede(&mut self, earlier: &Trail) {
        self.record.rows.precede(earlier, |row| Some(row.to_vec()));
    }

    /// The main motion has a new row.
    pub(super) fn expect(&mut self, due: DueRow) {
        // it has been there before the main motion was carried back
        if self.message.is_some() || due.0 < self.motion.state().time {
            return;
        }
        if self.due.len() >= MOST_DUE {
            let mut index = 0;
            self.due.retain(|upcoming| {
                index += 1;
                index % 2 == 0 || matches!(upcoming, Upcoming::Change(..))
            });
        }
        self.due.push_back(Upcoming::Row(due));
    }

    /// Whether it has not yet reached a time.
    pub(super) fn is_behind(&self, time: f64) -> bool {
        self.message.is_none() && (!self.due.is_empty() || self.motion.state().time < time)
    }

    /// Advances to a time in at most `budget` steps and rows. `variables` are the channels of the canonical variables,
    /// with their periods.
    pub(super) fn advance(
        &mut self,
        time: f64,
        ahead: f64,
        budget: &mut u64,
        (variables, periods): (&[usize], &[Option<f64>]),
    ) {
        while *budget > 0 && self.is_behind(time) {
            let next = match self.due.front() {
                Some(Upcoming::Row((time, _)) | Upcoming::Change(time, _)) => *time,
                None => time,
            };
            let outcome = if next <= self.motion.state().time {
                Ok(true)
            } else {
                self.reach(next, ahead, budget)
            };
            match outcome {
                Ok(true) => {
                    *budget = budget.saturating_sub(1);
                    match self.due.pop_front() {
                        Some(Upcoming::Row(main)) => {
                            self.record.add_row(&main, variables, periods);
                            self.log_state();
                        }
                        Some(Upcoming::Change(_, change)) => self.take(change),
                        None => {}
                    }
                }
                Ok(false) => return,
                Err(message) => {
                    self.message = Some(message);
                    self.due.clear();
                }
            }
        }
    }

    /// Advances to a time. Returns whether it is there, or why it never will be.
    fn reach(&mut self, time: f64, ahead: f64, budget: &mut u64) -> Result<bool, String> {
        let now = self.motion.state().time;
        let limit = (now + ahead.max(GROWTH * self.motion.step_size().abs())).max(time);
        loop {
            let reached = self.motion.reach(time, limit, budget).map_err(|why| why.to_string())?;
            match reached {
                Reached::Arrived => {
                    self.observe().map_err(|why| why.to_string())?;
                    return Ok(true);
                }
                Reached::OutOfBudget => return Ok(false),
                Reached::Ended => return Err("an event has ended it".to_owned()),
                Reached::Occurred(occurrence) => {
                    self.observe().map_err(|why| why.to_string())?;
                    match occurrence.kind {
                        OccurrenceKind::Crossing(surface) => {
                            self.record.add_crossing(surface, occurrence.time);
                        }
                        // what came before has other constraints
                        OccurrenceKind::Release(_) => {
                            self.log.clear();
                            self.log_state();
                        }
                        _ => {}
                    }
                }
            }
        }
    }

    fn take_observer(&mut self) {
        self.active_set_changes = self.motion.active_set_changes();
        self.observer = self.motion.system().observer(&self.parameters);
    }

    fn observe(&mut self) -> Result<(), MotionError> {
        if self.motion.system().constraints() > 0
            || self.active_set_changes != self.motion.active_set_changes()
        {
            self.take_observer();
        }
        self.observer.observe(self.motion.state(), &mut self.record.values)
    }

    /// The step in use, if all steps are equal and it is known.
    fn fixed_step(&self) -> Option<f64> {
        let is_fixed = self.motion.method().stepping == Stepping::Fixed;
        Some(self.motion.step_size().abs()).filter(|step| is_fixed && *step > 0.0)
    }

    fn released(&self) -> Arc<[usize]> {
        let system = self.motion.system();
        (0..system.constraints()).filter(|&k| system.is_released(k)).collect()
    }

    pub(super) fn separation(&self) -> Arc<DistanceHistory> {
        Arc::clone(&self.record.separation)
    }

    /// What is seen of it at the time of the main motion, which may have been carried back.
    pub(super) fn shown(&self, now: f64) -> Companion {
        let RecordSeen { time, values, trail, crossings } =
            self.record.seen(self.motion.state().time, now);
        Companion {
            number: self.number,
            origin: self.origin.clone(),
            time,
            values,
            parameters: self.parameters.as_slice().into(),
            method: self.motion.method().name,
            settings: self.motion.settings(),
            fixed_step: self.fixed_step(),
            released: self.released(),
            state: Arc::new(self.motion.state().clone()),
            trail,
            crossings,
            message: self.message.clone(),
        }
    }
}
