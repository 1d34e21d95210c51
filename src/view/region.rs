//! A part of the screen that the mouse can point at.
//!
//! In: what is drawn there. Out: a [`ScreenRegion`]. Never here: positions.

use super::plot::{PlotFrame, Scale};
use crate::app::{HitTarget, ValueId};

/// What a part of the screen is for the mouse; it is registered during drawing.
#[derive(Clone, Copy, Debug)]
pub(super) enum ScreenRegion {
    /// It hides the regions below it.
    Blank,
    /// The whole region is one target.
    Plain(HitTarget),
    Bar(ValueId, Scale),
    /// The time bar, from one time to the other.
    Time([f64; 2]),
    /// The inside of a plot's axes.
    Plot(usize, PlotFrame),
    /// A mass that can be dragged, by its index among the shapes of a picture, and the frame of that.
    Mass(usize, usize, PlotFrame),
    /// The inside of a picture of the motion in space.
    Space(usize),
}
