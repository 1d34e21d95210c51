//! An experiment advanced: rows recorded when they are due, occurrences noted, errors kept.
//!
//! In: a time, a budget of steps and rows. Out: how far it came. Never here: commands.

use super::gauges::Gauges;
use super::running_experiment::Experiment;
use crate::integrate::{Occurrence, OccurrenceKind, Reached};

/// The number of the shortest row intervals that a step may cover.
pub(super) const HORIZON: f64 = 4096.0;

/// The greatest ratio of a step to the previous one.
const GROWTH: f64 = 8.0;

/// How far an advance came.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AdvanceOutcome {
    /// It reached the requested time.
    Arrived,
    /// It used up its steps before the requested time.
    Underway,
    /// It failed before the requested time.
    Stuck,
    /// An event ended the motion before the requested time, or it is back where the run before it began, and paused.
    Ended,
}

impl Experiment {
    /// Advances the motion until its [clock](Experiment::clock) is at `time`, recording and monitoring along the way, and stops early after `budget` steps
    /// and rows. It advances even while paused; the caller decides whether time runs.
    ///
    /// The motions beside it follow to the time reached, with a budget of the same size. One that is behind makes the
    /// result `Underway`.
    pub fn advance(&mut self, time: f64, budget: u64) -> AdvanceOutcome {
        let progress = match self.return_clock().filter(|home| *home <= time) {
            Some(home) => match self.advance_main(home, budget) {
                AdvanceOutcome::Arrived => self.finish_return(),
                other => other,
            },
            None => self.advance_main(time, budget),
        };
        self.advance_companions(budget);
        match progress {
            AdvanceOutcome::Arrived if self.is_behind() => AdvanceOutcome::Underway,
            other => other,
        }
    }

    /// The same for this motion alone.
    pub(super) fn advance_main(&mut self, time: f64, mut budget: u64) -> AdvanceOutcome {
        if self.run.error.is_some() {
            return AdvanceOutcome::Stuck;
        }
        if self.run.ended.is_some() {
            return AdvanceOutcome::Ended;
        }
        while self.recorder.due() <= time {
            match self.reach(self.recorder.due(), &mut budget) {
                AdvanceOutcome::Arrived => self.record(),
                other => return other,
            }
            if budget == 0 {
                return AdvanceOutcome::Underway;
            }
            budget -= 1;
        }
        if time <= self.clock() {
            return AdvanceOutcome::Arrived;
        }
        let progress = self.reach(time, &mut budget);
        if progress == AdvanceOutcome::Arrived {
            self.recorder.widen(self.motion.values());
            self.gauge(Gauges::observe);
        }
        progress
    }

    /// Advances the motion, or fails.
    fn reach(&mut self, time: f64, budget: &mut u64) -> AdvanceOutcome {
        // otherwise a polynomial motion would be over in one step; no other motion is limited by this
        let ahead = (HORIZON * self.setup.spacing).max(GROWTH * self.motion.step_size().abs());
        let end = self.setup.end.filter(|_| !self.is_backwards());
        let limit = end.unwrap_or(self.clock() + ahead).max(time);
        let reached = loop {
            // within steps that are longer than what lies between rows nothing is observed but these
            let spacing = if self.only_ends { 0.0 } else { self.recorder.spacing() };
            let gauges = (&mut self.gauges, spacing);
            match self.motion.reach(time, limit, budget, gauges) {
                Ok(Reached::Occurred(Occurrence {
                    kind: OccurrenceKind::Crossing(surface),
                    time,
                    ..
                })) => {
                    let time = self.motion.sign() * time;
                    self.log.crossings.push(surface, time, self.motion.values());
                }
                Ok(Reached::Occurred(occurrence)) => {
                    let name = occurrence.name.clone();
                    match self.note(occurrence) {
                        Ok(sentence) => self.notices.push_once(name, sentence),
                        Err(error) => break Err(error),
                    }
                }
                other => break other,
            }
        };
        if let Some(sentence) = self.singular_passages() {
            self.notices.push_once("singular configuration".to_owned(), sentence);
        }
        if let Some(sentence) = self.comparison_passage() {
            self.notices.push_once(sentence.clone(), sentence);
        }
        if let Some(sentence) = self.passed_event() {
            self.notices.push_once(sentence.clone(), sentence);
        }
        for sentence in self.vanishing_events() {
            self.notices.push_once(sentence.clone(), sentence);
        }
        if let Some(sentence) = self.narrow_passage() {
            self.notices.push_once(sentence.clone(), sentence);
        }
        if let Some(sentence) = self.unstable() {
            self.notices.push_once(sentence.clone(), sentence);
        }
        match reached {
            Ok(Reached::Arrived | Reached::Occurred(_)) => AdvanceOutcome::Arrived,
            Ok(Reached::OutOfBudget) => AdvanceOutcome::Underway,
            Ok(Reached::Ended) => AdvanceOutcome::Ended,
            Err(error) => {
                // show what was computed before the error, as far as possible
                let _ = self.motion.reach_end();
                self.run.error = Some(self.motion.dated(error).into());
                AdvanceOutcome::Stuck
            }
        }
    }

    /// Records the current values as the row that is due.
    pub(super) fn record(&mut self) {
        self.row_spacing.row_recorded();
        // what was lost between two rows, as an image at a caustic, is not joined
        if let Some(values) = self.motion.parting() {
            self.recorder.insert(self.motion.clock(), &values);
        }
        self.recorder.record(self.motion.clock(), self.motion.values());
        if !self.is_backwards() {
            self.companions.expect(self.motion.time(), self.motion.values());
        }
        self.compare_with_echo(self.motion.time());
        let spacing = self.row_spacing.to_next(&self.setup, &self.motion);
        self.recorder.set_spacing(spacing);
        let dense = self.recorder.spacing() <= self.motion.step_size().abs();
        self.gauge(|gauges, now| gauges.sample(now, dense));
    }
}
