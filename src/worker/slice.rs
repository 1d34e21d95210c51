//! The number of steps in a slice: as many as fit into about two milliseconds, learned along the
//! way.

use std::time::Duration;

/// The target length of a slice.
const LENGTH: Duration = Duration::from_millis(2);

#[derive(Clone, Copy, Debug)]
pub(super) struct Slice {
    steps: u64,
}

impl Slice {
    /// Starts with a number small enough for any system; it soon grows.
    pub(super) fn new() -> Slice {
        Slice { steps: 16 }
    }

    /// The number of steps in the next slice.
    pub(super) fn budget(self) -> u64 {
        self.steps
    }

    /// Learns from a slice that used up its budget in this time.
    pub(super) fn learn(&mut self, took: Duration) {
        let ratio = LENGTH.as_secs_f64() / took.as_secs_f64().max(1e-9);
        // one slow slice may be due to another program
        let next = self.steps as f64 * ratio.clamp(0.5, 2.0);
        self.steps = (next as u64).clamp(1, 1_000_000);
    }
}
