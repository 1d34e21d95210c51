//! The state of the motion at which an action or an angle variable is asked for, and what was found so far along the motion.
//!
//! In: a plot over a coordinate, the motion. Out: the state there with the parameters and the initial values; the system frozen
//! at the instant, and the instants before. Never here: actions, angles, pictures.

use std::sync::Arc;

use super::conditions::PlotConditions;
use super::{Offer, Physics, Plot, Present};
use crate::action_angle::{FrozenMotion, FrozenSystem};
use crate::job::Progress;
use crate::model::Model;
use crate::system::{ChannelKind, Form, MotionError, System};

/// The coordinates that have an action and an angle variable, if the system has them.
pub(super) fn offers(physics: Physics<'_>, what: &str, about: &str) -> Vec<Offer> {
    let model = physics.model;
    if model.is_poisson() || !model.constraints.is_empty() {
        return Vec::new();
    }
    let offer = |(index, channel): (usize, usize)| {
        Offer::new(
            format!("{what} of {}", model.coordinates[index].shown),
            about,
            vec![vec![channel]],
        )
    };
    physics.positions().map(offer).collect()
}

#[derive(Clone)]
pub(super) struct CoordinateState {
    pub(super) coordinate: usize,
    pub(super) time: f64,
    pub(super) parameters: Vec<f64>,
    /// Where the recorded motion began.
    conditions: PlotConditions,
    energy: f64,
    pub(super) positions: Vec<f64>,
    pub(super) momenta: Vec<f64>,
}

impl CoordinateState {
    /// The current state; `None` if the plot is over no coordinate.
    pub(super) fn of(plot: &Plot, present: &Present<'_>) -> Option<CoordinateState> {
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
        Some(CoordinateState {
            coordinate,
            time: present.time,
            parameters: present.parameters.to_vec(),
            conditions: PlotConditions::of_recorded(present, &[]),
            energy: physics.channel(ChannelKind::Energy).map_or(f64::NAN, |c| present.value(c)),
            positions: values(ChannelKind::Position),
            momenta: values(ChannelKind::Momentum),
        })
    }

    /// The state at which the recorded motion began, under the law of now.
    pub(super) fn beginning(
        &self,
        system: &System,
        start: f64,
    ) -> Result<CoordinateState, MotionError> {
        let state = self.conditions.state(system, start)?;
        let state = system.convert(&state, Form::Momentum, &self.parameters)?;
        let (positions, momenta) = state.values.split_at(self.positions.len());
        let momenta = &momenta[..self.momenta.len()];
        Ok(CoordinateState {
            time: state.time,
            positions: positions.to_vec(),
            momenta: momenta.to_vec(),
            ..self.clone()
        })
    }

    /// The motion of the system frozen at this instant.
    pub(super) fn frozen<'a>(&self, system: &'a FrozenSystem) -> Result<FrozenMotion<'a>, String> {
        let place = [&self.positions[..], &self.momenta[..]];
        system.at(self.time, &self.parameters, place).map_err(|why| why.to_string())
    }

    /// Whether the energy is that of another state, up to a part of it.
    pub(super) fn has_energy_of(&self, other: &CoordinateState, (part, of): (f64, f64)) -> bool {
        (self.energy - other.energy).abs() <= part * of
    }
}

/// What was found along a motion, of the system frozen at each instant.
#[derive(Clone)]
pub(super) struct FrozenCourse<M> {
    /// The last state that was observed.
    pub(super) state: CoordinateState,
    pub(super) frozen: Result<Arc<FrozenSystem>, String>,
    /// What was found at the instants, in their order.
    pub(super) past: Vec<M>,
    /// Whether the instants are those of a law that was replaced since.
    replaced: bool,
}

impl<M: Clone> FrozenCourse<M> {
    /// Whether these are instants of the motion on which a state lies.
    pub(super) fn leads_to(&self, state: &CoordinateState) -> bool {
        let (here, there) = (&self.state.conditions, &state.conditions);
        self.state.coordinate == state.coordinate
            && here.begin_alike(there)
            && (self.replaced || here.are_of_one_motion(there))
    }

    pub(super) fn is_of_this_law(&self) -> bool {
        !self.replaced
    }

    /// The instants alone, for a law that replaces this one while the motion continues.
    pub(super) fn of_a_replaced_law(&self) -> FrozenCourse<M> {
        FrozenCourse { replaced: true, ..self.clone() }
    }

    /// Goes on to a state, with the instants before it if they are of the same motion; `time` is that of an instant.
    pub(super) fn continued(
        known: Option<&FrozenCourse<M>>,
        state: &CoordinateState,
        model: &Model,
        progress: &Progress,
        time: fn(&M) -> f64,
    ) -> FrozenCourse<M> {
        let same =
            known.filter(|known| known.state.coordinate == state.coordinate && !known.replaced);
        let frozen = same.map_or_else(
            || {
                FrozenSystem::of(model, state.coordinate, FrozenSystem::PRECISE, progress.token())
                    .map(Arc::new)
                    .map_err(|why| why.to_string())
            },
            |known| known.frozen.clone(),
        );
        let past = known.filter(|known| known.leads_to(state)).map_or(&[][..], |known| &known.past);
        let past = past.iter().filter(|instant| time(instant) < state.time).cloned().collect();
        FrozenCourse { state: state.clone(), frozen, past, replaced: false }
    }

    /// Whether the law depends on the time.
    pub(super) fn moves(&self) -> bool {
        self.frozen.as_ref().is_ok_and(|frozen| frozen.depends_on_time())
    }
}
