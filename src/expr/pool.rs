//! The pool stores every expression once and identifies it by a handle. Handles of parts are always
//! smaller than handles of the whole, so passes over an expression visit the handles in order and
//! need no recursion.

use rustc_hash::FxHashMap;
use std::sync::Arc;

use super::function::FunctionId;
use super::notation::{latex_name, unicode_name};
use super::symbol::{Rank, Symbol, SymbolInfo};
use crate::cancel::Cancel;
use crate::num::Number;

/// The largest number of nodes in one pool, so that an untrusted file cannot fill the memory.
pub const NODE_LIMIT: usize = 1_000_000;

/// A handle to an expression of one [`Pool`]. Equal handles mean equal canonical expressions.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Expr(pub(super) u32);

impl Expr {
    /// The number 0, the same in every pool.
    pub const ZERO: Expr = Expr(0);
    /// The number 1, the same in every pool.
    pub const ONE: Expr = Expr(1);

    /// The index of the node in its pool; parts come before the whole.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One canonical node.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// A number.
    Number(Number),
    /// The number π.
    Pi,
    /// A name.
    Symbol(Symbol),
    /// `constant + Σ coefficient · term`, terms ascending, no term a number or a sum, no
    /// coefficient zero, at least two summands.
    Sum(Number, Box<[(Number, Expr)]>),
    /// `coefficient · Π base ^ exponent`, bases ascending, no exponent zero, never a lone factor.
    Product(Number, Box<[(Expr, Number)]>),
    /// `base ^ exponent` with an exponent that is not a number.
    Power(Expr, Expr),
    /// A function applied to its arguments.
    Call(FunctionId, Box<[Expr]>),
}

impl Node {
    /// The parts of this node.
    pub fn parts(&self) -> Vec<Expr> {
        match self {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => Vec::new(),
            Node::Sum(_, terms) => terms.iter().map(|&(_, e)| e).collect(),
            Node::Product(_, factors) => factors.iter().map(|&(e, _)| e).collect(),
            Node::Power(base, exponent) => vec![*base, *exponent],
            Node::Call(_, arguments) => arguments.to_vec(),
        }
    }
}

/// The store of expressions and symbols; see the module documentation.
#[derive(Clone, Debug)]
pub struct Pool {
    nodes: Vec<Arc<Node>>,
    depths: Vec<u32>,
    index: FxHashMap<Arc<Node>, Expr>,
    symbols: Vec<SymbolInfo>,
    names: FxHashMap<String, Symbol>,
    size: usize,
    full: bool,
    cancel: Cancel,
    /// Radicands whose roots a power has removed; they are not negative.
    under_roots: Vec<Expr>,
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
            depths: Vec::new(),
            index: FxHashMap::default(),
            symbols: Vec::new(),
            names: FxHashMap::default(),
            size: 0,
            full: false,
            cancel: Cancel::new(),
            under_roots: Vec::new(),
        };
        pool.intern(Node::Number(Number::ZERO));
        pool.intern(Node::Number(Number::ONE));
        pool
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
    pub(super) fn shared(&self, e: Expr) -> Arc<Node> {
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

    /// Returns whether the pool has exceeded [`NODE_LIMIT`] or work on it was cancelled.
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
        self.depths[e.index()] as usize
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
        self.symbols.push(info);
        self.names.insert(name.to_owned(), symbol);
        symbol
    }

    /// The symbol with this name, if the pool has one.
    pub fn find_symbol(&self, name: &str) -> Option<Symbol> {
        self.names.get(name).copied()
    }

    /// The notation of a symbol.
    pub fn symbol_info(&self, symbol: Symbol) -> &SymbolInfo {
        &self.symbols[symbol.index()]
    }

    /// Changes the Unicode and LaTeX notation of a symbol; its name stays the same.
    pub fn describe(&mut self, symbol: Symbol, unicode: &str, latex: &str, rank: Rank) {
        let info = &mut self.symbols[symbol.index()];
        unicode.clone_into(&mut info.unicode);
        latex.clone_into(&mut info.latex);
        info.rank = rank;
    }

    /// The number of symbols in the pool.
    pub fn symbol_count(&self) -> usize {
        self.symbols.len()
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

    /// A number.
    pub fn number(&mut self, n: Number) -> Expr {
        self.intern(Node::Number(n.canonical()))
    }

    /// An integer.
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

    /// All nodes of some expressions, the roots included, parts before wholes.
    pub fn reachable(&self, roots: &[Expr]) -> Vec<Expr> {
        let mut seen: rustc_hash::FxHashSet<Expr> = rustc_hash::FxHashSet::default();
        let mut stack: Vec<Expr> = roots.to_vec();
        while let Some(e) = stack.pop() {
            if seen.insert(e) {
                stack.extend(self.node(e).parts());
            }
        }
        let mut all: Vec<Expr> = seen.into_iter().collect();
        all.sort_unstable();
        all
    }

    /// The number of distinct nodes in an expression.
    pub fn count(&self, e: Expr) -> usize {
        self.reachable(&[e]).len()
    }

    /// The symbols in an expression, in order of introduction.
    pub fn symbols_of(&self, e: Expr) -> Vec<Symbol> {
        let mut symbols: Vec<Symbol> =
            self.reachable(&[e]).into_iter().filter_map(|e| self.as_symbol(e)).collect();
        symbols.sort_unstable();
        symbols
    }

    /// Returns whether a symbol occurs in an expression.
    pub fn depends(&self, e: Expr, symbol: Symbol) -> bool {
        self.reachable(&[e]).into_iter().any(|e| self.as_symbol(e) == Some(symbol))
    }

    /// Returns whether any of the symbols occurs in an expression.
    pub fn depends_on_any(&self, e: Expr, symbols: &[Symbol]) -> bool {
        self.reachable(&[e])
            .into_iter()
            .any(|e| self.as_symbol(e).is_some_and(|s| symbols.contains(&s)))
    }

    /// Stores a canonical node, or finds the existing one. Only the constructors call this.
    pub(super) fn intern(&mut self, node: Node) -> Expr {
        let stopped = self.is_stopped();
        if let Some(&e) = self.index.get(&node).filter(|_| !stopped) {
            return e;
        }
        let parts = node.parts();
        if self.full || self.size > NODE_LIMIT || stopped {
            self.full = true;
            return Expr::ZERO;
        }
        let depth = parts.iter().map(|p| self.depths[p.index()] + 1).max().unwrap_or(0);
        let e = Expr(self.nodes.len() as u32);
        let node = Arc::new(node);
        self.size += 1 + parts.len() / 4;
        self.nodes.push(Arc::clone(&node));
        self.depths.push(depth);
        self.index.insert(node, e);
        e
    }
}
