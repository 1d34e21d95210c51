//! The values of a system's symbols, for every evaluation of one of its expressions.
//!
//! In: parameters, and whatever else is known. Out: a number for each symbol. Never here: where the
//! numbers come from.

use std::collections::HashMap;

use crate::expr::{Expr, Pool, Symbol};
use crate::model::Model;

/// A value for each symbol that has one.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Valuation(HashMap<Symbol, f64>);

impl Valuation {
    /// The values of a model's parameters, in the order of the model.
    pub fn of_parameters(model: &Model, parameters: &[f64]) -> Valuation {
        let known = model.parameters.iter().zip(parameters);
        Valuation(known.map(|(parameter, &value)| (parameter.symbol, value)).collect())
    }

    /// The same valuation with these values added; they replace known ones.
    #[must_use]
    pub fn with(mut self, values: impl IntoIterator<Item = (Symbol, f64)>) -> Valuation {
        self.0.extend(values);
        self
    }

    /// Sets the value of a symbol.
    pub fn set(&mut self, symbol: Symbol, value: f64) {
        self.0.insert(symbol, value);
    }

    /// The value of a symbol, or NaN if it has none.
    pub fn at(&self, symbol: Symbol) -> f64 {
        self.0.get(&symbol).copied().unwrap_or(f64::NAN)
    }

    /// The value of an expression.
    pub fn value(&self, pool: &Pool, e: Expr) -> f64 {
        pool.evaluate(e, &|symbol| self.at(symbol))
    }

    pub(super) fn size(&self, pool: &Pool, e: Expr) -> f64 {
        pool.evaluate_with_size(e, &|symbol| self.at(symbol)).1
    }

    /// Whether an expression has this value, up to this part of the value or of its terms: whatever the units, and where one is 0.
    pub(super) fn agrees(&self, pool: &Pool, e: Expr, expected: f64, within: f64) -> bool {
        let (value, size) = pool.evaluate_with_size(e, &|symbol| self.at(symbol));
        (value - expected).abs() <= within * size.max(expected.abs())
    }
}
