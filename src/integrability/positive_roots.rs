//! Random residues for symbols at which the roots of expressions have values.
//!
//! In: compiled expressions, the symbols to be drawn, in order. Out: a residue for each. Half of all residues are squares, so
//! that of n roots all have values at one random point in 2ⁿ. A symbol is therefore drawn again until the roots whose last
//! symbol it is have values: of the ½ N (N − 1) distances of N bodies no more than N − 1 at once. Never here: roots of what
//! contains other functions, which are left to chance.

use rustc_hash::FxHashMap;

use super::node_operation::NodeOperation;
use super::radicals::Radicals;
use super::random::Random;
use crate::expr::Symbol;
use crate::num::{PrimeField, Residue};

/// A symbol is drawn this many times as often as it takes on average.
const ATTEMPTS: usize = 16;

/// The most roots that the average is taken of.
const MOST_ROOTS: usize = 12;

/// What lies under roots of even order and is made of symbols by sums, products and roots alone.
#[derive(Clone, Debug, Default)]
pub(super) struct PositiveRoots {
    /// Every part of it, in order.
    nodes: Vec<usize>,
    /// The order of the root taken of a node.
    orders: FxHashMap<usize, u64>,
}

impl PositiveRoots {
    /// Those of compiled expressions, of which roots of these orders are taken.
    pub(super) fn new(steps: &[NodeOperation], orders: &FxHashMap<usize, u64>) -> PositiveRoots {
        let mut algebraic = vec![false; steps.len()];
        for (i, step) in steps.iter().enumerate() {
            algebraic[i] = match step {
                NodeOperation::Number(_) | NodeOperation::Symbol(_) => true,
                _ => step.parts().is_some_and(|mut parts| parts.all(|part| algebraic[part])),
            };
        }
        let orders: FxHashMap<usize, u64> = orders
            .iter()
            .filter(|(base, order)| **order % 2 == 0 && algebraic[**base])
            .map(|(&base, &order)| (base, order))
            .collect();
        let mut needed = vec![false; steps.len()];
        for i in (0..steps.len()).rev() {
            needed[i] |= orders.contains_key(&i);
            if needed[i] {
                steps[i].parts().into_iter().flatten().for_each(|part| needed[part] = true);
            }
        }
        PositiveRoots { nodes: (0..steps.len()).filter(|&i| needed[i]).collect(), orders }
    }

    /// Draws these symbols; `state` has those that are given.
    pub(super) fn draw(
        &self,
        (steps, radicals): (&[NodeOperation], &Radicals),
        (field, random): (PrimeField, &mut Random),
        symbols: &[Symbol],
        state: &mut FxHashMap<Symbol, Residue>,
    ) {
        if self.nodes.is_empty() {
            state.extend(symbols.iter().map(|&symbol| (symbol, random.residue(&field))));
            return;
        }
        let mut values = vec![Residue::ZERO; steps.len()];
        let mut roots = FxHashMap::default();
        for due in self.due(steps, symbols) {
            let count = due.nodes.iter().filter(|i| self.orders.contains_key(i)).count();
            let tries = match count {
                0 => 1,
                _ if due.symbol.is_none() => 1,
                _ => ATTEMPTS << count.min(MOST_ROOTS),
            };
            for _ in 0..tries {
                if let Some(symbol) = due.symbol {
                    state.insert(symbol, random.residue(&field));
                }
                roots.retain(|(base, _), _| !due.nodes.contains(base));
                let have_values = due.nodes.iter().all(|&i| {
                    let value = match &steps[i] {
                        NodeOperation::Symbol(s) => state.get(s).copied(),
                        step => step.algebraic(field, radicals, &values, &mut roots),
                    };
                    values[i] = value.unwrap_or_default();
                    let order = self.orders.get(&i);
                    value.is_some()
                        && order.is_none_or(|&order| field.root(values[i], order).is_some())
                });
                if have_values {
                    break;
                }
            }
        }
    }

    /// For each symbol the nodes whose last symbol it is; those without any come first.
    fn due(&self, steps: &[NodeOperation], symbols: &[Symbol]) -> Vec<Due> {
        let first = Due { symbol: None, nodes: Vec::new() };
        let mut all = vec![first];
        all.extend(symbols.iter().map(|&s| Due { symbol: Some(s), nodes: Vec::new() }));
        let mut last: FxHashMap<usize, usize> = FxHashMap::default();
        for &i in &self.nodes {
            let own = match &steps[i] {
                NodeOperation::Symbol(s) => {
                    symbols.iter().position(|symbol| symbol == s).map_or(0, |k| k + 1)
                }
                step => {
                    step.parts().into_iter().flatten().map(|part| last[&part]).max().unwrap_or(0)
                }
            };
            last.insert(i, own);
            all[own].nodes.push(i);
        }
        all
    }
}

/// What is to be evaluated once a symbol has been drawn.
struct Due {
    symbol: Option<Symbol>,
    nodes: Vec<usize>,
}
