//! The handle by which other threads use the worker.
//!
//! In: commands. Out: the newest snapshot. Never here: the loop on the thread.

use std::io;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::Builder;
use std::time::Duration;

use arc_swap::ArcSwapOption;

use super::runnable::Runnable;
use super::thread;
use super::thread::Message;
use crate::cancel::Cancel;
use crate::experiment::{Command, Snapshot};

/// The name of the worker's thread, by which a panic hook distinguishes it from the thread that
/// owns the terminal.
pub const THREAD_NAME: &str = "phaselab worker";

/// How long a worker may take to end. A step normally checks its token far sooner, and one that
/// does not must not delay the end of the program.
const TIMEOUT: Duration = Duration::from_millis(50);

/// A thread with its mailbox and its snapshot slot. Dropping it ends the thread.
#[derive(Debug)]
pub struct Worker {
    mailbox: Sender<Message>,
    slot: Arc<ArcSwapOption<Snapshot>>,
    seen: Option<Arc<Snapshot>>,
    epoch: u64,
    /// Cancels the current computation.
    cancel: Cancel,
    /// Closed when the thread has ended.
    end: Receiver<()>,
}

impl Worker {
    /// Creates a worker without an experiment.
    ///
    /// # Errors
    /// Returns an error if the system cannot create a thread.
    pub fn idle() -> io::Result<Worker> {
        let (mailbox, messages) = mpsc::channel();
        let slot = Arc::new(ArcSwapOption::empty());
        let theirs = Arc::clone(&slot);
        let (ended, end) = mpsc::channel();
        Builder::new().name(THREAD_NAME.to_owned()).spawn(move || {
            let _ended: Sender<()> = ended;
            thread::run(&messages, &theirs);
        })?;
        Ok(Worker { mailbox, slot, seen: None, epoch: 0, cancel: Cancel::new(), end })
    }

    /// Creates a worker with an experiment, which has epoch 1.
    ///
    /// # Errors
    /// Returns an error if the system cannot create a thread.
    pub fn spawn(runnable: impl Runnable + 'static) -> io::Result<Worker> {
        let mut worker = Worker::idle()?;
        worker.load(runnable);
        Ok(worker)
    }

    /// Replaces the experiment. Its snapshots have the returned epoch, and no snapshot of another
    /// epoch follows them.
    pub fn load(&mut self, mut runnable: impl Runnable + 'static) -> u64 {
        self.epoch += 1;
        self.cancel.cancel();
        self.cancel = runnable.cancel();
        runnable.set_epoch(self.epoch);
        self.send(Message::Load(self.epoch, Box::new(runnable)));
        self.epoch
    }

    /// The epoch of the last loaded experiment; 0 if there was none.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Sends a command. It is executed before the next slice, and a snapshot follows at once.
    pub fn execute(&self, command: Command) {
        self.send(Message::Execute(command));
    }

    /// The newest snapshot of the current epoch, unless it was already returned.
    pub fn newest(&mut self) -> Option<Arc<Snapshot>> {
        let newest = self.slot.load_full().filter(|s| s.epoch == self.epoch)?;
        if self.seen.as_ref().is_some_and(|seen| Arc::ptr_eq(seen, &newest)) {
            return None;
        }
        self.seen = Some(Arc::clone(&newest));
        Some(newest)
    }

    fn send(&self, message: Message) {
        // sending fails only if the thread has ended, and then nothing can be done
        let _ = self.mailbox.send(message);
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.cancel.cancel();
        self.send(Message::Stop);
        // its panics were caught where they happened; nothing is ever sent
        if let Err(RecvTimeoutError::Timeout) = self.end.recv_timeout(TIMEOUT) {
            // a step that does not check its token ends with the program
        }
    }
}
