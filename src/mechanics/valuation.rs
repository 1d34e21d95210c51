//! What the symbols of a system are worth: the one answer to that question, for whoever evaluates an expression of it.
//!
//! In: parameters, and whatever else is known. Out: a number for each symbol. Never here: where the numbers come from.

use std::collections::HashMap;

use crate::expr::{Expr, Pool, Symbol};
use crate::model::Model;

/// A value for each symbol that has one.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Valuation(HashMap<Symbol, f64>);

impl Valuation {
    /// The parameters of a model.
    pub fn of_parameters(model: &Model, parameters: &[f64]) -> Valuation {
        let known = model.parameters.iter().zip(parameters);
        Valuation(known.map(|(parameter, &value)| (parameter.symbol, value)).collect())
    }

    /// The same with other values, which take the place of those known.
    #[must_use]
    pub fn with(mut self, values: impl IntoIterator<Item = (Symbol, f64)>) -> Valuation {
        self.0.extend(values);
        self
    }

    /// Gives a symbol a value.
    pub fn set(&mut self, symbol: Symbol, value: f64) {
        self.0.insert(symbol, value);
    }

    /// The value of a symbol; not a number for one that has none.
    pub fn at(&self, symbol: Symbol) -> f64 {
        self.0.get(&symbol).copied().unwrap_or(f64::NAN)
    }

    /// The value of an expression.
    pub fn value(&self, pool: &Pool, e: Expr) -> f64 {
        pool.evaluate(e, &|symbol| self.at(symbol))
    }
}
