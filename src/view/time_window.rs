//! The window of a time series.
//!
//! In: the time that has passed, a viewport, the number of columns; the range of a prediction. Out: the scale of the axis.
//! Never here: curves.

use super::plot::Scale;
use super::quantity::{Quantities, through};
use crate::instrument::Viewport;
use crate::num::math;

/// The greatest length of a time window in seconds of the wall clock, at the file's own speed.
const SECONDS: f64 = 20.0;

/// How often the length of a time window is doubled until it is the greatest.
const DOUBLINGS: i32 = 3;

/// The time window over this many columns: it doubles its length as the motion fills it, up to the greatest, then
/// moves along by whole columns.
pub(super) fn time_window(q: &Quantities<'_>, viewport: Viewport, columns: u16) -> Scale {
    if let Some([from, to]) = q.lab.predicted_range(None) {
        return through(Scale::linear(from, to.max(q.snapshot.time)), (viewport, 0));
    }
    let speed = q.lab.loaded.model.run.speed;
    let most = SECONDS * if speed.is_finite() && speed > 0.0 { speed } else { 1.0 };
    let start = q.lab.loaded.model.run.start;
    let passed = q.snapshot.time - start;
    let lengths = (0..=DOUBLINGS).rev().map(|halved| most / math::powi(2.0, halved));
    let span = lengths.clone().find(|length| passed <= *length);
    let (span, end) = span.map_or_else(
        || {
            let column = most / f64::from(columns.max(1));
            (most, start + (passed / column).ceil() * column)
        },
        |span| (span, start + span),
    );
    let span = span / viewport.zoom[0];
    let shift = viewport.pan[0] * span;
    Scale::linear(end - span + shift, end + shift)
}
