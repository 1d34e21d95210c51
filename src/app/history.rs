//! Undo: the changes of values, to be taken back and done again.
//!
//! In: changes as they are made. Out: the change to be made instead. Never here: how a value is set.

use std::time::Duration;

use super::Target;

/// Changes of one value that follow each other within this time are taken back together.
const TOGETHER: Duration = Duration::from_millis(800);

/// One change that can be taken back.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Change {
    /// A value went from one number to another.
    Value {
        /// Which.
        target: Target,
        /// The number before.
        from: f64,
        /// The number after.
        to: f64,
    },
    /// All values were given back to the file; these are the ones before.
    FullReset(Vec<(Target, f64)>),
}

/// What was changed, and what of it was taken back.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    done: Vec<Change>,
    undone: Vec<Change>,
    since: Option<Duration>,
}

impl History {
    /// Takes note of a change made now.
    pub(super) fn note(&mut self, change: Change) {
        self.undone.clear();
        let soon = self.since.is_some_and(|since| since < TOGETHER);
        self.since = Some(Duration::ZERO);
        if let (
            true,
            Some(Change::Value { target: last, to: end, .. }),
            Change::Value { target, to, .. },
        ) = (soon, self.done.last_mut(), &change)
            && last == target
        {
            *end = *to;
            return;
        }
        self.done.push(change);
    }

    /// Time has passed.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.since = self.since.map(|since| since.saturating_add(elapsed));
    }

    /// The change to be taken back.
    pub(super) fn undo(&mut self) -> Option<Change> {
        let change = self.done.pop()?;
        self.since = None;
        self.undone.push(change.clone());
        Some(change)
    }

    /// The change to be made again.
    pub(super) fn redo(&mut self) -> Option<Change> {
        let change = self.undone.pop()?;
        self.since = None;
        self.done.push(change.clone());
        Some(change)
    }
}
