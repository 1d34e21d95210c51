//! The current values that the gauges read.
//!
//! In: the channels of a motion. Out: values of symbols. Never here: what is conserved.

use super::formula_monitors::ChannelValues;
use crate::analysis::Errors;
use crate::expr::Symbol;
use crate::mechanics::{Equations, Valuation};
use crate::system::{System, TermWatch};

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
