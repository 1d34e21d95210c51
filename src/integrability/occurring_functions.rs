//! The functions that occur in expressions, as far as their residues go: circles, units and roots, for which numbers are drawn.
//!
//! In: the nodes of expressions. Out: what they have in common, and the [`NodeOperation`] of each. Never here: residues.

use rustc_hash::FxHashMap;

use super::node_operation::{Angle, NodeOperation};
use super::units::{ArgumentUnits, Unsupported, least_common};
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::num::Number;

/// The functions that occur in expressions, for which numbers are drawn.
#[derive(Default)]
pub(super) struct OccurringFunctions {
    /// The angles of sines and cosines, and the exponents of exponentials, by their terms.
    pub(super) circles: ArgumentUnits,
    pub(super) units: ArgumentUnits,
    /// The order of the roots that are taken of each base.
    pub(super) roots_of: FxHashMap<Expr, u64>,
    /// The number of logarithms and arctangents.
    pub(super) opaque: usize,
    /// Whether there are numbers that are not short fractions.
    pub(super) inexact: bool,
}

impl OccurringFunctions {
    /// Those of these nodes, if they have values modulo a prime.
    pub(super) fn of(
        pool: &mut Pool,
        nodes: &[Expr],
        moving: &[Symbol],
    ) -> Result<Self, Unsupported> {
        let inexact = nodes.iter().any(|&e| has_real(pool, e));
        let mut found = OccurringFunctions { inexact, ..OccurringFunctions::default() };
        for &e in nodes {
            match &pool.node(e).clone() {
                Node::Call(
                    FunctionId::Sin | FunctionId::Cos | FunctionId::Tan | FunctionId::Cot,
                    u,
                ) => {
                    found.circles.collect(pool, u[0])?;
                }
                Node::Call(
                    FunctionId::Exp | FunctionId::Sinh | FunctionId::Cosh | FunctionId::Tanh,
                    u,
                ) => found.units.collect(pool, u[0])?,
                Node::Call(FunctionId::Ln | FunctionId::Atan, _) => found.opaque += 1,
                Node::Product(_, factors) => {
                    for &(base, n) in factors {
                        let Number::Rational(_, d) = n else {
                            let why = format!("the power {} is not a fraction", pool.text(e));
                            return Err(Unsupported(why));
                        };
                        let known = found.roots_of.entry(base).or_insert(1);
                        *known = least_common(*known as i64, d) as u64;
                    }
                }
                _ => {}
            }
        }
        for (&base, _) in found.roots_of.iter().filter(|(_, d)| **d > 1) {
            if pool.touches_zero(base, moving) {
                let why = "no search is made through a root with a kink, where";
                return Err(Unsupported(format!("{why} {} touches zero", pool.text(base))));
            }
        }
        Ok(found)
    }

    /// An angle by the units it is made of, and quarter turns.
    fn angle(&self, pool: &mut Pool, u: Expr) -> Result<Angle, Unsupported> {
        let turn = self.circles.order.iter().position(|&t| *pool.node(t) == Node::Pi);
        let (mut parts, mut quarters) = (self.circles.parts(pool, u), 0);
        if let Some(turn) = turn {
            let denominator = self.circles.denominators[&self.circles.order[turn]];
            for &(_, n) in parts.iter().filter(|(unit, _)| *unit == turn) {
                if 2 * n % denominator != 0 {
                    let why = "an angle is a fraction of π other than a quarter turn";
                    return Err(Unsupported(why.to_owned()));
                }
                quarters += 2 * n / denominator;
            }
            parts.retain(|(unit, _)| *unit != turn);
        }
        Ok(Angle { parts, quarters })
    }

    pub(super) fn operation(
        &self,
        pool: &mut Pool,
        e: Expr,
        index: &FxHashMap<Expr, usize>,
        moving: &[Symbol],
    ) -> Result<NodeOperation, Unsupported> {
        let at = |e: Expr| index[&e];
        Ok(match &pool.node(e).clone() {
            Node::Number(n) => NodeOperation::Number(*n),
            Node::Pi => NodeOperation::Constant,
            Node::Symbol(s) => NodeOperation::Symbol(*s),
            Node::Sum(c, terms) => {
                NodeOperation::Sum(*c, terms.iter().map(|&(c, t)| (c, at(t))).collect())
            }
            Node::Product(c, factors) => {
                let factor = |&(base, n): &(Expr, Number)| {
                    let d = self.roots_of[&base];
                    let Number::Rational(n, own) = n else { return None };
                    Some((at(base), d, n * (d as i64 / own)))
                };
                NodeOperation::Product(*c, factors.iter().filter_map(factor).collect())
            }
            Node::Power(..) => {
                let why =
                    format!("the power {} has an exponent that is not a number", pool.text(e));
                return Err(Unsupported(why));
            }
            Node::Call(function, u) => match function {
                FunctionId::Sin => NodeOperation::Sine(self.angle(pool, u[0])?, at(u[0])),
                FunctionId::Cos => NodeOperation::Cosine(self.angle(pool, u[0])?, at(u[0])),
                FunctionId::Exp => NodeOperation::Exp(self.units.parts(pool, u[0]), at(u[0])),
                FunctionId::Sinh => NodeOperation::Sinh(self.units.parts(pool, u[0]), at(u[0])),
                FunctionId::Cosh => NodeOperation::Cosh(self.units.parts(pool, u[0]), at(u[0])),
                FunctionId::Ln | FunctionId::Atan if !pool.depends_on_any(e, moving) => {
                    NodeOperation::Constant
                }
                FunctionId::Ln => NodeOperation::Ln(at(u[0])),
                FunctionId::Atan => NodeOperation::Atan(at(u[0])),
                other => {
                    let name = other.row().name;
                    return Err(Unsupported(format!("no search is made through `{name}`")));
                }
            },
        })
    }
}

/// Whether a node itself has a number that is not a short fraction.
fn has_real(pool: &Pool, e: Expr) -> bool {
    let real = |n: &Number| matches!(n, Number::Real(_));
    match pool.node(e) {
        Node::Number(n) => real(n),
        Node::Sum(c, terms) => real(c) || terms.iter().any(|(c, _)| real(c)),
        Node::Product(c, _) => real(c),
        _ => false,
    }
}
