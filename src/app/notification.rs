//! Transient notifications, shown beside the key hints.
//!
//! In: sentences. Out: the one to show now, and those that wait. Never here: lasting conditions, such as an error.

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
    /// Something is allowed, but probably not what was meant.
    Warning,
    /// Something went wrong.
    Error,
}

/// The notification shown, and those that wait until it has been.
#[derive(Clone, Debug, Default)]
pub struct Notifications {
    /// What is in the status line now.
    pub shown: Option<Notification>,
    waiting: VecDeque<Notification>,
}

impl Notifications {
    /// Shows a sentence now, in place of the one shown.
    pub fn show(&mut self, notification: Notification) {
        self.shown = Some(notification);
    }

    /// Removes the one shown; those that wait follow.
    pub fn dismiss(&mut self) {
        self.shown = None;
    }

    /// Shows a sentence now, or after those before it.
    pub(super) fn add(&mut self, notification: Notification) {
        // A newer notification on the same subject replaces the older one.
        let mut all = self.shown.iter_mut().chain(&mut self.waiting);
        if let Some(older) = all.find(|other| other.says_more_of(&notification)) {
            *older = Notification { shown: older.shown, ..notification };
        } else if self.shown.is_none() {
            self.shown = Some(notification);
        } else if self.waiting.len() < WAITING {
            self.waiting.push_back(notification);
        }
    }

    /// Advances the time: a sentence shown long enough is replaced by the next one. Returns whether another one is shown.
    pub(super) fn tick(&mut self, elapsed: Duration) -> bool {
        let before = self.shown.as_ref().map(|notification| notification.text.clone());
        self.shown = self.shown.take().and_then(|notification| notification.after(elapsed));
        let gives_way = self.shown.as_ref().is_none_or(|notification| notification.shown >= TURN);
        if gives_way && let Some(next) = self.waiting.pop_front() {
            self.shown = Some(next);
        }
        self.shown.as_ref().map(|notification| &notification.text) != before.as_ref()
    }

    /// Removes a sentence that dates an occurrence once there has been another of its name; `repeated` are the names of what
    /// occurred more than once.
    pub(super) fn outdate<'a>(&mut self, mut repeated: impl Iterator<Item = &'a str>) {
        if let Some(notification) = &self.shown
            && repeated.any(|name| notification.is_past(name))
        {
            self.shown = self.waiting.pop_front();
        }
    }

    /// Removes a sentence that no longer holds.
    pub(super) fn withdraw(&mut self, text: &str) {
        self.waiting.retain(|notification| notification.text != text);
        if self.shown.as_ref().is_some_and(|notification| notification.text == text) {
            self.shown = self.waiting.pop_front();
        }
    }

    pub(super) fn clear_waiting(&mut self) {
        self.waiting.clear();
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

    /// Creates a notification of something that is probably not what was meant.
    pub fn warning(text: impl Into<String>) -> Self {
        Self::new(text, NotificationKind::Warning, 10)
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
        let mut notifications = Notifications::default();
        for text in ["m: energy jumped by +1", "lift-off at t = 2", "m: energy jumped by +3"] {
            notifications.add(Notification::info(text));
        }
        assert_eq!(notifications.shown.map(|n| n.text).as_deref(), Some("m: energy jumped by +3"));
        assert_eq!(notifications.waiting.len(), 1);
    }
    #[test]
    fn what_occurred_is_not_dated_any_more_once_it_occurred_again() {
        let mut notifications = Notifications::default();
        notifications.show(Notification::info("kick at t = 1: energy +0.1"));
        notifications.outdate(["kick"].into_iter());
        assert!(notifications.shown.is_some(), "it has its turn");
        notifications.tick(TURN);
        notifications.outdate(["kic", "push"].into_iter());
        assert!(notifications.shown.is_some(), "of another name");
        notifications.outdate(std::iter::empty());
        assert!(notifications.shown.is_some(), "it is the only one");
        notifications.outdate(["push", "kick"].into_iter());
        assert_eq!(notifications.shown, None);
    }
}
