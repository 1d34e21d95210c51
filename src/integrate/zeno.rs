//! Detects events that recur at ever shorter intervals, so that time would never pass a point, as
//! the bounces of a ball do.
//!
//! In: the times of one event. Out: whether they accumulate. Never here: the consequences.

/// Events accumulate if their intervals shrink this many times in a row.
const LEAST_EVENTS: u32 = 4;

/// The last of these intervals is at most this part of the time that has passed.
const ACCUMULATION: f64 = 1e-9;

/// An interval shrinks if it is at most this part of the one before.
const FASTER: f64 = 0.9999;

/// The history of one event.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccumulationDetector {
    last: f64,
    gap: f64,
    count: u32,
}

impl AccumulationDetector {
    /// An event that has not occurred yet.
    pub(super) const NONE: AccumulationDetector =
        AccumulationDetector { last: f64::NEG_INFINITY, gap: 0.0, count: 0 };

    /// Records the event, in a motion that began at `start`. Returns true if the events accumulate.
    pub(super) fn record(&mut self, time: f64, start: f64) -> bool {
        let gap = time - self.last;
        let count = if gap <= FASTER * self.gap { self.count + 1 } else { 0 };
        *self = AccumulationDetector { last: time, gap, count };
        count >= LEAST_EVENTS && gap <= ACCUMULATION * (time - start).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether events with these gaps, the first of which occurs at 1, accumulate at the last one.
    fn accumulates(gaps: &[f64]) -> bool {
        let mut accumulation = AccumulationDetector::NONE;
        let mut time = 1.0;
        let mut last = accumulation.record(time, 0.0);
        for gap in gaps {
            time += gap;
            last = accumulation.record(time, 0.0);
        }
        last
    }

    #[test]
    fn four_gaps_in_a_row_are_enough_and_three_are_not() {
        let gaps = [8e-10, 4e-10, 2e-10, 1e-10];
        assert!(accumulates(&gaps));
        assert!(!accumulates(&gaps[..3]));
        // a longer interval restarts the count
        assert!(!accumulates(&[8e-10, 4e-10, 5e-10, 1e-10, 5e-11, 2e-11]));
    }

    #[test]
    fn it_comes_ever_faster_only_where_the_gaps_shrink() {
        let shrinking = |factor: f64| {
            let mut gap = 5e-10;
            let gaps = [(); 6].map(|()| {
                gap *= factor;
                gap
            });
            accumulates(&gaps)
        };
        assert!(shrinking(0.999));
        // rounding of time is near 2e-16
        assert!(!shrinking(0.99995));
        assert!(!shrinking(1.0));
    }

    #[test]
    fn the_last_gap_is_a_small_part_of_the_time() {
        let ending = |last: f64| accumulates(&[4e-8, 2e-8, 1e-8, last]);
        assert!(ending(0.95e-9));
        assert!(!ending(1.1e-9));
    }
}
