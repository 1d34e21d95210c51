//! The state of the motion at which an action variable is asked for, and what its value depends on.
//!
//! In: a plot over a coordinate, the motion. Out: the state there, the parameters, the initial values. Never here: actions,
//! angles, pictures.

use super::{Plot, Present};
use crate::system::ChannelKind;

/// A state of the motion, for one of its coordinates.
pub(super) struct MotionState {
    pub(super) coordinate: usize,
    pub(super) time: f64,
    pub(super) parameters: Vec<f64>,
    pub(super) initial: Vec<f64>,
    pub(super) positions: Vec<f64>,
    pub(super) momenta: Vec<f64>,
}

impl MotionState {
    /// The current state; `None` if the plot is over no coordinate.
    pub(super) fn of(plot: &Plot, present: &Present<'_>) -> Option<MotionState> {
        let channel = plot.column(0)?;
        let physics = &present.physics;
        let ChannelKind::Position(coordinate) = physics.system.channels()[channel].kind else {
            return None;
        };
        let degrees = physics.model.coordinates.len();
        let values = |kind: fn(usize) -> ChannelKind| -> Vec<f64> {
            let of = |i| physics.channel(kind(i)).map_or(f64::NAN, |c| present.value(c));
            (0..degrees).map(of).collect()
        };
        Some(MotionState {
            coordinate,
            time: present.time,
            parameters: present.parameters.to_vec(),
            initial: present.initial.to_vec(),
            positions: values(ChannelKind::Position),
            momenta: values(ChannelKind::Momentum),
        })
    }
}
