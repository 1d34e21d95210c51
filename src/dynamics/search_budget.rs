//! How many steps a search for a periodic orbit may take, and how many it has taken.
//!
//! In: steps. Out: whether there are more, and how far the search is. A search ends by its steps and never by a clock, so that
//! it finds the same on every machine. Never here: the search.

use std::cell::Cell;

use crate::integrate::{Method, Stepping};

/// The steps of a search, of a series and of a fixed size.
const STEPS: u64 = 100_000;
const STEPS_FIXED: u64 = 4_000_000;

/// The steps of the motions that a search follows.
pub(super) struct SearchBudget<'a> {
    taken: Cell<u64>,
    total: u64,
    /// Is given the steps taken and their greatest number.
    report: &'a dyn Fn(u64, u64),
}

impl<'a> SearchBudget<'a> {
    pub(super) fn of(method: &Method, report: &'a dyn Fn(u64, u64)) -> Self {
        let total = if method.stepping == Stepping::Fixed { STEPS_FIXED } else { STEPS };
        Self { taken: Cell::new(0), total, report }
    }

    pub(super) fn step(&self) {
        self.taken.set(self.taken.get() + 1);
        (self.report)(self.taken.get().min(self.total), self.total);
    }

    /// Whether all steps are taken.
    pub(super) fn is_spent(&self) -> bool {
        self.taken.get() >= self.total
    }

    /// What is said of a search that it has ended; nothing if it has not.
    pub(super) fn ended(&self) -> Option<String> {
        self.is_spent()
            .then(|| format!("the search ended after {} steps of the motion", self.total))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::method_named;

    #[test]
    fn a_search_ends_after_its_steps_and_says_after_how_many() {
        for (name, steps) in [("taylor", 100_000), ("dop853", 100_000), ("leapfrog", 4_000_000)] {
            let reported = Cell::new((0, 0));
            let report = |taken, total| reported.set((taken, total));
            let budget = SearchBudget::of(method_named(name).expect("a method"), &report);
            (1..steps).for_each(|_| budget.step());
            assert_eq!((budget.is_spent(), budget.ended()), (false, None), "{name}");
            budget.step();
            let ended = format!("the search ended after {steps} steps of the motion");
            assert_eq!((budget.is_spent(), budget.ended()), (true, Some(ended)), "{name}");
            assert_eq!(reported.get(), (steps, steps), "{name}");
        }
    }
}
