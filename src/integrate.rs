//! Steps in time: one table of methods, one file per method.
//!
//! In: a [`System`](crate::system::System) and a state. Out: steppers, which carry the state from
//! step to step and tell it anywhere inside the last one. Never here: rows, gauges, clocks.

mod impulse_schedule;
mod clock;
mod event_location;
mod dop853;
mod fixed;
mod gauss;
mod zeno;
mod leapfrog;
mod method;
mod propagator;
mod initial_step;
mod rk4;
mod roots;
mod roundoff;
mod splitting;
mod stability;
mod stepper;
mod taylor;
mod yoshida;

pub use clock::spacing;
pub use method::{METHODS, StepperResult, Method, Preserves, MethodError, Settings, Stepping, method_named};
pub use propagator::{Occurrence, OccurrenceKind, Propagator, Reached};
pub use roots::first_crossing;
pub use stability::Unstable;
pub use stepper::Stepper;
