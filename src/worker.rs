//! The thread that keeps an experiment in motion: commands in, the newest snapshot out.
//!
//! In: an experiment ([`Worker::load`]) and [`Command`]s. Out: [`Snapshot`]s through a slot of
//! one, where the newest wins and nobody waits. The mailbox is emptied before each slice of about
//! two milliseconds, so a held key costs one slice; nothing is computed, and nothing wakes, while
//! time is held. A panic of the experiment becomes a fault in a snapshot. What is no longer wanted is
//! stopped within its step, by its token. Never here: terminals, physics, drawing.

mod pace;
mod runnable;
mod slice;
mod thread;

use std::io;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::Builder;
use std::time::Duration;

use arc_swap::ArcSwapOption;

use crate::cancel::Cancel;
use crate::experiment::{Command, Snapshot};

pub use runnable::Runnable;

use thread::Message;

/// The name of the worker's thread, for a panic hook to tell it from the one that owns the
/// terminal.
pub const THREAD_NAME: &str = "phaselab worker";

/// How long the end of a worker is waited for: a step looks at its token far sooner, and one that
/// does not must not hold up the end of the program.
const PATIENCE: Duration = Duration::from_millis(50);

/// A thread and the two ways to and from it. Dropping it ends the thread.
#[derive(Debug)]
pub struct Worker {
    mailbox: Sender<Message>,
    slot: Arc<ArcSwapOption<Snapshot>>,
    seen: Option<Arc<Snapshot>>,
    epoch: u64,
    /// Stops what is being computed.
    cancel: Cancel,
    /// Closed when the thread has ended.
    end: Receiver<()>,
}

impl Worker {
    /// A worker with nothing to do yet.
    ///
    /// # Errors
    /// Where the system has no thread to give.
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

    /// A worker with an experiment, which is of epoch 1.
    ///
    /// # Errors
    /// Where the system has no thread to give.
    pub fn spawn(subject: impl Runnable + 'static) -> io::Result<Worker> {
        let mut worker = Worker::idle()?;
        worker.load(subject);
        Ok(worker)
    }

    /// Puts another experiment in the place of the present one; its snapshots are of the epoch
    /// returned, and none of another epoch follows them.
    pub fn load(&mut self, mut subject: impl Runnable + 'static) -> u64 {
        self.epoch += 1;
        self.cancel.cancel();
        self.cancel = subject.cancel();
        subject.set_epoch(self.epoch);
        self.send(Message::Load(self.epoch, Box::new(subject)));
        self.epoch
    }

    /// The epoch of what was loaded last; 0 before anything was.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Hands over a command. It is obeyed before the next slice, and a snapshot follows at once.
    pub fn tell(&self, command: Command) {
        self.send(Message::Execute(command));
    }

    /// The newest snapshot of the present epoch, if it was not returned before.
    pub fn newest(&mut self) -> Option<Arc<Snapshot>> {
        let newest = self.slot.load_full().filter(|s| s.epoch == self.epoch)?;
        if self.seen.as_ref().is_some_and(|seen| Arc::ptr_eq(seen, &newest)) {
            return None;
        }
        self.seen = Some(Arc::clone(&newest));
        Some(newest)
    }

    fn send(&self, letter: Message) {
        // a thread that is gone cannot be reported anything; there is nothing to be done about it
        let _ = self.mailbox.send(letter);
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.cancel.cancel();
        self.send(Message::Stop);
        // its panics were caught where they happened; nothing is ever sent
        if let Err(RecvTimeoutError::Timeout) = self.end.recv_timeout(PATIENCE) {
            // a step that does not look at its token ends with the program
        }
    }
}
