//! The stability of a fixed step: how a method amplifies small oscillations about the motion.
//!
//! The rates are linearised about the motion by differences, of rates on the same side of each kink. Each eigenvalue λ belongs to a mode
//! e^{λt}, which a method multiplies in a step h by a factor that depends on z = hλ alone. If that
//! exceeds 1 for a mode that does not grow by itself, the step is too long, and the motion is wrong
//! whatever its local error.
//!
//! In: rates, a state, a step. Out: the longest step that is stable there, if this one is not. Never here: errors of
//! stable steps.
//!
//! Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.2.

use nalgebra::DMatrix;

use crate::num::{self, math};
use crate::system::KinkSides;

/// A mode that grows by less than this part in a step counts as constant.
const GROWS: f64 = 1e-3;

/// A mode counts as not growing by itself up to this part of its rate, the accuracy of eigenvalues
/// from differences.
const STEADY: f64 = 1e-3;

/// The perturbation of a number for a difference, relative to its size.
const DIFFERENCE: f64 = 1e-6;

/// The longest stable step is found to one part in this many.
const PARTS: u32 = 200;

/// A fixed step beyond the stability limit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Unstable {
    /// The time at which it was found.
    pub time: f64,
    /// The step in use.
    pub step: f64,
    /// The limit below which steps are stable there.
    pub limit: f64,
}

/// The factor by which a method multiplies a mode in one step, at z = hλ.
pub(super) type GrowthFactor = fn(&[f64], [f64; 2]) -> f64;

/// How a method amplifies modes: the rule, and its weights.
#[derive(Clone, Copy)]
pub(super) struct Modes<'a> {
    pub(super) growth: GrowthFactor,
    pub(super) weights: &'a [f64],
    /// No mode with |z| up to this is amplified.
    pub(super) harmless: f64,
}

/// The distance between two values of |z| at which amplification is searched for.
const APART: f64 = 1.0 / 32.0;

/// A mode is harmless up to this part of the least |z| that is amplified, and up to this |z|: an
/// oscillation of π a step comes back with the opposite sign, where the least error amplifies it.
const SAFE: f64 = 0.9;
const FARTHEST: f64 = 2.5;

/// The |z| up to which no oscillation is amplified by a method that does not judge other modes.
pub(super) fn harmless(growth: GrowthFactor, weights: &[f64]) -> f64 {
    let steps = (1..).map(|k| APART * f64::from(k));
    let stable = |z: &f64| *z <= FARTHEST && growth(weights, [0.0, *z]) <= 1.0 + GROWS / 2.0;
    SAFE * steps.take_while(stable).last().unwrap_or(0.0)
}

impl Modes<'_> {
    /// The longest stable step, if `step` is not stable; `z` are the eigenvalues times the step.
    pub(super) fn limit(self, z: &[[f64; 2]], step: f64) -> Option<f64> {
        let grows = |part: f64| {
            z.iter().any(|&[re, im]| {
                let steady = re <= STEADY * math::hypot(re, im);
                let own = math::exp(part * re.max(0.0));
                let made = (self.growth)(self.weights, [part * re, part * im]);
                steady && made > (1.0 + GROWS) * own
            })
        };
        if !grows(1.0) {
            return None;
        }
        // no mode grows by anything in a step that is short enough
        let mut whole = 1.0;
        while whole > f64::MIN_POSITIVE && grows(whole / f64::from(PARTS)) {
            whole /= f64::from(PARTS);
        }
        let part = |k: u32| whole * f64::from(k) / f64::from(PARTS);
        let first = (1..=PARTS).find(|&k| grows(part(k))).unwrap_or(PARTS);
        Some(step.abs() * part(first - 1))
    }
}

/// Writes the rates at some numbers, and returns on which side of each kink they lie; `None` if there are no rates.
pub(super) trait RatesWithSides:
    FnMut(&[f64], &mut [f64]) -> Option<Vec<KinkSides>>
{
}

impl<F: FnMut(&[f64], &mut [f64]) -> Option<Vec<KinkSides>>> RatesWithSides for F {}

/// The longest stable step at a state, if `step` is not stable. `rates` gives the rates of the leading
/// `moving` numbers.
pub(super) fn limit(
    modes: Modes<'_>,
    (numbers, moving): (&[f64], usize),
    step: f64,
    rates: impl RatesWithSides,
) -> Option<f64> {
    let matrix = linearised(numbers, moving, step, rates)?;
    // no eigenvalue is larger than a norm
    if matrix.norm() <= modes.harmless {
        return None;
    }
    modes.limit(&num::eigenvalues(matrix), step)
}

/// The rates at some numbers, and the sides of the kinks these lie on.
struct RatesAtPoint {
    rates: Vec<f64>,
    sides: Vec<KinkSides>,
}

impl RatesAtPoint {
    /// Whether there is no kink between two points.
    fn is_beside(&self, other: &RatesAtPoint) -> bool {
        self.sides.iter().zip(&other.sides).all(|(a, b)| a.agrees(b))
    }
}

/// The rates at a state, linearised, times the step; `None` if there are none.
fn linearised(
    numbers: &[f64],
    moving: usize,
    step: f64,
    mut rates: impl RatesWithSides,
) -> Option<DMatrix<f64>> {
    let mut point = |numbers: &[f64]| {
        let mut out = vec![0.0; numbers.len()];
        rates(numbers, &mut out).map(|sides| RatesAtPoint { rates: out, sides })
    };
    let here = point(numbers)?;
    let mut matrix = DMatrix::zeros(moving, moving);
    let mut moved = numbers.to_vec();
    for (j, &x) in numbers.iter().enumerate().take(moving) {
        let ahead = step * here.rates[j];
        let by = DIFFERENCE * x.abs().max(ahead.abs());
        // a number that stays at zero has no size, and no part in the motion
        if !((x + by) - x).is_normal() {
            continue;
        }
        let mut at = |offset: f64| {
            moved[j] = x + offset;
            let place = moved[j];
            let found = point(&moved);
            moved[j] = x;
            found.map(|found| (place, found))
        };
        let beside = |(_, other): &(f64, RatesAtPoint)| here.is_beside(other);
        let near = at(by).filter(beside).or_else(|| at(-by).filter(beside));
        let mut write = |(from, here): (f64, &RatesAtPoint), (to, there): (f64, &RatesAtPoint)| {
            let rates = there.rates.iter().zip(&here.rates);
            for (i, (there, here)) in rates.enumerate().take(moving) {
                matrix[(i, j)] = step * ((there - here) / (to - from));
            }
        };
        if let Some((place, there)) = &near {
            write((x, &here), (*place, there));
            continue;
        }
        // on a kink the motion is that of the side it moves to
        let by = by.copysign(ahead);
        if let (Some((from, here)), Some((to, there))) = (at(by), at(2.0 * by))
            && here.is_beside(&there)
        {
            write((from, &here), (to, &there));
        }
    }
    Some(matrix)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A method that amplifies modes as Euler's explicit rule does.
    const EULER: Modes<'static> =
        Modes { growth: |_, [re, im]| math::hypot(1.0 + re, im), weights: &[], harmless: 0.0 };

    #[test]
    fn a_mode_that_falls_is_stable_up_to_two() {
        assert_eq!(EULER.limit(&[[-2.0, 0.0]], 1.0), None);
        assert_eq!(EULER.limit(&[[-2.0009, 0.0]], 1.0), None);
        let limit = EULER.limit(&[[-2.0011, 0.0]], 1.0).unwrap_or(0.0);
        assert!((0.99..1.0).contains(&limit), "{limit}");
        // accurate to one part in two hundred
        let limit = EULER.limit(&[[-4.0, 0.0]], 1.0).unwrap_or(0.0);
        assert!((limit - 0.5).abs() <= 0.0051 && limit >= 0.4949, "{limit}");
        // a step that is far too long
        let limit = EULER.limit(&[[-4e9, 0.0]], 1.0).unwrap_or(0.0);
        assert!((limit / 5e-10 - 1.0).abs() <= 0.02, "{limit}");
    }

    #[test]
    fn a_mode_that_grows_by_itself_is_not_caused_by_the_step() {
        // |1 + z| exceeds e^(re z) where im is large beside re
        assert!(EULER.limit(&[[0.9e-3, 1.0]], 1.0).is_some());
        assert_eq!(EULER.limit(&[[1.1e-3, 1.0]], 1.0), None);
    }
}
