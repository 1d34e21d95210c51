//! A node of an expression, and the handle by which it is known.
//!
//! In: parts. Out: nodes. Never here: where they are stored.

use super::symbol::Symbol;
use crate::num::Number;

/// A handle to an expression of one [`Pool`](super::Pool). Equal handles mean equal canonical expressions.
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

/// A function, identified by the index of its row in [`FUNCTIONS`](super::FUNCTIONS).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
#[expect(missing_docs, reason = "each variant is the function of that name; its row describes it")]
#[repr(u8)]
pub enum FunctionId {
    Sin,
    Cos,
    Tan,
    Cot,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
    Min,
    Max,
}

/// One canonical node.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// A constant, exact where it can be.
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

    /// The same node of other parts, which are not put in order.
    pub(super) fn with_parts(&self, of: impl Fn(Expr) -> Expr) -> Node {
        match self {
            Node::Sum(constant, terms) => {
                Node::Sum(*constant, terms.iter().map(|&(c, e)| (c, of(e))).collect())
            }
            Node::Product(c, factors) => {
                Node::Product(*c, factors.iter().map(|&(e, n)| (of(e), n)).collect())
            }
            Node::Power(base, exponent) => Node::Power(of(*base), of(*exponent)),
            Node::Call(function, arguments) => {
                Node::Call(*function, arguments.iter().map(|&e| of(e)).collect())
            }
            plain @ (Node::Number(_) | Node::Pi | Node::Symbol(_)) => plain.clone(),
        }
    }

    /// Calls `f` with every part of this node.
    pub fn for_each_part(&self, mut f: impl FnMut(Expr)) {
        match self {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => {}
            Node::Sum(_, terms) => terms.iter().for_each(|&(_, e)| f(e)),
            Node::Product(_, factors) => factors.iter().for_each(|&(e, _)| f(e)),
            Node::Power(base, exponent) => [*base, *exponent].into_iter().for_each(f),
            Node::Call(_, arguments) => arguments.iter().for_each(|&e| f(e)),
        }
    }
}
