//! A parameter: a number that the user may change while the system moves.

use crate::expr::Symbol;

/// An adjustable parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// As written in expressions.
    pub name: String,
    /// As it is printed.
    pub shown: String,
    /// Its symbol in the model's pool.
    pub symbol: Symbol,
    /// The value the file gives.
    pub value: f64,
    /// The least value of its range.
    pub min: f64,
    /// The greatest value of its range.
    pub max: f64,
    /// The spacing of the steps in its range.
    pub scale: RangeSpacing,
    /// Its unit, empty if none is given.
    pub unit: String,
    /// Its meaning, in words.
    pub about: String,
}

impl Parameter {
    /// A number that nobody sees by a name, and nobody changes.
    pub(super) fn nameless(symbol: Symbol, value: f64) -> Parameter {
        Parameter {
            name: String::new(),
            shown: String::new(),
            symbol,
            value,
            min: value,
            max: value,
            scale: RangeSpacing::Linear,
            unit: String::new(),
            about: String::new(),
        }
    }
}

/// The spacing of the steps in a range.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum RangeSpacing {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal ratios; the range is positive.
    Log,
}
