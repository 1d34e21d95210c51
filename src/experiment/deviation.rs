//! The deviation of a motion from a condition imposed on it: zero up to rounding.
//!
//! In: deviations relative to the size of their terms. Out: the numbers of a [`Gauge`]. Never here:
//! what the condition is.

use super::{Gauge, Reference};
use crate::analysis::{Growth, History, LOST, Stretch, Verdict};

/// A deviation below this is rounding: a few units in the last place.
const ROUNDING: f64 = 1e-14;

/// The recorded deviation from one condition.
#[derive(Clone, Debug)]
pub(super) struct Deviation {
    since: f64,
    farthest: f64,
    history: History,
}

impl Deviation {
    pub(super) fn since(time: f64) -> Deviation {
        Deviation { since: time, farthest: 0.0, history: History::new() }
    }

    /// Continues from a saved reference of the same condition.
    pub(super) fn restore(&mut self, known: &Reference) {
        self.since = known.since;
        self.farthest = self.farthest.max(known.farthest.unwrap_or(known.max_drift));
    }

    pub(super) fn observe(&mut self, now: f64) {
        self.farthest = self.farthest.max(now);
    }

    /// Records a deviation at one of the evenly spaced times.
    pub(super) fn sample(&mut self, time: f64, now: f64) {
        self.observe(now);
        self.history.push(time, now);
    }

    pub(super) fn gauge(&self, name: &str, shown: &str, reason: String, now: f64) -> Gauge {
        let verdict = match self.farthest {
            ..=ROUNDING => Verdict::Exact(Growth::Level),
            ..=LOST => Verdict::Bounded,
            _ => Verdict::Lost,
        };
        Gauge {
            name: name.to_owned(),
            shown: shown.to_owned(),
            reason,
            proved: false,
            value: now,
            initial: 0.0,
            scale: 1.0,
            farthest: self.farthest,
            reference: 0.0,
            reference_time: self.since,
            drift: now,
            max_drift: self.farthest,
            left: None,
            history: self.history.stretches().iter().map(|s| Stretch::peak(s) as f32).collect(),
            verdict,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_is_rounding_up_to_1e_14_and_lost_from_a_tenth() {
        let verdict = |farthest: f64| {
            let mut deviation = Deviation::since(0.0);
            deviation.observe(farthest);
            deviation.gauge("c", "c", String::new(), 0.0).verdict
        };
        for (farthest, wanted) in [
            (0.99e-14, Verdict::Exact(Growth::Level)),
            (1.01e-14, Verdict::Bounded),
            (0.099, Verdict::Bounded),
            (0.101, Verdict::Lost),
        ] {
            assert_eq!(verdict(farthest), wanted, "{farthest}");
        }
    }
}
