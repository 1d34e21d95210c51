//! Jobs on a thread of their own, beside the worker's: one at a time, and the newest is the one that counts.
//!
//! In: [`Job`]s with their numbers. Out: how far the one under way is, and what became of it, once. A job that is replaced, or
//! whose owner goes, is asked to stop, and what it still returns is dropped. Never here: what is computed, and who asked.

use std::fmt;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

use crate::job::{Job, Outcome, Progress, Share};

/// A derivation goes as deep as its expressions are nested, and a stranger's file may nest them far.
const STACK: usize = 64 << 20;

/// A place on the side where one job runs at a time.
pub struct Side<T> {
    /// What its threads are called.
    name: &'static str,
    sender: Sender<(u64, Outcome<T>)>,
    receiver: Receiver<(u64, Outcome<T>)>,
    under_way: Option<(u64, Progress)>,
}

impl<T: Send + 'static> Side<T> {
    /// A place with nothing to do; the name is that of its threads.
    pub fn new(name: &'static str) -> Self {
        let (sender, receiver) = channel();
        Self { name, sender, receiver, under_way: None }
    }

    /// Begins a job, and stops the one before.
    pub fn begin(&mut self, ticket: u64, job: Job<T>) {
        self.begin_with(ticket, job, Progress::new());
    }

    /// The same, where the progress is known to somebody else too.
    pub fn begin_with(&mut self, ticket: u64, job: Job<T>, progress: Progress) {
        self.stop();
        self.under_way = Some((ticket, progress.clone()));
        let sender = self.sender.clone();
        let work = move || {
            let outcome = job.run(&progress);
            // what was computed may be large, and nobody waits for a job that was stopped
            if !matches!(outcome, Outcome::Cancelled) {
                // the program may have ended meanwhile
                let _ = sender.send((ticket, outcome));
            }
        };
        let thread = thread::Builder::new().name(self.name.to_owned()).stack_size(STACK);
        if let Err(error) = thread.spawn(work) {
            let told = format!("there is no thread for it: {error}");
            let _ = self.sender.send((ticket, Outcome::Failed(told)));
        }
    }

    /// The job under way is no longer wanted.
    pub fn stop(&mut self) {
        if let Some((_, progress)) = self.under_way.take() {
            progress.cancel();
        }
    }

    /// Whether a job is under way.
    pub fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// The number of the job under way, and how far it is.
    pub fn share(&self) -> Option<(u64, Share)> {
        self.under_way.as_ref().map(|(ticket, progress)| (*ticket, progress.share()))
    }

    /// What became of the job, once it has ended.
    pub fn take(&mut self) -> Option<(u64, Outcome<T>)> {
        let newest = self.under_way.as_ref()?.0;
        let ended = self.receiver.try_iter().find(|(ticket, _)| *ticket == newest)?;
        // its token may be that of what it made
        self.under_way = None;
        Some(ended)
    }

    /// The same, waited for so long; `None` where there was none, or it takes longer.
    pub fn wait(&mut self, time: Duration) -> Option<Outcome<T>> {
        let (newest, _) = self.under_way.take()?;
        let (ticket, outcome) = self.receiver.recv_timeout(time).ok()?;
        (ticket == newest).then_some(outcome)
    }
}

impl<T> fmt::Debug for Side<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Side")
            .field("name", &self.name)
            .field("under_way", &self.under_way)
            .finish_non_exhaustive()
    }
}

impl<T> Drop for Side<T> {
    fn drop(&mut self) {
        if let Some((_, progress)) = self.under_way.take() {
            progress.cancel();
        }
    }
}
