//! The loop on the thread.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
use std::time::{Duration, Instant};

use arc_swap::ArcSwapOption;

use super::Runnable;
use super::pace::Pace;
use super::slice::Slice;
use crate::experiment::{AdvanceOutcome, Command, RunError, Snapshot, Status};

/// The least time between two snapshots that no command asked for.
const BETWEEN_SNAPSHOTS: Duration = Duration::from_millis(16);

pub(super) enum Message {
    Execute(Command),
    /// A new subject with its epoch.
    Load(u64, Box<dyn Runnable>),
    /// Ends the thread.
    Stop,
}

/// The thread was asked to end.
struct Stopped;

/// Runs until it receives [`Message::Stop`].
pub(super) fn run(messages: &Receiver<Message>, slot: &ArcSwapOption<Snapshot>) {
    let mut worker = WorkerLoop {
        messages,
        slot,
        runnable: None,
        epoch: 0,
        pace: Pace::new(Instant::now(), 0.0, 1.0),
        slice: Slice::new(),
        published: Instant::now(),
    };
    while worker.iterate().is_ok() {}
}

struct WorkerLoop<'a> {
    messages: &'a Receiver<Message>,
    slot: &'a ArcSwapOption<Snapshot>,
    /// `None` before the first one, and after one has panicked.
    runnable: Option<Box<dyn Runnable>>,
    epoch: u64,
    pace: Pace,
    slice: Slice,
    published: Instant,
}

impl WorkerLoop<'_> {
    /// One iteration: messages, a slice of work, a snapshot, and sleep if there is time.
    fn iterate(&mut self) -> Result<(), Stopped> {
        self.read_messages()?;
        let Some(runnable) = self.running() else {
            if self.catches_up() {
                return Ok(());
            }
            let message = self.messages.recv().map_err(|_| Stopped)?;
            return self.handle(message);
        };
        let time = runnable.time();
        let began = Instant::now();
        let target = self.pace.target(began, time);
        let budget = self.slice.budget();
        let progress = self.guarded(|runnable| runnable.advance(target, budget));
        if progress == Some(AdvanceOutcome::Underway) {
            self.slice.learn(began.elapsed());
        }
        let since = self.published.elapsed();
        if since >= BETWEEN_SNAPSHOTS
            || matches!(progress, Some(AdvanceOutcome::Stuck | AdvanceOutcome::Ended))
        {
            self.publish();
            self.guarded(|runnable| runnable.shown());
        } else if progress == Some(AdvanceOutcome::Arrived) {
            return self.wait(BETWEEN_SNAPSHOTS.saturating_sub(since));
        }
        Ok(())
    }

    /// Lets what is behind catch up by a slice while time does not run. Returns whether there was anything to do.
    fn catches_up(&mut self) -> bool {
        let Some(runnable) = self.runnable.as_deref().filter(|runnable| runnable.is_behind())
        else {
            return false;
        };
        let time = runnable.time();
        let began = Instant::now();
        let budget = self.slice.budget();
        self.guarded(|runnable| runnable.advance(time, budget));
        self.slice.learn(began.elapsed());
        let done = !self.runnable.as_deref().is_some_and(Runnable::is_behind);
        if done || self.published.elapsed() >= BETWEEN_SNAPSHOTS {
            self.publish();
        }
        true
    }

    /// The subject, if time runs in it.
    fn running(&self) -> Option<&dyn Runnable> {
        self.runnable.as_deref().filter(|runnable| runnable.status() == Status::Running)
    }

    /// Sleeps for this long, or until a message comes.
    fn wait(&mut self, time: Duration) -> Result<(), Stopped> {
        match self.messages.recv_timeout(time) {
            Ok(message) => self.handle(message),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => Err(Stopped),
        }
    }

    /// Empties the mailbox.
    fn read_messages(&mut self) -> Result<(), Stopped> {
        loop {
            match self.messages.try_recv() {
                Ok(message) => self.handle(message)?,
                Err(TryRecvError::Empty) => return Ok(()),
                Err(TryRecvError::Disconnected) => return Err(Stopped),
            }
        }
    }

    /// Handles a message and publishes the result. Simulated time continues without interruption,
    /// unless the message changed it.
    fn handle(&mut self, message: Message) -> Result<(), Stopped> {
        let before = self.pace_inputs();
        match message {
            Message::Stop => return Err(Stopped),
            Message::Load(epoch, runnable) => {
                self.epoch = epoch;
                self.runnable = Some(runnable);
            }
            Message::Execute(command) => {
                self.guarded(|runnable| runnable.execute(command));
            }
        }
        let after = self.pace_inputs();
        if let Some((_, time, speed)) = after
            && after != before
        {
            self.pace = Pace::new(Instant::now(), time, speed);
        }
        self.publish();
        Ok(())
    }

    /// The inputs of the pacing: whether time runs, the current time, and the speed.
    fn pace_inputs(&self) -> Option<(bool, f64, f64)> {
        let runnable = self.runnable.as_deref()?;
        Some((runnable.status() == Status::Running, runnable.time(), runnable.speed()))
    }

    fn publish(&mut self) {
        if let Some(snapshot) = self.guarded(|runnable| runnable.snapshot()) {
            self.slot.store(Some(Arc::new(snapshot)));
        }
        self.published = Instant::now();
    }

    /// Lets the subject do something. If it panics, it is dropped, and the newest snapshot reports
    /// the panic.
    fn guarded<T>(&mut self, act: impl FnOnce(&mut dyn Runnable) -> T) -> Option<T> {
        let runnable = self.runnable.as_deref_mut()?;
        // the subject is dropped if it panics, so its half-done state is never seen
        match catch_unwind(AssertUnwindSafe(|| act(runnable))) {
            Ok(result) => Some(result),
            Err(panic) => {
                self.runnable = None;
                self.report_panic(panic.as_ref());
                None
            }
        }
    }

    fn report_panic(&self, panic: &(dyn Any + Send)) {
        let last = self.slot.load_full().filter(|last| last.epoch == self.epoch);
        let last = last.map_or_else(|| Snapshot::empty(self.epoch), |last| (*last).clone());
        let reason = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("no reason given");
        let message = format!(
            "the integrator was stopped by a bug in phaselab ({reason}); load the system again"
        );
        let status = Status::Failed(RunError { time: last.time, message, ends_motion: false });
        self.slot.store(Some(Arc::new(Snapshot { status, ..last })));
    }
}
