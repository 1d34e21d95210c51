//! The angle variable of one coordinate: the part of the period that has gone by at a place, w = ∂S/∂J.
//!
//! In: a coordinate with its [`EffectivePotential`], its region at an energy, a place, the sign of the velocity. Out: w from 0
//! to 1, 0 where the coordinate turns on the left, or is zero in a rotation. At equal energy ∂p/∂E = 1/q̇, so w is the integral
//! of dq/q̇ over the period: a quadrature over places, and no motion is followed. That w grows evenly along a motion is
//! therefore a check of both. With q = c − r cos φ the integrand is smooth where the coordinate turns.
//! Source: *The Principles of Dynamics*, § 4.2.

use std::f64::consts::PI;

use super::{ActionRow, EffectivePotential, NoAction, RegionKind};
use crate::ensemble::{NotOnShell, Root};
use crate::num::{gauss, math};

/// The nodes on each part of an interval, the least and the greatest number of parts, the relative change that ends, and that
/// which may be rounding.
const NODES: usize = 16;
const FEWEST: usize = 2;
const MOST: usize = 1024;
const SETTLED: f64 = 1e-13;
const ROUNDING: f64 = 1e-10;

/// The angle variable w, in turns.
///
/// # Errors
/// Returns an error if the motion does not return, or a place of its region has no velocity.
pub fn angle(
    potential: &mut EffectivePotential<'_>,
    row: &ActionRow,
    place: f64,
    velocity: f64,
) -> Result<f64, NoAction> {
    let never = || NoAction::NoReturn("the motion does not return, and has no angle".to_owned());
    if !row.period.is_finite() {
        return Err(never());
    }
    let period = potential.period();
    let mut along = TravelTime { potential, energy: row.energy };
    match (row.kind, row.turning_points, period) {
        (RegionKind::Libration, [Some(left), Some(right)], period) => {
            let (middle, half) = (f64::midpoint(left, right), 0.5 * (right - left));
            // the turn of the coordinate in which the region lies
            let place = match period {
                Some(turn) => place - turn * ((place - middle) / turn).round(),
                None => place,
            };
            let phase = math::acos(((middle - place) / half).clamp(-1.0, 1.0));
            let mut time = |to: f64, root| {
                let step = |phase: f64| (middle - half * math::cos(phase), half * math::sin(phase));
                along.time(to, &step, root)
            };
            let there = time(PI, Root::Positive)?;
            let back = time(PI, Root::Negative)?;
            let elapsed = if velocity >= 0.0 {
                time(phase, Root::Positive)?
            } else {
                there + back - time(phase, Root::Negative)?
            };
            Ok((elapsed / (there + back)).rem_euclid(1.0))
        }
        (RegionKind::Rotation | RegionKind::BackwardRotation, _, Some(turn)) => {
            let (sign, root) =
                if velocity < 0.0 { (-1.0, Root::Negative) } else { (1.0, Root::Positive) };
            let step = |way: f64| (sign * way, 1.0);
            let whole = along.time(turn, &step, root)?;
            let part = along.time((sign * place).rem_euclid(turn), &step, root)?;
            Ok((part / whole).rem_euclid(1.0))
        }
        _ => Err(never()),
    }
}

/// A coordinate at an energy.
struct TravelTime<'a, 'b> {
    potential: &'a mut EffectivePotential<'b>,
    energy: f64,
}

impl TravelTime<'_, '_> {
    /// ∫ dq/|q̇| from 0 to `to` of a variable that gives the place and its derivative.
    fn time(
        &mut self,
        to: f64,
        place: &dyn Fn(f64) -> (f64, f64),
        root: Root,
    ) -> Result<f64, NotOnShell> {
        let rule = gauss(NODES);
        let (mut before, mut changed) = (f64::NAN, f64::INFINITY);
        let mut parts = FEWEST;
        while parts <= MOST {
            let width = to / parts as f64;
            let mut sum = 0.0;
            for part in 0..parts {
                for &(x, weight) in &rule {
                    let (q, rate) = place(width * (part as f64 + x));
                    sum += width * weight * rate / self.potential.speed(q, self.energy, root)?;
                }
            }
            let change = (sum - before).abs() / sum.abs();
            if sum == 0.0 || change <= SETTLED || (change <= ROUNDING && change >= 0.5 * changed) {
                return Ok(sum);
            }
            (before, changed) = (sum, change);
            parts *= 2;
        }
        Ok(before)
    }
}
