//! The times of impulses: at their listed times and at every multiple of their interval, each once.
//!
//! In: the schedule of every impulse, the current time. Out: the next time, and which impulse is
//! due. Never here: what an impulse does.

use super::clock::spacing;
use crate::num::DoubleDouble;
use crate::system::ImpulseTimes;

#[derive(Clone, Debug, Default)]
pub(super) struct ImpulseSchedule {
    schedule: Vec<ImpulseTimes>,
    start: f64,
    /// The time and index of the last impulse applied.
    applied: Option<(f64, usize)>,
}

impl ImpulseSchedule {
    /// Replaces the schedule; impulses already applied are not repeated.
    pub(super) fn reschedule(&mut self, schedule: Vec<ImpulseTimes>) {
        self.schedule = schedule;
    }

    /// Whether there are no impulses at any time.
    pub(super) fn is_empty(&self) -> bool {
        let timed =
            |schedule: &ImpulseTimes| schedule.interval.is_some() || !schedule.times.is_empty();
        !self.schedule.iter().any(timed)
    }

    /// Counts from here, with no impulse applied.
    pub(super) fn begin(&mut self, start: f64) {
        self.start = start;
        self.applied = None;
    }

    /// Marks all impulses at this time as applied.
    pub(super) fn pass(&mut self, now: f64) {
        self.applied = Some((now, usize::MAX));
    }

    /// Whether an impulse at a time has not been applied yet. Impulses at the same time are applied
    /// in the order of the file.
    fn is_open(&self, impulse: usize, time: f64) -> bool {
        time > self.start && self.applied.is_none_or(|(at, last)| at != time || impulse > last)
    }

    /// The first time from `now` on of this impulse that has not been applied.
    fn next_of(&self, impulse: usize, now: f64) -> Option<f64> {
        let schedule = &self.schedule[impulse];
        let open = |time: &f64| *time >= now && self.is_open(impulse, *time);
        let listed = schedule.times.iter().map(|time| time.high).filter(open);
        let periodic = schedule.interval.and_then(|interval| {
            let count = ((now - self.start) / interval.high).floor().max(1.0);
            let time = |k: i32| {
                (DoubleDouble::from_decimal(self.start) + interval * (count + f64::from(k))).high
            };
            (-1..=2).map(time).find(open)
        });
        listed.chain(periodic).min_by(f64::total_cmp)
    }

    /// The first time from `now` on of any impulse that has not been applied.
    pub(super) fn next(&self, now: f64) -> Option<f64> {
        let all = 0..self.schedule.len();
        all.filter_map(|i| self.next_of(i, now)).min_by(f64::total_cmp)
    }

    /// Whether the interval of an impulse is below the resolution of time.
    pub(super) fn stands_still(&self, now: f64) -> bool {
        let mut intervals = self.schedule.iter().filter_map(|schedule| schedule.interval);
        intervals.any(|interval| interval.high < spacing(now))
    }

    /// The impulse that is due now, if any.
    pub(super) fn due(&self, now: f64) -> Option<usize> {
        (0..self.schedule.len()).find(|&i| self.next_of(i, now) == Some(now))
    }

    /// Marks an impulse as applied now and returns its time beyond the last digit.
    pub(super) fn apply_scheduled(&mut self, impulse: usize, now: f64) -> DoubleDouble {
        self.applied = Some((now, impulse));
        self.schedule[impulse].exactly(self.start, now)
    }
}
