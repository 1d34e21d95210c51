//! The longest step in which the argument of a function stays where its series holds.
//!
//! In: a function, the series of its argument. Out: a time, in the unit of the series. Never here: tolerances.

use super::last_orders::FAINT;
use crate::expr::FunctionId;
use crate::num::math;

/// The largest change of a function's argument in one step: a short-range potential must not be
/// stepped over.
pub(super) const FARTHEST_ARGUMENT: f64 = 6.0;

/// Beyond this argument exponentials leave the range of `f64`, and functions that saturate with
/// them no longer change: up to there an argument may move at once.
const SATURATED: f64 = 750.0;

/// The largest relative change of the argument of a function without scale (`ln`, `atan`).
const PART_OF_ARGUMENT: f64 = 0.5;

/// The largest part of the way to a pole of an argument, where its function has a value on either side.
const PART_OF_RADIUS: f64 = 0.7;

/// Whether a function may have a smooth continuation through a pole of its argument on another branch, as arctan(tan t) has,
/// so that no other series shows the pole.
pub(super) fn may_pass_pole(function: FunctionId) -> bool {
    function == FunctionId::Atan
}

/// The step in which the argument of such a function stays clear of its poles: a part of the least radius of convergence that
/// its last terms show beside those in the middle, of which the first may be parts of something else.
pub(super) fn before_pole(u: &[f64]) -> f64 {
    let (middle, last) = (u.len() / 4..u.len() / 2, u.len() / 2..u.len());
    let known = |k: &usize| u[*k].abs() >= FAINT;
    let radius = |k: usize| {
        let beside = middle.clone().filter(known);
        let beside = beside.map(|j| math::powf((u[j] / u[k]).abs(), 1.0 / (k - j) as f64));
        let first = math::powf(u[0].abs().max(1.0) / u[k].abs(), 1.0 / k as f64);
        beside.reduce(f64::max).unwrap_or(first)
    };
    PART_OF_RADIUS * last.filter(known).map(radius).fold(f64::INFINITY, f64::min)
}

/// The step in which the argument of a function changes by the largest amount allowed.
pub(super) fn of_argument(function: FunctionId, u: &[f64]) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_ends_its_step_before_a_pole_of_its_tangent() {
        // 1/(r − t) and 1/(10⁶ (r − t)) have their pole at r; a sine has none
        for (r, size) in [(2.0_f64, 1.0), (1e-3, 1.0), (3.0, 1e-6)] {
            let pole: Vec<f64> = (0..28).map(|k| size * math::powi(r, -1 - k)).collect();
            let step = before_pole(&pole);
            assert!((0.3 * r..0.95 * r).contains(&step), "{step} of {r}");
        }
        let line: Vec<f64> = (0..28).map(|k| if k < 2 { 1.0 } else { 0.0 }).collect();
        assert_eq!(before_pole(&line), f64::INFINITY);
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
