//! Steps in time: one table of methods, one file per method.
//!
//! In: a [`System`](crate::system::System) and a state. Out: steppers, which carry the state from
//! step to step and tell it anywhere inside the last one. Never here: rows, gauges, clocks.

mod clock;
mod dop853;
mod event_location;
mod fixed;
mod gauss;
mod impulse_schedule;
mod initial_step;
mod leapfrog;
mod method;
mod propagator;
mod rk4;
mod roots;
mod roundoff;
mod splitting;
mod stability;
mod stepper;
mod taylor;
mod yoshida;
mod zeno;

pub use clock::spacing;
pub use method::{
    METHODS, Method, MethodError, Preserves, Settings, StepperResult, Stepping, method_named,
};
pub use propagator::{Occurrence, OccurrenceKind, Propagator, Reached};
pub use roots::first_crossing;
pub use stability::Unstable;
pub use stepper::Stepper;
