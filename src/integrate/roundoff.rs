//! The effect of rounding alone on rates of change, below which an error cannot shrink.
//!
//! In: the rates of a motion at one state, and the sizes of its numbers there. Out: the part of
//! each rate that is rounding. It is measured again at each request and never fed back, so an error
//! of the method cannot pass for rounding.

use crate::system::{MotionError, Rates};

/// The perturbations of successive numbers in units in the last place. They differ, so that no
/// symmetry of the motion hides their effect.
const UNITS: [f64; 5] = [2.0, -3.0, 1.0, -2.0, 3.0];

/// The number of perturbations tried.
const WAYS: usize = 3;

/// A state is beside a kink if a change of its numbers by this part of what they move by in the step leads over it.
const BESIDE_A_KINK: f64 = 1e-3;

pub(super) struct RatesPoint<'a> {
    pub(super) time: f64,
    pub(super) numbers: &'a [f64],
    /// The size of each number within the step.
    pub(super) sizes: &'a [f64],
    pub(super) step: f64,
}

/// Writes into `noise` the change of each rate when every number and the time change in their last places, and
/// when a number also changes by the rounding of its own rate over the step: a velocity that is nothing
/// but rounding is the rate of its coordinate. This distinguishes a rate that is zero only by
/// cancellation from one that is small, in any units. Across a kink a rate changes by more than
/// rounding, and the measurement is discarded; so it is beside one, where a rate may have no bound, as that of |x|^0.7, and changes by
/// much while the motion leaves it in a small part of the step.
pub(super) fn measure(
    rates: &mut Rates,
    place: &RatesPoint<'_>,
    noise: &mut [f64],
) -> Result<(), MotionError> {
    noise.fill(0.0);
    let mut here = vec![0.0; noise.len()];
    rates.evaluate(place.time, place.numbers, &mut here)?;
    let sides = rates.sides();
    let mut there = here.clone();
    let mut moved = place.numbers.to_vec();
    if sides.any() {
        for by in [BESIDE_A_KINK, -BESIDE_A_KINK] {
            for (j, x) in moved.iter_mut().enumerate() {
                let moves = (place.step * here[j]).abs();
                *x = place.numbers[j] + UNITS[j % UNITS.len()] * by * moves;
            }
            if rates.evaluate(place.time, &moved, &mut there).is_err()
                || !rates.sides().agrees(&sides)
            {
                return Ok(());
            }
        }
    }
    for pass in 0..2 {
        let own = noise.to_vec();
        for way in 0..WAYS {
            for (j, x) in moved.iter_mut().enumerate() {
                let change = f64::EPSILON * place.sizes[j] + (place.step * own[j]).abs();
                *x = place.numbers[j] + UNITS[(WAYS * pass + way + j) % UNITS.len()] * change;
            }
            if rates.evaluate(place.time, &moved, &mut there).is_err()
                || !rates.sides().agrees(&sides)
            {
                continue;
            }
            widen(noise, &there, &here, f64::EPSILON);
        }
    }
    // the rates are evaluated at times that are rounded, which is all there is of them where a ramp has just begun
    for time in [place.time.next_up(), place.time.next_down()] {
        if rates.evaluate(time, place.numbers, &mut there).is_ok() && rates.sides().agrees(&sides) {
            widen(noise, &there, &here, 0.0);
        }
    }
    Ok(())
}

/// Counts the differences between two sets of rates, and the rounding of each, as rounding.
fn widen(noise: &mut [f64], there: &[f64], here: &[f64], rounding: f64) {
    for ((noise, there), here) in noise.iter_mut().zip(there).zip(here) {
        let change = (there - here).abs() + rounding * here.abs();
        if change.is_finite() {
            *noise = noise.max(change);
        }
    }
}
