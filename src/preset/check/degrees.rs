//! Degrees where radians are meant: sine and its like of a quantity whose unit is the degree.
//!
//! In: an expression that has been read, the units of the file. Out: warnings. Never here: conversion of numbers, as a unit is a label.

use super::ModelBuilder;
use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, FunctionId, Node, Symbol};
use crate::num::Number;
use crate::preset::draft::Formula;

/// The largest number in a factor that converts nothing.
const SMALL: u64 = 12;

const DEGREES: [&str; 4] = ["°", "deg", "degree", "degrees"];

impl ModelBuilder<'_> {
    /// Notes the symbol of a quantity whose unit is the degree.
    pub(super) fn note_degrees(&mut self, symbol: Symbol, unit: &str) {
        if DEGREES.contains(&unit) {
            self.degrees.push(symbol);
        }
    }

    /// Reports a trigonometric function of a quantity in degrees, or of a simple multiple or a sum of some. Another factor may
    /// convert it, and a ratio has no unit.
    pub(super) fn in_radians(&mut self, e: Expr, formula: &Formula) {
        let pool = &self.model.pool;
        if !pool.depends_on_any(e, &self.degrees) {
            return;
        }
        for part in pool.reachable(&[e]) {
            let (name, argument) = match pool.node(part) {
                Node::Call(FunctionId::Sin, arguments) => ("sin", arguments[0]),
                Node::Call(FunctionId::Cos, arguments) => ("cos", arguments[0]),
                Node::Call(FunctionId::Tan, arguments) => ("tan", arguments[0]),
                Node::Call(FunctionId::Cot, arguments) => ("cot", arguments[0]),
                _ => continue,
            };
            if let Some(symbol) = self.in_degrees(argument) {
                let of = &pool.symbol_info(symbol).name;
                let message = format!("`{of}` is in degrees, but {name} takes radians");
                let help = format!("write {name}({of}*pi/180), or give `{of}` in radians");
                self.diagnostics.push(Diagnostic::warning(formula.span(), message).with_help(help));
                return;
            }
        }
    }

    /// A quantity in degrees that is an angle as it stands, is a term of it, or has a simple number as its only factor.
    fn in_degrees(&self, angle: Expr) -> Option<Symbol> {
        match self.model.pool.node(angle) {
            Node::Symbol(symbol) => Some(*symbol).filter(|symbol| self.degrees.contains(symbol)),
            Node::Sum(_, terms) => {
                let mut simple = terms.iter().filter(|(factor, _)| is_simple(*factor));
                simple.find_map(|&(_, term)| self.in_degrees(term))
            }
            Node::Product(factor, factors) => match **factors {
                [(base, power)] if power == Number::ONE && is_simple(*factor) => {
                    self.in_degrees(base)
                }
                _ => None,
            },
            _ => None,
        }
    }
}

/// Whether a factor is a ratio of small whole numbers, which converts no unit.
fn is_simple(factor: Number) -> bool {
    matches!(factor, Number::Rational(n, d) if n.unsigned_abs() <= SMALL && d.unsigned_abs() <= SMALL)
}
