//! Conjugate points: where neighbouring motions from the same place meet again to first order.
//!
//! In: a motion from a state. Out: the times at which ∂q(t)/∂p(0) is singular, each as often as it
//! loses rank; or at which neighbouring ways of the same energy meet. Never here: the path between two ends.
//! Source: V. I. Arnold, Mathematical Methods of Classical Mechanics, app. 11; of equal energy, where the envelope of the
//! ways from a point is touched: C. G. J. Jacobi, Vorlesungen über Dynamik, 6th lecture.

use nalgebra::DMatrix;

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::num::{false_position, golden_section};
use crate::system::State;

/// The parts of a step at which the determinant is evaluated.
const PARTS: u32 = 16;

/// Enough secants and halves for a zero to the last digit, and golden sections for a least value to half the digits.
const ROUNDS: u32 = 200;
const SECTIONS: u32 = 60;

/// A matrix has lost rank where a singular value is this small beside the largest that it has had.
const LOST: f64 = 1e-5;

/// The times after the start, up to a duration, at which ∂q/∂p(0) is singular (conjugate points).
///
/// # Errors
/// Returns an error if the motion cannot be followed.
pub fn conjugate_points(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    duration: f64,
) -> Result<Vec<f64>, DynamicsError> {
    let n = space.dimension() / 2;
    let momenta = DMatrix::from_fn(2 * n, n, |i, j| if i == n + j { 1.0 } else { 0.0 });
    singular(space, (method, settings), (start, &momenta), duration)
}

/// The times after the start, up to a duration, at which curves of equal energy from the same place meet to first order,
/// touching their envelope. With one coordinate these are the turning points.
///
/// # Errors
/// Returns an error if the motion cannot be followed, does not conserve its energy, or begins at rest.
pub fn conjugate_points_at_energy(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    duration: f64,
) -> Result<Vec<f64>, DynamicsError> {
    let unsuited = |why: &str| Err(DynamicsError::Unsuited(why.to_owned()));
    if !(space.is_hamiltonian() && space.is_autonomous()) {
        return unsuited("the energy of this motion is not conserved");
    }
    let n = space.dimension() / 2;
    let mut field = space.vector_field();
    field.evaluate(start.time, space.variables(start))?;
    // along the motion its own rate is carried into its own rate
    let rate = field.rate();
    let velocity = rate.rows(0, n).into_owned();
    let speed = velocity.norm();
    if n > 1 && !speed.is_normal() {
        return unsuited("the motion begins at rest, and its way has no direction there");
    }
    // δE = q̇·δp vanishes on what is perpendicular to q̇: the columns of a reflection that takes the first axis there
    let mut mirror = velocity / speed;
    mirror[0] += if mirror[0] < 0.0 { -1.0 } else { 1.0 };
    let twice = 2.0 / mirror.norm_squared();
    let vectors = DMatrix::from_fn(2 * n, n, |i, j| match (i.checked_sub(n), j) {
        (_, 0) => rate[i],
        (None, _) => 0.0,
        (Some(i), j) => f64::from(u8::from(i == j)) - twice * mirror[i] * mirror[j],
    });
    singular(space, (method, settings), (start, &vectors), duration)
}

/// The times at which the upper half of the vectors that a motion carries is singular.
fn singular(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    (start, vectors): (&State, &DMatrix<f64>),
    duration: f64,
) -> Result<Vec<f64>, DynamicsError> {
    let n = vectors.ncols();
    let mut carrier = Carrier::new(space, method, settings, n)?;
    carrier.start(start, vectors)?;
    let until = start.time + duration;
    let mut found: Vec<f64> = Vec::new();
    let mut largest = 0.0_f64;
    // at the start the determinant grows like tⁿ, with one sign
    let mut seen: Vec<(f64, f64)> = Vec::new();
    while carrier.time() < until {
        carrier.step(until)?;
        let (begin, end) = carrier.interval();
        let end = end.min(until);
        for part in 1..=PARTS {
            let time = begin + (end - begin) * f64::from(part) / f64::from(PARTS);
            let matrix = block(&mut carrier, time)?;
            largest = largest.max(matrix.amax());
            let value = (matrix / largest).determinant();
            seen.push((time, value));
            let [.., a, b] = seen[..] else { continue };
            let earlier = if seen.len() > 2 { Some(seen[seen.len() - 3]) } else { None };
            let inside = |time: f64| time >= begin;
            if a.1 != 0.0 && a.1.signum() != b.1.signum() && inside(a.0) {
                let [time, _] = false_position([a, b], (ROUNDS, 0.0), |time| {
                    determinant(&mut carrier, largest, time)
                })?;
                add(&mut carrier, largest, time, start.time, &mut found)?;
            } else if let Some(c) = earlier
                && c.1.signum() == a.1.signum()
                && a.1.abs() < c.1.abs()
                && a.1.abs() <= b.1.abs()
                && n > 1
                && inside(c.0)
            {
                // a double zero has no change of sign
                let [from, to] = golden_section([c.0, b.0], SECTIONS, |time| {
                    Ok::<_, DynamicsError>(determinant(&mut carrier, largest, time)?.abs())
                })?;
                let time = f64::midpoint(from, to);
                let smallest = singular_values(&mut carrier, time)?;
                if rank_lost(&smallest, largest) > 1 {
                    add(&mut carrier, largest, time, start.time, &mut found)?;
                }
            }
        }
    }
    Ok(found)
}

/// The upper half of the vectors, as ∂q/∂p(0), at a time within the last step.
fn block(carrier: &mut Carrier, time: f64) -> Result<DMatrix<f64>, DynamicsError> {
    let (_, vectors) = carrier.at(time)?;
    let n = vectors.ncols();
    Ok(vectors.rows(0, n).into_owned())
}

/// Its singular values, ascending.
fn singular_values(carrier: &mut Carrier, time: f64) -> Result<Vec<f64>, DynamicsError> {
    let mut values: Vec<f64> = block(carrier, time)?.singular_values().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    Ok(values)
}

/// Adds a time as often as the matrix loses rank there.
fn add(
    carrier: &mut Carrier,
    largest: f64,
    time: f64,
    start: f64,
    found: &mut Vec<f64>,
) -> Result<(), DynamicsError> {
    let values = singular_values(carrier, time)?;
    let lost = rank_lost(&values, largest).max(1);
    found.extend(std::iter::repeat_n(time - start, lost));
    Ok(())
}

/// By how much the rank of a matrix with these singular values is less, where `largest` is the largest that it has had.
fn rank_lost(values: &[f64], largest: f64) -> usize {
    values.iter().filter(|&&value| value <= LOST * largest).count()
}

/// The determinant at a time, over the `largest` entry that the matrix has had.
fn determinant(carrier: &mut Carrier, largest: f64, time: f64) -> Result<f64, DynamicsError> {
    Ok((block(carrier, time)? / largest).determinant())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rank_is_lost_below_1e_5_of_the_largest_singular_value() {
        for (values, lost) in [
            ([0.0, 1.9e-5, 1.0], 2),
            ([0.0, 2.1e-5, 1.0], 1),
            ([1.9e-5, 1.9e-5, 1.9e-5], 3),
            ([2.1e-5, 2.1e-5, 2.1e-5], 0),
        ] {
            assert_eq!(rank_lost(&values, 2.0), lost, "{values:?}");
        }
    }
}
