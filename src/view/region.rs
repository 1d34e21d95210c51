//! A part of the screen as the mouse finds it.
//!
//! In: what is drawn there. Out: a [`Region`]. Never here: places.

use super::plot::{Frame, Scale};
use crate::app::{HitTarget, ValueId};

/// What something on the screen is for the mouse, told while it is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Region {
    /// It hides what was there before.
    Blank,
    /// The same spot wherever it is touched.
    Plain(HitTarget),
    /// The bar of a value.
    Bar(ValueId, Scale),
    /// The inside of a plot's axes.
    Plot(usize, Frame),
    /// The inside of a picture of the motion in space.
    Space(usize),
}
