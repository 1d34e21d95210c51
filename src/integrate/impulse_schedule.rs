//! When impulses fall: at their listed times and at every multiple of their interval, each once.
//!
//! In: the schedule of every impulse, the present. Out: the next time, and which impulse is due. Never
//! here: what an impulse does.

use super::clock::spacing;
use crate::num::DoubleDouble;
use crate::system::Schedule;

/// The impulses of one motion.
#[derive(Clone, Debug, Default)]
pub(super) struct ImpulseSchedule {
    schedule: Vec<Schedule>,
    start: f64,
    /// The last impulse that fell, and when.
    fallen: Option<(f64, usize)>,
}

impl ImpulseSchedule {
    /// Takes another schedule; what has fallen stays so.
    pub(super) fn reschedule(&mut self, schedule: Vec<Schedule>) {
        self.schedule = schedule;
    }

    /// Counts from here, with nothing fallen.
    pub(super) fn begin(&mut self, start: f64) {
        self.start = start;
        self.fallen = None;
    }

    /// All that falls at this time has fallen.
    pub(super) fn pass(&mut self, now: f64) {
        self.fallen = Some((now, usize::MAX));
    }

    /// Whether an impulse has not fallen at a time yet: of several at one time those further down
    /// in the file are still to fall.
    fn is_open(&self, impulse: usize, time: f64) -> bool {
        time > self.start && self.fallen.is_none_or(|(at, last)| at != time || impulse > last)
    }

    /// The first time from `now` on at which an impulse falls that has not.
    fn next_of(&self, impulse: usize, now: f64) -> Option<f64> {
        let schedule = &self.schedule[impulse];
        let open = |time: &f64| *time >= now && self.is_open(impulse, *time);
        let listed = schedule.times.iter().map(|time| time.high).filter(open);
        let periodic = schedule.interval.and_then(|interval| {
            let count = ((now - self.start) / interval.high).floor().max(1.0);
            let time = |k: i32| {
                (DoubleDouble::written(self.start) + interval * (count + f64::from(k))).high
            };
            (-1..=2).map(time).find(open)
        });
        listed.chain(periodic).min_by(f64::total_cmp)
    }

    /// The first time from `now` on at which an impulse falls that has not.
    pub(super) fn next(&self, now: f64) -> Option<f64> {
        let all = 0..self.schedule.len();
        all.filter_map(|i| self.next_of(i, now)).min_by(f64::total_cmp)
    }

    /// Whether the clock cannot tell two impulses of an impulse apart.
    pub(super) fn stands_still(&self, now: f64) -> bool {
        let mut intervals = self.schedule.iter().filter_map(|schedule| schedule.interval);
        intervals.any(|interval| interval.high < spacing(now))
    }

    /// The impulse that falls now, if one does.
    pub(super) fn due(&self, now: f64) -> Option<usize> {
        (0..self.schedule.len()).find(|&i| self.next_of(i, now) == Some(now))
    }

    /// An impulse falls now: its time beyond the last digit.
    pub(super) fn apply_scheduled(&mut self, impulse: usize, now: f64) -> DoubleDouble {
        self.fallen = Some((now, impulse));
        self.schedule[impulse].exactly(self.start, now)
    }
}
