//! A condition on the motion, kept by a force of its own.

use super::SourceRange;
use crate::expr::{Expr, Pool, Rank, Symbol};

/// expression = 0, kept by λ times its gradient.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// As written in the file: `no slip`.
    pub name: String,
    /// What is to vanish: f(q, t) where it is holonomic, else Σ A_α(q, t) q̇_α + A(q, t).
    pub expression: Expr,
    /// λ, written [`multiplier_name`]; stands in observables only.
    pub multiplier: Symbol,
    /// The unit of λ, empty where none is given.
    pub unit: String,
    /// What λ is, in words; empty where the file does not say.
    pub about: String,
    /// Where the expression stands in the file.
    pub place: SourceRange,
}

/// How the multiplier of a constraint is written: `lambda_no_slip`.
pub fn multiplier_name(constraint: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    format!("lambda_{}", constraint.chars().map(letter).collect::<String>())
}

/// A name as words of LaTeX.
fn in_words(name: &str) -> String {
    let plain = |c: char| if "\\{}$&#^_%~".contains(c) { ' ' } else { c };
    format!("\\text{{{}}}", name.chars().map(plain).collect::<String>())
}

impl Constraint {
    /// A constraint; introduces its multiplier into the pool. `only` says that there is no other,
    /// so that a bare λ tells enough.
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
