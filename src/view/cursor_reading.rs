//! What is read at the cursor of a plot.
//!
//! In and out: its coordinates and its place. Never here: how it is drawn.

#[derive(Clone, Copy, Debug)]
pub(super) struct CursorReading {
    /// Its data coordinates.
    pub(super) at: [f64; 2],
    /// Its place in fractions of the width from the left and of the height from below.
    pub(super) place: [f64; 2],
}
