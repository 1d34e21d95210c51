//! The approach to an essential singularity of the law, as that of sin(1/(1 − t)) at t = 1: towards an ordinary one steps shrink as
//! the distance from it, towards this one faster, so that no number of them arrives.
//!
//! In: the series of what the law divides by, the steps. Out: the instant that is never reached. Never here: singularities that a
//! finite number of steps comes to.

/// An approach is known after so many short steps: what lies before the instant, an event or a row, is within reach of fewer.
const KNOWN_AFTER: u32 = 1 << 17;

/// From one power of two of their number to the next the distance grows by this factor at least, counted in steps; it doubles where the
/// argument of a function runs off at an even pace, and it would fall if the steps arrived.
const GROWTH: f64 = 1.5;

/// The first power of two that is looked at.
const FIRST: u32 = 1 << 8;

/// The distance has fallen to this part of what it was at the first of the short steps: what is only far away is not approached.
const FALLEN: f64 = 0.5;

/// From one power of two to the next the instant moves by no more than this part of the distance.
const STEADY: f64 = 1e-2;

/// Corrections of a zero.
const CORRECTIONS: u32 = 6;

/// What is divided by is zero where no more than rounding is left of it: (1 − t)⁴ + 1e-20 is not zero, and its steps arrive.
const VANISHED: f64 = 1e-13;

/// The approach to an instant in succession of short steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// The instant, and how far it was at the first of them.
    instant: f64,
    first: f64,
    /// The number of steps, and the instant and the distance in steps when it last was a power of two.
    steps: u32,
    before: f64,
    in_steps: f64,
}

impl Approach {
    fn begin(instant: f64, distance: f64) -> Approach {
        Approach { instant, first: distance, steps: 0, before: instant, in_steps: 0.0 }
    }

    /// The approach with a step of this size more, which began so far from an instant; anew where it is another one, or where steps
    /// come nearer. Infinite distances are those of nothing ahead.
    pub(super) fn after(
        before: Option<Approach>,
        (instant, distance): (f64, f64),
        size: f64,
    ) -> Option<Approach> {
        if !distance.is_finite() || distance <= 0.0 {
            return None;
        }
        let is_same = |known: &Approach| (known.before - instant).abs() <= STEADY * distance;
        let begun = Approach::begin(instant, distance);
        let mut now = before.filter(is_same).unwrap_or(begun);
        (now.instant, now.steps) = (instant, now.steps + 1);
        if now.steps >= FIRST && now.steps.is_power_of_two() {
            let in_steps = distance / size;
            if in_steps < GROWTH * now.in_steps {
                return Some(begun);
            }
            (now.before, now.in_steps) = (instant, in_steps);
        }
        Some(now)
    }

    /// The instant, if it is known that no number of steps reaches it from where it is so far.
    pub(super) fn unreachable(&self, distance: f64) -> Option<f64> {
        let is_known = self.steps >= KNOWN_AFTER && distance <= FALLEN * self.first;
        is_known.then_some(self.instant)
    }
}

/// The first zero ahead of what is divided by, in the unit of its series; infinite where none is seen.
pub(super) fn nearest_zero<'a>(divisors: impl Iterator<Item = &'a [f64]>) -> f64 {
    divisors.filter_map(zero_of).fold(f64::INFINITY, f64::min)
}

/// The zero ahead of a series, by Newton's method for u/u′, which has a simple zero where u has a multiple one.
fn zero_of(u: &[f64]) -> Option<f64> {
    // the highest order is not known where that of the state is
    let u = &u[..u.len() - 1];
    let mut zero = 0.0;
    for _ in 0..CORRECTIONS {
        let (value, slope, half_bend) = value_slope_and_half_bend(u, zero);
        if value == 0.0 {
            break;
        }
        zero -= value * slope / (slope * slope - 2.0 * value * half_bend);
    }
    let (left, ..) = value_slope_and_half_bend(u, zero);
    (zero.is_finite() && zero > 0.0 && left.abs() <= VANISHED * u[0].abs()).then_some(zero)
}

fn value_slope_and_half_bend(u: &[f64], x: f64) -> (f64, f64, f64) {
    u.iter().rev().fold((0.0, 0.0, 0.0), |(value, slope, bend), &c| {
        (value * x + c, slope * x + value, bend * x + slope)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

    /// What is known of steps of this size at a distance, from a distance 1.
    fn known(size: impl Fn(f64) -> f64) -> Option<f64> {
        let (mut distance, mut approach) = (1.0, None);
        for _ in 0..KNOWN_AFTER + FIRST {
            let step: f64 = size(distance);
            approach = Approach::after(approach, (7.0, distance), step);
            if let Some(instant) = approach.and_then(|approach| approach.unreachable(distance)) {
                return Some(instant);
            }
            distance -= step;
            if distance <= 0.0 {
                return None;
            }
        }
        None
    }

    #[test]
    fn steps_that_shrink_faster_than_the_distance_do_not_arrive() {
        assert_eq!(known(|r| 6.0 * r * r / (1.0 + 6.0 * r)), Some(7.0));
        assert_eq!(known(|r| (r * r * math::exp(-1.0 / r)).min(0.1 * r)), Some(7.0));
        // towards a pole, or evenly across what is not one
        assert_eq!(known(|r| 0.01 * r), None);
        assert_eq!(known(|_| 1e-4), None);
        // these would be many, and arrive
        assert_eq!(known(|r| 1e-3 * r.sqrt()), None);
    }

    #[test]
    fn a_zero_ahead_is_that_of_the_series() {
        let of = |u: &[f64]| nearest_zero([u].into_iter());
        // 1 − t/2, (1 − t)² and (2 − t)³; then what does not vanish ahead, or not quite
        assert_eq!(of(&[1.0, -0.5, 0.0, 0.0]), 2.0);
        assert!((of(&[1.0, -2.0, 1.0, 0.0]) - 1.0).abs() < 1e-12);
        assert!((of(&[8.0, -12.0, 6.0, -1.0, 0.0]) - 2.0).abs() < 1e-4);
        assert_eq!(of(&[1.0, 0.5, 0.0]), f64::INFINITY);
        assert_eq!(of(&[1.0 + 1e-11, -2.0, 1.0, 0.0]), f64::INFINITY);
    }
}
