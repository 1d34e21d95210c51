//! Whether a run can come to its end: where a motion meets its kinks ever so often, or its steps have become much shorter
//! than they were, they may be more than anyone waits for.
//!
//! In: the time that a number of steps has led to. Out: why the run is given up, in a sentence. Never here: what the steps
//! do; steps whose size was asked for.

use crate::printable;

/// The number of steps after which the rate of steps is known.
const KNOWN_AFTER: u64 = 1 << 17;

/// More steps than these take hours.
const MOST: f64 = 1e10;

/// Where there are no kinks, steps must have become shorter than this part of what they were: a long run may be wanted.
const SHORTENED: f64 = 1e-4;

/// How far the steps of a run lead.
pub(super) struct Outlook {
    start: f64,
    end: f64,
    /// Whether the motion may meet kinks.
    kinks: bool,
    /// The time from which steps are counted, and how many there were before it.
    from: (f64, u64),
}

impl Outlook {
    pub(super) fn new(start: f64, end: f64, kinks: bool) -> Outlook {
        Outlook { start, end, kinks, from: (start, 0) }
    }

    /// Looks at a time that so many steps have led to. Returns why there are too many more.
    pub(super) fn see(&mut self, time: f64, steps: u64) -> Option<String> {
        let (from, before) = self.from;
        let taken = steps - before;
        if taken < KNOWN_AFTER {
            return None;
        }
        self.from = (time, steps);
        let step = (time - from) / taken as f64;
        let left = (self.end - time) / step;
        let shortened = before > 0 && step < SHORTENED * (from - self.start) / before as f64;
        (left > MOST && (self.kinks || shortened)).then(|| {
            let [time, end] = [time, self.end].map(printable::number);
            let what = if shortened { "it has come to steps of" } else { "it takes steps of" };
            let help = if self.kinks {
                "; where it goes from one kink to the next, begin exactly on the kink, or farther from it"
            } else {
                ""
            };
            format!(
                "{what} {step:.1e} at t = {time}, and {left:.1e} more of them to t = {end}: end the run sooner with \
                 --until{help}"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run to 1 after two paces of steps of this size.
    fn given_up(step: f64) -> bool {
        let mut outlook = Outlook::new(0.0, 1.0, true);
        let half = KNOWN_AFTER / 2;
        (1..=4).any(|k| outlook.see(step * (half * k) as f64, half * k).is_some())
    }

    #[test]
    fn a_run_is_given_up_beyond_ten_billion_steps() {
        assert!(given_up(0.9e-10));
        assert!(!given_up(1.1e-10));
        // steps that do not advance the time
        assert!(given_up(0.0));
    }

    #[test]
    fn without_kinks_a_run_is_given_up_only_where_its_steps_have_become_much_shorter() {
        // a step of 1 at first, and then this part of it
        let given_up = |part: f64, most: f64| {
            let mut outlook = Outlook::new(0.0, most, false);
            assert_eq!(outlook.see(KNOWN_AFTER as f64, KNOWN_AFTER), None);
            outlook.see(KNOWN_AFTER as f64 * (1.0 + part), 2 * KNOWN_AFTER).is_some()
        };
        assert!(given_up(0.9e-4, 1e12) && !given_up(1.1e-4, 1e12));
        assert!(!given_up(0.9e-4, 1e5));
        assert!(!given_up(1.0, 1e30));
    }

    #[test]
    fn the_pace_is_that_of_the_last_steps() {
        let mut outlook = Outlook::new(0.0, 1.0, true);
        assert_eq!(outlook.see(0.1, KNOWN_AFTER), None);
        assert!(outlook.see(0.1 + 1e-5, 2 * KNOWN_AFTER).is_some());
        assert_eq!(outlook.see(0.2, 3 * KNOWN_AFTER), None);
    }
}
