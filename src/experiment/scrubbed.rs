//! A time in the past that is looked at.
//!
//! In: nothing. Out: [`Scrubbed`]. Never here: how it is looked at.

use super::observed_motion::ObservedMotion;

/// A time in the past that is looked at.
pub(super) struct Scrubbed {
    /// A motion of the same system, at that time.
    pub(super) motion: ObservedMotion,
}
