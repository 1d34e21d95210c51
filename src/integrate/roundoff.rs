//! What rounding alone does to rates of change: where an error cannot become smaller.
//!
//! In: the rates of a motion at one place, and how large its numbers are there. Out: how much of
//! each rate is rounding. It is measured afresh wherever it is asked for, and what was found is
//! never fed back: an error of the method cannot pass for rounding.

use crate::system::{MotionError, Rates};

/// By how many units in the last place the numbers are moved, in turn: unlike each other, so that
/// no symmetry of the motion hides what they do.
const UNITS: [f64; 5] = [2.0, -3.0, 1.0, -2.0, 3.0];

/// In how many ways the numbers are moved.
const WAYS: usize = 3;

/// Where the rates are asked for.
pub(super) struct Place<'a> {
    pub(super) time: f64,
    pub(super) numbers: &'a [f64],
    /// How large each number is within the step.
    pub(super) sizes: &'a [f64],
    pub(super) step: f64,
}

/// Writes into `noise` how much each rate changes where every number changes in its last places,
/// and once more where it changes also by what rounding of its own rate adds to it within the
/// step: a velocity that is nothing but rounding is the rate of its coordinate. A rate that is
/// zero by cancellation only is told apart by this from one that is small, whatever the units.
/// Across a kink a rate changes by more than rounding, and nothing is learnt.
pub(super) fn measure(
    rates: &mut Rates,
    place: &Place<'_>,
    noise: &mut [f64],
) -> Result<(), MotionError> {
    noise.fill(0.0);
    let mut here = vec![0.0; noise.len()];
    rates.evaluate(place.time, place.numbers, &mut here)?;
    let sides = rates.sides();
    let mut there = here.clone();
    let mut moved = place.numbers.to_vec();
    for pass in 0..2 {
        let own = noise.to_vec();
        for way in 0..WAYS {
            for (j, x) in moved.iter_mut().enumerate() {
                let change = f64::EPSILON * place.sizes[j] + (place.step * own[j]).abs();
                *x = place.numbers[j] + UNITS[(WAYS * pass + way + j) % UNITS.len()] * change;
            }
            if rates.evaluate(place.time, &moved, &mut there).is_err() || rates.sides() != sides {
                continue;
            }
            for ((noise, there), here) in noise.iter_mut().zip(&there).zip(&here) {
                let change = (there - here).abs() + f64::EPSILON * here.abs();
                if change.is_finite() {
                    *noise = noise.max(change);
                }
            }
        }
    }
    Ok(())
}
