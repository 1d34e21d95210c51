//! Transient notifications, shown beside the key hints.
//!
//! In: sentences. Out: the one to show now, and those that wait. Never here: lasting conditions, such as a fault.

use std::collections::VecDeque;
use std::time::Duration;

/// How long a sentence is shown while another waits.
const TURN: Duration = Duration::from_secs(2);

/// The maximum number of waiting sentences; all of them appear on the plain-reading page.
const WAITING: usize = 8;

/// A sentence that disappears after a while.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notification {
    /// The sentence.
    pub text: String,
    /// What it is about.
    pub kind: NotificationKind,
    left: Duration,
    shown: Duration,
}

/// What a notification is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotificationKind {
    /// A success or a change.
    Info,
    /// Why a key does nothing here, and what would.
    Hint,
    /// Something went wrong.
    Error,
}

/// Sentences that wait until earlier ones have been shown.
#[derive(Clone, Debug, Default)]
pub(super) struct NotificationQueue(VecDeque<Notification>);

impl NotificationQueue {
    /// Shows a sentence now, or after those before it.
    pub(super) fn tell(&mut self, now: &mut Option<Notification>, notice: Notification) {
        // A newer notification on the same subject replaces the older one.
        let older = now.iter_mut().chain(&mut self.0).find(|other| other.says_more_of(&notice));
        if let Some(older) = older {
            *older = Notification { shown: older.shown, ..notice };
        } else if now.is_none() {
            *now = Some(notice);
        } else if self.0.len() < WAITING {
            self.0.push_back(notice);
        }
    }

    /// Advances the time: a sentence shown long enough is replaced by the next one.
    pub(super) fn tick(&mut self, now: &mut Option<Notification>, elapsed: Duration) {
        *now = now.take().and_then(|notice| notice.after(elapsed));
        let gives_way = now.as_ref().is_none_or(|notice| notice.shown >= TURN);
        if gives_way && let Some(next) = self.0.pop_front() {
            *now = Some(next);
        }
    }

    /// Removes a sentence that dates an occurrence once there has been another of its name; `repeated` are the names of what
    /// occurred more than once.
    pub(super) fn outdate<'a>(
        &mut self,
        now: &mut Option<Notification>,
        mut repeated: impl Iterator<Item = &'a str>,
    ) {
        if let Some(notice) = now
            && repeated.any(|name| notice.is_past(name))
        {
            *now = self.0.pop_front();
        }
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}

impl Notification {
    /// Whether both start with the same words before a colon: `m: energy jumped by …`.
    fn says_more_of(&self, other: &Self) -> bool {
        let lead = |text: &str| text.split_once(": ").map(|(lead, _)| lead.to_owned());
        lead(&self.text).is_some_and(|of| lead(&other.text) == Some(of))
    }

    /// Whether it dates an occurrence of this name, and has been shown for its turn.
    fn is_past(&self, name: &str) -> bool {
        let rest = self.text.strip_prefix(name);
        self.shown >= TURN && rest.is_some_and(|rest| rest.starts_with(" at t = "))
    }

    /// Creates a notification of success or of a change.
    pub fn info(text: impl Into<String>) -> Self {
        Self::new(text, NotificationKind::Info, 5)
    }

    /// Creates a notification that says why a key does nothing here.
    pub fn hint(text: impl Into<String>) -> Self {
        Self::new(text, NotificationKind::Hint, 10)
    }

    /// Creates a notification of an error.
    pub fn error(text: impl Into<String>) -> Self {
        Self::new(text, NotificationKind::Error, 10)
    }

    fn new(text: impl Into<String>, kind: NotificationKind, seconds: u64) -> Self {
        let left = Duration::from_secs(seconds);
        Self { text: text.into(), kind, left, shown: Duration::ZERO }
    }

    /// Whether something went wrong.
    pub fn is_error(&self) -> bool {
        self.kind == NotificationKind::Error
    }

    /// Returns the notification after this time, or `None` if it has expired.
    #[must_use]
    pub fn after(self, elapsed: Duration) -> Option<Self> {
        let left = self.left.saturating_sub(elapsed);
        let shown = self.shown.saturating_add(elapsed);
        (!left.is_zero()).then_some(Self { left, shown, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newer_word_on_a_thing_takes_the_place_of_the_older() {
        let (mut queue, mut now) = (NotificationQueue::default(), None);
        for text in ["m: energy jumped by +1", "lift-off at t = 2", "m: energy jumped by +3"] {
            queue.tell(&mut now, Notification::info(text));
        }
        assert_eq!(now.map(|n| n.text).as_deref(), Some("m: energy jumped by +3"));
        assert_eq!(queue.0.len(), 1);
    }
    #[test]
    fn what_occurred_is_not_dated_any_more_once_it_occurred_again() {
        let mut queue = NotificationQueue::default();
        let mut now = Some(Notification::info("kick at t = 1: energy +0.1"));
        queue.outdate(&mut now, ["kick"].into_iter());
        assert!(now.is_some(), "it has its turn");
        queue.tick(&mut now, TURN);
        queue.outdate(&mut now, ["kic", "push"].into_iter());
        assert!(now.is_some(), "of another name");
        queue.outdate(&mut now, std::iter::empty());
        assert!(now.is_some(), "it is the only one");
        queue.outdate(&mut now, ["push", "kick"].into_iter());
        assert_eq!(now, None);
    }
}
