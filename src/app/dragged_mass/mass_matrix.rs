//! The masses of a system, and whether they become singular between two places.
//!
//! In: the law, values of what it depends on. Out: det M, a verdict on a way. Never here: which way.

use nalgebra::DMatrix;

use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::Flow;
use crate::num::golden_section;

/// The places of the way between two coordinates at which the masses are looked at, and the golden sections by which the least is
/// found between them.
const PLACES: usize = 64;
const SECTIONS: u32 = 80;

/// A determinant of the masses is zero below this, relative to the largest on the way.
const SINGULAR: f64 = 1e-12;

/// The masses of a system: M = ∂p/∂q̇, or ∂q̇/∂p, its inverse.
#[derive(Clone, Debug)]
pub(super) struct MassMatrix {
    pool: Pool,
    entries: Vec<Vec<Expr>>,
    is_inverse: bool,
}

impl MassMatrix {
    pub(super) fn of(flow: &Flow, pool: &Pool, momenta: &[Symbol]) -> Self {
        let mut pool = pool.clone();
        let (entries, is_inverse) = match flow {
            Flow::Lagrange { mass, .. } => (mass.clone(), false),
            Flow::Hamilton { velocities, .. } => {
                let row = |v: &Expr| momenta.iter().map(|p| pool.derivative(*v, *p)).collect();
                (velocities.iter().map(row).collect(), true)
            }
            Flow::Poisson { .. } => (Vec::new(), false),
        };
        Self { pool, entries, is_inverse }
    }

    /// det M.
    pub(super) fn determinant(&self, at: &dyn Fn(Symbol) -> f64) -> f64 {
        let n = self.entries.len();
        let entry = |i: usize, k: usize| self.pool.evaluate(self.entries[i][k], at);
        let determinant = DMatrix::from_fn(n, n, entry).determinant();
        if self.is_inverse { 1.0 / determinant } else { determinant }
    }
}

/// Whether a determinant vanishes, has another sign, or is not a number between the ends 0 and 1 of a way. What is small is measured
/// against the largest on the way, so units do not matter.
pub(super) fn is_singular_on_the_way(determinant: impl Fn(f64) -> f64) -> bool {
    let share = |i: usize| i as f64 / PLACES as f64;
    let values: Vec<f64> = (0..=PLACES).map(|i| determinant(share(i))).collect();
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let is_zero =
        |value: f64| !value.is_finite() || value * values[0].signum() <= SINGULAR * largest;
    if values.iter().any(|value| is_zero(*value)) {
        return true;
    }
    let size = |i: usize| values[i].abs();
    let beside = |i: usize| [i.saturating_sub(1), (i + 1).min(PLACES)];
    let mut lows = (0..=PLACES).filter(|&i| beside(i).into_iter().all(|k| size(i) <= size(k)));
    lows.any(|i| {
        let unless_zero = |share: f64| match determinant(share) {
            value if is_zero(value) => Err(()),
            value => Ok(value.abs()),
        };
        golden_section(beside(i).map(share), SECTIONS, unless_zero).is_err()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polar coordinates: r² vanishes between r and −r, by whatever unit it is measured, and near the end of a way, too; not where r
    /// only becomes small, or where the masses change without vanishing.
    #[test]
    fn a_way_is_singular_where_the_determinant_vanishes() {
        for unit in [1e-30, 1.0, 1e30] {
            let way = |from: f64, to: f64| {
                move |share: f64| unit * (from + share * (to - from)) * (from + share * (to - from))
            };
            for (from, to) in [(0.5, -0.875), (1.0, -1e-3), (1e-3, -1.0), (-1.0, 0.7), (1.0, 0.0)] {
                assert!(is_singular_on_the_way(way(from, to)), "{unit} {from} {to}");
            }
            for (from, to) in [(0.5, 0.8), (1.0, 1e-3), (-1.0, -0.2)] {
                assert!(!is_singular_on_the_way(way(from, to)), "{unit} {from} {to}");
            }
            // a cart with a pendulum of a thousandth of its mass, or a thousand times as heavy
            for ratio in [1e-3, 1e3] {
                let masses = |share: f64| {
                    let sine = crate::num::math::sin(6.0 * share - 3.0);
                    unit * (1.0 + ratio * sine * sine)
                };
                assert!(!is_singular_on_the_way(masses), "{unit} {ratio}");
            }
            assert!(is_singular_on_the_way(|share| unit * (share - 0.3)), "{unit}");
            assert!(is_singular_on_the_way(|share| -unit * (share - 0.3)), "{unit}");
            assert!(!is_singular_on_the_way(|share| -unit * (share + 0.3)), "{unit}");
        }
        assert!(is_singular_on_the_way(|_| 0.0));
        assert!(is_singular_on_the_way(|_| f64::NAN));
    }
}
