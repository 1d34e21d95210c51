//! Integrals of p over q by the trapezoidal rule: over a period, and between turning points with q = c + r sin θ, whose integrand is
//! analytic and periodic.
//!
//! In: an [`EffectivePotential`], an energy, the places between which it moves. Out: the integral. Never here: regions, periods.

use std::f64::consts::PI;

use super::EffectivePotential;
use crate::ensemble::{NotOnShell, Root};
use crate::num::math;

/// The least and the greatest number of places in a quadrature, the relative change that ends it, and that which may be
/// rounding.
const FEWEST: usize = 32;
const MOST: usize = 4096;
const CONVERGED: f64 = 1e-14;
const ROUNDING: f64 = 1e-11;

/// The area of the curve of an energy between two places, ∮ p dq, where the curve closes at both.
///
/// # Errors
/// Returns an error if there is no state in between.
pub(super) fn action_between(
    potential: &mut EffectivePotential<'_>,
    left: f64,
    right: f64,
    energy: f64,
) -> Result<f64, NotOnShell> {
    let (middle, half) = (f64::midpoint(left, right), 0.5 * (right - left));
    converged(|n| {
        let step = PI / n as f64;
        (0..n).try_fold(0.0, |sum, i| {
            let angle = -0.5 * PI + (i as f64 + 0.5) * step;
            let place = middle + half * math::sin(angle);
            Ok(sum + step * half * math::cos(angle) * potential.width(place, energy)?)
        })
    })
}

/// The part of ∫ p dq over a period that is the same both ways, as of p = q̇ + A: a turn to the right has it more than `half` of the
/// area between both ways, one to the left less. It is smooth where the coordinate turns.
///
/// # Errors
/// Returns an error if there is no state at a place.
pub(super) fn common_part(
    potential: &mut EffectivePotential<'_>,
    (period, half): (f64, f64),
    energy: f64,
) -> Result<f64, NotOnShell> {
    let turn = over_a_period(period, |place| {
        let right = potential.momentum_at(place, energy, Root::Positive)?;
        let left = potential.momentum_at(place, energy, Root::Negative)?;
        let common = right.zip(left).map_or(0.0, |(right, left)| f64::midpoint(right, left));
        Ok(half / period + common)
    })?;
    Ok(turn - half)
}

/// The integral of a periodic function over its period, by the trapezoidal rule.
pub(super) fn over_a_period(
    period: f64,
    mut integrand: impl FnMut(f64) -> Result<f64, NotOnShell>,
) -> Result<f64, NotOnShell> {
    converged(|n| {
        let step = period / n as f64;
        (0..n).try_fold(0.0, |sum, i| Ok(sum + step * integrand((i as f64 + 0.5) * step)?))
    })
}

/// A sum with ever more places, until it no longer changes, or only by rounding, which does not shrink.
fn converged(mut sum: impl FnMut(usize) -> Result<f64, NotOnShell>) -> Result<f64, NotOnShell> {
    let (mut last, mut before) = (sum(FEWEST)?, f64::INFINITY);
    let mut n = 2 * FEWEST;
    while n <= MOST {
        let next = sum(n)?;
        let change = (next - last).abs() / next.abs();
        if change <= CONVERGED || (change <= ROUNDING && change >= 0.5 * before) {
            return Ok(next);
        }
        (last, before, n) = (next, change, 2 * n);
    }
    Ok(last)
}
