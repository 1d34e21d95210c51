//! A job: one file that a key asked for, made and written on a thread of its own, so that no key waits for the disk.
//!
//! In: what is to be done. Out: a sentence on what became of it, once. One at a time. Never here: what is written.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;
use std::time::Duration;

/// What became of it, as a sentence for the user.
pub(super) type Told = Result<String, String>;

/// The job under way, if there is one.
#[derive(Debug, Default)]
pub(super) struct Job {
    answer: Option<Receiver<Told>>,
}

impl Job {
    /// Begins a job.
    ///
    /// # Errors
    /// Where one is under way, or there is no thread for it.
    pub(super) fn begin(
        &mut self,
        work: impl FnOnce() -> Told + Send + 'static,
    ) -> Result<(), String> {
        if self.answer.is_some() {
            return Err("A file is still being written; ask again when it is there.".to_owned());
        }
        let (sender, answer) = channel();
        let guarded = move || {
            let told = catch_unwind(AssertUnwindSafe(work));
            let told = told.unwrap_or_else(|_| {
                Err("The file is not written, by a defect of the program.".to_owned())
            });
            // the program may have ended meanwhile
            let _ = sender.send(told);
        };
        let started = thread::Builder::new().name("writer".to_owned()).spawn(guarded);
        started.map_err(|why| format!("There is no thread to write the file on: {why}."))?;
        self.answer = Some(answer);
        Ok(())
    }

    /// What became of it, once it has ended.
    pub(super) fn take(&mut self) -> Option<Told> {
        let told = match self.answer.as_ref()?.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Ok(told) => Some(told),
            Err(TryRecvError::Disconnected) => None,
        };
        self.answer = None;
        told
    }

    /// The same, waited for so long; `None` where there was none, or it takes longer.
    pub(super) fn wait(&mut self, time: Duration) -> Option<Told> {
        self.answer.take()?.recv_timeout(time).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_one_at_a_time_and_it_is_reported_once() {
        let (go, wait) = channel::<()>();
        let mut job = Job::default();
        let work = move || wait.recv().map(|()| "done".to_owned()).map_err(|why| why.to_string());
        assert_eq!(job.begin(work), Ok(()));
        assert_eq!(job.take(), None);
        assert!(job.begin(|| Ok(String::new())).is_err(), "one is under way");
        go.send(()).expect("it waits");
        assert_eq!(job.wait(Duration::from_secs(20)), Some(Ok("done".to_owned())));
        assert_eq!(job.take(), None);
        assert_eq!(job.begin(|| Ok(String::new())), Ok(()));
    }
}
