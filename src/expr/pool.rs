//! The pool stores every expression once and identifies it by a handle. Handles of parts are always
//! smaller than handles of the whole, so passes over an expression visit the handles in order and
//! need no recursion.

use std::hash::BuildHasher;
use std::sync::Arc;

use hashbrown::HashTable;
use rustc_hash::{FxBuildHasher, FxHashMap};

use super::measure::{DISTINCT, NodeMeasure, SymbolSet};
use super::memo::Memo;
use super::node::{Expr, Node};
use super::notation::{latex_name, unicode_name};
use super::steps::Steps;
use super::symbol::{Rank, Symbol, SymbolInfo};
use crate::cancel::Cancel;
use crate::num::Number;

/// The largest number of nodes in one pool, so that an untrusted file cannot fill the memory.
pub const NODE_LIMIT: usize = 1_000_000;

/// The store of expressions and symbols; see the module documentation.
#[derive(Clone, Debug)]
pub struct Pool {
    nodes: Vec<Arc<Node>>,
    measures: Vec<NodeMeasure>,
    /// The handles, found by the hashes of their nodes.
    index: HashTable<Expr>,
    /// The symbols and their names, which clones share until one of them adds to them.
    symbols: Arc<Vec<SymbolInfo>>,
    names: Arc<FxHashMap<String, Symbol>>,
    size: usize,
    full: bool,
    pub(super) steps: Steps,
    cancel: Cancel,
    /// Radicands whose roots a power has removed; they are not negative.
    under_roots: Vec<Expr>,
    pub(super) memo: Memo,
}

impl Default for Pool {
    fn default() -> Self {
        Pool::new()
    }
}

impl Pool {
    /// Creates a pool that contains only 0 and 1.
    pub fn new() -> Pool {
        let mut pool = Pool {
            nodes: Vec::new(),
            measures: Vec::new(),
            index: HashTable::new(),
            symbols: Arc::default(),
            names: Arc::default(),
            size: 0,
            full: false,
            steps: Steps::UNBOUNDED,
            cancel: Cancel::new(),
            under_roots: Vec::new(),
            memo: Memo::default(),
        };
        pool.intern(Node::Number(Number::ZERO));
        pool.intern(Node::Number(Number::ONE));
        pool
    }

    /// A pool with the same symbols and no other expression.
    pub(super) fn with_the_same_symbols(&self) -> Pool {
        Pool { symbols: Arc::clone(&self.symbols), names: Arc::clone(&self.names), ..Pool::new() }
    }

    /// Radicands of even roots that powers have removed, such as x in (√x)². They are nonnegative
    /// wherever the original expressions have a value.
    pub fn under_roots(&self) -> &[Expr] {
        &self.under_roots
    }

    /// Records that a power has removed a root of `e`.
    pub(super) fn note_root(&mut self, e: Expr) {
        if !self.under_roots.contains(&e) && self.as_number(e).is_none() {
            self.under_roots.push(e);
        }
    }

    /// The node of a handle.
    pub fn node(&self, e: Expr) -> &Node {
        &self.nodes[e.index()]
    }

    /// The node of a handle, shared so that the pool may grow meanwhile.
    pub fn shared(&self, e: Expr) -> Arc<Node> {
        Arc::clone(&self.nodes[e.index()])
    }

    /// The expression as a number, if it is one.
    pub fn as_number(&self, e: Expr) -> Option<Number> {
        match self.node(e) {
            Node::Number(n) => Some(*n),
            _ => None,
        }
    }

    /// The expression as a symbol, if it is one.
    pub fn as_symbol(&self, e: Expr) -> Option<Symbol> {
        match self.node(e) {
            Node::Symbol(s) => Some(*s),
            _ => None,
        }
    }

    /// Sets the token that stops work on the pool and on everything created from it.
    pub fn set_cancel(&mut self, cancel: Cancel) {
        self.cancel = cancel;
    }

    /// The token that stops work on the pool.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// The number of expressions in the pool.
    pub fn built(&self) -> usize {
        self.nodes.len()
    }

    /// Returns whether the pool has exceeded [`NODE_LIMIT`] or the allowance of an
    /// [attempt](Pool::attempt), or work on it was cancelled.
    /// Expressions built since then are not valid, and the stage that built them must return an
    /// error.
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Returns whether work on the pool was cancelled. Passes over expressions then end early, with
    /// an incomplete result.
    pub(super) fn is_stopped(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Marks the pool as full if an expression, written out, has more than [`NODE_LIMIT`] nodes.
    /// They are counted before anything is built from it.
    pub fn refuse_heavy(&mut self, e: Expr) {
        self.full |= self.weight(e) > NODE_LIMIT as u64;
    }

    /// The length of the longest chain of parts below an expression.
    pub fn depth(&self, e: Expr) -> usize {
        self.measures[e.index()].depth as usize
    }

    /// The symbol with this name. A new one is displayed according to [`unicode_name`] and
    /// [`latex_name`].
    pub fn symbol(&mut self, name: &str) -> Symbol {
        if let Some(&symbol) = self.names.get(name) {
            return symbol;
        }
        let info = SymbolInfo {
            name: name.to_owned(),
            unicode: unicode_name(name),
            latex: latex_name(name),
            rank: Rank::Constant,
        };
        let symbol = Symbol(self.symbols.len() as u32);
        Arc::make_mut(&mut self.symbols).push(info);
        Arc::make_mut(&mut self.names).insert(name.to_owned(), symbol);
        symbol
    }

    /// The symbol with this name, if the pool has one.
    pub fn find_symbol(&self, name: &str) -> Option<Symbol> {
        self.names.get(name).copied()
    }

    /// Returns whether some symbol is shown like this.
    pub fn shows(&self, unicode: &str) -> bool {
        self.symbols.iter().any(|info| info.unicode == unicode)
    }

    /// The notation of a symbol.
    pub fn symbol_info(&self, symbol: Symbol) -> &SymbolInfo {
        &self.symbols[symbol.index()]
    }

    /// The notations of all symbols as they are now, in the order of introduction.
    pub fn symbol_infos(&self) -> Arc<Vec<SymbolInfo>> {
        Arc::clone(&self.symbols)
    }

    /// Changes the Unicode and LaTeX notation of a symbol; its name stays the same.
    pub fn describe(&mut self, symbol: Symbol, unicode: &str, latex: &str, rank: Rank) {
        let info = &mut Arc::make_mut(&mut self.symbols)[symbol.index()];
        unicode.clone_into(&mut info.unicode);
        latex.clone_into(&mut info.latex);
        info.rank = rank;
    }

    /// The expression of a symbol.
    pub fn variable(&mut self, symbol: Symbol) -> Expr {
        self.intern(Node::Symbol(symbol))
    }

    /// The expression of a name.
    pub fn named(&mut self, name: &str) -> Expr {
        let symbol = self.symbol(name);
        self.variable(symbol)
    }

    /// Interns a constant.
    pub fn number(&mut self, n: Number) -> Expr {
        self.intern(Node::Number(n.canonical()))
    }

    /// Interns a whole number.
    pub fn integer(&mut self, n: i64) -> Expr {
        self.number(Number::integer(n))
    }

    /// The exact rational `n / d`.
    pub fn ratio(&mut self, n: i64, d: i64) -> Expr {
        self.number(Number::ratio(i128::from(n), i128::from(d)))
    }

    /// The number π.
    pub fn pi(&mut self) -> Expr {
        self.intern(Node::Pi)
    }

    /// The number of nodes in an expression when it is written out; a common part counts each time
    /// it occurs. Saturates at `u64::MAX`.
    pub fn weight(&self, e: Expr) -> u64 {
        // once stopped: too heavy for any further step
        if self.is_stopped() { u64::MAX } else { self.measures[e.index()].weight }
    }

    /// What an expression costs to read: its weight, with a penalty for denominators.
    pub(super) fn cost(&self, e: Expr) -> u64 {
        self.measures[e.index()].cost
    }

    /// All nodes of some expressions, the roots included, parts before wholes.
    pub fn reachable(&self, roots: &[Expr]) -> Vec<Expr> {
        self.reachable_until(roots, |_| false)
    }

    /// Like [`Pool::reachable`], without the nodes at which `stop` holds and what is below them
    /// alone.
    pub(crate) fn reachable_until(&self, roots: &[Expr], stop: impl Fn(Expr) -> bool) -> Vec<Expr> {
        let Some(top) = roots.iter().max() else { return Vec::new() };
        // parts have smaller handles than wholes: one walk downwards over a set of bits meets every
        // node after all that it is a part of
        let mut marked = vec![0_u64; top.index() / 64 + 1];
        let place = |e: Expr| (e.index() / 64, 1_u64 << (e.index() % 64));
        for &root in roots {
            let (word, bit) = place(root);
            marked[word] |= bit;
        }
        let mut all: Vec<Expr> = Vec::new();
        for word in (0..marked.len()).rev() {
            // what is marked meanwhile in this word lies below what is taken from it
            let mut below = u64::MAX;
            while marked[word] & below != 0 {
                let bit = (marked[word] & below).ilog2();
                below = (1 << bit) - 1;
                let e = Expr((word * 64) as u32 + bit);
                if stop(e) {
                    continue;
                }
                all.push(e);
                self.node(e).for_each_part(|part| {
                    let (word, bit) = place(part);
                    marked[word] |= bit;
                });
            }
        }
        all.reverse();
        all
    }

    /// The number of distinct nodes in an expression.
    pub fn count(&self, e: Expr) -> usize {
        self.reachable(&[e]).len()
    }

    /// The symbols in an expression, in order of introduction.
    pub fn symbols_of(&self, e: Expr) -> Vec<Symbol> {
        if self.symbols.len() <= DISTINCT {
            return self.measures[e.index()].symbols.bits().map(|i| Symbol(i as u32)).collect();
        }
        let mut symbols: Vec<Symbol> =
            self.reachable(&[e]).into_iter().filter_map(|e| self.as_symbol(e)).collect();
        symbols.sort_unstable();
        symbols
    }

    /// Returns whether a symbol occurs in an expression.
    pub fn depends(&self, e: Expr, symbol: Symbol) -> bool {
        self.depends_on_any(e, &[symbol])
    }

    /// Returns whether any of the symbols occurs in an expression.
    pub fn depends_on_any(&self, e: Expr, symbols: &[Symbol]) -> bool {
        let set = SymbolSet::of_all(symbols.iter().copied());
        self.may_contain(e, set)
            && (self.symbols.len() <= DISTINCT
                || self
                    .reachable_until(&[e], |part| !self.may_contain(part, set))
                    .into_iter()
                    .any(|e| self.as_symbol(e).is_some_and(|s| symbols.contains(&s))))
    }

    /// Returns whether any symbol of a set may occur in an expression; `false` is certain.
    pub(super) fn may_contain(&self, e: Expr, symbols: SymbolSet) -> bool {
        self.measures[e.index()].symbols.meets(symbols)
    }

    /// Stores a canonical node, or finds the existing one. Only the constructors call this.
    pub(super) fn intern(&mut self, node: Node) -> Expr {
        let stopped = self.is_stopped();
        let mut parts = 0;
        node.for_each_part(|_| parts += 1);
        self.full |= !self.steps.take(1 + parts as u64);
        let hash = FxBuildHasher.hash_one(&node);
        let known = self.index.find(hash, |&e| *self.nodes[e.index()] == node);
        if let Some(&e) = known.filter(|_| !stopped) {
            return e;
        }
        if self.full || self.size > NODE_LIMIT || stopped {
            self.full = true;
            return Expr::ZERO;
        }
        let e = Expr(self.nodes.len() as u32);
        self.size += 1 + parts / 4;
        self.measures.push(NodeMeasure::of(&node, &self.measures));
        self.nodes.push(Arc::new(node));
        let nodes = &self.nodes;
        self.index.insert_unique(hash, e, |&e| FxBuildHasher.hash_one(&*nodes[e.index()]));
        e
    }
}
