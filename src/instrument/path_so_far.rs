//! The path of the running motion from where it began to where it is, beside which others are looked for.
//!
//! In: a plot of one coordinate, the current state. Out: the path's ends, or that there is none yet. Never here: other paths.

use super::conditions::PlotConditions;
use super::{Plot, Present};
use crate::integrate::{Method, method_named};
use crate::num::significant;
use crate::system::ChannelKind;

/// The end of the path moves on by so many seconds of the wall clock at the file's own speed, at most so often.
const GRID: f64 = 0.25;
const MOST: f64 = 240.0;

/// From where a motion began up to now.
#[derive(Clone, PartialEq)]
pub(super) struct PathSoFar {
    pub(super) conditions: PlotConditions,
    /// The coordinate that the other paths differ by.
    pub(super) coordinate: usize,
    pub(super) begin: f64,
    pub(super) duration: f64,
}

impl PathSoFar {
    /// The path, and the method by which the motion is followed; `None` if there is no path yet, or no coordinate is chosen.
    pub(super) fn of(plot: &Plot, present: &Present<'_>) -> Option<(PathSoFar, &'static Method)> {
        let (channel, method) = (plot.column(0)?, method_named(present.method)?);
        let ChannelKind::Position(coordinate) = present.physics.system.channels()[channel].kind
        else {
            return None;
        };
        let conditions = PlotConditions::of_recorded(present, &plot.seeds);
        let begin = conditions.begin(present.physics.model.run.start);
        let duration = duration(present)?;
        Some((PathSoFar { conditions, coordinate, begin, duration }, method))
    }
}

/// How long the path is: up to now, while the motion runs on a grid; `None` where it is paused before there is any.
pub(super) fn duration(present: &Present<'_>) -> Option<f64> {
    let run = &present.physics.model.run;
    let passed = present.time - present.began();
    let grid = if run.speed.is_normal() { GRID * run.speed.abs() } else { GRID };
    if !present.running {
        return (passed > 0.0).then(|| passed.min(MOST * grid));
    }
    Some(grid * (passed / grid).floor().clamp(1.0, MOST))
}

/// What is said where the motion is paused before there is a path.
pub(super) fn nothing_yet(present: &Present<'_>) -> Option<String> {
    if duration(present).is_some() {
        return None;
    }
    let began = significant(present.began(), 4, 1e-3..1e5).replace('-', "−");
    Some(match present.changed {
        Some((what, _)) => format!("no motion yet since t = {began}, where {what} was changed"),
        None => format!("no motion yet since t = {began}"),
    })
}
