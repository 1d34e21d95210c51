//! Numbers: the arithmetic everything else is computed in.
//!
//! In and out: numbers. [`Real`] is what a program is evaluated in: `f64`, [`DoubleDouble`] where twice its digits are
//! wanted, [`ExtendedRange`] where something leaves the range of both. A [`Number`] stands in an expression. [`math`] has
//! the elementary functions, the same bits on every machine. Never here: expressions, units, files.

mod double_double;
mod extended_range;
mod format;
pub mod math;
mod number;
mod real;

pub use double_double::DoubleDouble;
pub use extended_range::ExtendedRange;
pub use format::{short, significant};
pub use number::Number;
pub use real::{Real, Recurrence, RecurrenceStep};
