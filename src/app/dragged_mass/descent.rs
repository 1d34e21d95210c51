//! The search for values at which expressions are what they shall be, or as near to it as they can be: steps of Newton's method,
//! each halved until it leads nearer.
//!
//! In: expressions and their unknowns, the way to a step. Out: values. Never here: what they mean.

use nalgebra::{DMatrix, DVector};

use crate::expr::{Expr, Pool, Symbol};

/// The most steps, and the most halvings of each.
const STEPS: usize = 60;
const HALVINGS: u32 = 30;

/// Expressions, the symbols that are searched for, and the derivatives by these.
#[derive(Clone, Debug)]
pub(super) struct Descent {
    pool: Pool,
    unknowns: Vec<Symbol>,
    expressions: Vec<Expr>,
    slopes: Vec<Vec<Expr>>,
}

impl Descent {
    pub(super) fn new(mut pool: Pool, unknowns: Vec<Symbol>, expressions: Vec<Expr>) -> Self {
        let row = |e: &Expr| unknowns.iter().map(|symbol| pool.derivative(*e, *symbol)).collect();
        let slopes = expressions.iter().map(row).collect();
        Self { pool, unknowns, expressions, slopes }
    }

    fn value(&self, e: Expr, at: &DVector<f64>, known: &dyn Fn(Symbol) -> f64) -> f64 {
        let own = |symbol| self.unknowns.iter().position(|other| *other == symbol);
        self.pool.evaluate(e, &|symbol| own(symbol).map_or_else(|| known(symbol), |i| at[i]))
    }

    /// What is left to the values that the expressions shall have.
    pub(super) fn left(
        &self,
        at: &DVector<f64>,
        target: &DVector<f64>,
        known: &dyn Fn(Symbol) -> f64,
    ) -> DVector<f64> {
        DVector::from_fn(target.len(), |i, _| {
            target[i] - self.value(self.expressions[i], at, known)
        })
    }

    /// The derivatives of the expressions, a row for each.
    pub(super) fn jacobian(
        &self,
        at: &DVector<f64>,
        known: &dyn Fn(Symbol) -> f64,
    ) -> DMatrix<f64> {
        let entry = |i: usize, k: usize| self.value(self.slopes[i][k], at, known);
        DMatrix::from_fn(self.expressions.len(), self.unknowns.len(), entry)
    }

    /// The values from which no step leads nearer. A step follows from the derivatives and what is left.
    pub(super) fn nearest(
        &self,
        mut at: DVector<f64>,
        target: &DVector<f64>,
        known: &dyn Fn(Symbol) -> f64,
        step: &dyn Fn(DMatrix<f64>, &DVector<f64>) -> Option<DVector<f64>>,
    ) -> DVector<f64> {
        let mut left = self.left(&at, target, known);
        for _ in 0..STEPS {
            let Some(step) = step(self.jacobian(&at, known), &left) else { break };
            let parts = (0..HALVINGS).map(|halved| 1.0 / f64::from(1_u32 << halved));
            let tried = parts.map(|part| &at + part * &step);
            let nearer = tried
                .map(|next| (self.left(&next, target, known), next))
                .find(|(then, _)| then.norm() < left.norm());
            let Some(next) = nearer else { break };
            (left, at) = next;
        }
        at
    }
}
