//! The search for the coordinates with which a mass is at a place, or as near to it as it can be.
//!
//! In: the place of the mass in terms of coordinates, a place. Out: coordinates. Never here: which coordinates may be moved.

use nalgebra::{DMatrix, DVector};

use super::descent::Descent;
use crate::expr::{Expr, Pool, Symbol};

/// The damping, relative to the squares of the slopes: where a place cannot be reached the nearest one is found.
const DAMPING: f64 = 1e-8;

/// The search for the coordinates of a mass.
#[derive(Clone, Debug)]
pub(super) struct MassSearch(Descent);

impl MassSearch {
    pub(super) fn new(pool: Pool, mass: [Expr; 2], symbols: Vec<Symbol>) -> Self {
        Self(Descent::new(pool, symbols, mass.to_vec()))
    }

    /// The coordinates that bring the mass nearest to a place, by damped Gauss-Newton steps from these.
    pub(super) fn nearest(
        &self,
        at: [f64; 2],
        values: Vec<f64>,
        known: &dyn Fn(Symbol) -> f64,
    ) -> Option<Vec<f64>> {
        let target = DVector::from_row_slice(&at);
        let found = self.0.nearest(DVector::from_vec(values), &target, known, &gauss_newton);
        let left = self.0.left(&found, &target, known);
        let is_finite = found.iter().chain(left.iter()).all(|value| value.is_finite());
        is_finite.then(|| found.data.into())
    }
}

/// The least step that leads to the place, damped where it does not change with the coordinates.
fn gauss_newton(slopes: DMatrix<f64>, left: &DVector<f64>) -> Option<DVector<f64>> {
    let across = slopes.transpose();
    let squares = slopes * &across;
    let damping = DAMPING * squares.trace() * DMatrix::identity(left.len(), left.len());
    Some(across * (squares + damping).lu().solve(left)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bead on the parabola y = x²/a: with all lengths 2⁻⁵⁰ times as long the same place is found, to the last bit.
    #[test]
    fn the_search_does_not_depend_on_the_unit_of_length() {
        let found = |unit: f64| {
            let mut pool = Pool::new();
            let symbols = [pool.symbol("x"), pool.symbol("a")];
            let [x, size] = symbols.map(|symbol| pool.variable(symbol));
            let square = pool.mul(x, x);
            let height = pool.div(square, size);
            let search = MassSearch::new(pool, [x, height], vec![symbols[0]]);
            let at = [0.9 * unit, 1.7 * unit];
            search.nearest(at, vec![0.2 * unit], &|_| unit).expect("a place")[0] / unit
        };
        let one = found(1.0);
        // the foot of the perpendicular: (x − 0.9) + 2 x (x² − 1.7) = 0
        assert!((one - 0.9 + 2.0 * one * (one * one - 1.7)).abs() < 1e-7, "{one}");
        let small = crate::num::math::powi(2.0, -50);
        assert_eq!(found(small), one);
    }
}
