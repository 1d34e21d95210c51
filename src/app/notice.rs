//! What the user is told in passing, beside the key hints.
//!
//! In: sentences. Out: the one to be shown now, and those that wait. Never here: what lasts, as a fault does.

use std::collections::VecDeque;
use std::time::Duration;

/// While another waits, a sentence is shown for this long.
const TURN: Duration = Duration::from_secs(2);

/// More sentences than this do not wait; all of them are on the page of plain reading.
const WAITING: usize = 8;

/// A sentence that goes away by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// The sentence.
    pub text: String,
    /// Whether something went wrong.
    pub error: bool,
    left: Duration,
    shown: Duration,
}

/// Sentences that wait until the ones before were shown.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue(VecDeque<Notice>);

impl Queue {
    /// Shows a sentence now, or after those before it.
    pub(super) fn tell(&mut self, now: &mut Option<Notice>, notice: Notice) {
        if now.is_none() {
            *now = Some(notice);
        } else if self.0.len() < WAITING {
            self.0.push_back(notice);
        }
    }

    /// Time has passed: what was shown long enough gives way to what waits.
    pub(super) fn tick(&mut self, now: &mut Option<Notice>, elapsed: Duration) {
        *now = now.take().and_then(|notice| notice.after(elapsed));
        let gives_way = now.as_ref().is_none_or(|notice| notice.shown >= TURN);
        if gives_way && let Some(next) = self.0.pop_front() {
            *now = Some(next);
        }
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}

impl Notice {
    /// For what went well.
    pub fn info(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            error: false,
            left: Duration::from_secs(5),
            shown: Duration::ZERO,
        }
    }

    /// For what did not.
    pub fn error(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            error: true,
            left: Duration::from_secs(10),
            shown: Duration::ZERO,
        }
    }

    /// The notice after some time has passed.
    #[must_use]
    pub fn after(self, elapsed: Duration) -> Option<Self> {
        let left = self.left.saturating_sub(elapsed);
        let shown = self.shown.saturating_add(elapsed);
        (!left.is_zero()).then_some(Self { left, shown, ..self })
    }
}
