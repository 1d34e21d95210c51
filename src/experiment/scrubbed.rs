//! A time in the past that is shown.
//!
//! In: nothing. Out: [`Scrubbed`]. Never here: how it is computed.

use super::observed_motion::ObservedMotion;

/// A time in the past that is shown.
pub(super) struct Scrubbed {
    /// A motion of the same system, at that time.
    pub(super) motion: ObservedMotion,
}
