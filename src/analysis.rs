//! What can be said of a motion: verdicts on its invariants, whether a file's claims hold, and the
//! [`Landscape`] of the energy it moves in.
//!
//! In: histories of values, a [`Model`](crate::model::Model) with its claims, a compiled system.
//! Out: a [`Verdict`], mistakes at their places, curves. Never here: threads, clocks, terminals, files.

mod brackets;
mod claims;
mod history;
mod inquiry;
mod landscape;
mod start;
mod verdict;

pub use claims::{false_claims, flaws};
pub use history::{History, Stretch};
pub use inquiry::{Answer, Inquiry};
pub use landscape::{Curve, Grid, Landscape, Plane};
pub use verdict::{Growth, LEFT, LOST, Verdict, rounding_floor};
