//! The longest step that a series allows.
//!
//! The error of each number of the state is measured relative to its own size, so units do not
//! matter and nothing small is lost beside something large. Its series is truncated at order p; the
//! step h is such that the last terms are a small part of the tolerance, |c_p| h^p ≤ ε/100 max_j
//! |c_j| h^j, and stays inside the radius of convergence however small those terms are: a body far
//! from a collision is hardly affected by it.

use crate::expr::FunctionId;
use crate::num::math;
use crate::system::Series;

/// The part of the tolerance allowed for the last terms, which represent everything truncated.
/// Truncation errs in the same direction step by step, while rounding does not.
const SHARE: f64 = 0.01;

/// The number of last orders that enter. There are more than two, because symmetric motions have
/// coefficients that vanish in a regular pattern.
const LAST: usize = 4;

/// The number of orders before these that also enter, with a larger tolerance.
const BEFORE: usize = 6;
const INDULGENCE: f64 = 1.5;

/// The largest step as a part of the radius of convergence.
const PART_OF_RADIUS: f64 = 0.6;

/// The tolerance of an integral (action, work), in tolerances of the motion: its errors have no
/// effect on the motion.
const SPARED: f64 = 1e3;

/// The largest change of a function's argument in one step: a short-range potential must not be
/// stepped over.
const FARTHEST_ARGUMENT: f64 = 6.0;

/// Beyond this argument exponentials leave the range of `f64`, and functions that saturate with
/// them no longer change: up to there an argument may move at once.
const SATURATED: f64 = 750.0;

/// The largest relative change of the argument of a function without scale (`ln`, `atan`).
const PART_OF_ARGUMENT: f64 = 0.5;

/// A coefficient below this is an underflow: in a unit of time near the step its term is far below
/// the last digit of anything.
const FAINT: f64 = 1e-290;

/// The order at which a tolerance costs least: the step grows with the order, the work with its
/// square (Jorba & Zou, proposition 3.2, find −½ ln ε + 1 if each order costs the same work; orders
/// cost less here).
pub(super) fn order_for(tolerance: f64) -> usize {
    ((-math::ln(tolerance) * 0.66).ceil() as usize).clamp(12, 44)
}

/// Whether all rates of change are finite.
pub(super) fn has_velocity(series: &Series) -> bool {
    numbers(series).all(|c| c[1].is_finite())
}

/// The longest step that a tolerance allows, in the unit of the series; infinite for a polynomial.
/// Returns `None` if a coefficient is not finite.
pub(super) fn longest(series: &Series, tolerance: f64) -> Option<f64> {
    let tolerance = tolerance * SHARE;
    let mut logs = [0.0; 64];
    let mut shortest = f64::INFINITY;
    let judged = numbers(series).chain((0..series.switches()).map(|i| series.switch(i)));
    let judged = judged.map(|c| (c, tolerance));
    let integrals = integrals(series).map(|c| (c, tolerance * SPARED));
    for (c, tolerance) in judged.chain(integrals) {
        if c.iter().any(|x| !x.is_finite()) {
            return None;
        }
        for (log, x) in logs.iter_mut().zip(c) {
            *log = if x.abs() < FAINT { f64::NEG_INFINITY } else { math::ln(x.abs()) };
        }
        shortest = shortest.min(of_one(&logs[..c.len()], math::ln(tolerance)));
    }
    for (function, u) in series.arguments() {
        shortest = shortest.min(of_argument(function, u));
    }
    Some(shortest)
}

/// The step in which the argument of a function changes by the largest amount allowed.
fn of_argument(function: FunctionId, u: &[f64]) -> f64 {
    let room = match function {
        FunctionId::Exp | FunctionId::Sinh | FunctionId::Cosh | FunctionId::Tanh => {
            u[0].abs() - SATURATED
        }
        FunctionId::Ln | FunctionId::Atan | FunctionId::Atan2 => u[0].abs() * PART_OF_ARGUMENT,
        _ => 0.0,
    };
    let mut step = moving(FARTHEST_ARGUMENT, &u[..4]);
    if room > FARTHEST_ARGUMENT {
        // all terms together, each with a share
        let mut safe = f64::INFINITY;
        for (k, c) in u.iter().enumerate().skip(1).filter(|(_, c)| c.abs() >= FAINT) {
            safe = safe.min(0.5 * math::powf(room / c.abs(), 1.0 / k as f64));
        }
        step = step.max(safe);
    }
    step
}

/// The time in which no term of a series exceeds `far`.
fn moving(far: f64, u: &[f64]) -> f64 {
    let mut shortest = f64::INFINITY;
    for (k, c) in u.iter().enumerate().skip(1) {
        let bound = math::powf(far / c.abs(), 1.0 / k as f64);
        if bound.is_finite() {
            shortest = shortest.min(bound);
        }
    }
    shortest
}

/// The series of the coordinates and rates.
fn numbers(series: &Series) -> impl Iterator<Item = &[f64]> {
    (0..series.inputs()).map(|i| series.coefficients(i))
}

/// The series of the integrals.
fn integrals(series: &Series) -> impl Iterator<Item = &[f64]> {
    (series.inputs()..series.len()).map(|i| series.coefficients(i))
}

/// The step of one number, from the logarithms of its coefficients.
fn of_one(logs: &[f64], log_tolerance: f64) -> f64 {
    let p = logs.len() - 1;
    let mut shortest = f64::INFINITY;
    for k in (p + 1).saturating_sub(LAST + BEFORE).max(3)..=p {
        if logs[k] == f64::NEG_INFINITY {
            continue;
        }
        let (mut by_tolerance, mut radius) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for j in 0..k {
            let root = (logs[j] - logs[k]) / (k - j) as f64;
            by_tolerance = by_tolerance.max(root + log_tolerance / (p - j) as f64);
            if (2..k - 1).contains(&j) {
                radius = radius.max(root);
            }
        }
        let mut log_step = by_tolerance;
        if radius > f64::NEG_INFINITY {
            log_step = log_step.min(radius + math::ln(PART_OF_RADIUS));
        }
        if k + LAST <= p {
            log_step += math::ln(INDULGENCE);
        }
        shortest = shortest.min(math::exp(log_step));
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The logarithms of a series whose terms shrink by a factor from one to the next.
    fn geometric(ratio: f64) -> Vec<f64> {
        (0..29).map(|k| f64::from(k) * math::ln(ratio)).collect()
    }

    #[test]
    fn a_step_leaves_last_terms_of_a_hundredth_of_the_tolerance() {
        // of an entire function: |c_k| h^k = 1/k! · h^k, at h where the last is ε
        let logs: Vec<f64> = std::iter::successors(Some((0.0, 0.0)), |(log, k): &(f64, f64)| {
            Some((log - math::ln(k + 1.0), k + 1.0))
        })
        .map(|(log, _)| log)
        .take(29)
        .collect();
        let tolerance = 1e-12 * SHARE;
        let step = of_one(&logs, math::ln(tolerance));
        let last = math::exp(logs[28] + 28.0 * math::ln(step));
        let largest = (0..29).map(|k| math::exp(logs[k] + k as f64 * math::ln(step)));
        let part = last / largest.fold(0.0, f64::max);
        // earlier terms also enter, so less than a hundredth is left
        assert!((0.4e-15..4e-15).contains(&part), "{part:e}");
    }

    #[test]
    fn a_step_stays_within_six_tenths_of_the_radius() {
        // 1/(1 − t) has radius 1; a loose tolerance would lead beyond
        let step = of_one(&geometric(1.0), math::ln(0.1));
        assert!((0.59..0.61).contains(&step), "{step}");
        // in any unit
        let step = of_one(&geometric(4.0), math::ln(0.1));
        assert!((0.147..0.153).contains(&step), "{step}");
    }

    #[test]
    fn what_underflow_has_left_shortens_no_step() {
        // FAINT is far below the last digit of the largest coefficient, and above what underflows
        const { assert!(FAINT < 1e-250 && FAINT > f64::MIN_POSITIVE) }
    }

    #[test]
    fn arguments_move_as_far_as_their_functions_stay_told() {
        let line = |value: f64| [value, 1.0, 0.0, 0.0, 0.0];
        let step = |function, value| of_argument(function, &line(value));
        let near = |step: f64, wanted: f64| assert!((step / wanted - 1.0).abs() < 1e-9, "{step}");
        near(step(FunctionId::Exp, 1.0), 6.0);
        near(step(FunctionId::Exp, -749.0), 6.0);
        // beyond the range of exponentials nothing changes until the argument comes back
        near(step(FunctionId::Exp, -850.0), 50.0);
        near(step(FunctionId::Ln, 100.0), 25.0);
        near(step(FunctionId::Sin, 100.0), 6.0);
    }
}
