//! A job: a computation in the background of the experiment, with a name, progress, a cancellation token and a
//! result.
//!
//! In: a function. Out: an [`Outcome`]. A job runs wherever it is called: on its own thread in the laboratory, or
//! directly without a screen. Never here: threads, clocks, or what is computed.

use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use crate::cancel::Cancel;

/// The work of a job: it reports its progress, checks for cancellation, and returns a result.
type Work<T> = dyn Fn(&Progress) -> T + Send + Sync;

/// A computation that can be sent to another thread. The same job gives the same result wherever it runs.
pub struct Job<T> {
    /// A short description: "level curves of the energy".
    pub name: String,
    /// How long it may take before it is asked to end with what it has.
    pub budget: Option<Duration>,
    work: Arc<Work<T>>,
}

/// The outcome of a job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome<T> {
    /// It finished.
    Done(T),
    /// It was cancelled, so its result is discarded.
    Cancelled,
    /// It failed, for the reason given in a sentence.
    Failed(String),
}

/// The progress of a job and its cancellation. Clones share both.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    cancel: Cancel,
    done: Arc<AtomicU64>,
    total: Arc<AtomicU64>,
    spent: Arc<AtomicBool>,
}

/// How much of a job is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// The amount done, which never decreases.
    pub done: u64,
    /// The total amount, or `None` if it is unknown.
    pub total: Option<u64>,
}

impl<T> Job<T> {
    /// Creates a named job.
    pub fn new(
        name: impl Into<String>,
        work: impl Fn(&Progress) -> T + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), budget: None, work: Arc::new(work) }
    }

    /// Sets how long it may take before whoever runs it calls [`Progress::spend`]; without a clock nobody does.
    #[must_use]
    pub fn within(self, budget: Duration) -> Self {
        Self { budget: Some(budget), ..self }
    }

    /// Runs the job. A panic is caught and reported.
    pub fn run(&self, progress: &Progress) -> Outcome<T> {
        // whatever a panic leaves half done belongs to the job alone and is dropped with it
        let made = catch_unwind(AssertUnwindSafe(|| (self.work)(progress)));
        match made {
            _ if progress.is_cancelled() => Outcome::Cancelled,
            Ok(result) => Outcome::Done(result),
            Err(panic) => Outcome::Failed(format!(
                "{} stopped by a bug in phaselab: {}",
                self.name,
                reason(panic.as_ref())
            )),
        }
    }
}

fn reason(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given")
}

impl<T> Clone for Job<T> {
    fn clone(&self) -> Self {
        Self { name: self.name.clone(), budget: self.budget, work: Arc::clone(&self.work) }
    }
}

impl<T> fmt::Debug for Job<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Job").field(&self.name).finish()
    }
}

/// Jobs are equal if they are the same job.
impl<T> PartialEq for Job<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.work, &other.work)
    }
}

impl Progress {
    /// Creates a progress with nothing done and no cancellation.
    pub fn new() -> Self {
        Self::default()
    }

    /// The cancellation token, for the functions that the job calls.
    pub fn token(&self) -> &Cancel {
        &self.cancel
    }

    /// Cancels the job.
    pub fn cancel(&self) {
        self.cancel.cancel();
    }

    /// Whether the job was cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Asks the job to end early with the result it has.
    pub fn spend(&self) {
        self.spent.store(true, Ordering::Relaxed);
    }

    /// Whether the job is to end with the result it has.
    pub fn is_spent(&self) -> bool {
        self.spent.load(Ordering::Relaxed)
    }

    /// Sets the total amount.
    pub fn expect(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }

    /// Sets the amount done; a smaller amount than before is ignored.
    pub fn reach(&self, done: u64) {
        self.done.fetch_max(done, Ordering::Relaxed);
    }

    /// How much of the job is done.
    pub fn share(&self) -> Share {
        let total = self.total.load(Ordering::Relaxed);
        let done = self.done.load(Ordering::Relaxed);
        let known = (total > 0).then_some(total);
        Share { done: known.map_or(done, |total| done.min(total)), total: known }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counting() -> Job<u64> {
        Job::new("counting", |progress| {
            progress.expect(10);
            let counted = (1..=10).take_while(|_| !progress.is_cancelled());
            counted.inspect(|done| progress.reach(*done)).count() as u64
        })
    }

    #[test]
    fn a_job_gives_its_result_and_says_how_far_it_is() {
        let progress = Progress::new();
        assert_eq!(progress.share(), Share { done: 0, total: None });
        assert_eq!(counting().run(&progress), Outcome::Done(10));
        assert_eq!(progress.share(), Share { done: 10, total: Some(10) });
    }

    #[test]
    fn progress_never_becomes_less_nor_more_than_all() {
        let progress = Progress::new();
        for (done, shown) in [(3, 3), (2, 3), (7, 7), (0, 7), (40, 40)] {
            progress.reach(done);
            assert_eq!(progress.share().done, shown);
        }
        progress.expect(20);
        assert_eq!(progress.share(), Share { done: 20, total: Some(20) });
    }

    #[test]
    fn a_job_asked_to_stop_gives_no_result() {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(counting().run(&progress), Outcome::Cancelled);
        assert_eq!(progress.share().done, 0);
    }

    #[test]
    fn a_job_whose_budget_is_spent_ends_with_what_it_has() {
        let job = Job::new("counting", |progress| {
            (1..=10).take_while(|done| *done <= 4 || !progress.is_spent()).count()
        });
        assert_eq!(job.run(&Progress::new()), Outcome::Done(10));
        let progress = Progress::new();
        progress.spend();
        assert_eq!(job.within(Duration::from_secs(1)).run(&progress), Outcome::Done(4));
    }

    #[test]
    fn a_panic_is_reported_with_the_name_of_the_job() {
        let job: Job<()> = Job::new("the search", |_| panic!("no way"));
        let reason = "the search stopped by a bug in phaselab: no way".to_owned();
        assert_eq!(job.run(&Progress::new()), Outcome::Failed(reason));
    }
}
