//! The units of which the arguments of functions are made, so that angles are multiples of few angles and exponentials
//! powers of few exponentials.
//!
//! In: arguments. Out: integral multiples of units. Never here: residues.

use rustc_hash::FxHashMap;

use crate::expr::{Expr, Node, Pool};
use crate::num::{Number, gcd};

/// Why a law cannot be evaluated over a prime field.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{0}")]
pub struct Unsupported(pub String);

/// The units of which arguments are made: each term with the least common denominator of its coefficients.
#[derive(Default)]
pub(super) struct ArgumentUnits {
    pub(super) denominators: FxHashMap<Expr, i64>,
    pub(super) order: Vec<Expr>,
}

impl ArgumentUnits {
    pub(super) fn collect(&mut self, pool: &mut Pool, argument: Expr) -> Result<(), Unsupported> {
        for (c, term) in terms(pool, argument) {
            let Number::Rational(_, d) = c else {
                return Err(Unsupported(
                    "a number in an angle or exponent is not a short fraction: make it a parameter"
                        .into(),
                ));
            };
            let known = self.denominators.entry(term).or_insert_with(|| {
                self.order.push(term);
                1
            });
            *known = least_common(*known, d);
        }
        Ok(())
    }

    pub(super) fn parts(&self, pool: &mut Pool, argument: Expr) -> Vec<(usize, i64)> {
        let multiple = |(c, term): (Number, Expr)| {
            let unit = self.order.iter().position(|&t| t == term)?;
            let Number::Rational(n, d) = c else { return None };
            Some((unit, n * (self.denominators[&term] / d)))
        };
        terms(pool, argument).into_iter().filter_map(multiple).collect()
    }
}

/// The least common multiple.
pub(super) fn least_common(a: i64, b: i64) -> i64 {
    a / gcd(a.unsigned_abs().into(), b.unsigned_abs().into()) as i64 * b
}

/// An argument as a sum of multiples of terms without coefficient.
pub(super) fn terms(pool: &mut Pool, e: Expr) -> Vec<(Number, Expr)> {
    let mut all = Vec::new();
    for (c, term) in pool.summands(e) {
        match pool.node(term) {
            // a constant that is not a short fraction is a unit of its own
            Node::Number(n) => match c * *n {
                whole @ Number::Rational(..) => all.push((whole, Expr::ONE)),
                real @ Number::Real(_) => all.push((Number::ONE, pool.number(real))),
            },
            Node::Product(k, _) => {
                let k = *k;
                all.push((c * k, pool.scale(k.recip(), term)));
            }
            _ => all.push((c, term)),
        }
    }
    all
}
