//! A state at rest: the velocities, or the momenta, with which nothing moves.
//!
//! In: the law, coordinates. Out: momenta with q̇ = 0. Never here: which coordinates.

use nalgebra::{DMatrix, DVector};

use super::descent::Descent;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Flow};

/// The step that is left, relative to the momenta and to the first step.
const ENOUGH: f64 = 1e-12;

/// What makes a state one at rest.
#[derive(Clone, Debug)]
pub(super) enum Rest {
    /// Velocities that are zero.
    Velocities,
    /// Momenta in closed form, with the pool in which they are written.
    Momenta(Box<Pool>, Vec<Expr>),
    /// Momenta to be searched for: those at which ∂H/∂p vanishes.
    Search(Box<MomentaSearch>),
}

/// The search for the momenta at which the velocities vanish.
#[derive(Clone, Debug)]
pub(super) struct MomentaSearch {
    velocities: Descent,
    count: usize,
}

impl Rest {
    /// Of a law; `None` where it has neither velocities nor momenta.
    pub(super) fn of(equations: &Equations) -> Option<Self> {
        match &equations.flow {
            Flow::Lagrange { .. } => Some(Self::Velocities),
            Flow::Hamilton { velocities, .. } => {
                let mut own = Equations::clone(equations);
                if let Some(momenta) = own.momenta_at_rest() {
                    return Some(Self::Momenta(Box::new(own.pool), momenta));
                }
                let momenta: Vec<Symbol> =
                    equations.coordinates.iter().map(|c| c.momentum).collect();
                let search = MomentaSearch::new(own.pool, momenta, velocities.clone());
                Some(Self::Search(Box::new(search)))
            }
            Flow::Poisson { .. } => None,
        }
    }

    /// The momenta at rest where everything else has these values: none where velocities are zero; `None` where none are found.
    pub(super) fn momenta(&self, known: &dyn Fn(Symbol) -> f64) -> Option<Vec<f64>> {
        let found = match self {
            Self::Velocities => Vec::new(),
            Self::Momenta(pool, momenta) => {
                momenta.iter().map(|e| pool.evaluate(*e, known)).collect()
            }
            Self::Search(search) => search.find(known)?,
        };
        found.iter().all(|p| p.is_finite()).then_some(found)
    }
}

impl MomentaSearch {
    fn new(pool: Pool, momenta: Vec<Symbol>, velocities: Vec<Expr>) -> Self {
        let count = momenta.len();
        Self { velocities: Descent::new(pool, momenta, velocities), count }
    }

    /// The momenta at rest, searched for from zero; `None` where there are none whose digits are known.
    fn find(&self, known: &dyn Fn(Symbol) -> f64) -> Option<Vec<f64>> {
        let Self { velocities, count } = self;
        let none = DVector::zeros(*count);
        let newton = |slopes: DMatrix<f64>, left: &DVector<f64>| slopes.lu().solve(left);
        let momenta = velocities.nearest(none.clone(), &none, known, &newton);
        let step = |at: &DVector<f64>| {
            let left = velocities.left(at, &none, known);
            let is_there = left.iter().all(|v| *v == 0.0);
            if is_there {
                Some(none.clone())
            } else {
                newton(velocities.jacobian(at, known), &left)
            }
        };
        let (first, last) = (step(&none)?, step(&momenta)?);
        let is_at_rest = last.norm() <= ENOUGH * (momenta.norm() + first.norm());
        is_at_rest.then(|| momenta.data.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H = c √((p − a)² + m²c²) of a charge in a vector potential, from p = 0 with |a| far beyond m c, where a whole step of Newton's
    /// leads away: at rest p = a.
    #[test]
    fn a_fast_charge_is_at_rest_where_its_momentum_is_that_of_the_field() {
        let mut pool = Pool::new();
        let [p, a] = ["p", "a"].map(|name| pool.symbol(name));
        let [momentum, field] = [p, a].map(|symbol| pool.variable(symbol));
        let kinetic = pool.sub(momentum, field);
        let square = pool.powi(kinetic, 2);
        let below = pool.add(square, Expr::ONE);
        let root = pool.sqrt(below);
        let velocity = pool.div(kinetic, root);
        let search = MomentaSearch::new(pool, vec![p], vec![velocity]);
        for there in [0.0, 0.5, -3.0, 40.0] {
            let found = search.find(&|_| there).expect("a momentum");
            assert!((found[0] - there).abs() <= 1e-12 * (1.0 + there.abs()), "{found:?} {there}");
        }
    }

    /// q̇ = 1 + p² vanishes nowhere.
    #[test]
    fn what_never_rests_has_no_momenta_at_rest() {
        let mut pool = Pool::new();
        let p = pool.symbol("p");
        let momentum = pool.variable(p);
        let square = pool.powi(momentum, 2);
        let velocity = pool.add(square, Expr::ONE);
        assert_eq!(MomentaSearch::new(pool, vec![p], vec![velocity]).find(&|_| 0.0), None);
    }
}
