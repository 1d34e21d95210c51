//! Rewriting an expression from its parts upwards.
//!
//! A pass gives every node one result, whatever the node is a part of; what was rewritten once is
//! not visited again. In: an expression, and what a pass does with one node. Out: an expression.
//! Never here: the passes.

use rustc_hash::FxHashMap;

use super::memo::Pass;
use super::node::{Expr, Node};
use super::pool::Pool;
use crate::num::Number;

impl Pool {
    /// Rewrites an expression from its parts upwards: `rewrite` is handed each node with its parts
    /// already rewritten. Nodes whose result is known are not visited.
    pub(super) fn rewrite(
        &mut self,
        pass: Pass,
        e: Expr,
        mut rewrite: impl FnMut(&mut Pool, Expr) -> Expr,
    ) -> Expr {
        for part in self.reachable_until(&[e], |part| self.memo.get(pass, part).is_some()) {
            if self.is_stopped() {
                return e;
            }
            let rebuilt = self.rebuild(part, |pool, p| pool.memo.get(pass, p).unwrap_or(p));
            let rewritten = rewrite(self, rebuilt);
            self.remember(pass, part, rewritten);
        }
        self.memo.get(pass, e).unwrap_or(e)
    }

    /// The same, once: no result is remembered. Where the work is cancelled the expression comes back as it is; nobody waits for
    /// a result then.
    pub(super) fn each_part(&mut self, e: Expr, change: impl Fn(&mut Pool, Expr) -> Expr) -> Expr {
        let mut changed: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            if self.is_stopped() {
                return e;
            }
            let rebuilt = self.rebuild_from(part, &changed);
            let new = change(self, rebuilt);
            changed.insert(part, new);
        }
        changed[&e]
    }

    /// Remembers a result, if it is valid.
    pub(super) fn remember(&mut self, pass: Pass, e: Expr, result: Expr) {
        if !self.is_full() && !self.is_stopped() {
            self.memo.insert(pass, e, result);
        }
    }

    /// The same node with its parts replaced as `of` says.
    fn rebuild(&mut self, e: Expr, of: impl Fn(&Pool, Expr) -> Expr) -> Expr {
        let mut is_same = true;
        self.node(e).for_each_part(|part| is_same &= of(self, part) == part);
        if is_same {
            return e;
        }
        match &*self.shared(e) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => e,
            Node::Sum(constant, terms) => {
                let terms: Vec<(Number, Expr)> =
                    terms.iter().map(|&(c, t)| (c, of(self, t))).collect();
                self.linear(*constant, &terms)
            }
            Node::Product(c, factors) => {
                let factors: Vec<(Expr, Number)> =
                    factors.iter().map(|&(b, n)| (of(self, b), n)).collect();
                self.monomial(*c, &factors)
            }
            &Node::Power(base, exponent) => {
                let (base, exponent) = (of(self, base), of(self, exponent));
                self.pow(base, exponent)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Expr> = arguments.iter().map(|&a| of(self, a)).collect();
                self.call(*function, &arguments)
            }
        }
    }

    /// Replaces the [long](Number::is_long) numbers of an expression that are no exponents.
    pub fn replace_long_numbers(
        &mut self,
        e: Expr,
        of: &mut dyn FnMut(&mut Pool, f64) -> Expr,
    ) -> Expr {
        let mut done: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            if self.is_stopped() {
                return e;
            }
            let parts = |done: &FxHashMap<Expr, Expr>, e: Expr| done.get(&e).copied().unwrap_or(e);
            let mut scaled = |pool: &mut Pool, n: Number, e: Expr| {
                if n.is_long() {
                    let number = of(pool, n.value());
                    pool.mul(number, e)
                } else {
                    pool.scale(n, e)
                }
            };
            let replaced = match self.node(part).clone() {
                Node::Number(n) => scaled(self, n, Expr::ONE),
                Node::Sum(constant, terms) => {
                    let mut all = vec![scaled(self, constant, Expr::ONE)];
                    for (c, term) in terms {
                        all.push(scaled(self, c, parts(&done, term)));
                    }
                    self.sum(&all)
                }
                Node::Product(c, factors) => {
                    let factors: Vec<(Expr, Number)> =
                        factors.iter().map(|&(b, n)| (parts(&done, b), n)).collect();
                    let product = self.monomial(Number::ONE, &factors);
                    scaled(self, c, product)
                }
                _ => self.rebuild_from(part, &done),
            };
            done.insert(part, replaced);
        }
        done.get(&e).copied().unwrap_or(e)
    }

    /// The same node with its parts replaced where the map has something for them.
    pub(super) fn rebuild_from(&mut self, e: Expr, parts: &FxHashMap<Expr, Expr>) -> Expr {
        self.rebuild(e, |_, part| parts.get(&part).copied().unwrap_or(part))
    }
}
