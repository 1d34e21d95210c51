//! Where a function of the state vanishes: on a surface, which almost every line meets, or on less.
//!
//! In: an expression. Out: whether it passes or touches zero on a surface. A root of what touches zero has a kink there,
//! as √(x²) = |x| has; √(x² + y²) has none, but for a point. Never here: kinks of functions, which have names.

use std::convert::Infallible;

use super::evaluate::Repeated;
use super::node::Expr;
use super::pool::Pool;
use super::sample::sample;
use super::symbol::Symbol;
use crate::num::{golden_section, math};

/// The lines along which a function is followed.
const LINES: u64 = 4;

/// Places on a line: sinh(u) for |u| up to 9 in steps of this, so that they reach some 4000 units to both sides.
const SPACING: f64 = 0.03;
const PLACES: u32 = 300;

/// The ratio of a least value to the values beside it below which it is zero. The place of a least value is found to half
/// the digits, which leaves 1e-13 of a square; a line that passes a point at a tenth of `SPACING` leaves 1e-2.
const ZERO: f64 = 1e-10;

/// Golden sections between three places for the least value.
const SECTIONS: u32 = 60;

impl Pool {
    /// Whether a function of the `moving` symbols is zero on a surface on both sides of which it is positive.
    pub fn touches_zero(&self, e: Expr, moving: &[Symbol]) -> bool {
        self.some_line(e, moving, &touches)
    }

    /// Whether a function of the `moving` symbols is zero on a surface.
    pub fn vanishes(&self, e: Expr, moving: &[Symbol]) -> bool {
        let magnitude = |at: &dyn Fn(f64) -> f64| passes(at) || touches(&|x| at(x).abs());
        self.some_line(e, moving, &magnitude)
    }

    fn some_line(
        &self,
        e: Expr,
        moving: &[Symbol],
        holds: &dyn Fn(&dyn Fn(f64) -> f64) -> bool,
    ) -> bool {
        if !self.depends_on_any(e, moving) {
            return false;
        }
        let function = Repeated::of(self, e);
        (0..LINES).any(|line| {
            holds(&|place| {
                function.at(&|symbol| {
                    let begin = sample(symbol, 2 * line);
                    // what does not move has one value on the line
                    if moving.contains(&symbol) {
                        begin + place * (sample(symbol, 2 * line + 1) - 1.1)
                    } else {
                        begin
                    }
                })
            })
        })
    }
}

/// Whether something holds on a line on which the `moving` symbols move, each at its own rate, while the others have the
/// values `at`. It is given the symbols' values by the place on the line, and places from end to end.
pub(super) fn on_lines(
    moving: &[Symbol],
    at: &dyn Fn(Symbol) -> f64,
    holds: &mut dyn FnMut(&dyn Fn(Symbol, f64) -> f64, &[f64]) -> bool,
) -> bool {
    let places: Vec<f64> = (0..=2 * PLACES).map(place).collect();
    (0..LINES).any(|line| {
        let along = |symbol: Symbol, place: f64| {
            if moving.contains(&symbol) {
                sample(symbol, 2 * line) + place * (sample(symbol, 2 * line + 1) - 1.1)
            } else {
                at(symbol)
            }
        };
        holds(&along, &places)
    })
}

fn place(k: u32) -> f64 {
    math::sinh(SPACING * (f64::from(k) - f64::from(PLACES)))
}

/// Whether a function of one number changes its sign.
fn passes(at: &dyn Fn(f64) -> f64) -> bool {
    let values: Vec<f64> = (0..=2 * PLACES).map(|k| at(place(k))).collect();
    values.windows(2).any(|pair| pair[0] * pair[1] < 0.0)
}

/// Whether a function of one number touches zero from above.
fn touches(at: &dyn Fn(f64) -> f64) -> bool {
    let values: Vec<f64> = (0..=2 * PLACES).map(|k| at(place(k))).collect();
    (1..2 * PLACES).any(|k| {
        let [before, here, after] = [k - 1, k, k + 1].map(|k| values[k as usize]);
        here <= before
            && here <= after
            && least(at, place(k - 1), place(k + 1)).abs() <= ZERO * before.min(after)
    })
}

/// The least value of a function between two places.
fn least(at: &dyn Fn(f64) -> f64, left: f64, right: f64) -> f64 {
    let value = |x| Ok::<_, Infallible>(at(x));
    let Ok([left, right]) = golden_section([left, right], SECTIONS, value);
    at(f64::midpoint(left, right))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_expression_evaluated_many_times_has_the_same_values_each_time() {
        let mut pool = Pool::new();
        let [x, y] = ["x", "y"].map(|name| pool.symbol(name));
        let [a, b] = [x, y].map(|symbol| pool.variable(symbol));
        let product = pool.mul(a, b);
        let sum = pool.add(product, a);
        let e = pool.call(crate::expr::FunctionId::Sin, &[sum]);
        let repeated = Repeated::of(&pool, e);
        for k in 0..5 {
            let at = |symbol| if symbol == x { f64::from(k) } else { 0.5 - f64::from(k) };
            assert_eq!(repeated.at(&at).to_bits(), pool.evaluate(e, &at).to_bits());
        }
    }

    #[test]
    fn squares_touch_zero_and_what_passes_or_stays_above_does_not() {
        assert!(touches(&|x| x * x));
        assert!(touches(&|x| (x - 30.0) * (x - 30.0)));
        assert!(touches(&|x| x * x - 60.0 * x + 900.0));
        assert!(touches(&|x| 1.0 - math::cos(x)));
        assert!(!touches(&|x| x * x * x));
        assert!(!touches(&|x| 1.0 + x * x));
        assert!(!touches(&|x| x * x - 1.0));
        // close to a point, from either side of what counts
        assert!(!touches(&|x| x * x + 3e-10 * SPACING * SPACING));
        assert!(touches(&|x| x * x + 3e-11 * SPACING * SPACING));
    }
}
