//! Steps of work on a pool, counted.
//!
//! In: how many are taken, and how many are allowed. Out: whether they were allowed. Never here: what a step is.

/// The steps that were taken, and how many may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    taken: u64,
    allowed: u64,
}

impl Steps {
    /// As many as one likes.
    pub(super) const UNBOUNDED: Steps = Steps { taken: 0, allowed: u64::MAX };

    /// Takes some, and returns whether they were allowed.
    pub(super) fn take(&mut self, steps: u64) -> bool {
        self.taken += steps;
        self.taken <= self.allowed
    }

    /// Allows so many from now on, if they are allowed now; returns what was allowed before.
    pub(super) fn allow(&mut self, steps: u64) -> u64 {
        let before = self.allowed;
        self.allowed = before.min(self.taken.saturating_add(steps));
        before
    }

    pub(super) fn allow_again(&mut self, allowed: u64) {
        self.allowed = allowed;
    }
}
