//! The pool: every expression is stored once and known by a handle. Handles of parts are always
//! smaller than handles of the whole, so passes over an expression walk the handles in order and
//! need no recursion.

use rustc_hash::FxHashMap;
use std::sync::Arc;

use super::function::FunctionId;
use super::notation::{latex_name, unicode_name};
use super::symbol::{Rank, Symbol, SymbolInfo};
use crate::cancel::Cancel;
use crate::num::Number;

/// The most nodes one pool may hold: a stranger's file must not fill the memory.
pub const NODE_LIMIT: usize = 1_000_000;

/// A handle to an expression of one [`Pool`]. Equal handles mean equal canonical expressions.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Expr(pub(super) u32);

impl Expr {
    /// The number 0, the same in every pool.
    pub const ZERO: Expr = Expr(0);
    /// The number 1, the same in every pool.
    pub const ONE: Expr = Expr(1);

    /// The place of the node in its pool; parts stand before the whole.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One canonical node.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// A number.
    Number(Number),
    /// The circle constant.
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
    /// The parts this node is made of.
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

/// The store of expressions and symbols; see the module's head.
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
    /// What stood under a root that a power has taken away: it is not below zero.
    under_roots: Vec<Expr>,
}

impl Default for Pool {
    fn default() -> Self {
        Pool::new()
    }
}

impl Pool {
    /// An empty pool (it knows 0 and 1).
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

    /// What stood under even roots that powers have taken away, as x in (√x)²: expressions that
    /// are not below zero where those written have a value.
    pub fn under_roots(&self) -> &[Expr] {
        &self.under_roots
    }

    /// A root of `e` was taken away by a power.
    pub(super) fn note_root(&mut self, e: Expr) {
        if !self.under_roots.contains(&e) && self.as_number(e).is_none() {
            self.under_roots.push(e);
        }
    }

    /// The node behind a handle.
    pub fn node(&self, e: Expr) -> &Node {
        &self.nodes[e.index()]
    }

    /// The node behind a handle, held apart from the pool so that the pool may grow meanwhile.
    pub(super) fn shared(&self, e: Expr) -> Arc<Node> {
        Arc::clone(&self.nodes[e.index()])
    }

    /// The number an expression is, if it is one.
    pub fn as_number(&self, e: Expr) -> Option<Number> {
        match self.node(e) {
            Node::Number(n) => Some(*n),
            _ => None,
        }
    }

    /// The symbol an expression is, if it is one.
    pub fn as_symbol(&self, e: Expr) -> Option<Symbol> {
        match self.node(e) {
            Node::Symbol(s) => Some(*s),
            _ => None,
        }
    }

    /// Lets work on the pool be stopped by this token, and with it whatever is made from it.
    pub fn set_cancel(&mut self, cancel: Cancel) {
        self.cancel = cancel;
    }

    /// The token by which work on the pool is stopped.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// Whether more was asked of the pool than [`NODE_LIMIT`], or work on it was cancelled: what
    /// was built since is not to be used, and the stage that built it must refuse.
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Whether somebody asked that work on the pool stop: passes over expressions end early, with
    /// whatever they have.
    pub(super) fn is_stopped(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Refuses all further work where an expression, written out, has more pieces than
    /// [`NODE_LIMIT`]: counted before anything is made of it.
    pub fn refuse_heavy(&mut self, e: Expr) {
        self.full |= self.weight(e) > NODE_LIMIT as u64;
    }

    /// The longest chain of parts below an expression.
    pub fn depth(&self, e: Expr) -> usize {
        self.depths[e.index()] as usize
    }

    /// The symbol of a name; a new one is written as [`unicode_name`] and [`latex_name`] say.
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

    /// The symbol of a name, if the pool knows it.
    pub fn find_symbol(&self, name: &str) -> Option<Symbol> {
        self.names.get(name).copied()
    }

    /// How a symbol is written.
    pub fn symbol_info(&self, symbol: Symbol) -> &SymbolInfo {
        &self.symbols[symbol.index()]
    }

    /// Changes how a symbol is written on screens and in LaTeX; its name stays.
    pub fn describe(&mut self, symbol: Symbol, unicode: &str, latex: &str, rank: Rank) {
        let info = &mut self.symbols[symbol.index()];
        unicode.clone_into(&mut info.unicode);
        latex.clone_into(&mut info.latex);
        info.rank = rank;
    }

    /// How many symbols the pool knows.
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

    /// The circle constant.
    pub fn pi(&mut self) -> Expr {
        self.intern(Node::Pi)
    }

    /// Every node an expression is made of, itself included, parts before wholes.
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

    /// How many different nodes an expression is made of.
    pub fn count(&self, e: Expr) -> usize {
        self.reachable(&[e]).len()
    }

    /// The symbols an expression is made of, in order of their introduction.
    pub fn symbols_of(&self, e: Expr) -> Vec<Symbol> {
        let mut symbols: Vec<Symbol> =
            self.reachable(&[e]).into_iter().filter_map(|e| self.as_symbol(e)).collect();
        symbols.sort_unstable();
        symbols
    }

    /// Whether a symbol occurs in an expression.
    pub fn depends(&self, e: Expr, symbol: Symbol) -> bool {
        self.reachable(&[e]).into_iter().any(|e| self.as_symbol(e) == Some(symbol))
    }

    /// Whether any of the symbols occurs in an expression.
    pub fn depends_on_any(&self, e: Expr, symbols: &[Symbol]) -> bool {
        self.reachable(&[e])
            .into_iter()
            .any(|e| self.as_symbol(e).is_some_and(|s| symbols.contains(&s)))
    }

    /// Stores a canonical node, or finds it. Only the constructors call this.
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
