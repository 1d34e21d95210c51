//! Marks on the time bar, and the keys that lead from one to the next.

use std::sync::Arc;

use phaselab::app::{AppEvent, Effect};
use phaselab::experiment::{Command, Recorded};

use crate::fixtures::{in_lab, pendulum, press, snapshot};

/// The time that a key looks at, in a motion known from 0 to 2 s with three marks, seen at a time.
fn looked_at(seen: f64, key: &str) -> Option<f64> {
    let mut app = in_lab();
    let mut at = snapshot(&pendulum(), seen);
    at.recorded = Recorded { from: 0.0, to: 2.0, ..at.recorded };
    app.update(AppEvent::Snapshot(Arc::new(at)));
    app.lab.as_mut().expect("a lab").marks = vec![0.5, 1.0, 1.5, 7.0];
    match press(&mut app, key)[..] {
        [Effect::Execute(Command::ScrubTo(time))] => Some(time),
        _ => None,
    }
}

#[test]
fn keys_lead_to_the_mark_before_and_to_the_mark_after() {
    for (seen, before, after) in
        [(2.0, 1.5, 0.5), (1.2, 1.0, 1.5), (0.2, 1.5, 0.5), (1.0, 0.5, 1.5)]
    {
        assert_eq!(looked_at(seen, "'"), Some(before), "{seen}");
        assert_eq!(looked_at(seen, "\""), Some(after), "{seen}");
    }
}

/// A mark beyond what is known is not looked at.
#[test]
fn without_a_mark_in_the_past_a_sentence_says_so() {
    let mut app = in_lab();
    let before = app.notifications.shown.clone();
    assert!(press(&mut app, "\"").is_empty());
    assert_ne!(app.notifications.shown.map(|notice| notice.text), before.map(|notice| notice.text));
}
