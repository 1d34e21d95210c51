//! Background jobs, each on its own thread beside the worker's: one at a time, and the newest replaces the last.
//!
//! In: [`Job`]s with their numbers. Out: the progress of the current job, and its outcome once. A job that is
//! replaced, or whose owner is dropped, is cancelled, and its result is discarded. Never here: what is computed, and
//! for whom.

use std::fmt;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::job::{Job, Outcome, Progress, Share};

/// A derivation recurses as deeply as its expressions are nested, and an untrusted file may nest them deeply.
const STACK: usize = 64 << 20;

/// Runs one background job at a time.
pub struct SideJob<T> {
    name: &'static str,
    sender: Sender<(u64, Outcome<T>)>,
    receiver: Receiver<(u64, Outcome<T>)>,
    under_way: Option<(u64, Progress)>,
    /// When the job's budget is spent.
    ends: Option<Instant>,
}

impl<T: Send + 'static> SideJob<T> {
    /// Creates an idle instance with a name for its threads.
    pub fn new(name: &'static str) -> Self {
        let (sender, receiver) = channel();
        Self { name, sender, receiver, under_way: None, ends: None }
    }

    /// Starts a job and cancels the one before.
    pub fn begin(&mut self, ticket: u64, job: Job<T>) {
        self.begin_with(ticket, job, Progress::new());
    }

    /// Like [`begin`](SideJob::begin), with a progress that the caller shares.
    pub fn begin_with(&mut self, ticket: u64, job: Job<T>, progress: Progress) {
        self.stop();
        self.under_way = Some((ticket, progress.clone()));
        self.ends = job.budget.and_then(|budget| Instant::now().checked_add(budget));
        let sender = self.sender.clone();
        let work = move || {
            let outcome = job.run(&progress);
            // a result may be large, and the result of a cancelled job is not needed
            if !matches!(outcome, Outcome::Cancelled) {
                // the program may have ended meanwhile
                let _ = sender.send((ticket, outcome));
            }
        };
        let thread = thread::Builder::new().name(self.name.to_owned()).stack_size(STACK);
        if let Err(error) = thread.spawn(work) {
            let reason = format!("there is no thread for it: {error}");
            let _ = self.sender.send((ticket, Outcome::Failed(reason)));
        }
    }

    /// Cancels the current job.
    pub fn stop(&mut self) {
        if let Some((_, progress)) = self.under_way.take() {
            progress.cancel();
        }
    }

    /// Whether a job is running.
    pub fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// The number and progress of the current job. A job whose budget is spent is asked to end with what it has.
    pub fn share(&self) -> Option<(u64, Share)> {
        if let Some((_, progress)) = self.under_way.as_ref()
            && self.ends.is_some_and(|ends| Instant::now() >= ends)
        {
            progress.spend();
        }
        self.under_way.as_ref().map(|(ticket, progress)| (*ticket, progress.share()))
    }

    /// The outcome of the job, once it has ended.
    pub fn take(&mut self) -> Option<(u64, Outcome<T>)> {
        let newest = self.under_way.as_ref()?.0;
        let ended = self.receiver.try_iter().find(|(ticket, _)| *ticket == newest)?;
        // the job's token may be the token of its result
        self.under_way = None;
        Some(ended)
    }

    /// Waits this long for the outcome. Returns `None` if there is no job or it takes longer.
    pub fn wait(&mut self, time: Duration) -> Option<Outcome<T>> {
        let (newest, _) = self.under_way.take()?;
        let (ticket, outcome) = self.receiver.recv_timeout(time).ok()?;
        (ticket == newest).then_some(outcome)
    }
}

impl<T> fmt::Debug for SideJob<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Side")
            .field("name", &self.name)
            .field("under_way", &self.under_way)
            .finish_non_exhaustive()
    }
}

impl<T> Drop for SideJob<T> {
    fn drop(&mut self) {
        if let Some((_, progress)) = self.under_way.take() {
            progress.cancel();
        }
    }
}
