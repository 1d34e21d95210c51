//! The time line: time reversed, the recorded past shown, and marks on it.
//!
//! In: keys and the mouse on the time bar. Out: commands. Never here: how a motion runs backwards, or what is recorded.

use super::{App, Effect, Lab, Notification};
use crate::dynamics::{PhaseSpace, conformal_rate};
use crate::experiment::{Command, Recorded, Status};
use crate::expr::Expr;
use crate::num::short;

const MOST: usize = 32;

/// A key moves the time that is shown by this part of the recorded past.
const STEPS: f64 = 50.0;

/// Times closer together than this part of the recorded past are one.
const SAME: f64 = 1e-9;

impl App {
    /// Reverses time, and shows how the motion returns.
    pub(super) fn reverse(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some(seen) = lab.seen() else { return Vec::new() };
        if matches!(seen.status, Status::Failed(_)) {
            return self.notify("There is no motion to reverse: reset it with r.");
        }
        let (back, paused) = (!seen.backwards, seen.status != Status::Running);
        let sentence = if back { lab.what_grows() } else { None };
        if back {
            lab.show("separation");
        }
        self.notifications.shown = sentence.map(Notification::info);
        let mut effects = vec![Effect::Execute(Command::Reverse)];
        if paused {
            effects.push(Effect::Execute(Command::Play));
        }
        effects
    }

    /// Looks at another time of the recorded past, so many fiftieths of it later.
    pub(super) fn scrub_by(&mut self, by: f64) -> Vec<Effect> {
        let Some(seen) = self.lab.as_ref().and_then(Lab::seen) else { return Vec::new() };
        let Recorded { from, to, .. } = seen.recorded.clone();
        if from == to {
            return match &seen.recorded.changed {
                Some(last) => {
                    let why = format!("Nothing has been recorded since {} was changed.", last.what);
                    self.notify(why)
                }
                None => self.notify("Nothing has been recorded yet."),
            };
        }
        let time = seen.time + by * (to - from) / STEPS;
        let (low, high) = (from.min(to), from.max(to));
        vec![Effect::Execute(Command::ScrubTo(time.clamp(low, high)))]
    }

    /// Sets a mark at the time that is seen, or takes the mark there away.
    pub(super) fn mark_time(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some((time, near)) = lab.seen().map(|seen| {
            let Recorded { from, to, .. } = seen.recorded;
            (seen.time, SAME * (to - from).abs())
        }) else {
            return Vec::new();
        };
        let sentence = match lab.marks.iter().position(|mark| (mark - time).abs() <= near) {
            Some(index) => {
                lab.marks.remove(index);
                format!("Removed the mark at t = {}.", short(time))
            }
            None if lab.marks.len() == MOST => {
                return self
                    .notify(format!("There can be at most {MOST} marks; ; at a mark removes it."));
            }
            None => {
                lab.marks.push(time);
                lab.marks.sort_by(f64::total_cmp);
                format!("Mark set at t = {}; ' returns to it.", short(time))
            }
        };
        self.notifications.show(Notification::info(sentence));
        Vec::new()
    }

    /// Looks at the mark before the time that is seen, and from the first one at the last; or at the one after, and from
    /// the last one at the first.
    pub(super) fn go_to_mark(&mut self, back: bool) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(seen) = lab.seen() else { return Vec::new() };
        if lab.marks.is_empty() {
            return self.notify("No marks yet: press ; to set one.");
        }
        let Recorded { from, to, .. } = seen.recorded;
        let (low, high) = (from.min(to), from.max(to));
        let known = || lab.marks.iter().copied().filter(|mark| *mark >= low && *mark <= high);
        let same = SAME * (high - low);
        let mark = if back {
            known().rev().find(|mark| *mark < seen.time - same).or_else(|| known().next_back())
        } else {
            known().find(|mark| *mark > seen.time + same).or_else(|| known().next())
        };
        let Some(mark) = mark else {
            let times: Vec<String> = lab.marks.iter().map(|mark| short(*mark)).collect();
            return self.notify(format!(
                "The motion is known from t = {} to {}; the marks are at {}.",
                short(low),
                short(high),
                times.join(", ")
            ));
        };
        vec![Effect::Execute(Command::ScrubTo(mark))]
    }
}

impl Lab {
    /// What is said of a system whose energy is not conserved before its time is reversed.
    fn what_grows(&self) -> Option<String> {
        let seen = self.seen()?;
        let physics = self.loaded.physics();
        if physics.equations.energy_rate == Expr::ZERO {
            return None;
        }
        let space =
            PhaseSpace::of((physics.model, physics.equations, physics.system), &seen.parameters);
        let rate = space.ok().and_then(|space| {
            let state = space.state(&seen.state).ok()?;
            conformal_rate(&space, seen.time, [space.variables(&state)]).ok()?
        });
        match rate {
            Some(0.0) => None,
            Some(rate) if rate < 0.0 => Some(format!(
                "Running backwards, friction returns what it took: areas grow like e^{{{} t}}, and errors with them.",
                short(-rate)
            )),
            _ => Some(
                "The energy is not conserved here: what it lost comes back, and errors grow with it."
                    .to_owned(),
            ),
        }
    }
}
