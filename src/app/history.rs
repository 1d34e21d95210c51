//! Undo history: all changes of values, method and pictures, to be undone and redone in one order.
//!
//! In: changes as they are made, and the motion before each. Out: the change to be undone or redone, and the motion to
//! go back to. Never here: how it is carried out.
//! Navigation (the focus, the page, a zoomed pane) is not a change.

use std::time::Duration;

use super::earlier_window::EarlierWindow;
use crate::experiment::Checkpoint;
use crate::instrument::Plot;
use crate::integrate::Settings;
use crate::system::InitialOverride;

/// Changes of one thing that follow each other within this time are undone together.
const TOGETHER: Duration = Duration::from_millis(800);

/// The most motions whose recorded past is stored, and not their state alone.
const MOST_PASTS: usize = 8;

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Change {
    Parameter {
        index: usize,
        /// Its value before and after.
        numbers: [f64; 2],
    },
    /// An initial value was changed.
    Initial {
        index: usize,
        /// Its value before and after.
        numbers: [f64; 2],
        /// All overrides of the file's initial values before and after.
        given: [Vec<InitialOverride>; 2],
    },
    /// Several initial values were set at once.
    Start {
        /// All overrides before and after.
        given: [Vec<InitialOverride>; 2],
        /// The ranges that the pictures keep, before and after.
        windows: [EarlierWindow; 2],
    },
    /// A flow has carried the state to another orbit: all overrides before and after.
    Flow([Vec<InitialOverride>; 2]),
    /// All values were reset to the file's.
    FullReset {
        /// The parameters before.
        parameters: Vec<f64>,
        /// The overrides of the file's initial values before.
        given: Vec<InitialOverride>,
    },
    /// A picture shows something else, or its view has changed.
    Plot {
        index: usize,
        /// The picture before and after.
        plots: Box<[Plot; 2]>,
    },
    /// The method was changed: its name before and after.
    Method([&'static str; 2]),
    /// The method's step or tolerance was changed: before and after.
    Settings([Settings; 2]),
    /// Several changes made as one, in this order.
    Together(Vec<Change>),
}

impl Change {
    /// Whether the motion is another one after it.
    pub(super) fn is_of_motion(&self) -> bool {
        match self {
            Self::Parameter { .. }
            | Self::Initial { .. }
            | Self::Start { .. }
            | Self::Flow(_)
            | Self::FullReset { .. } => true,
            Self::Plot { .. } | Self::Method(_) | Self::Settings(_) => false,
            Self::Together(changes) => changes.iter().any(Self::is_of_motion),
        }
    }

    /// Merges a later change of the same thing into this one. Returns whether the two belong together.
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
            (
                Self::Start { given, windows },
                Self::Start { given: [_, given_after], windows: [_, window_after] },
            ) => {
                given[1].clone_from(given_after);
                windows[1].clone_from(window_after);
            }
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

/// A change, and where the motion was.
#[derive(Clone, Debug)]
struct HistoryEntry {
    change: Change,
    /// The motion before the change, and the one after it at which it was undone.
    motions: [Option<Box<Checkpoint>>; 2],
}

/// A change to be made or undone, and the motion to return to.
type ChangeAtMotion = (Change, Option<Box<Checkpoint>>);

/// The changes made, and the changes undone.
#[derive(Clone, Debug, Default)]
pub(super) struct UndoHistory {
    done: Vec<HistoryEntry>,
    undone: Vec<HistoryEntry>,
    since: Option<Duration>,
    /// The parameter that was changed last, if nothing else was since, and how long ago.
    stepped: Option<(usize, Duration)>,
    /// The number of changes made when the mouse began to drag something.
    begin_group: Option<usize>,
}

impl UndoHistory {
    /// Whether a change of this parameter, about to be noted, is another step of the change before it: in the same drag, or
    /// soon after it, as while a key is held.
    pub(super) fn steps_on(&self, parameter: usize) -> bool {
        self.stepped.is_some_and(|(last, since)| {
            last == parameter && (since < TOGETHER || self.begin_group.is_some())
        })
    }

    /// Records a change made now. Returns whether it begins an entry of its own.
    pub(super) fn note(&mut self, change: Change) -> bool {
        self.undone.clear();
        self.stepped = match change {
            Change::Parameter { index, .. } => Some((index, Duration::ZERO)),
            _ => None,
        };
        let last = self.done.len().saturating_sub(1);
        let joining = match self.begin_group {
            // Everything changed during a drag is one change, however long it takes.
            Some(before) => self.done.get_mut(before..).unwrap_or_default(),
            None if self.since.is_some_and(|since| since < TOGETHER) => &mut self.done[last..],
            None => &mut [],
        };
        self.since = Some(Duration::ZERO);
        if joining.iter_mut().rev().any(|earlier| earlier.change.join(&change)) {
            return false;
        }
        self.done.push(HistoryEntry { change, motions: [None, None] });
        true
    }

    /// Keeps the motion before the last entry.
    pub(super) fn keep_motion(&mut self, before: Checkpoint) {
        if let Some(entry) = self.done.last_mut() {
            entry.motions[0] = Some(Box::new(before));
        }
        self.forget_old_pasts();
    }

    /// Keeps the recorded pasts of the last changes alone; of those before the states are left.
    fn forget_old_pasts(&mut self) {
        let entries = self.undone.iter_mut().rev().chain(self.done.iter_mut().rev());
        let motions = entries.flat_map(|entry| entry.motions.iter_mut().flatten());
        let pasts = motions.filter(|motion| motion.past.is_some());
        pasts.skip(MOST_PASTS).for_each(|motion| motion.past = None);
    }

    /// Forgets the motions before and after the changes, as they follow another law than that of now.
    pub(super) fn forget_motions(&mut self) {
        let entries = self.done.iter_mut().chain(&mut self.undone);
        entries.for_each(|entry| entry.motions = [None, None]);
    }

    /// Begins a group: the mouse begins to drag something, or values begin to move.
    pub(super) fn begin_group(&mut self) {
        self.begin_group = Some(self.done.len());
        self.stepped = self.stepped.filter(|(_, since)| *since < TOGETHER);
    }

    /// Ends the group; all changes made since its start are undone as one.
    pub(super) fn end_group(&mut self) {
        if let Some(before) = self.begin_group.filter(|before| self.done.len() > before + 1) {
            let entries = self.done.split_off(before);
            let first = entries.iter().find_map(|entry| entry.motions[0].clone());
            let changes = entries.into_iter().map(|entry| entry.change).collect();
            let change = Change::Together(changes);
            self.done.push(HistoryEntry { change, motions: [first, None] });
        }
        // without a group a change may still be a step of the one before it
        if self.begin_group.take().is_some() {
            self.since = None;
        }
    }

    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.since = self.since.map(|since| since.saturating_add(elapsed));
        self.stepped = self.stepped.map(|(index, since)| (index, since.saturating_add(elapsed)));
    }

    /// Returns the change to be undone and the motion before it. The motion now is stored for when it is redone.
    pub(super) fn undo(&mut self, now: Option<Checkpoint>) -> Option<ChangeAtMotion> {
        self.moved(0, now)
    }

    /// Returns the change to be redone and the motion at which it was undone. The motion now is stored for when it is undone.
    pub(super) fn redo(&mut self, now: Option<Checkpoint>) -> Option<ChangeAtMotion> {
        self.moved(1, now)
    }

    fn moved(&mut self, side: usize, now: Option<Checkpoint>) -> Option<ChangeAtMotion> {
        let [from, to] = match side {
            0 => [&mut self.done, &mut self.undone],
            _ => [&mut self.undone, &mut self.done],
        };
        let mut entry = from.pop()?;
        let motion = entry.motions[side].clone();
        entry.motions[1 - side] = now.map(Box::new).filter(|_| motion.is_some());
        let change = entry.change.clone();
        to.push(entry);
        (self.since, self.stepped) = (None, None);
        self.forget_old_pasts();
        Some((change, motion))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns how many undo entries result from two changes this many milliseconds apart.
    fn changes(milliseconds: u64) -> usize {
        let mut history = UndoHistory::default();
        history.note(Change::Parameter { index: 0, numbers: [1.0, 2.0] });
        history.tick(Duration::from_millis(milliseconds));
        history.note(Change::Parameter { index: 0, numbers: [2.0, 3.0] });
        std::iter::from_fn(|| history.undo(None)).count()
    }

    #[test]
    fn what_follows_within_eight_tenths_of_a_second_is_one_change() {
        assert_eq!(changes(790), 1);
        assert_eq!(changes(810), 2);
    }
}
