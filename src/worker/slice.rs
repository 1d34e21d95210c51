//! How many steps make a slice: as many as fit into about two milliseconds, learnt on the way.

use std::time::Duration;

/// What a slice is to last.
const LENGTH: Duration = Duration::from_millis(2);

/// The number of steps in a slice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slice {
    steps: u64,
}

impl Slice {
    /// Small enough for any system; it soon grows.
    pub(super) fn new() -> Slice {
        Slice { steps: 16 }
    }

    /// How many steps the next slice may have.
    pub(super) fn budget(self) -> u64 {
        self.steps
    }

    /// Learns from a slice that used up its budget in this time.
    pub(super) fn learn(&mut self, took: Duration) {
        let ratio = LENGTH.as_secs_f64() / took.as_secs_f64().max(1e-9);
        // one slow slice may be another program's doing
        let next = self.steps as f64 * ratio.clamp(0.5, 2.0);
        self.steps = (next as u64).clamp(1, 1_000_000);
    }
}
