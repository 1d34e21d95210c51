//! How far a motion is from keeping a condition it is kept on: zero but for rounding.
//!
//! In: deviations, measured by the size of what they are deviations of. Out: the numbers of a
//! [`Gauge`]. Never here: what the condition is.

use super::Gauge;
use crate::analysis::{Growth, History, Stretch, Verdict};

/// A deviation below this is rounding: a few units in the last place.
const ROUNDING: f64 = 1e-14;

/// What is remembered of one condition.
#[derive(Clone, Debug)]
pub(super) struct Deviation {
    since: f64,
    farthest: f64,
    history: History,
}

impl Deviation {
    /// From this time on.
    pub(super) fn since(time: f64) -> Deviation {
        Deviation { since: time, farthest: 0.0, history: History::new() }
    }

    /// Takes note of a deviation.
    pub(super) fn look(&mut self, now: f64) {
        self.farthest = self.farthest.max(now);
    }

    /// Takes note of a deviation at one of the evenly spaced times.
    pub(super) fn sample(&mut self, time: f64, now: f64) {
        self.look(now);
        self.history.push(time, now);
    }

    /// The gauge that shows it.
    pub(super) fn gauge(&self, name: &str, shown: &str, reason: String, now: f64) -> Gauge {
        let exact = self.farthest <= ROUNDING;
        let verdict = if exact { Verdict::Exact(Growth::Level) } else { Verdict::Bounded };
        Gauge {
            name: name.to_owned(),
            shown: shown.to_owned(),
            reason,
            value: now,
            initial: 0.0,
            scale: 1.0,
            farthest: self.farthest,
            reference: 0.0,
            reference_time: self.since,
            drift: now,
            max_drift: self.farthest,
            history: self.history.stretches().iter().map(|s| Stretch::peak(s) as f32).collect(),
            verdict,
        }
    }
}
