//! Degrees where radians are meant: sine and its like of a quantity whose unit is the degree.
//!
//! In: an expression that has been read, the units of the file. Out: errors. Never here: conversion of numbers, as a unit is a label.

use super::ModelBuilder;
use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, FunctionId, Node, Symbol};
use crate::preset::draft::Formula;

const DEGREES: [&str; 4] = ["°", "deg", "degree", "degrees"];

impl ModelBuilder<'_> {
    /// Notes the symbol of a quantity whose unit is the degree.
    pub(super) fn note_degrees(&mut self, symbol: Symbol, unit: &str) {
        if DEGREES.contains(&unit) {
            self.degrees.push(symbol);
        }
    }

    /// Reports a trigonometric function of a quantity in degrees. A factor of π in its argument converts it.
    pub(super) fn in_radians(&mut self, e: Expr, formula: &Formula) {
        let pool = &self.model.pool;
        if !pool.depends_on_any(e, &self.degrees) {
            return;
        }
        for part in pool.reachable(&[e]) {
            let (name, arguments) = match pool.node(part) {
                Node::Call(FunctionId::Sin, arguments) => ("sin", arguments),
                Node::Call(FunctionId::Cos, arguments) => ("cos", arguments),
                Node::Call(FunctionId::Tan, arguments) => ("tan", arguments),
                Node::Call(FunctionId::Cot, arguments) => ("cot", arguments),
                _ => continue,
            };
            let in_degrees = |symbol: &&Symbol| pool.depends(arguments[0], **symbol);
            let has_pi = |e: &Expr| matches!(pool.node(*e), Node::Pi);
            if let Some(&symbol) = self.degrees.iter().find(in_degrees)
                && !pool.reachable(arguments).iter().any(has_pi)
            {
                let of = &pool.symbol_info(symbol).name;
                let message = format!("`{of}` is in degrees, but {name} takes radians");
                let help = format!("write {name}({of}*pi/180), or give `{of}` in radians");
                self.diagnostics.push(Diagnostic::error(formula.span(), message).with_help(help));
                return;
            }
        }
    }
}
