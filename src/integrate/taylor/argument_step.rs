//! The longest step in which the argument of a function stays where its series holds.
//!
//! In: a function, the series of its argument. Out: a time, in the unit of the series. Never here: tolerances.

use super::last_orders::{FAINT, ROOM};
use crate::expr::FunctionId;
use crate::num::{Analytic, ExtendedRange, Real, math};

/// The largest change of a function's argument in one step: a short-range potential must not be
/// stepped over.
pub(super) const FARTHEST_ARGUMENT: f64 = 6.0;

/// Beyond this argument exponentials leave the range of `f64`, and functions that saturate with
/// them no longer change: up to there an argument may move at once.
const SATURATED: f64 = 750.0;

/// ln 750, from above.
const LOG_SATURATED: f64 = 6.621;

/// ln 1e-250, from above: below it the last terms of what a force adds to a motion may be fainter than [`FAINT`].
const LOG_SEEN: f64 = -575.0;

/// What is left of terms that cancel to this part of them is their rounding.
const ROUNDING: f64 = 1e-13;

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
/// `wide` is the same series where it is known in a wider range, beyond which that of `f64` may be.
pub(super) fn of_argument(function: FunctionId, u: &[f64], wide: Option<&[ExtendedRange]>) -> f64 {
    let room = match function {
        _ if saturates(function) => u[0].abs() - SATURATED,
        FunctionId::Ln | FunctionId::Atan | FunctionId::Atan2 => u[0].abs() * PART_OF_ARGUMENT,
        _ => 0.0,
    };
    let mut step = moving(FARTHEST_ARGUMENT, &u[..4]);
    if saturates(function) {
        let fall = wide.map_or_else(|| math::ln(u[0].abs()), log_size) - LOG_SATURATED;
        if fall > 1.0 {
            step = step.max(match wide {
                Some(wide) => before_fall(wide, fall),
                None => before_fall(u, fall),
            });
        }
    }
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

/// ln |u| at the origin.
fn log_size(u: &[ExtendedRange]) -> f64 {
    let size = if u[0].value() < 0.0 { -u[0] } else { u[0] };
    Analytic::ln(size).value()
}

/// Whether a function no longer changes, or is beyond the range of `f64`, where its argument is large.
fn saturates(function: FunctionId) -> bool {
    matches!(function, FunctionId::Exp | FunctionId::Sinh | FunctionId::Cosh | FunctionId::Tanh)
}

/// The step before which a high negative power c/u^n, that is e^(ln c − n ln u), becomes large enough to show itself in the
/// series of the motion; infinite where it does.
pub(super) fn of_steep_pole(degree: f64, above: f64, u: &[f64]) -> f64 {
    let factor = math::ln(above.abs());
    let log = if factor.is_finite() { factor } else { 0.0 } - degree * math::ln(u[0].abs());
    let is_unseen = degree > 0.0 && log.is_finite() && log < LOG_SEEN;
    let Some(logs) = logarithm(u).filter(|_| is_unseen) else { return f64::INFINITY };
    let mut exponent = logs.map(|l| -degree * l);
    exponent[0] = log;
    // the highest order of u is not known where that of the state is
    of_argument(FunctionId::Exp, &exponent[..u.len() - 1], None)
}

/// A time in which |u| does not fall by a factor of more than e^`fall`: the sum of the sizes of the terms of ln |u| stays below
/// it, each having a share. Where u grows fast, as an exponential or a high power does, its own terms allow far less.
fn before_fall<R: Real>(u: &[R], fall: f64) -> f64 {
    let Some(logs) = logarithm(u) else { return 0.0 };
    let mut safe = f64::INFINITY;
    for (k, log) in logs.iter().enumerate().skip(1).filter(|(_, log)| log.abs() >= FAINT) {
        safe = safe.min(0.5 * math::powf(fall / log.abs(), 1.0 / k as f64));
        if k >= u.len() / 2 {
            // a zero of u at a distance r is a term r^−k/k
            let zero = math::powf(k as f64 * log.abs(), -1.0 / k as f64);
            safe = safe.min(PART_OF_RADIUS * zero);
        }
    }
    safe
}

/// The series of ln |u| beyond its first term: with a_k = u_k/u₀, l_k = a_k − Σ_{0<j<k} j l_j a_{k−j}/k; zero where that is within its
/// rounding. With the digits of double-double that is followed from order to order: of e^(2x³) all digits of the third term may be lost
/// beside the first, and those behind are made of what was lost. Of `f64` such bounds would leave nothing. `None` where a term is not
/// finite.
fn logarithm<R: Real>(u: &[R]) -> Option<[f64; ROOM]> {
    let size_of = |x: R| if x.value() < 0.0 { -x } else { x };
    let exceeds = |a: R, b: R| (a - b).value() > 0.0;
    let rounding = ROUNDING / f64::EPSILON * R::ROUNDING;
    let (mut logs, mut errors, mut ratios) = ([R::ZERO; ROOM], [R::ZERO; ROOM], [R::ZERO; ROOM]);
    let mut known = [0.0; ROOM];
    // the highest order of an argument is not known where that of the state is
    let orders = (u.len() - 1).min(ROOM);
    for k in 1..orders {
        ratios[k] = u[k] / u[0];
        let (mut log, mut size, mut error) = (ratios[k], size_of(ratios[k]), R::ZERO);
        for j in 1..k {
            let factor = ratios[k - j] * j as f64 / k as f64;
            let term = factor * logs[j];
            log = log - term;
            if exceeds(size_of(term), size) {
                size = size_of(term);
            }
            error = error + size_of(factor) * errors[j];
        }
        let own = size * rounding;
        if R::UNBOUNDED {
            (logs[k], errors[k]) = (log, own + error);
        } else if exceeds(size_of(log), own) {
            logs[k] = log;
        }
        if exceeds(size_of(logs[k]), errors[k]) {
            known[k] = logs[k].value();
        }
        let is_lost = if R::UNBOUNDED { log.value().is_nan() } else { !log.value().is_finite() };
        if is_lost || !known[k].is_finite() {
            return None;
        }
    }
    Some(known)
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
    use crate::num::DoubleDouble;

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
    fn arguments_move_as_far_as_their_functions_stay_resolved() {
        let line = |value: f64| [value, 1.0, 0.0, 0.0, 0.0];
        let step = |function, value| of_argument(function, &line(value), None);
        let near = |step: f64, wanted: f64| assert!((step / wanted - 1.0).abs() < 1e-9, "{step}");
        near(step(FunctionId::Exp, 1.0), 6.0);
        near(step(FunctionId::Exp, -749.0), 6.0);
        // beyond the range of exponentials nothing changes until the argument comes back
        near(step(FunctionId::Exp, -850.0), 50.0);
        // −1e6 − t falls by a factor of 1e6/750 within less than 1e6
        assert!((4e5..1e6).contains(&step(FunctionId::Exp, -1e6)));
        // e^u, of which only ln |e^u| = 1e9 is known, with u′ = 1
        let exponential = exponential_of(1e9, &[1.0]);
        let longest = of_argument(FunctionId::Exp, &in_its_unit(&exponential), Some(&exponential));
        assert!((4e8..1e9).contains(&longest), "{longest}");
        // (1 + t)⁴¹, from 1e60: it has fallen to 750 near t = −0.96
        let mut power = vec![1e60];
        (0..20).for_each(|k| power.push(power[k] * (41 - k) as f64 / (k + 1) as f64));
        let longest = of_argument(FunctionId::Tanh, &power, None);
        assert!((0.3..0.96).contains(&longest), "{longest}");
        // 1e300 (1 − t) passes zero at t = 1, whatever the number of its terms
        for order in [12, 20, 28] {
            let mut line = vec![0.0; order + 1];
            (line[0], line[1]) = (1e300, -1e300);
            let longest = of_argument(FunctionId::Tanh, &line, None);
            assert!((0.3..0.95).contains(&longest), "{order}: {longest}");
        }
        // x^−600 from 5 toward 0 comes into the range of numbers near 3.5
        let falling: Vec<f64> =
            (0..20).map(|k| [5.0, -1.0].get(k).copied().unwrap_or(0.0)).collect();
        let longest = of_steep_pole(600.0, 1.0, &falling);
        assert!((0.3..1.51).contains(&longest), "{longest}");
        // where it is no longer tiny the series of the motion shows it
        assert_eq!(of_steep_pole(300.0, 1.0, &falling), f64::INFINITY);
        near(step(FunctionId::Ln, 100.0), 25.0);
        near(step(FunctionId::Sin, 100.0), 6.0);
    }

    /// The series of e^v, where v has this value and these further coefficients.
    fn exponential_of(value: f64, v: &[f64]) -> Vec<ExtendedRange> {
        let wide = |x: f64| ExtendedRange::of(DoubleDouble::from(x));
        let mut all = vec![Analytic::exp(wide(value))];
        for k in 1..29_usize {
            let terms = v.iter().zip(1..=k).map(|(&c, j)| all[k - j] * c * j as f64 / k as f64);
            all.push(terms.fold(ExtendedRange::ZERO, |sum, term| sum + term));
        }
        all
    }

    /// The same series in proportion, as large as `f64` has it.
    fn in_its_unit(u: &[ExtendedRange]) -> Vec<f64> {
        u.iter().map(|&c| (c / u[0]).value() * 1e300).collect()
    }

    /// −e^(2x³), which falls to −750 near x = 1.5 only, along x ± t: of the third term of its logarithm, ±2, no digit of `f64` is left.
    #[test]
    fn an_exponential_of_a_power_may_move_as_far_as_it_stays_out_of_range() {
        for x in [50.0, 90.0, 95.0, 1e3, 1e5, 1e8] {
            for v in [1.0, -1.0] {
                let u = exponential_of(2.0 * x * x * x, &[6.0 * x * x * v, 6.0 * x, 2.0 * v]);
                let longest = of_argument(FunctionId::Exp, &in_its_unit(&u), Some(&u));
                assert!((0.1 * x..0.9 * x).contains(&longest), "{longest} at {x}");
            }
        }
        // e^(c t) (1 − t/r) beyond the range of numbers passes zero at r
        for (c, r) in [(0.0, 0.5), (20.0, 0.5), (20.0, 2.0), (100.0, 0.5)] {
            let mut u = exponential_of(1e6, &[c]);
            for k in (1..u.len()).rev() {
                u[k] = u[k] - u[k - 1] / r;
            }
            let longest = of_argument(FunctionId::Tanh, &in_its_unit(&u), Some(&u));
            assert!((0.3 * r..0.95 * r).contains(&longest), "{longest} before {r}, {c}");
        }
    }
}
