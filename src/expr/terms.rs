//! The size of an expression's terms, against which its value has to be measured if terms may
//! cancel, inside a product or a function as well as in the sum itself.
//!
//! In: an expression. Out: another one, which is never negative. Never here: numbers.

use rustc_hash::FxHashMap;

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use crate::num::Number;

impl Pool {
    /// The size of an expression's terms: |c| + Σ|cᵢ|·size for a sum, the product of the sizes of
    /// the factors for a product, |f(u)| + |f'(u)|·size for a function of a sum u, and |e| for
    /// anything else. It is never less than |e|.
    pub fn magnitude(&mut self, e: Expr) -> Expr {
        let mut sizes: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let size = self.size_of_node(part, &sizes);
            sizes.insert(part, size);
        }
        sizes[&e]
    }

    /// The first-order change of an expression under relative changes of all its symbols: Σ |s
    /// ∂e/∂s|. Times the relative rounding error of the symbols, it is the resulting error of the
    /// value, even where the terms vanish.
    pub fn size_of_inputs(&mut self, e: Expr) -> Expr {
        let mut parts = Vec::new();
        for symbol in self.symbols_of(e) {
            let slope = self.derivative(e, symbol);
            let s = self.variable(symbol);
            let part = self.mul(s, slope);
            parts.push(self.call(FunctionId::Abs, &[part]));
        }
        self.sum(&parts)
    }

    fn size_of_node(&mut self, e: Expr, sizes: &FxHashMap<Expr, Expr>) -> Expr {
        match &*self.shared(e) {
            Node::Sum(constant, terms) => {
                let terms: Vec<(Number, Expr)> =
                    terms.iter().map(|(c, t)| (c.abs(), sizes[t])).collect();
                self.linear(constant.abs(), &terms)
            }
            Node::Product(c, factors) => {
                let mut parts = Vec::with_capacity(factors.len());
                for &(base, exponent) in factors {
                    let base = if exponent.is_negative() {
                        self.call(FunctionId::Abs, &[base])
                    } else {
                        sizes[&base]
                    };
                    parts.push((base, exponent));
                }
                self.monomial(c.abs(), &parts)
            }
            Node::Call(function, arguments) => {
                let mut parts = vec![self.call(FunctionId::Abs, &[e])];
                for (i, argument) in arguments.iter().enumerate() {
                    if matches!(self.node(*argument), Node::Sum(..)) {
                        let slope = (function.row().derivative)(self, arguments, i);
                        let slope = self.call(FunctionId::Abs, &[slope]);
                        parts.push(self.mul(slope, sizes[argument]));
                    }
                }
                self.sum(&parts)
            }
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Power(..) => {
                self.call(FunctionId::Abs, &[e])
            }
        }
    }
}
