//! Steps in time: one table of methods, one file per method.
//!
//! In: a [`System`](crate::system::System) and a state. Out: steppers, which carry the state from
//! step to step and tell it anywhere inside the last one. Never here: rows, gauges, clocks.

mod calendar;
mod clock;
mod crossing;
mod crossings;
mod dop853;
mod fixed;
mod gauss;
mod haste;
mod leapfrog;
mod method;
mod methods;
mod motion;
mod pace;
mod polynomial;
mod probe;
mod rk4;
mod roots;
mod rounding;
mod sampling;
mod splitting;
mod stability;
mod stepper;
mod taylor;
mod yoshida;

pub use clock::spacing;
pub use method::{Made, Method, Preserves, Refusal, Settings, Stepping};
pub use methods::{METHODS, method_named};
pub use motion::{Happening, Kind, Motion, Reached};
pub use roots::first_crossing;
pub use stability::Unstable;
pub use stepper::Stepper;
