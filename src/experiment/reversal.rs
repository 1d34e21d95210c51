//! What is known of the reversals of time of an experiment.
//!
//! In: a system run the other way, the run before. Out: both, when they are needed again. Never here: how time is reversed
//! (`reverse`).

use super::echo::Echo;
use crate::system::System;

pub(super) struct Reversal {
    /// The system run the other way, once it was needed.
    pub(super) other_way: Option<System>,
    /// The reading of the clock at which time was reversed last, or the motion began.
    pub(super) began: f64,
    /// The run before time was reversed.
    pub(super) echo: Option<Box<Echo>>,
}

impl Reversal {
    pub(super) fn none(began: f64) -> Reversal {
        Reversal { other_way: None, began, echo: None }
    }
}
