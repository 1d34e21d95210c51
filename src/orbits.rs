//! What many orbits of one system have: their ends, measures.
//!
//! In: a compiled [`System`](crate::system::System), a method, a [`Start`](crate::ensemble::Start) for each orbit. Out: one result an orbit, in
//! the order asked for and the same to the last bit whatever the number of threads. Never here: files, tables, what is
//! printed.

mod measure;
mod outcome;

pub use measure::{MEASURES, MeasuredOrbits, OrbitMeasure, Zeros, measure_named};
pub use outcome::{Departed, RunOutcome, RunPlan};
