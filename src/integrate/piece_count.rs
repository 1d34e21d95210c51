//! How many pieces a step was divided into, and how many of them were minimal.
//!
//! In: the beginnings and lengths of pieces. Out: an error where a function changes too fast to be followed. Never here: the
//! function.

use super::clock::{DIGITS, spacing};
use crate::system::{MotionError, MotionErrorKind};

/// So many minimal intervals in a row are no pole, at which no function is simple on any interval: a function changes too fast
/// for the resolution of time.
const MOST_SHORTEST: u32 = 64;

/// The most pieces of one step in a row on which the functions are sampled and none crosses zero: a
/// step with more is far beyond what its method can follow.
const MOST_PIECES: u32 = 1 << 16;

#[derive(Clone, Debug)]
pub(super) struct PieceCount {
    /// The number of minimal intervals in a row.
    pub(super) shortest: u32,
    /// The beginning of the last step that was sampled.
    step: f64,
    count: u32,
}

impl PieceCount {
    pub(super) const NONE: PieceCount = PieceCount { shortest: 0, step: f64::NAN, count: 0 };

    /// Begins to count anew within a step.
    pub(super) fn begin(&mut self) {
        self.count = 0;
    }

    /// Counts a piece, which begins at a time, of the step that begins at `step`, and returns an error if there are too many.
    pub(super) fn count(&mut self, step: f64, from: f64) -> Result<(), MotionError> {
        self.count = if self.step == step { self.count + 1 } else { 1 };
        self.step = step;
        if self.count > MOST_PIECES {
            let kind = MotionErrorKind::Swings;
            return Err(MotionError { time: from, kind, place: Vec::new() });
        }
        Ok(())
    }

    /// Records how far the functions are represented after a time, and returns an error if that is
    /// too often less than the spacing of time.
    pub(super) fn note_length(&mut self, from: f64, length: f64) -> Result<(), MotionError> {
        let shortest = length < DIGITS * spacing(from);
        self.shortest = if shortest { self.shortest + 1 } else { 0 };
        if self.shortest > MOST_SHORTEST {
            let kind = MotionErrorKind::ClockStands(spacing(from));
            return Err(MotionError { time: from, kind, place: Vec::new() });
        }
        Ok(())
    }
}
