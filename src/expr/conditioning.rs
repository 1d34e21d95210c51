//! The effect of rounding on the value of an expression: running error analysis, node by node (N.
//! J. Higham, *Accuracy and Stability of Numerical Algorithms*, SIAM 2002, § 3.3).

use rustc_hash::FxHashMap;

use super::evaluate::real_power;
use super::node::{Expr, Node};
use super::pool::Pool;
use super::symbol::Symbol;
use crate::num::Number;
use crate::num::math;

/// The error of one rounding, in units of ε times the value.
const HALF: f64 = 0.5;

/// The change of an argument by which the slope of a function is estimated: relative, but where the argument is large no more than
/// functions change little in, and no less than its error.
const NUDGE: f64 = 1e-7;
const WIDEST: f64 = 1e-4;

/// A difference of up to this many ε of the value is rounding, and one of more than this part of it is a jump.
const ROUNDED: f64 = 64.0;
const JUMP: f64 = 1e-3;

impl Pool {
    /// The value of `e`, and its error in units of ε if every input is rounded to an `f64` and
    /// every operation is done in `f64`. In a sum that cancels, the error is that of the terms; an
    /// error that a factor or a power reduces counts only in reduced form.
    pub fn evaluate_with_error(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> (f64, f64) {
        self.running_error(e, at, &|_| true, HALF)
    }

    /// The error of the value of `e` in units of ε if this input alone is rounded.
    pub fn error_by_input(&self, e: Expr, at: &dyn Fn(Symbol) -> f64, input: Symbol) -> f64 {
        self.running_error(e, at, &|symbol| symbol == input, 0.0).1
    }

    /// The value of `e` and its error if these inputs are rounded, and each operation has this error.
    fn running_error(
        &self,
        e: Expr,
        at: &dyn Fn(Symbol) -> f64,
        is_rounded: &dyn Fn(Symbol) -> bool,
        operation: f64,
    ) -> (f64, f64) {
        let mut known: FxHashMap<Expr, (f64, f64)> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let rounded = |value: f64| (value, operation * value.abs());
            let result = match self.node(part) {
                Node::Number(n) => rounded(n.value()),
                Node::Pi => rounded(std::f64::consts::PI),
                Node::Symbol(s) if is_rounded(*s) => (at(*s), HALF * at(*s).abs()),
                Node::Symbol(s) => (at(*s), 0.0),
                Node::Sum(constant, terms) => {
                    let mut total = constant.value();
                    let mut error = operation * total.abs();
                    for (c, t) in terms {
                        let (value, part) = known[t];
                        let (value, part) = (c.value() * value, (c.value() * part).abs());
                        total += value;
                        error += part + operation * value.abs();
                    }
                    (total, error)
                }
                Node::Product(c, factors) => product(c.value(), factors, &known, operation),
                Node::Power(base, exponent) => {
                    let ((b, b_error), (n, n_error)) = (known[base], known[exponent]);
                    let value = math::powf(b, n);
                    let of_base =
                        if b_error == 0.0 { 0.0 } else { (n * value / b).abs() * b_error };
                    let of_exponent =
                        if n_error == 0.0 { 0.0 } else { (math::ln(b) * value).abs() * n_error };
                    (value, operation * value.abs() + of_base + of_exponent)
                }
                Node::Call(function, arguments) => {
                    let f = function.row().value;
                    let values: Vec<f64> = arguments.iter().map(|a| known[a].0).collect();
                    let value = f(&values);
                    let mut error = operation * value.abs();
                    for (i, argument) in arguments.iter().enumerate() {
                        let (x, own) = known[argument];
                        let nudge = (NUDGE * x.abs()).min(WIDEST).max(own * f64::EPSILON);
                        if nudge > 0.0 && own > 0.0 {
                            let mut beside = values.clone();
                            let mut difference = |nudge: f64| {
                                beside[i] = x + nudge;
                                (f(&beside) - value).abs()
                            };
                            let mut slope = difference(nudge) / nudge;
                            // where x is far less than what it is the difference of, its error may change no digit
                            if nudge < NUDGE
                                && slope * nudge <= ROUNDED * f64::EPSILON * value.abs()
                            {
                                let wide = difference(NUDGE);
                                if wide <= JUMP * value.abs() {
                                    slope = wide / NUDGE;
                                }
                            }
                            error += slope * own;
                        }
                    }
                    (value, error)
                }
            };
            known.insert(part, result);
        }
        known[&e]
    }
}

/// A product and its error: the error of every factor times the other factors.
fn product(
    c: f64,
    factors: &[(Expr, Number)],
    known: &FxHashMap<Expr, (f64, f64)>,
    operation: f64,
) -> (f64, f64) {
    let powers: Vec<f64> = factors.iter().map(|(base, n)| real_power(known[base].0, *n)).collect();
    let value = powers.iter().fold(c, |product, power| product * power);
    let mut error = operation * value.abs();
    for (i, (base, n)) in factors.iter().enumerate() {
        let (b, own) = known[base];
        let exponent = n.value();
        let slope =
            if exponent == 1.0 { 1.0 } else { exponent * math::powf(b.abs(), exponent - 1.0) };
        let others = powers.iter().enumerate().filter(|(j, _)| *j != i);
        let others = others.fold(c, |product, (_, power)| product * power);
        error += (others * slope).abs() * own;
    }
    (value, error)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slope of max(x − y, edge) by x − y that is found.
    fn slope_below_an_edge([x, y]: [f64; 2], edge: f64) -> f64 {
        let mut pool = Pool::new();
        let [a, b] = ["a", "b"].map(|name| pool.symbol(name));
        let (u, v) = (pool.variable(a), pool.variable(b));
        let difference = pool.sub(u, v);
        let constant = pool.number(Number::Real(edge));
        let larger = pool.call(crate::expr::FunctionId::Max, &[difference, constant]);
        let at = |s: Symbol| if s == a { x } else { y };
        let (_, own) = pool.evaluate_with_error(difference, &at);
        let (value, error) = pool.evaluate_with_error(larger, &at);
        // by the edge, which is as large as the value, it is 1
        (error - HALF * value.abs() - HALF * edge) / own
    }

    /// The wide step of 1e-7 is nearly all beyond the edge: a jump if that is more than a thousandth of the value.
    #[test]
    fn a_jump_is_a_thousandth_of_the_value() {
        for (edge, slope) in [(1.25e-4, 1.0), (0.8e-4, 0.0)] {
            let found = slope_below_an_edge([1.0 + edge * (1.0 - 1e-6), 1.0], edge);
            assert!((found - slope).abs() < 0.01, "{edge}: {found}");
        }
    }

    /// The edge is within the narrow step, by so many ε of the value: a slope where they are more than rounding.
    #[test]
    fn a_difference_of_sixty_four_units_is_rounding() {
        let (x, y) = (1.5, 1.0);
        let nudge = NUDGE * (x - y);
        for (units, slope) in [(50.0, 0.5), (80.0, 0.0)] {
            let found = slope_below_an_edge([x, y], 0.5 + nudge - units * f64::EPSILON * 0.5);
            assert!((found - slope).abs() < 0.01, "{units}: {found}");
        }
    }

    /// Of exp(x − y) at places of size 1e9 the difference is off by their rounding, half a unit of each, and that is all.
    #[test]
    fn rounding_is_carried_to_first_order() {
        let mut pool = Pool::new();
        let [x, y] = ["x", "y"].map(|name| pool.symbol(name));
        let at = |s: Symbol| if s == x { 1e9 + 0.25 } else { 1e9 };
        let (a, b) = (pool.variable(x), pool.variable(y));
        let difference = pool.sub(a, b);
        let exponential = pool.call(crate::expr::FunctionId::Exp, &[difference]);
        let (value, error) = pool.evaluate_with_error(exponential, &at);
        assert!((value - math::exp(0.25)).abs() < 1e-15);
        assert!((error / (2e9 * value) - 1.0).abs() < 1e-3, "{error}");
        // each input has its share, and operations have none
        for input in [x, y] {
            let share = pool.error_by_input(exponential, &at, input) / (0.5e9 * value);
            assert!((share - 1.0).abs() < 1e-3, "{share}");
        }
        // where both are equal, the error of the difference is far above the difference
        let (_, own) = pool.evaluate_with_error(difference, &|_| 0.75);
        let (value, error) = pool.evaluate_with_error(exponential, &|_| 0.75);
        assert!(value == 1.0 && own > 0.5 && (error - own - 0.5).abs() < 1e-5, "{error} {own}");
        // a jump is no slope
        let below = pool.linear(Number::ratio(-1, 1 << 40), &[(Number::ONE, difference)]);
        let sign = pool.call(crate::expr::FunctionId::Sign, &[below]);
        assert_eq!(pool.evaluate_with_error(sign, &|_| 0.75), (-1.0, 0.5));
        let wave = pool.call(crate::expr::FunctionId::Sin, &[a]);
        let (_, error) = pool.evaluate_with_error(wave, &at);
        let slope = math::cos(1e9 + 0.25).abs();
        assert!((error / (0.5e9 * slope) - 1.0).abs() < 1e-2, "{error}");
    }
}
