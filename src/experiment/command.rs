//! What can be asked of an experiment: plain data that can be logged and replayed.

use super::Checkpoint;
use crate::integrate::Settings;
use crate::system::InitialOverride;

/// One request.
#[derive(Clone, PartialEq, Debug)]
pub enum Command {
    /// Let time run.
    Play,
    /// Hold it.
    Pause,
    /// Advance by this many single steps (of the view's frame time, 1/60 s of simulated time at
    /// the current speed) while paused.
    Step(u32),
    /// Simulated seconds per second of the wall clock; infinite means flat out.
    Speed(f64),
    /// Sets a parameter; q and p are kept, and the gauges take the new values as their reference.
    Parameter {
        /// Its place among the parameters.
        index: usize,
        /// Its new value.
        value: f64,
    },
    /// Sets an initial value and starts again from the initial values.
    Initial {
        /// Its place: coordinates first, then velocities (Lagrangian) or momenta (Hamiltonian).
        index: usize,
        /// Its new value.
        value: f64,
    },
    /// Begins the motion anew with these in place of the file's initial values, and with no others.
    Start(Vec<InitialOverride>),
    /// Strikes the motion now with the impulse of this index.
    ApplyImpulse(usize),
    /// Back to the initial values; parameters stay.
    Reset,
    /// Back to all values of the file.
    FullReset,
    /// Chooses a method by the name in the table of methods.
    Method(String),
    /// The step of a method of fixed step.
    StepSize(f64),
    /// The tolerance of an adaptive method.
    Tolerance(f64),
    /// The step and the tolerance of the method, each as asked for or left to the method.
    Settings(Settings),
    /// Takes the present values as the gauges' reference.
    Reference,
    /// Takes up a motion that was left elsewhere.
    TakeUp(Box<Checkpoint>),
}
