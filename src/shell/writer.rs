//! The writer: creates one file requested by a key, in the background, so that no key waits for the disk.
//!
//! In: the work to do. Out: a sentence about its outcome, once. Only one file is written at a time, and a write is
//! never cancelled for the next. Never here: what is written.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::job::{Job, Outcome};
use crate::worker::SideJob;

/// The outcome, as a sentence for the user.
pub(super) type WriteReport = Result<String, String>;

/// The file being written, if there is one.
#[derive(Debug)]
pub(super) struct Writer {
    side: SideJob<WriteReport>,
}

impl Writer {
    pub(super) fn new() -> Self {
        Self { side: SideJob::new("writer") }
    }

    /// Starts to write a file.
    ///
    /// # Errors
    /// Returns an error if a file is already being written.
    pub(super) fn begin(
        &mut self,
        work: impl FnOnce() -> WriteReport + Send + 'static,
    ) -> Result<(), String> {
        if self.side.is_busy() {
            return Err("A file is still being written; try again when it is done.".to_owned());
        }
        // A file is written once, although a job could be run again.
        let work = Mutex::new(Some(work));
        let job = Job::new("The writing of the file", move |_| {
            let work = work.lock().unwrap_or_else(PoisonError::into_inner).take();
            work.map_or_else(|| Err("The file was written before.".to_owned()), |work| work())
        });
        self.side.begin(0, job);
        Ok(())
    }

    pub(super) fn is_busy(&self) -> bool {
        self.side.is_busy()
    }

    /// Returns the outcome as soon as there is one.
    pub(super) fn take(&mut self) -> Option<WriteReport> {
        self.side.take().and_then(|(_, outcome)| report(outcome))
    }

    /// Waits at most this long for the outcome. Returns `None` if there is no write, or if it takes longer.
    pub(super) fn wait(&mut self, time: Duration) -> Option<WriteReport> {
        self.side.wait(time).and_then(report)
    }
}

fn report(outcome: Outcome<WriteReport>) -> Option<WriteReport> {
    match outcome {
        Outcome::Done(report) => Some(report),
        Outcome::Failed(sentence) => Some(Err(format!("{sentence}."))),
        Outcome::Cancelled => None,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn there_is_one_at_a_time_and_it_is_reported_once() {
        let (go, wait) = channel::<()>();
        let mut writer = Writer::new();
        let work = move || wait.recv().map(|()| "done".to_owned()).map_err(|why| why.to_string());
        assert_eq!(writer.begin(work), Ok(()));
        assert_eq!(writer.take(), None);
        assert!(writer.begin(|| Ok(String::new())).is_err(), "one is under way");
        go.send(()).expect("it waits");
        assert_eq!(writer.wait(Duration::from_secs(20)), Some(Ok("done".to_owned())));
        assert_eq!(writer.take(), None);
        assert_eq!(writer.begin(|| Ok(String::new())), Ok(()));
    }
}
