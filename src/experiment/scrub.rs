//! The recorded past shown again, which changes nothing: the motion stays where it is, and what was recorded stays too.
//!
//! In: a time between the first step that is known and now. Out: a snapshot of that time, exact by dense output. Never
//! here: the step that takes the motion itself back (`rewind`).

use super::advance::HORIZON;
use super::{Command, Experiment, Recorded};
use crate::num::short;

impl Experiment {
    /// Pauses, and shows a time in the past, of this motion and of the run before.
    pub(super) fn scrub_to(&mut self, time: f64) {
        self.show_recorded(time);
        let now = self.seen().time();
        if let Some(echo) = &mut self.reversal.echo {
            echo.scrub_to(now, HORIZON * self.setup.spacing);
        }
    }

    fn show_recorded(&mut self, time: f64) {
        self.run.running = false;
        if !self.motion.has_begun() || time.is_nan() {
            return;
        }
        let (sign, Recorded { from, to, .. }) = (self.motion.sign(), self.recorded());
        if sign * time >= sign * to {
            self.scrubbed = None;
            return;
        }
        if sign * time < sign * from {
            let side = if sign < 0.0 { "after" } else { "before" };
            self.notify(format!("the motion {side} t = {} is no longer recorded", short(from)));
        }
        let time = if sign * time < sign * from { from } else { time };
        let (horizon, start) = (HORIZON * self.setup.spacing, self.schedule_start());
        let Some(known) = self.motion.known_at(time, start) else { return };
        let viewer = match self.scrubbed.take() {
            Some(viewer) => Ok(*viewer),
            None => self.motion.another(&self.setup.parameters),
        };
        let mut motion = match viewer {
            Ok(motion) => motion,
            Err(why) => return self.notify(why.to_string()),
        };
        if motion.go_to(time, &known, horizon) {
            motion.observe_terms();
            self.scrubbed = Some(Box::new(motion));
        } else {
            self.notify(format!("t = {} can no longer be shown", short(time)));
        }
    }

    /// Does what a command means while the past is shown. Returns whether that was all: otherwise the motion has been
    /// carried back to the time that is shown, or is about to begin again.
    pub(super) fn scrubs(&mut self, command: &Command) -> bool {
        let Some(scrubbed) = &self.scrubbed else { return false };
        let (time, sign) = (scrubbed.time(), self.motion.sign());
        match command {
            Command::ScrubTo(_) | Command::Speed(_) | Command::Follow(_) => false,
            Command::Pause => true,
            Command::Step(count) => {
                self.scrub_to(time + sign * f64::from(*count) * self.frame());
                true
            }
            Command::StepBack(count) => {
                let earlier = time - sign * f64::from(*count) * self.frame();
                let from = self.recorded().from;
                self.scrub_to(if sign * earlier < sign * from { from } else { earlier });
                true
            }
            Command::Reset
            | Command::FullReset
            | Command::Start(_)
            | Command::Initial { .. }
            | Command::Restore(_) => {
                self.scrubbed = None;
                false
            }
            _ => {
                self.scrubbed = None;
                self.rewind_to(sign * time);
                false
            }
        }
    }
}
