//! The functions that an expression may call: one row and one file each, which holds the value, the
//! derivative and the Taylor rule. To add a function, write its file and add a line to
//! [`FUNCTIONS`] and to [`FunctionId`] (`node`); the parser, printers, derivatives and integrators use the
//! row.

mod abs;
mod acos;
mod asin;
mod atan;
mod atan2;
mod cos;
mod cosh;
mod cot;
mod exp;
mod ln;
mod max;
mod min;
mod recurrence;
mod sign;
mod sin;
mod sinh;
mod sqrt;
mod tan;
mod tanh;

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use crate::num::{Analytic, Number};
pub use recurrence::{BilinearEquation, Convolution, Divisor, Recurrence, SeriesOperand};

/// The functions, in the order of [`FunctionId`].
pub const FUNCTIONS: [Function; 18] = [
    sin::FUNCTION,
    cos::FUNCTION,
    tan::FUNCTION,
    cot::FUNCTION,
    asin::FUNCTION,
    acos::FUNCTION,
    atan::FUNCTION,
    atan2::FUNCTION,
    sinh::FUNCTION,
    cosh::FUNCTION,
    tanh::FUNCTION,
    exp::FUNCTION,
    ln::FUNCTION,
    sqrt::FUNCTION,
    abs::FUNCTION,
    sign::FUNCTION,
    min::FUNCTION,
    max::FUNCTION,
];

/// One function: its notation, its value and its derivative.
pub struct Function {
    /// Its identifier.
    pub id: FunctionId,
    /// Its name in a file.
    pub name: &'static str,
    /// Its Unicode notation.
    pub unicode: &'static str,
    /// Its LaTeX notation.
    pub latex: &'static str,
    /// The number of arguments, 1 or 2.
    pub arity: usize,
    /// In `f64`, at as many arguments as the function has.
    pub value: fn(&[f64]) -> f64,
    /// A simpler canonical form of the call, if there is one, by special values and parity.
    pub fold: fn(&mut Pool, &[Expr]) -> Option<Expr>,
    /// The partial derivative with respect to an argument, as an expression.
    pub derivative: fn(&mut Pool, &[Expr], usize) -> Expr,
    /// How a Taylor series is propagated through it.
    pub rule: Rule,
}

/// How a power series in time is propagated through a function.
pub enum Rule {
    /// A recurrence for the normalised coefficients.
    Series(Recurrence),
    /// Two smooth branches on the two sides of a switching surface, which an integrator locates.
    Branch(fn(&mut Pool, &[Expr]) -> KinkBranches),
    /// A numeric power. The call is rewritten as one and never occurs in a canonical expression.
    Power,
}

/// A function with a kink: equal to `positive` where `switch > 0`, to `negative` where
/// `switch < 0`, and to their mean on the surface between.
#[derive(Clone, Copy, Debug)]
pub struct KinkBranches {
    /// The expression that changes sign at the kink.
    pub switch: Expr,
    /// The function where `switch > 0`.
    pub positive: Expr,
    /// The function where `switch < 0`.
    pub negative: Expr,
}

impl FunctionId {
    /// The row of the function.
    pub fn row(self) -> &'static Function {
        static ROWS: [Function; 18] = FUNCTIONS;
        &ROWS[self as usize]
    }

    /// The value of the function and that of its companion in its Taylor recurrence (cos for sin,
    /// 1 + u² for atan, …), which is zero where it has none. A function of one argument ignores the
    /// second.
    pub fn with_companion<R: Analytic>(self, u: [R; 2]) -> (R, R) {
        match self {
            FunctionId::Sin => sin::with_companion(u),
            FunctionId::Cos => cos::with_companion(u),
            FunctionId::Tan => tan::with_companion(u),
            FunctionId::Cot => cot::with_companion(u),
            FunctionId::Asin => asin::with_companion(u),
            FunctionId::Acos => acos::with_companion(u),
            FunctionId::Atan => atan::with_companion(u),
            FunctionId::Atan2 => atan2::with_companion(u),
            FunctionId::Sinh => sinh::with_companion(u),
            FunctionId::Cosh => cosh::with_companion(u),
            FunctionId::Tanh => tanh::with_companion(u),
            FunctionId::Exp => exp::with_companion(u),
            FunctionId::Ln => ln::with_companion(u),
            FunctionId::Sqrt => (u[0].sqrt(), R::ZERO),
            FunctionId::Abs => (u[0].where_positive(u[0], -u[0]), R::ZERO),
            FunctionId::Sign => {
                let not_positive = (-u[0]).where_positive(-R::ONE, R::ZERO);
                (u[0].where_positive(R::ONE, not_positive), R::ZERO)
            }
            FunctionId::Max => ((u[0] - u[1]).where_positive(u[0], u[1]), R::ZERO),
            FunctionId::Min => ((u[0] - u[1]).where_positive(u[1], u[0]), R::ZERO),
        }
    }

    /// The function with this name.
    pub fn by_name(name: &str) -> Option<FunctionId> {
        FUNCTIONS.iter().find(|row| row.name == name).map(|row| row.id)
    }
}

impl Pool {
    /// Applies a function to its arguments, whose number must equal its arity.
    pub fn call(&mut self, function: FunctionId, arguments: &[Expr]) -> Expr {
        debug_assert_eq!(arguments.len(), function.row().arity, "arity is checked by the parser");
        match (function.row().fold)(self, arguments) {
            Some(simpler) => simpler,
            None => self.intern(Node::Call(function, arguments.into())),
        }
    }

    /// Returns whether an expression is written with a leading minus: `−x`, `−2x + y`.
    fn leads_negative(&self, e: Expr) -> bool {
        match self.node(e) {
            Node::Number(n) => n.is_negative(),
            Node::Product(c, _) => c.is_negative(),
            Node::Sum(_, terms) => terms[0].0.is_negative(),
            _ => false,
        }
    }

    /// `f(−u) = −f(u)`.
    fn fold_odd(&mut self, function: FunctionId, u: Expr) -> Option<Expr> {
        if u == Expr::ZERO {
            return Some(Expr::ZERO);
        }
        self.leads_negative(u).then(|| {
            let positive = self.neg(u);
            let call = self.call(function, &[positive]);
            self.neg(call)
        })
    }

    /// `f(−u) = f(u)`.
    fn fold_even(&mut self, function: FunctionId, u: Expr) -> Option<Expr> {
        self.leads_negative(u).then(|| {
            let positive = self.neg(u);
            self.call(function, &[positive])
        })
    }

    /// The rational `r` with `e = r π`, if there is one.
    fn turns(&self, e: Expr) -> Option<Number> {
        match self.node(e) {
            Node::Number(n) if n.is_zero() => Some(Number::ZERO),
            Node::Pi => Some(Number::ONE),
            Node::Product(c, factors) => match **factors {
                [(base, n)] if n.is_one() && *self.node(base) == Node::Pi => Some(*c),
                _ => None,
            },
            _ => None,
        }
    }
}

/// The sine of `r π`, if it is rational.
fn exact_sine(r: Number) -> Option<Number> {
    let Number::Rational(n, d) = r else { return None };
    if 6 % d != 0 {
        return None;
    }
    match (n.rem_euclid(2 * d)) * (6 / d) {
        0 | 6 => Some(Number::ZERO),
        1 | 5 => Some(Number::HALF),
        3 => Some(Number::ONE),
        7 | 11 => Some(-Number::HALF),
        9 => Some(Number::MINUS_ONE),
        _ => None,
    }
}
