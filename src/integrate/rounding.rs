//! What rounding alone does to rates of change: where an error cannot become smaller.

use crate::system::{Fault, Rates};

/// By how many units in the last place the numbers are moved, in turn: unlike each other, so that
/// no symmetry of the motion hides what they do.
const UNITS: [f64; 5] = [2.0, -3.0, 1.0, -2.0, 3.0];

/// Raises `noise` to how much each rate changes where every number of a state changes in its last
/// places, and by what the noise known so far makes of it in a step; `slope` is the rates at the
/// state, `round` counts the tries, which all differ. A rate that is zero by cancellation only is
/// told apart by this from one that is small, whatever the units.
pub(super) fn listen(
    rates: &mut Rates,
    (time, numbers): (f64, &[f64]),
    slope: &[f64],
    (step, round): (f64, usize),
    noise: &mut [f64],
) -> Result<(), Fault> {
    let units = UNITS.iter().cycle().skip(round % UNITS.len());
    let moved = numbers.iter().zip(noise.iter()).zip(units).map(|((x, noise), units)| {
        let last_place = f64::EPSILON * x.abs() + (step * noise).abs();
        x + units * (1 + round) as f64 * last_place
    });
    let moved: Vec<f64> = moved.collect();
    let mut there = vec![0.0; slope.len()];
    rates.evaluate(time, &moved, &mut there)?;
    for ((noise, there), here) in noise.iter_mut().zip(&there).zip(slope) {
        let change = (there - here).abs() + f64::EPSILON * here.abs();
        if change.is_finite() {
            *noise = noise.max(change);
        }
    }
    Ok(())
}
