//! The subject of a worker. The program has only one kind, the [`Experiment`]; tests have others,
//! which panic or count.

use crate::cancel::Cancel;
use crate::experiment::{AdvanceOutcome, Command, Experiment, Snapshot, Status};

/// Something that executes commands, advances in time and takes snapshots.
pub trait Runnable: Send {
    /// Sets the epoch of all further snapshots.
    fn set_epoch(&mut self, epoch: u64);
    /// The token that cancels its computations, even within a step.
    fn cancel(&self) -> Cancel {
        Cancel::new()
    }
    /// Executes a command.
    fn execute(&mut self, command: Command);
    /// Advances to a time in at most `budget` steps.
    fn advance(&mut self, time: f64, budget: u64) -> AdvanceOutcome;
    /// What it advances in: the current time, or its negative while time runs backwards.
    fn time(&self) -> f64;
    /// Simulated seconds per second of wall time; infinite for as fast as possible.
    fn speed(&self) -> f64;
    /// Whether time runs.
    fn status(&self) -> Status;
    /// Takes a snapshot of the current state.
    fn snapshot(&self) -> Snapshot;
    /// Whether something beside it has yet to reach the current time.
    fn is_behind(&self) -> bool {
        false
    }
    /// A frame's worth of time has passed since this was called last.
    fn shown(&mut self) {}
}

impl Runnable for Experiment {
    fn set_epoch(&mut self, epoch: u64) {
        Experiment::set_epoch(self, epoch);
    }

    fn cancel(&self) -> Cancel {
        Experiment::cancel(self).clone()
    }

    fn execute(&mut self, command: Command) {
        Experiment::execute(self, command);
    }

    fn advance(&mut self, time: f64, budget: u64) -> AdvanceOutcome {
        Experiment::advance(self, time, budget)
    }

    fn time(&self) -> f64 {
        Experiment::clock(self)
    }

    fn speed(&self) -> f64 {
        Experiment::speed(self)
    }

    fn status(&self) -> Status {
        Experiment::status(self)
    }

    fn snapshot(&self) -> Snapshot {
        Experiment::snapshot(self)
    }

    fn is_behind(&self) -> bool {
        Experiment::is_behind(self)
    }

    fn shown(&mut self) {
        Experiment::shown(self);
    }
}
