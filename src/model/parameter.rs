//! A parameter: a number the user turns while the system moves.

use crate::expr::Symbol;

/// A live parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// As written in expressions.
    pub name: String,
    /// As shown.
    pub shown: String,
    /// Its symbol in the model's pool.
    pub symbol: Symbol,
    /// The value the file gives.
    pub value: f64,
    /// The least value of its range.
    pub min: f64,
    /// The greatest value of its range.
    pub max: f64,
    /// How the range is divided.
    pub scale: Scale,
    /// Its unit, empty where none is given.
    pub unit: String,
    /// What it means, in words.
    pub about: String,
}

/// How a range is divided into steps.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By equal factors; the range is positive.
    Log,
}
