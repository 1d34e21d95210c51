//! Whether an event comes ever faster, so that time would never pass a point: a ball whose bounces
//! pile up.
//!
//! In: the times of one event. Out: whether they pile up. Never here: what is done about it.

/// An event that comes ever faster, so many times in a row, …
const PATIENCE: u32 = 4;

/// … and at last after so small a part of the time that has passed, piles up.
const ACCUMULATION: f64 = 1e-9;

/// It comes faster where the time to the last one is at most this part of that before.
const FASTER: f64 = 0.9999;

/// What is remembered of one event.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccumulationDetector {
    last: f64,
    gap: f64,
    count: u32,
}

impl AccumulationDetector {
    /// An event that has not come yet.
    pub(super) const NONE: AccumulationDetector =
        AccumulationDetector { last: f64::NEG_INFINITY, gap: 0.0, count: 0 };

    /// The event comes, in a motion that began at `start`; true where it piles up.
    pub(super) fn record(&mut self, time: f64, start: f64) -> bool {
        let gap = time - self.last;
        let count = if gap <= FASTER * self.gap { self.count + 1 } else { 0 };
        *self = AccumulationDetector { last: time, gap, count };
        count >= PATIENCE && gap <= ACCUMULATION * (time - start).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the last of events with these gaps, the first of which comes at 1, piles up.
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
        // one that comes later begins the count anew
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
        // rounding of the clock is near 2e-16
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
