//! What is known of a node from the moment it is stored: how deep it is, how much of it there is to
//! read, and which symbols may occur in it.
//!
//! In: a node, and the measures of its parts. Out: its own. Never here: the nodes themselves.

use super::node::{Expr, Node};
use super::symbol::Symbol;

/// The number of symbols that a [`SymbolSet`] distinguishes.
pub(super) const DISTINCT: usize = u128::BITS as usize;

/// A set of symbols, one bit each. From the symbol [`DISTINCT`] on several share a bit: what is not
/// in the set does not occur, what is in it may.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct SymbolSet(u128);

impl SymbolSet {
    pub(super) fn of(symbol: Symbol) -> SymbolSet {
        SymbolSet(1 << (symbol.index() % DISTINCT))
    }

    pub(super) fn of_all(symbols: impl IntoIterator<Item = Symbol>) -> SymbolSet {
        symbols.into_iter().fold(SymbolSet::default(), |all, s| all.union(SymbolSet::of(s)))
    }

    fn union(self, other: SymbolSet) -> SymbolSet {
        SymbolSet(self.0 | other.0)
    }

    /// Returns whether the two sets have a bit in common.
    pub(super) fn meets(self, other: SymbolSet) -> bool {
        self.0 & other.0 != 0
    }

    /// The bits that are set, ascending: the indices of the symbols if none of them share one.
    pub(super) fn bits(self) -> impl Iterator<Item = usize> {
        let mut left = self.0;
        std::iter::from_fn(move || {
            let next = (left != 0).then(|| left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some(next)
        })
    }
}

/// What is known of a node without looking below it.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeMeasure {
    /// The length of the longest chain of parts.
    pub(super) depth: u32,
    /// The number of nodes when it is written out, a common part counted wherever it occurs;
    /// saturates.
    pub(super) weight: u64,
    /// What it costs to read: the weight, with a penalty for denominators; saturates.
    pub(super) cost: u64,
    /// The symbols that may occur in it.
    pub(super) symbols: SymbolSet,
}

impl NodeMeasure {
    pub(super) fn of(node: &Node, known: &[NodeMeasure]) -> NodeMeasure {
        let mut measure = NodeMeasure {
            depth: 0,
            weight: 1,
            cost: own_cost(node),
            symbols: SymbolSet::default(),
        };
        if let Node::Symbol(symbol) = node {
            measure.symbols = SymbolSet::of(*symbol);
        }
        node.for_each_part(|part: Expr| {
            let below = &known[part.index()];
            measure.depth = measure.depth.max(below.depth + 1);
            measure.weight = measure.weight.saturating_add(below.weight);
            measure.cost = measure.cost.saturating_add(below.cost);
            measure.symbols = measure.symbols.union(below.symbols);
        });
        measure
    }
}

fn own_cost(node: &Node) -> u64 {
    match node {
        Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Power(..) => 2,
        Node::Sum(constant, terms) => {
            let coefficients = terms.iter().filter(|(c, _)| !c.abs().is_one()).count();
            1 + 2 * u64::from(!constant.is_zero()) + coefficients as u64
        }
        Node::Product(c, factors) => {
            let powers = factors.iter().filter(|(_, n)| !n.abs().is_one()).count();
            1 + u64::from(!c.abs().is_one()) + powers as u64
        }
        Node::Call(..) => 3,
    }
}
