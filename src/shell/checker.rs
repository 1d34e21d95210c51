//! The checker: from a text being edited to an experiment, on a thread of its own, so that no key waits for it.
//!
//! In: a text. Out: what was made of it, or its mistakes, and how long that took. One text at a time: the next one stops
//! the one before. Never here: the stages themselves.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::loader::{STACK, defect};
use crate::cancel::Cancel;
use crate::diagnostic::{Diagnostic, Document};
use crate::experiment::Prepared;

/// Checks texts.
#[derive(Debug)]
pub(super) struct Checker {
    sender: Sender<Answer>,
    receiver: Receiver<Answer>,
    /// Stops the check under way, of that number.
    cancel: Option<(u64, Cancel)>,
}

/// What became of a text.
pub(super) struct Answer {
    /// Which check it was.
    pub(super) ticket: u64,
    /// The experiment it makes, or what is wrong with it.
    pub(super) outcome: Result<Box<Prepared>, Vec<Diagnostic>>,
    /// How long that took.
    pub(super) took: Duration,
}

impl Checker {
    /// A checker with nothing to do.
    pub(super) fn new() -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, cancel: None }
    }

    /// The check under way is no longer wanted.
    pub(super) fn stop(&mut self) {
        if let Some((_, cancel)) = self.cancel.take() {
            cancel.cancel();
        }
    }

    /// Begins to check a text, and stops the check before.
    pub(super) fn check(&mut self, ticket: u64, document: Document) {
        self.stop();
        let cancel = Cancel::new();
        self.cancel = Some((ticket, cancel.clone()));
        let sender = self.sender.clone();
        let begun = Instant::now();
        let work = move || {
            let made = catch_unwind(AssertUnwindSafe(|| Prepared::with(&document, &cancel)));
            if cancel.is_cancelled() {
                // nobody waits for it, and it is large
                return;
            }
            let outcome = match made {
                Ok(Ok(ready)) => Ok(Box::new(ready)),
                Ok(Err(unready)) => Err(unready.mistakes),
                Err(panic) => Err(vec![Diagnostic::error(0..0, defect(panic.as_ref()))]),
            };
            // The program may have ended meanwhile.
            let _ = sender.send(Answer { ticket, outcome, took: begun.elapsed() });
        };
        let started =
            thread::Builder::new().name("checker".to_owned()).stack_size(STACK).spawn(work);
        if let Err(error) = started {
            let mistake =
                Diagnostic::error(0..0, format!("there is no thread to check it on: {error}"));
            let answer = Answer { ticket, outcome: Err(vec![mistake]), took: begun.elapsed() };
            let _ = self.sender.send(answer);
        }
    }

    /// An answer, once it is there.
    pub(super) fn take(&mut self) -> Option<Answer> {
        let answer = self.receiver.try_recv().ok()?;
        // the token is the system's from now on
        self.cancel.take_if(|(ticket, _)| *ticket == answer.ticket);
        Some(answer)
    }
}

impl Drop for Checker {
    fn drop(&mut self) {
        self.stop();
    }
}
