//! Whether an event comes ever faster, so that time would never pass a point: a ball whose bounces
//! pile up.
//!
//! In: the times of one event. Out: whether they pile up. Never here: what is done about it.

/// An event that comes ever faster, so many times in a row, …
const PATIENCE: u32 = 4;

/// … and at last after so small a part of the time that has passed, piles up.
const HASTE: f64 = 1e-9;

/// It comes faster where the time to the last one is at most this part of that before.
const FASTER: f64 = 0.9999;

/// What is remembered of one event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Haste {
    last: f64,
    gap: f64,
    count: u32,
}

impl Haste {
    /// An event that has not come yet.
    pub(super) const NONE: Haste = Haste { last: f64::NEG_INFINITY, gap: 0.0, count: 0 };

    /// The event comes, in a motion that began at `start`; true where it piles up.
    pub(super) fn comes(&mut self, time: f64, start: f64) -> bool {
        let gap = time - self.last;
        let count = if gap <= FASTER * self.gap { self.count + 1 } else { 0 };
        *self = Haste { last: time, gap, count };
        count >= PATIENCE && gap <= HASTE * (time - start).abs()
    }
}
