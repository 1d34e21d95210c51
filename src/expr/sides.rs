//! On which sides of its kinks an expression vanishes, and whether it is more than that on others.
//!
//! In: an expression, and the sides of some kinks. Out: proofs that it vanishes there, and values beyond rounding that it
//! has elsewhere. Never here: where a motion goes.

use super::function::KinkBranches;
use super::node::{Expr, Node};
use super::pool::Pool;
use super::symbol::Symbol;
use super::vanishing::on_lines;
use super::zero_test::Zero;
use crate::num::Number;

/// A kink: the function that changes its sign there.
type Switch = Expr;

/// Distances from a kink at which values are taken, relative to its place on a line.
const BESIDE: [f64; 4] = [1e-12, 1e-9, 1e-6, 1e-3];

/// A jump below this part of the size of what jumps is rounding.
const SEEN: f64 = 1e-9;

impl Pool {
    /// The functions whose changes of sign are the kinks of an expression, those of outer functions before those of what they
    /// are made of. The expression is returned with its roots of even powers as absolute values.
    pub fn switches(&mut self, e: Expr) -> (Expr, Vec<Switch>) {
        let opened = self.open_roots(e);
        let mut parts = self.reachable(&[opened]);
        parts.reverse();
        let mut switches = Vec::new();
        for part in parts {
            if let Some((switch, _)) = self.switch_of(part)
                && !switches.contains(&switch)
            {
                switches.push(switch);
            }
        }
        (opened, switches)
    }

    /// Whether an expression is proved to vanish on these sides of these kinks, where the second of a pair is whether the
    /// first is positive; outer ones come first.
    pub fn vanishes_on_sides(&mut self, e: Expr, sides: &[(Switch, bool)]) -> bool {
        let side = self.on_sides(e, sides);
        let form = self.normal_form(side);
        !self.is_full() && form == Expr::ZERO
    }

    fn on_sides(&mut self, e: Expr, sides: &[(Switch, bool)]) -> Expr {
        sides.iter().fold(e, |e, &(switch, positive)| self.on_side(e, switch, positive))
    }

    /// Whether an expression has a value beyond rounding on a line on which the `moving` symbols move, among others beside
    /// its kinks; `true` is a proof. The other symbols have the values `at`.
    pub fn has_value_beyond_kinks(
        &self,
        e: Expr,
        switches: &[Switch],
        moving: &[Symbol],
        at: &dyn Fn(Symbol) -> f64,
    ) -> bool {
        self.some_place(moving, at, switches, &|here| self.refutes(e, here))
    }

    /// Whether an expression jumps where a switch changes its sign.
    pub fn jumps_at(
        &mut self,
        e: Expr,
        switch: Switch,
        moving: &[Symbol],
        at: &dyn Fn(Symbol) -> f64,
    ) -> bool {
        let [above, below] = [true, false].map(|positive| self.on_side(e, switch, positive));
        self.some_crossing(moving, at, switch, &|here| {
            let [(a, size_of_a), (b, size_of_b)] =
                [above, below].map(|side| self.evaluate_with_size(side, here));
            is_jump(a - b, size_of_a + size_of_b)
        })
    }

    /// The two sides of a product that is 0/0 on one side of a kink, as (1 + sign u)/√max(0, u) where u < 0: there it is the
    /// zero of its numerator.
    pub fn one_sided_quotient(&mut self, e: Expr) -> Option<KinkBranches> {
        let shared = self.shared(e);
        let Node::Product(_, factors) = &*shared else { return None };
        let divisor = |&(base, exponent): &(Expr, Number)| match *self.node(base) {
            // the exponent is a parameter, or made of some
            Node::Power(base, _) => Some(base),
            _ => exponent.is_negative().then_some(base),
        };
        let divisors: Vec<Expr> = factors.iter().filter_map(divisor).collect();
        for divisor in divisors {
            let Some((switch, _)) = self.switch_of(divisor) else { continue };
            for positive in [true, false] {
                let mut vanishes = |e: Expr| self.on_side(e, switch, positive) == Expr::ZERO;
                let above = |&&(base, exponent): &&(Expr, Number)| {
                    base != divisor && !exponent.is_negative()
                };
                if !vanishes(divisor) || !factors.iter().filter(above).any(|f| vanishes(f.0)) {
                    continue;
                }
                let other = self.on_side(e, switch, !positive);
                let (positive, negative) =
                    if positive { (Expr::ZERO, other) } else { (other, Expr::ZERO) };
                return Some(KinkBranches { switch, positive, negative });
            }
        }
        None
    }

    /// By how much an expression jumps at the cut of an angle, atan2(y, x), which is π on one side and −π on the other.
    pub fn jump_of_angle(&mut self, e: Expr, angle: Expr) -> Expr {
        let pi = self.pi();
        let opposite = self.neg(pi);
        let [above, below] = [pi, opposite].map(|value| self.replace(e, angle, value));
        self.sub(above, below)
    }

    /// Whether an expression is the same one turn on, so that nothing in it shows the cut of an angle, as cos(3 atan2(y, x)).
    pub fn has_whole_turns(&mut self, e: Expr, angle: Expr) -> bool {
        let (pi, turn) = (self.pi(), Number::integer(2));
        let turned = self.linear(Number::ZERO, &[(Number::ONE, angle), (turn, pi)]);
        let turned = self.replace(e, angle, turned);
        let change = self.sub(turned, e);
        matches!(self.is_zero(change), Zero::Proved | Zero::Numerically)
    }

    fn some_place(
        &self,
        moving: &[Symbol],
        at: &dyn Fn(Symbol) -> f64,
        switches: &[Switch],
        holds: &dyn Fn(&dyn Fn(Symbol) -> f64) -> bool,
    ) -> bool {
        on_lines(moving, at, &mut |line, places| {
            let there = |place: f64| holds(&|symbol| line(symbol, place));
            places.iter().any(|&place| there(place))
                || switches.iter().any(|&switch| {
                    let value = |place: f64| self.evaluate(switch, &|symbol| line(symbol, place));
                    crossings(&value, places).into_iter().any(|place| {
                        let mut beside = BESIDE.iter().flat_map(|by| [1.0 - by, 1.0 + by]);
                        beside.any(|factor| there(place * factor))
                    })
                })
        })
    }

    fn some_crossing(
        &self,
        moving: &[Symbol],
        at: &dyn Fn(Symbol) -> f64,
        switch: Switch,
        holds: &dyn Fn(&dyn Fn(Symbol) -> f64) -> bool,
    ) -> bool {
        on_lines(moving, at, &mut |line, places| {
            let value = |place: f64| self.evaluate(switch, &|symbol| line(symbol, place));
            let mut crossings = crossings(&value, places).into_iter();
            crossings.any(|place| holds(&|symbol| line(symbol, place)))
        })
    }
}

/// Whether a difference of what has terms of this size is more than rounding.
fn is_jump(by: f64, size: f64) -> bool {
    by.abs() > SEEN * size
}

/// Where a function changes its sign, to the last digit.
fn crossings(value: &dyn Fn(f64) -> f64, places: &[f64]) -> Vec<f64> {
    let values: Vec<f64> = places.iter().map(|&place| value(place)).collect();
    let pairs = places.windows(2).zip(values.windows(2));
    let changed = pairs.filter(|(_, values)| values[0] * values[1] < 0.0);
    let located = changed.map(|(ends, values)| {
        let (mut left, mut right) = (ends[0], ends[1]);
        for _ in 0..80 {
            let middle = f64::midpoint(left, right);
            if value(middle) * values[0] > 0.0 { left = middle } else { right = middle }
        }
        f64::midpoint(left, right)
    });
    located.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_is_seen_beyond_a_billionth_of_the_terms() {
        assert!(is_jump(-2.1e-9, 2.0) && !is_jump(-1.9e-9, 2.0));
    }
}
