//! The values of a system's symbols at one state.
//!
//! In: a time, parameters, the value of every channel. Out: a [`Valuation`], and which symbol has which channel. Never here: states.

use super::{ChannelKind, System};
use crate::expr::Symbol;
use crate::mechanics::{Equations, Valuation};
use crate::model::Model;
use crate::num::DoubleDouble;

impl System {
    /// The values of all symbols: the parameters and the quantities derived from the file's body,
    /// the time, and the symbols that have channels.
    pub fn valuation(
        &self,
        (model, equations): (&Model, &Equations),
        time: f64,
        parameters: &[f64],
        values: &[f64],
    ) -> Valuation {
        let seen = self.symbol_channels(equations);
        let seen = seen.into_iter().filter_map(|(symbol, i)| Some((symbol, *values.get(i)?)));
        Valuation::of_parameters(model, parameters)
            .with(self.body_values(parameters))
            .with(seen)
            .with([(equations.symbols.time, time)])
    }

    /// The channel of each symbol that has one.
    pub fn symbol_channels(&self, equations: &Equations) -> Vec<(Symbol, usize)> {
        let symbol = |kind: ChannelKind| match kind {
            ChannelKind::Position(i) => Some(equations.coordinates[i].position),
            ChannelKind::Velocity(i) => Some(equations.coordinates[i].velocity),
            ChannelKind::Momentum(i) => Some(equations.coordinates[i].momentum),
            ChannelKind::Multiplier(k) => Some(equations.constraints[k].multiplier),
            ChannelKind::Energy => Some(equations.symbols.energy),
            ChannelKind::Attitude(i) => {
                equations.supplements.attitude_symbols.map(|matrix| matrix[i / 3][i % 3])
            }
            _ => None,
        };
        let channels = self.channels().iter().enumerate();
        channels.filter_map(|(i, channel)| Some((symbol(channel.kind)?, i))).collect()
    }

    /// The values of the body's symbols at these parameters, empty if there is no body.
    pub fn body_values(&self, parameters: &[f64]) -> Vec<(Symbol, f64)> {
        let Some(inertia) = &self.shared.inertia else { return Vec::new() };
        let written: Vec<DoubleDouble> =
            parameters.iter().map(|&x| DoubleDouble::from_decimal(x)).collect();
        let values = inertia.values(&written).into_iter().map(|x| x.high);
        inertia.names().iter().copied().zip(values).collect()
    }
}
