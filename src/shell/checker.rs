//! The checker: from a text being edited to an experiment, on the side, so that no key waits for it.
//!
//! In: a text. Out: what was made of it, or its mistakes, and how long that took. One text at a time: the next one stops
//! the one before. Never here: the stages themselves.

use std::time::{Duration, Instant};

use crate::diagnostic::{Diagnostic, Document};
use crate::experiment::Prepared;
use crate::job::{Job, Outcome};
use crate::worker::Side;

/// Checks texts.
#[derive(Debug)]
pub(super) struct Checker {
    side: Side<Result<Box<Prepared>, Vec<Diagnostic>>>,
    begun: Instant,
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
        Self { side: Side::new("checker"), begun: Instant::now() }
    }

    /// The check under way is no longer wanted.
    pub(super) fn stop(&mut self) {
        self.side.stop();
    }

    /// Begins to check a text, and stops the check before.
    pub(super) fn check(&mut self, ticket: u64, document: Document) {
        self.begun = Instant::now();
        // the token is the system's once it is there
        let check = Job::new("checking", move |progress| {
            let ready = Prepared::with(&document, progress.token());
            ready.map(Box::new).map_err(|unready| unready.mistakes)
        });
        self.side.begin(ticket, check);
    }

    /// An answer, once it is there.
    pub(super) fn take(&mut self) -> Option<Answer> {
        let (ticket, outcome) = self.side.take()?;
        let outcome = match outcome {
            Outcome::Done(made) => made,
            Outcome::Failed(sentence) => Err(vec![Diagnostic::error(0..0, sentence)]),
            Outcome::Cancelled => return None,
        };
        Some(Answer { ticket, outcome, took: self.begun.elapsed() })
    }
}
