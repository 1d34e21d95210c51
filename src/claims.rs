//! Whether what a file claims of itself is true: what it says is conserved is, and its numbers are
//! what the motion gives.
//!
//! In: a model and what follows from it. Out: a mistake for each claim that is false, at its
//! place. What is proved symbolically is not integrated. Never here: how claims are written.

mod brackets;
mod check;
mod start;

pub use check::{false_claims, flaws};
