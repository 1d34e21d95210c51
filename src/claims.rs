//! Checks the claims of a file: whether the quantities declared conserved are conserved, and the
//! expected numbers are those of the motion.
//!
//! In: a model and its equations. Out: a diagnostic for each claim that is false, at its place.
//! Claims proved symbolically are not integrated. Never here: how claims are written.

mod brackets;
mod check;
mod conservation;
mod dissipation;
mod invariants;
mod motion;
mod observation;
mod own_method;
mod quantity_sizes;
mod start;
mod step;
mod uniqueness;
mod unresolved;

pub use check::{false_claims, false_claims_followed, structure_diagnostics};
pub use start::{start_on_a_pole, undefined_start};
pub use uniqueness::several_starts;
pub use unresolved::unresolved_feature;
