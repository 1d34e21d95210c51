//! Analysis of a motion: verdicts on its invariants, answers to questions about brackets, and the
//! [`Landscape`] of its energy.
//!
//! In: histories of values, a compiled system. Out: a [`Verdict`], an [`Inquiry`], curves. Never
//! here: files and their claims, threads, wall clocks, terminals.

mod crossing_log;
mod history;
mod inquiry;
mod landscape;
mod separation;
mod verdict;

pub use crossing_log::CrossingLog;
pub use history::{History, Stretch};
pub use inquiry::{Inquiry, InquiryAnswer};
pub use landscape::{Curve, Grid, Landscape, Plane};
pub use separation::{DistanceHistory, Slope, distance};
pub use verdict::{
    Errors, Growth, LEFT, LOST, RESOLVED, RoundedInput, Unseen, Verdict, rounding_floor,
};
