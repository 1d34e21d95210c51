//! A condition on the motion, enforced by a force of constraint.

use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Pool, Rank, Symbol};

/// The condition expression = 0, enforced by λ times its gradient.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// As written in the file: `no slip`.
    pub name: String,
    /// The expression that has to vanish: f(q, t) if the constraint is holonomic, else Σ A_α(q, t)
    /// q̇_α + A(q, t).
    pub expression: Expr,
    /// λ, written [`multiplier_name`]; it may be used in observables only.
    pub multiplier: Symbol,
    /// The unit of λ, empty if none is given.
    pub unit: String,
    /// The meaning of λ, in words; empty if the file does not give one.
    pub about: String,
    /// The place of the expression in the file.
    pub place: SourceRange,
}

/// The name of a constraint's multiplier: `lambda_no_slip`.
pub fn multiplier_name(constraint: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    format!("lambda_{}", constraint.chars().map(letter).collect::<String>())
}

/// A name as LaTeX text.
fn in_words(name: &str) -> String {
    let plain = |c: char| if "\\{}$&#^_%~".contains(c) { ' ' } else { c };
    format!("\\text{{{}}}", name.chars().map(plain).collect::<String>())
}

impl Constraint {
    /// Creates a constraint and introduces its multiplier into the pool. If it is the `only`
    /// constraint, a bare λ is unambiguous.
    pub fn new(pool: &mut Pool, name: &str, expression: Expr, only: bool) -> Constraint {
        let multiplier = pool.symbol(&multiplier_name(name));
        let shown = if only { "λ".to_owned() } else { format!("λ_{name}") };
        let latex =
            if only { "\\lambda".to_owned() } else { format!("\\lambda_{{{}}}", in_words(name)) };
        pool.describe(multiplier, &shown, &latex, Rank::Momentum);
        Constraint {
            name: name.to_owned(),
            expression,
            multiplier,
            unit: String::new(),
            about: String::new(),
            place: 0..0,
        }
    }
}
