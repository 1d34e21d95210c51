//! What a worker can keep in motion. There is one in the program, the [`Experiment`]; tests have
//! others, which panic or count.

use crate::cancel::Cancel;
use crate::experiment::{Command, Experiment, Progress, Snapshot, Status};

/// Something that obeys commands, moves in time and can be looked at.
pub trait Runnable: Send {
    /// Gives all snapshots this epoch.
    fn set_epoch(&mut self, epoch: u64);
    /// The token that stops what it computes, also in the middle of a step.
    fn cancel(&self) -> Cancel {
        Cancel::new()
    }
    /// Does what a command asks.
    fn execute(&mut self, command: Command);
    /// Moves on to a time in at most `budget` steps.
    fn advance(&mut self, time: f64, budget: u64) -> Progress;
    /// The present time.
    fn time(&self) -> f64;
    /// Simulated seconds per second of the wall clock; infinite means flat out.
    fn speed(&self) -> f64;
    /// Whether time runs.
    fn status(&self) -> Status;
    /// What can be seen of it now.
    fn snapshot(&self) -> Snapshot;
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

    fn advance(&mut self, time: f64, budget: u64) -> Progress {
        Experiment::advance(self, time, budget)
    }

    fn time(&self) -> f64 {
        Experiment::time(self)
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
}
