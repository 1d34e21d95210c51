//! The checker: builds an experiment from a text being edited, in the background, so that no key waits for it.
//!
//! In: a text. Out: the experiment or the text's errors, and the time taken. Only one text is checked at a time:
//! a new check cancels the previous one. Never here: the stages themselves.

use std::time::{Duration, Instant};

use crate::diagnostic::{Diagnostic, Document};
use crate::experiment::Prepared;
use crate::job::{Job, Outcome};
use crate::worker::SideJob;

/// Checks texts.
#[derive(Debug)]
pub(super) struct Checker {
    side: SideJob<Result<Box<Prepared>, Vec<Diagnostic>>>,
    begun: Instant,
}

pub(super) struct CheckResult {
    pub(super) ticket: u64,
    /// The experiment, or what is wrong with the text.
    pub(super) outcome: Result<Box<Prepared>, Vec<Diagnostic>>,
    /// How long the check took.
    pub(super) took: Duration,
}

impl Checker {
    pub(super) fn new() -> Self {
        Self { side: SideJob::new("checker"), begun: Instant::now() }
    }

    /// Cancels the check under way.
    pub(super) fn stop(&mut self) {
        self.side.stop();
    }

    /// Starts to check a text, and cancels the previous check.
    pub(super) fn check(&mut self, ticket: u64, document: Document) {
        self.begun = Instant::now();
        // The token passes to the system once that exists.
        let check = Job::new("checking", move |progress| {
            let ready = Prepared::with(&document, progress.token());
            ready.map(Box::new).map_err(|error| error.diagnostics)
        });
        self.side.begin(ticket, check);
    }

    /// Returns a result as soon as there is one.
    pub(super) fn take(&mut self) -> Option<CheckResult> {
        let (ticket, outcome) = self.side.take()?;
        let outcome = match outcome {
            Outcome::Done(made) => made,
            Outcome::Failed(sentence) => Err(vec![Diagnostic::error(0..0, sentence)]),
            Outcome::Cancelled => return None,
        };
        Some(CheckResult { ticket, outcome, took: self.begun.elapsed() })
    }
}
