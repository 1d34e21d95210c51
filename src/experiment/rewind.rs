//! One step back in time, exact by dense output.
//!
//! In: an experiment with its log of steps. Out: the experiment as it was a frame earlier. Never here: motions that run
//! backwards.

use super::Experiment;
use super::advance::HORIZON;
use super::execute::FRAME;
use super::gauges::Gauges;
use crate::num::short;

impl Experiment {
    /// Takes a paused motion back by so many frames. What was recorded after that time is gone.
    pub(super) fn step_back(&mut self, count: u32) {
        self.run.running = false;
        if !self.motion.has_begun() {
            return;
        }
        let now = self.clock();
        let time = (now - f64::from(count) * self.frame()).max(self.reversal.began);
        if time >= now {
            return self.notify("this is the beginning of the motion".to_owned());
        }
        self.rewind_to(time);
    }

    /// The time of a frame on the screen.
    pub(super) fn frame(&self) -> f64 {
        let speed =
            if self.setup.speed.is_finite() { self.setup.speed } else { self.model.run.speed };
        FRAME * speed
    }

    /// Takes the motion back to a reading of its clock. What was recorded after it is gone.
    pub(super) fn rewind_to(&mut self, time: f64) {
        let sign = self.motion.sign();
        let impulses = self.motion.impulses();
        // no step ends early that did not when it was first taken
        let limit = time + HORIZON * self.setup.spacing;
        match self.motion.back_to((time, limit), self.setup.start) {
            Err(error) => {
                self.run.error = Some(self.motion.dated(error).into());
                return;
            }
            Ok(Some(first)) if first.is_finite() => {
                return self.notify(format!(
                    "the motion before t = {} is no longer recorded",
                    short(sign * first)
                ));
            }
            Ok(Some(_)) => {
                return self.notify("the motion before this is no longer recorded".to_owned());
            }
            Ok(None) => {}
        }
        self.run.error = None;
        self.run.ended = None;
        self.recorder.rewind(time);
        if sign > 0.0 {
            self.companions.forget_rows_after(time);
        }
        self.log.rewind(sign * time, sign, self.motion.values().len());
        // an impulse has shifted what the gauges measure from
        if self.motion.impulses() == impulses {
            self.gauge(Gauges::observe);
        } else {
            self.gauge(Gauges::refer);
        }
        self.record();
    }
}
