//! Exact differentiation. A derivation is a map from symbols to expressions, extended by the rules
//! for sums, products and compositions; a total time derivative is therefore one pass, like any
//! partial one.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use super::measure::SymbolSet;
use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::symbol::Symbol;
use crate::num::Number;

impl Pool {
    /// `∂e/∂symbol`.
    pub fn derivative(&mut self, e: Expr, symbol: Symbol) -> Expr {
        self.derivation(e, &[(symbol, Expr::ONE)])
    }

    /// The derivation that maps each listed symbol to its expression and every other symbol to
    /// zero. With `[(q, q'), (q', q''), (t, 1)]` it is d/dt.
    pub fn derivation(&mut self, e: Expr, seeds: &[(Symbol, Expr)]) -> Expr {
        let seeds: FxHashMap<Symbol, Expr> = seeds.iter().copied().collect();
        let set = SymbolSet::of_all(seeds.keys().copied());
        let mut done: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable_until(&[e], |part| !self.may_contain(part, set)) {
            if self.is_stopped() {
                return Expr::ZERO;
            }
            let derived = self.derive_node(part, &seeds, &done);
            done.insert(part, derived);
        }
        slope_of(&done, e)
    }

    fn derive_node(
        &mut self,
        e: Expr,
        seeds: &FxHashMap<Symbol, Expr>,
        done: &FxHashMap<Expr, Expr>,
    ) -> Expr {
        match &*self.shared(e) {
            Node::Number(_) | Node::Pi => Expr::ZERO,
            Node::Symbol(s) => seeds.get(s).copied().unwrap_or(Expr::ZERO),
            Node::Sum(_, terms) => {
                let terms: Vec<(Number, Expr)> = terms
                    .iter()
                    .map(|(c, t)| (*c, slope_of(done, *t)))
                    .filter(|t| t.1 != Expr::ZERO)
                    .collect();
                self.linear(Number::ZERO, &terms)
            }
            Node::Product(c, factors) => {
                let mut terms = Vec::new();
                for (i, &(base, n)) in factors.iter().enumerate() {
                    let slope = slope_of(done, base);
                    if slope == Expr::ZERO {
                        continue;
                    }
                    let mut rest = factors.to_vec();
                    rest[i].1 = n + Number::MINUS_ONE;
                    rest.push((slope, Number::ONE));
                    terms.push((Number::ONE, self.monomial(*c * n, &rest)));
                }
                self.linear(Number::ZERO, &terms)
            }
            Node::Power(base, exponent) => {
                let (db, de) = (slope_of(done, *base), slope_of(done, *exponent));
                let mut terms = Vec::new();
                if db != Expr::ZERO {
                    let lowered = self.linear(Number::MINUS_ONE, &[(Number::ONE, *exponent)]);
                    let power = self.pow(*base, lowered);
                    terms.push(self.product(&[*exponent, power, db]));
                }
                if de != Expr::ZERO {
                    let logarithm = self.call(FunctionId::Ln, &[*base]);
                    terms.push(self.product(&[e, logarithm, de]));
                }
                self.sum(&terms)
            }
            Node::Call(function, arguments) => {
                let mut terms = Vec::new();
                for (i, argument) in arguments.iter().enumerate() {
                    let slope = slope_of(done, *argument);
                    if slope != Expr::ZERO {
                        let partial = (function.row().derivative)(self, arguments, i);
                        terms.push(self.mul(partial, slope));
                    }
                }
                self.sum(&terms)
            }
        }
    }

    /// Replaces symbols by expressions, all simultaneously.
    pub fn substitute(&mut self, e: Expr, replacements: &HashMap<Symbol, Expr>) -> Expr {
        let set = SymbolSet::of_all(replacements.keys().copied());
        let mut done: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable_until(&[e], |part| !self.may_contain(part, set)) {
            if self.is_stopped() {
                return e;
            }
            let replaced = match self.as_symbol(part) {
                Some(s) => replacements.get(&s).copied().unwrap_or(part),
                None => self.rebuild_from(part, &done),
            };
            done.insert(part, replaced);
        }
        done.get(&e).copied().unwrap_or(e)
    }
}

/// The derivative of a part; one that no seed occurs in has none.
fn slope_of(done: &FxHashMap<Expr, Expr>, part: Expr) -> Expr {
    done.get(&part).copied().unwrap_or(Expr::ZERO)
}
