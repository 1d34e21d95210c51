//! What instruments look at: a system, and where its motion is now.
//!
//! In: references to what others hold. Out: channels and values. Never here: how the motion came about.

use std::sync::Arc;

use crate::mechanics::{Equations, Valuation};
use crate::model::Model;
use crate::system::{Channel, ChannelKind, System};

/// A system: what its file says, what follows from it, and the program.
#[derive(Clone, Copy)]
pub struct Physics<'a> {
    /// What the file says.
    pub model: &'a Arc<Model>,
    /// What follows from it.
    pub equations: &'a Arc<Equations>,
    /// The program, with its channels.
    pub system: &'a Arc<System>,
}

/// A system in motion, as it is at one moment.
#[derive(Clone, Copy)]
pub struct Present<'a> {
    /// The system.
    pub physics: Physics<'a>,
    /// The time.
    pub time: f64,
    /// The parameters.
    pub parameters: &'a [f64],
    /// The value of each channel.
    pub values: &'a [f64],
    /// The least and greatest value of each channel since the beginning.
    pub bounds: &'a [(f64, f64)],
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

    /// A channel's name in mathematics.
    pub fn shown(self, channel: usize) -> &'a str {
        self.system.channels().get(channel).map_or("?", |channel| &channel.shown)
    }

    /// The channels that can be told from the others by their names.
    pub fn named(self) -> impl Iterator<Item = (usize, &'a Channel)> {
        let all = self.system.channels();
        let known = move |index: usize, name: &str| all[..index].iter().any(|c| c.name == name);
        all.iter().enumerate().filter(move |(index, channel)| {
            !channel.name.is_empty() && !known(*index, &channel.name)
        })
    }
}

impl Present<'_> {
    /// The value of a channel.
    pub fn value(&self, channel: usize) -> f64 {
        self.values.get(channel).copied().unwrap_or(f64::NAN)
    }

    /// What the symbols of the system are worth now.
    pub fn valuation(&self) -> Valuation {
        let Physics { model, equations, system } = self.physics;
        system.valuation((model, equations), self.time, self.parameters, self.values)
    }
}
