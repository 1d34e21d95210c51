//! The search for the coordinates with which a mass is at a place, or as near to it as it can be.
//!
//! In: the place of the mass in terms of coordinates, a place. Out: coordinates. Never here: which coordinates may be moved.

use crate::expr::{Expr, Pool, Symbol};

/// The most steps of the search for coordinates, and the most halvings of each.
const STEPS: usize = 40;
const HALVINGS: usize = 12;

/// The damping, relative to the squares of the slopes: where a place cannot be reached the nearest one is found.
const DAMPING: f64 = 1e-8;

/// The step of the mass, relative to the way to the mouse, at which the search ends.
const ENOUGH: f64 = 1e-10;

/// The search for the coordinates of a mass.
#[derive(Clone, Debug)]
pub(super) struct MassSearch {
    pool: Pool,
    mass: [Expr; 2],
    symbols: Vec<Symbol>,
    /// The derivatives of its place by each coordinate.
    slopes: Vec<[Expr; 2]>,
}

impl MassSearch {
    pub(super) fn new(mut pool: Pool, mass: [Expr; 2], symbols: Vec<Symbol>) -> Self {
        let slopes =
            symbols.iter().map(|symbol| mass.map(|e| pool.derivative(e, *symbol))).collect();
        Self { pool, mass, symbols, slopes }
    }

    /// The coordinates that bring the mass nearest to a place, by damped Gauss-Newton steps from these.
    pub(super) fn nearest(
        &self,
        at: [f64; 2],
        mut values: Vec<f64>,
        known: &dyn Fn(Symbol) -> f64,
    ) -> Option<Vec<f64>> {
        let evaluate = |e: Expr, values: &[f64]| {
            let own = |symbol: Symbol| self.symbols.iter().position(|other| *other == symbol);
            self.pool
                .evaluate(e, &|symbol| own(symbol).map_or_else(|| known(symbol), |i| values[i]))
        };
        let off = |values: &[f64]| [0, 1].map(|k| at[k] - evaluate(self.mass[k], values));
        let length = |[x, y]: [f64; 2]| x * x + y * y;
        let way = off(&values);
        let mut left = way;
        for _ in 0..STEPS {
            let slopes: Vec<[f64; 2]> =
                self.slopes.iter().map(|slope| slope.map(|e| evaluate(e, &values))).collect();
            let sum =
                |i: usize, k: usize| slopes.iter().map(|slope| slope[i] * slope[k]).sum::<f64>();
            let damping = DAMPING * (sum(0, 0) + sum(1, 1));
            let (a, b, d) = (sum(0, 0) + damping, sum(0, 1), sum(1, 1) + damping);
            let determinant = a * d - b * b;
            let pull = [
                (d * left[0] - b * left[1]) / determinant,
                (a * left[1] - b * left[0]) / determinant,
            ];
            let step: Vec<f64> =
                slopes.iter().map(|slope| slope[0] * pull[0] + slope[1] * pull[1]).collect();
            if step.iter().any(|change| !change.is_finite()) {
                break;
            }
            let parts = (0..HALVINGS).map(|halved| 1.0 / f64::from(1_u32 << halved));
            let tried = parts.map(|part| {
                values.iter().zip(&step).map(|(value, change)| value + part * change).collect()
            });
            let nearer = |values: &Vec<f64>| length(off(values)) < length(left);
            let Some(next) = tried.into_iter().find(nearer) else { break };
            let then = off(&next);
            let is_enough =
                length([then[0] - left[0], then[1] - left[1]]) <= ENOUGH * ENOUGH * length(way);
            (left, values) = (then, next);
            if is_enough {
                break;
            }
        }
        (length(left).is_finite() && values.iter().all(|value| value.is_finite())).then_some(values)
    }
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
