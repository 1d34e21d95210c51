//! The input of instruments: a system and the current state of its motion.
//!
//! In: references to data owned elsewhere. Out: channels and values. Never here: how the motion is computed.

use std::sync::Arc;

use super::PeriodicOrbits;
use crate::analysis::{CrossingLog, DistanceHistory};
use crate::dynamics::Equilibrium;
use crate::integrate::Settings;
use crate::mechanics::{Equations, Valuation};
use crate::model::Model;
use crate::system::{Channel, ChannelKind, State, System};

/// A system: its model, its derived equations, and the compiled program.
#[derive(Clone, Copy)]
pub struct Physics<'a> {
    /// The model of the file.
    pub model: &'a Arc<Model>,
    /// The derived equations.
    pub equations: &'a Arc<Equations>,
    /// The compiled system, with its channels.
    pub system: &'a Arc<System>,
}

/// A system in motion, at one instant.
#[derive(Clone, Copy)]
pub struct Present<'a> {
    /// The system.
    pub physics: Physics<'a>,
    /// The time at which all of this holds.
    pub time: f64,
    /// Whether time is running: where it is not, what is carried along beside the motion is wanted at this very time.
    pub running: bool,
    /// The time up to which everything is known that is carried along beside the motion, such as a cloud; at most the time.
    pub carried: f64,
    /// What of the law was changed last, and the state from which the motion continued, if it was since the start.
    pub changed: Option<(&'a str, &'a Arc<State>)>,
    /// The values now, in the order of the model.
    pub parameters: &'a [f64],
    /// The initial values: coordinates, then velocities or momenta.
    pub initial: &'a [f64],
    /// The value of each channel.
    pub values: &'a [f64],
    /// The least and greatest value of each channel since the start.
    pub bounds: &'a [(f64, f64)],
    /// Where the motion has crossed each surface of section.
    pub crossings: &'a CrossingLog,
    /// The motions beside this one: the number of each, and its distance.
    pub separations: &'a [(usize, Arc<DistanceHistory>)],
    /// The equilibria that were found at these parameters.
    pub equilibria: &'a [Equilibrium],
    /// The periodic orbits that other pictures have found.
    pub periodic: &'a [Arc<PeriodicOrbits>],
    /// The name of the method.
    pub method: &'static str,
    /// Its step and tolerance, as they were set.
    pub settings: Settings,
    /// How the motion returns along the run before, if time was reversed.
    pub returned: Option<Returned>,
    /// The state at which it was, and the time at which the run before began.
    pub turned: Option<(&'a Arc<State>, f64)>,
}

/// A motion whose time was reversed, held against the run before.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Returned {
    /// The time elapsed back, and back to the start of the run before.
    pub elapsed: [f64; 2],
    /// ε, the error of a step, the mean size of a step, and whether the errors of steps are independent of each other.
    pub step_error: (f64, f64, bool),
    /// The distance from the run before at the same time.
    pub distance: Option<f64>,
    /// The return error: the distance from the start.
    pub error: Option<f64>,
}

impl<'a> Physics<'a> {
    /// The channel of a kind.
    pub fn channel(self, kind: ChannelKind) -> Option<usize> {
        self.system.channels().iter().position(|channel| channel.kind == kind)
    }

    /// The channels of the coordinates.
    pub fn positions(self) -> impl Iterator<Item = (usize, usize)> {
        let all = 0..self.model.coordinates.len();
        all.filter_map(move |i| Some((i, self.channel(ChannelKind::Position(i))?)))
    }

    /// The coordinates, each with the next.
    pub(super) fn neighbouring_positions(self) -> Vec<(usize, usize)> {
        let all: Vec<usize> = self.positions().map(|(_, x)| x).collect();
        all.windows(2).map(|pair| (pair[0], pair[1])).collect()
    }

    /// The coordinates, each with its momentum, or its velocity where it has none; of variables of brackets there are none.
    pub(super) fn phase_planes(self) -> Vec<(usize, usize)> {
        let rate = |i: usize| {
            let momentum = self.channel(ChannelKind::Momentum(i));
            momentum.or_else(|| self.channel(ChannelKind::Velocity(i)))
        };
        let pairs = self.positions().filter_map(|(i, x)| Some((x, rate(i)?)));
        pairs.filter(|_| !self.model.is_poisson()).collect()
    }

    /// A channel's name in mathematical notation.
    pub fn shown(self, channel: usize) -> &'a str {
        self.system.channels().get(channel).map_or("?", |channel| &channel.shown)
    }

    /// The channels that can be distinguished by their names.
    pub fn named(self) -> impl Iterator<Item = (usize, &'a Channel)> {
        let all = self.system.channels();
        let known = move |index: usize, name: &str| all[..index].iter().any(|c| c.name == name);
        all.iter().enumerate().filter(move |(index, channel)| {
            !channel.name.is_empty() && !known(*index, &channel.name)
        })
    }
}

impl Present<'_> {
    /// The key that starts the motion, after a sentence, where time is not running.
    pub(super) fn how_to_begin(&self) -> &'static str {
        if self.running { "" } else { " Space starts the motion." }
    }

    /// When the recorded motion began, under the law of now.
    pub fn began(&self) -> f64 {
        self.changed_at().unwrap_or(self.physics.model.run.start)
    }

    /// When the law was changed last, if it was since the start.
    pub fn changed_at(&self) -> Option<f64> {
        self.changed.map(|(_, state)| state.time)
    }

    /// One turn of a periodic quantity, if a range leads beyond it.
    pub(super) fn turn_within(&self, channel: usize, [lo, hi]: [f64; 2]) -> Option<[f64; 2]> {
        let half = self.physics.system.period(channel, self.parameters)? / 2.0;
        (lo < -half || hi > half).then_some([-half, half])
    }

    /// The value of a channel.
    pub fn value(&self, channel: usize) -> f64 {
        self.values.get(channel).copied().unwrap_or(f64::NAN)
    }

    /// The current values of the system's symbols.
    pub fn valuation(&self) -> Valuation {
        let Physics { model, equations, system } = self.physics;
        system.valuation((model, equations), self.time, self.parameters, self.values)
    }
}
