//! Numbers of a file that are no short fractions, such as those of SI units in an atom or a galaxy, or measured ones
//! with many digits, as parameters.
//!
//! What is derived and searched multiplies and divides them, and in rounded products relations are lost that hold for
//! every value. In: a model. Out: the same model with such numbers of its law, constraints and observables as symbols
//! whose name is the number as a file would have it. Numbers whose ratio is a short fraction share a symbol. Never here:
//! derivations, and the numbers of exponents.

use super::Model;
use super::parameter::Parameter;
use crate::expr::{Expr, Pool, Rank, Symbol};
use crate::num::Number;

impl Model {
    /// Makes parameters of the numbers that are no short fractions. Whether there were any.
    pub fn name_literals(&mut self) -> bool {
        let Model { pool, mechanics, constraints, impulses, observables, .. } = self;
        let mut all: Vec<&mut Expr> = mechanics.expressions_mut();
        all.extend(constraints.iter_mut().map(|constraint| &mut constraint.expression));
        all.extend(impulses.iter_mut().flat_map(|impulse| &mut impulse.change));
        all.extend(observables.iter_mut().map(|observable| &mut observable.expression));
        let mut known: Vec<(f64, Symbol)> = Vec::new();
        for e in all {
            *e = pool.replace_long_numbers(*e, &mut |pool, x| in_terms_of(pool, &mut known, x));
        }
        let parameter = |&(value, symbol): &(f64, Symbol)| {
            let info = pool.symbol_info(symbol);
            let [name, shown] = [&info.name, &info.unicode].map(Clone::clone);
            Parameter { name, shown, ..Parameter::nameless(symbol, value) }
        };
        let named: Vec<Parameter> = known.iter().map(parameter).collect();
        self.parameters.extend(named);
        !known.is_empty()
    }
}

/// A number as a multiple of one that has a name.
fn in_terms_of(pool: &mut Pool, known: &mut Vec<(f64, Symbol)>, x: f64) -> Expr {
    let found =
        known.iter().find_map(|&(first, symbol)| Some((Number::short_ratio(x, first)?, symbol)));
    let (ratio, symbol) = found.unwrap_or_else(|| {
        let symbol = name(pool, x.abs());
        known.push((x.abs(), symbol));
        (if x < 0.0 { Number::MINUS_ONE } else { Number::ONE }, symbol)
    });
    let symbol = pool.variable(symbol);
    pool.scale(ratio, symbol)
}

/// The symbol of a number. Where a power of it is shown the number is in parentheses.
fn name(pool: &mut Pool, x: f64) -> Symbol {
    let (unicode, latex) = match Number::Real(x).canonical() {
        // as a decimal, since its fraction says nothing
        Number::Rational(..) => (x.to_string(), x.to_string()),
        real @ Number::Real(_) => {
            let number = pool.number(real);
            (pool.unicode(number), pool.latex(number))
        }
    };
    let symbol = pool.symbol(&format!("{x:?}"));
    pool.describe(symbol, &format!("({unicode})"), &format!("({latex})"), Rank::Constant);
    symbol
}
