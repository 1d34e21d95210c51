//! Whether a motion follows a kink of its law, and which method then takes the steps.
//!
//! In: nothing. Out: the course. Never here: steps.

use crate::integrate::taylor::Taylor;

/// Where the motion is beside the kinks of its law.
#[derive(Debug)]
pub(super) enum KinkCourse {
    /// The motion is on no kink.
    Away,
    Along(Box<Taylor>),
    /// On none since the end of the last step, which belongs to the other method still.
    Left(Box<Taylor>),
}
