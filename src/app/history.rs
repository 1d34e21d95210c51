//! Undo: all that a person changed of values, method and pictures, to be taken back and done again in one order.
//!
//! In: changes as they are made. Out: the change to be taken back or made again. Never here: how it is carried out.
//! Where a person looks (the focus, the page, a pane that fills the page) is no change.

use std::time::Duration;

use super::Plot;
use crate::integrate::Settings;
use crate::system::InitialOverride;

/// Changes of one thing that follow each other within this time are taken back together.
const TOGETHER: Duration = Duration::from_millis(800);

/// One change that can be taken back.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Change {
    /// A parameter went from one number to another.
    Parameter {
        /// Which.
        index: usize,
        /// The number before, and after.
        numbers: [f64; 2],
    },
    /// An initial value was given.
    Initial {
        /// Which.
        index: usize,
        /// What stood there before, and after.
        numbers: [f64; 2],
        /// All that was given in place of the file's values before, and after.
        given: [Vec<InitialOverride>; 2],
    },
    /// Several initial values were given at once: all that was given before, and after.
    Start([Vec<InitialOverride>; 2]),
    /// All values were given back to the file; these are the ones before.
    FullReset {
        /// The parameters.
        parameters: Vec<f64>,
        /// What was given in place of the file's initial values.
        given: Vec<InitialOverride>,
    },
    /// A picture shows something else, or is looked at in another way.
    Plot {
        /// Its place among the pictures.
        index: usize,
        /// It before, and after.
        plots: Box<[Plot; 2]>,
    },
    /// Another method integrates: its name before, and after.
    Method([&'static str; 2]),
    /// It has another step or tolerance: before, and after.
    Settings([Settings; 2]),
    /// Several things were changed in one go, in this order.
    Together(Vec<Change>),
}

impl Change {
    /// Takes in a later change of the same thing; whether it is one that goes together with it.
    fn join(&mut self, later: &Self) -> bool {
        match (self, later) {
            (
                Self::Parameter { index, numbers },
                Self::Parameter { index: other, numbers: [_, to] },
            ) if index == other => numbers[1] = *to,
            (
                Self::Initial { index, numbers, given },
                Self::Initial { index: other, numbers: [_, to], given: [_, after] },
            ) if index == other => {
                numbers[1] = *to;
                given[1].clone_from(after);
            }
            (Self::Start(given), Self::Start([_, after])) => given[1].clone_from(after),
            (Self::Plot { index, plots }, Self::Plot { index: other, plots: later })
                if index == other && plots[0].differs_smoothly(&later[1]) =>
            {
                plots[1] = later[1].clone();
            }
            _ => return false,
        }
        true
    }
}

/// What was changed, and what of it was taken back.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    done: Vec<Change>,
    undone: Vec<Change>,
    since: Option<Duration>,
    /// How much was done when the mouse took hold of something.
    begin_group: Option<usize>,
}

impl History {
    /// Takes note of a change made now.
    pub(super) fn note(&mut self, change: Change) {
        self.undone.clear();
        let last = self.done.len().saturating_sub(1);
        let joining = match self.begin_group {
            // All that is done while something is held is one change, however long it takes.
            Some(before) => self.done.get_mut(before..).unwrap_or_default(),
            None if self.since.is_some_and(|since| since < TOGETHER) => &mut self.done[last..],
            None => &mut [],
        };
        self.since = Some(Duration::ZERO);
        if !joining.iter_mut().rev().any(|earlier| earlier.join(&change)) {
            self.done.push(change);
        }
    }

    /// The mouse takes hold of something, or values begin to be carried elsewhere.
    pub(super) fn begin_group(&mut self) {
        self.begin_group = Some(self.done.len());
    }

    /// They are let go; all that was changed meanwhile is taken back as one.
    pub(super) fn end_group(&mut self) {
        if let Some(before) = self.begin_group.filter(|before| self.done.len() > before + 1) {
            let changes = self.done.split_off(before);
            self.done.push(Change::Together(changes));
        }
        (self.begin_group, self.since) = (None, None);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// How many changes are taken back of two that follow each other after so many milliseconds.
    fn changes(milliseconds: u64) -> usize {
        let mut history = History::default();
        history.note(Change::Parameter { index: 0, numbers: [1.0, 2.0] });
        history.tick(Duration::from_millis(milliseconds));
        history.note(Change::Parameter { index: 0, numbers: [2.0, 3.0] });
        std::iter::from_fn(|| history.undo()).count()
    }

    #[test]
    fn what_follows_within_eight_tenths_of_a_second_is_one_change() {
        assert_eq!(changes(790), 1);
        assert_eq!(changes(810), 2);
    }
}
