//! What many orbits of one system have: their ends, measures, actions.
//!
//! In: a compiled [`System`](crate::system::System), a method, a [`Start`](crate::ensemble::Start) for each orbit. Out: one result an orbit, in
//! the order asked for and the same to the last bit whatever the number of threads. Never here: files, tables, what is
//! printed.

mod actions;
mod effective_potential;
mod measure;
mod outcome;

pub use actions::{
    ActionRow, ActionSystems, NoAction, RegionKind, action_between, action_row, cyclic_row,
};
pub use effective_potential::{AllowedInterval, EffectivePotential};
pub use measure::{MEASURES, MeasuredOrbit, OrbitMeasure, Zeros, measure_named};
pub use outcome::{RunOutcome, RunPlan};
