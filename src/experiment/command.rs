//! The commands of an experiment: plain data that can be logged and replayed.

use super::{Checkpoint, FoundConstant};
use crate::integrate::Settings;
use crate::system::InitialOverride;

/// A request to the experiment; it can be logged and replayed.
#[derive(Clone, PartialEq, Debug)]
pub enum Command {
    /// Lets time run.
    Play,
    /// Pauses time.
    Pause,
    /// Advances by this many single steps while paused. A single step is one frame, 1/60 s of wall
    /// time, at the current speed.
    Step(u32),
    /// Pauses, and carries the motion back by this many single steps.
    StepBack(u32),
    /// Pauses, and shows a time in the recorded past. The next command that acts on the motion continues it there; a time
    /// not before the current one leads back to it.
    ScrubTo(f64),
    /// Reverses time: from the current state on the motion runs the other way, by the same method.
    Reverse,
    /// Sets the simulated seconds per second of wall time; infinite for as fast as possible.
    Speed(f64),
    /// Sets a parameter. q and p are preserved, and the gauges take the new values as their
    /// reference.
    Parameter {
        /// Its index among the parameters.
        index: usize,
        /// Its new value.
        value: f64,
    },
    /// Sets a parameter as another step of the change before it, such as of a slider that is dragged: the jump of the
    /// energy is reported of the whole change.
    MoveParameter {
        /// Its index among the parameters.
        index: usize,
        /// Its new value.
        value: f64,
    },
    /// Sets an initial value and restarts.
    Initial {
        /// Its index: coordinates first, then velocities (Lagrangian) or momenta (Hamiltonian).
        index: usize,
        /// Its new value.
        value: f64,
    },
    /// Restarts with exactly these overrides of the file's initial values.
    Start(Vec<InitialOverride>),
    /// Applies the impulse of this index now.
    ApplyImpulse(usize),
    /// Restarts from the initial values; parameters are preserved.
    Reset,
    /// Restores all values of the file.
    FullReset,
    /// Selects a method by its name in the table of methods.
    Method(String),
    /// Sets the step of a fixed-step method.
    StepSize(f64),
    /// Sets the tolerance of an adaptive method.
    Tolerance(f64),
    /// Sets the step and the tolerance; `None` leaves the choice to the method.
    Settings(Settings),
    /// Takes the current values as the gauges' reference.
    Reference,
    /// Adds gauges for constants of the motion that were found, in place of those added before.
    Follow(Vec<FoundConstant>),
    /// Forgets the crossings of the surfaces of section so far.
    ForgetCrossings,
    /// Adds a motion from these overrides of the file's initial values beside the others.
    AddStart(Vec<InitialOverride>),
    /// Adds a motion that begins close beside the main one.
    AddNeighbour,
    /// Keeps the current run, with its parameters and its method, beside what follows.
    Pin,
    /// Removes all motions beside the main one.
    ClearCompanions,
    /// Resumes from a checkpoint.
    Restore(Box<Checkpoint>),
}

impl Command {
    /// Whether it sets values of the system or the place of its motion.
    pub fn sets_values(&self) -> bool {
        matches!(self, Self::Parameter { .. } | Self::MoveParameter { .. } | Self::Restore(_))
            || self.begins_another_motion()
    }

    /// Whether it begins another motion, so that what was said about the previous one no longer holds.
    pub fn begins_another_motion(&self) -> bool {
        matches!(self, Self::Initial { .. } | Self::Start(_) | Self::Reset | Self::FullReset)
    }
}
