//! The current values that the gauges read, and by which channel each symbol is read.
//!
//! In: the channels of a motion. Out: values of symbols. Never here: what is conserved.

use super::formula_monitors::ChannelValues;
use crate::analysis::Errors;
use crate::expr::Symbol;
use crate::mechanics::{Equations, Valuation};
use crate::system::{ChannelKind, System, TermWatch};

/// The current values that the gauges read.
pub(in crate::experiment) struct GaugeInputs<'a> {
    pub(in crate::experiment) time: f64,
    pub(in crate::experiment) steps: u64,
    pub(in crate::experiment) errors: Errors,
    /// The value of every channel.
    pub(in crate::experiment) values: &'a [f64],
    /// The residual of each constraint, in position and in velocity.
    pub(in crate::experiment) residuals: &'a [[f64; 2]],
    pub(in crate::experiment) action: f64,
    /// The terms of the conserved quantities.
    pub(in crate::experiment) terms: &'a TermWatch,
    pub(in crate::experiment) system: &'a System,
    /// The parameters, and the constants that follow from a body.
    pub(in crate::experiment) constants: &'a Valuation,
}

impl<'a> GaugeInputs<'a> {
    /// The value of a symbol of a state expression.
    pub(super) fn value_of(
        &self,
        symbol: Symbol,
        places: &[(Symbol, usize)],
        equations: &Equations,
    ) -> f64 {
        match places.iter().find(|(s, _)| *s == symbol) {
            Some(&(_, channel)) => self.values[channel],
            None if symbol == equations.symbols.time => self.time,
            None if symbol == equations.symbols.action => self.action,
            None => self.constants.at(symbol),
        }
    }

    pub(super) fn channels(&self, places: &'a [(Symbol, usize)]) -> ChannelValues<'a> {
        ChannelValues { time: self.time, values: self.values, places }
    }
}

/// The channels of the symbols that formulas are made of.
pub(super) fn places(equations: &Equations, system: &System) -> Vec<(Symbol, usize)> {
    let find = |kind: ChannelKind| system.channels().iter().position(|c| c.kind == kind);
    let mut places = Vec::new();
    for (i, c) in equations.coordinates.iter().enumerate() {
        for (symbol, kind) in [
            (c.position, ChannelKind::Position(i)),
            (c.velocity, ChannelKind::Velocity(i)),
            (c.momentum, ChannelKind::Momentum(i)),
        ] {
            places.extend(find(kind).map(|channel| (symbol, channel)));
        }
    }
    places.extend(find(ChannelKind::Energy).map(|channel| (equations.symbols.energy, channel)));
    for (i, symbol) in equations.supplements.attitude_symbols.iter().flatten().flatten().enumerate()
    {
        places.extend(find(ChannelKind::Attitude(i)).map(|channel| (*symbol, channel)));
    }
    places
}
