//! The value of an expression, computed node by node: a simple reference for the compiled program,
//! and the way in which initial values and quick numerical checks are computed.

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use super::ball::Ball;
use super::node::{Expr, Node};
use super::pool::Pool;
use super::symbol::Symbol;
use crate::num::Number;
use crate::num::math;

impl Pool {
    /// The value of `e`; `at` gives the value of each symbol.
    pub fn evaluate(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> f64 {
        self.evaluate_with_size(e, at).0
    }

    /// The value, and the largest magnitude among the summands on the way, against which rounding
    /// errors have to be measured.
    pub fn evaluate_with_size(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> (f64, f64) {
        let mut values: FxHashMap<Expr, (f64, f64)> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let value = self.value_of(part, &|e| values[&e], at);
            values.insert(part, value);
        }
        values[&e]
    }

    /// The values of `e` where one symbol takes these values in turn; `at` gives those of the others.
    pub fn evaluate_along(
        &self,
        e: Expr,
        (along, places): (Symbol, &[f64]),
        at: &dyn Fn(Symbol) -> f64,
    ) -> Vec<f64> {
        let repeated = Repeated::along(self, e, along, at);
        let value =
            |place: &f64| repeated.at(&|symbol| if symbol == along { *place } else { at(symbol) });
        places.iter().map(value).collect()
    }

    /// The value of a node and the largest magnitude among its summands, from those of its parts.
    fn value_of(
        &self,
        node: Expr,
        known: &dyn Fn(Expr) -> (f64, f64),
        at: &dyn Fn(Symbol) -> f64,
    ) -> (f64, f64) {
        match self.node(node) {
            Node::Number(n) => sized(n.value()),
            Node::Pi => sized(std::f64::consts::PI),
            Node::Symbol(s) => sized(at(*s)),
            Node::Sum(constant, terms) => {
                let (mut total, mut size) = (constant.value(), constant.value().abs());
                for (c, t) in terms {
                    let (value, part) = known(*t);
                    total += c.value() * value;
                    size += (c.value() * part).abs();
                }
                (total, size)
            }
            Node::Product(c, factors) => {
                let (mut value, mut size) = sized(c.value());
                for (base, n) in factors {
                    let (b, s) = known(*base);
                    value *= real_power(b, *n);
                    let grown = if n.is_negative() { b.abs() } else { s };
                    size *= real_power(grown, *n).abs();
                }
                (value, size)
            }
            Node::Power(base, exponent) => sized(math::powf(known(*base).0, known(*exponent).0)),
            Node::Call(function, arguments) => {
                let arguments: Vec<f64> = arguments.iter().map(|a| known(*a).0).collect();
                sized((function.row().value)(&arguments))
            }
        }
    }

    /// Whether the value of `e`, which is below the normal numbers of `f64`, is the result of underflow: in a wider range
    /// it is not 0, or its terms, which cancel, are all that small.
    pub fn underflows(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> bool {
        let least = i64::from(f64::MIN_EXP);
        self.enclosure(e, at).is_some_and(|ball| {
            ball.excludes_zero() || ball.magnitude().is_some_and(|size| size < least)
        })
    }

    /// An enclosure of the value of `e`, or `None` if it has no value or no bound is known.
    pub(super) fn enclosure(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> Option<Ball> {
        self.enclosures(e, 0.0, at)[&e]
    }

    /// Enclosures of the values of `e` and of all its parts, if each symbol's value has a relative
    /// error of up to `slack`.
    pub(super) fn enclosures(
        &self,
        e: Expr,
        slack: f64,
        at: &dyn Fn(Symbol) -> f64,
    ) -> FxHashMap<Expr, Option<Ball>> {
        let mut values: FxHashMap<Expr, Option<Ball>> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let value = self.enclosure_of(part, slack, at, &values);
            values.insert(part, value);
        }
        values
    }

    fn enclosure_of(
        &self,
        part: Expr,
        slack: f64,
        at: &dyn Fn(Symbol) -> f64,
        values: &FxHashMap<Expr, Option<Ball>>,
    ) -> Option<Ball> {
        match self.node(part) {
            Node::Number(n) => Ball::number(*n),
            Node::Pi => Ball::number(Number::Real(std::f64::consts::PI)),
            Node::Symbol(s) => Ball::exact(at(*s))?.widened(slack),
            Node::Sum(constant, terms) => {
                let mut total = Ball::number(*constant)?;
                for (c, term) in terms {
                    total = total.add(values[term]?.mul(Ball::number(*c)?)?)?;
                }
                Some(total)
            }
            Node::Product(c, factors) => {
                let mut value = Ball::number(*c)?;
                for (base, n) in factors {
                    value = value.mul(values[base]?.power(*n)?)?;
                }
                Some(value)
            }
            Node::Power(base, exponent) => values[base]?.real_power(values[exponent]?, false),
            Node::Call(function, arguments) => {
                let arguments: Option<Vec<Ball>> = arguments.iter().map(|a| values[a]).collect();
                Ball::call(*function, &arguments?)
            }
        }
    }
}

/// An expression to be evaluated many times: its nodes are found once.
pub(super) struct Repeated<'a> {
    pool: &'a Pool,
    nodes: Vec<Expr>,
    /// The value of each node, by its handle less the least.
    values: RefCell<Vec<(f64, f64)>>,
    least: usize,
    whole: Expr,
}

impl<'a> Repeated<'a> {
    pub(super) fn of(pool: &'a Pool, whole: Expr) -> Self {
        let nodes = pool.reachable(&[whole]);
        let least = nodes.iter().map(|e| e.index()).min().unwrap_or(0);
        let values = RefCell::new(vec![(0.0, 0.0); whole.index() + 1 - least]);
        Self { pool, nodes, values, least, whole }
    }

    /// An expression of which only one symbol will take other values: what does not depend on it is computed now.
    fn along(pool: &'a Pool, whole: Expr, along: Symbol, at: &dyn Fn(Symbol) -> f64) -> Self {
        let mut all = Self::of(pool, whole);
        let nodes = std::mem::take(&mut all.nodes);
        let mut moves = vec![false; whole.index() + 1 - all.least];
        for node in nodes {
            let place = node.index() - all.least;
            match pool.node(node) {
                Node::Symbol(symbol) => moves[place] = *symbol == along,
                other => {
                    let mut any = false;
                    other.for_each_part(|part| any |= moves[part.index() - all.least]);
                    moves[place] = any;
                }
            }
            if moves[place] {
                all.nodes.push(node);
            } else {
                let values = all.values.get_mut();
                values[place] = pool.value_of(node, &|e| values[e.index() - all.least], at);
            }
        }
        all
    }

    /// The value as [`Pool::evaluate`] has it.
    pub(super) fn at(&self, at: &dyn Fn(Symbol) -> f64) -> f64 {
        let mut values = self.values.borrow_mut();
        for &node in &self.nodes {
            let value = self.pool.value_of(node, &|e| values[e.index() - self.least], at);
            values[node.index() - self.least] = value;
        }
        values[self.whole.index() - self.least].0
    }
}

fn sized(value: f64) -> (f64, f64) {
    (value, value.abs())
}

/// `base ^ exponent` for a numeric exponent, exact for integers and halves where possible.
pub(super) fn real_power(base: f64, exponent: Number) -> f64 {
    match exponent {
        Number::Rational(n, 1) => match i32::try_from(n) {
            Ok(n) => math::powi(base, n),
            Err(_) => math::powf(base, n as f64),
        },
        Number::Rational(1, 2) => base.sqrt(),
        Number::Rational(-1, 2) => 1.0 / base.sqrt(),
        _ => math::powf(base, exponent.value()),
    }
}
