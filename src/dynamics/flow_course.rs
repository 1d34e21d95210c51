//! The derivative of the flow at several times of one motion: M(t) = ∂η(t)/∂η(0) with its determinant and ‖M𝕁Mᵀ − 𝕁‖.
//!
//! In: a state, times. Out: [`FlowAtTime`]s. Under a method of fixed step M is that of the method's own map, and the times are
//! those at which its steps end. Never here: constraints, what rounding leaves ([`flow_map`](super::flow_map)).

use nalgebra::DMatrix;

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::flow_map::Divergence;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::num::math;
use crate::system::{Form, MotionError, State};

/// The derivative of a motion by its initial values, at one time.
#[derive(Clone, PartialEq, Debug)]
pub struct FlowAtTime {
    /// When the derivative is taken.
    pub time: f64,
    /// ∂η_i(t)/∂η_j(0).
    pub matrix: DMatrix<f64>,
    /// What volumes have grown by.
    pub determinant: f64,
    /// exp ∫ div f dt along the motion, times the determinants of its impulses: 1 where nothing but H acts.
    pub determinant_expected: f64,
    /// Whether rounding leaves nothing of it: products of the entries of M cancel.
    pub determinant_lost: bool,
    /// The largest entry of |M𝕁Mᵀ − 𝕁|; `None` if the variables are not canonical.
    pub symplectic_residual: Option<f64>,
    /// What rounding of M in so many steps leaves of that entry.
    pub symplectic_rounding: Option<f64>,
    /// The same of whichever entry it leaves the most of.
    pub rounding_floor: f64,
    /// Whether it is no more than what rounding leaves of large entries of M.
    pub residual_lost: bool,
}

/// What rounding may leave of det M and of an entry of 𝕁 that is no longer small beside 1.
const NOT_SMALL: f64 = 1e-3;

/// How many times its estimate rounding may be: that of M alone, and that of M in so many steps.
const TIMES: f64 = 64.0;
const TIMES_IN_STEPS: f64 = 16.0;

/// Follows a motion from a state of the space through increasing times, and `report`s the time after each step. A motion that cannot
/// continue has the derivatives up to there, and the error.
///
/// # Errors
/// Returns an error if the motion cannot begin, or M cannot be evaluated.
pub fn flow_course(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    times: &[f64],
    report: &mut dyn FnMut(f64),
) -> Result<(Vec<FlowAtTime>, Option<MotionError>), DynamicsError> {
    let n = space.dimension();
    let mut carrier = Carrier::new(space, method, settings, n)?;
    carrier.start(start, &DMatrix::identity(n, n))?;
    let mut divergence = Divergence::of(space, method);
    let (mut logarithm, mut done) = (0.0, start.time);
    let mut flows = Vec::new();
    let mut waiting = times;
    while let Some(&last) = waiting.last() {
        let jumped = carrier.jump_determinant();
        if let Err(error) = carrier.step(last) {
            return Ok((flows, Some(error)));
        }
        let (_, end) = carrier.interval();
        let passed = waiting.partition_point(|&time| time <= end);
        let (reached, left) = waiting.split_at(passed);
        // a state inside a step of fixed size is no state of the method's own map
        let within = if carrier.is_fixed() { &reached[..0] } else { reached };
        let at_end = carrier.is_fixed() && !reached.is_empty();
        for time in within.iter().copied().chain(at_end.then_some(end)) {
            logarithm += divergence.along(space, &mut carrier, [done, time])?;
            done = time;
            let (_, matrix) = carrier.at(time)?;
            let steps = carrier.steps();
            // an impulse acts at the end of a step
            let jumped = if time < end { jumped } else { carrier.jump_determinant() };
            let expected = math::exp(logarithm) * jumped;
            flows.push(FlowAtTime::of(space, (time, steps), matrix, expected));
        }
        if !left.is_empty() && done < end {
            logarithm += divergence.along(space, &mut carrier, [done, end])?;
            done = end;
        }
        waiting = left;
        report(end);
    }
    Ok((flows, None))
}

impl FlowAtTime {
    /// Whether ‖M𝕁Mᵀ − 𝕁‖ is no more than what rounding leaves of it: M is symplectic as far as can be known.
    pub fn is_at_rounding(&self) -> bool {
        let known = self.symplectic_residual.zip(self.symplectic_rounding);
        known.is_some_and(|(residual, rounding)| residual <= TIMES_IN_STEPS * rounding)
    }

    fn of(
        space: &PhaseSpace,
        (time, steps): (f64, u64),
        matrix: DMatrix<f64>,
        determinant_expected: f64,
    ) -> FlowAtTime {
        let none = DMatrix::zeros(matrix.nrows(), matrix.ncols());
        let residual = || PhaseSpace::symplectic_residual(&matrix, &none);
        let residual = (space.form() == Form::Momentum).then(residual);
        let lost = |(residual, rounding): (f64, f64)| {
            let rounding = TIMES * rounding;
            rounding >= NOT_SMALL && residual <= rounding
        };
        let determinant = matrix.determinant();
        // Hadamard's bound, each column measured by its largest entry, so that units do not count
        let columns: Vec<f64> = matrix.column_iter().map(|column| column.amax()).collect();
        let scaled = |row: usize| {
            let entries = columns.iter().enumerate();
            entries.fold(0.0, |sum, (j, c)| math::hypot(sum, matrix[(row, j)] / c))
        };
        let bound: f64 =
            columns.iter().product::<f64>() * (0..matrix.nrows()).map(scaled).product::<f64>();
        // errors of different steps are independent, so that their squares add up
        let in_steps = (steps as f64).max(1.0).sqrt();
        // |M| |𝕁|
        let n = matrix.ncols();
        let swapped = DMatrix::from_fn(n, n, |i, j| matrix[(i, (j + n / 2) % n)].abs());
        FlowAtTime {
            time,
            determinant,
            determinant_expected,
            determinant_lost: f64::EPSILON * bound >= NOT_SMALL * determinant_expected.abs(),
            symplectic_residual: residual.map(|(largest, _)| largest),
            symplectic_rounding: residual.map(|(_, rounding)| rounding * in_steps),
            rounding_floor: (swapped * matrix.abs().transpose()).amax() * f64::EPSILON * in_steps,
            residual_lost: residual.is_some_and(lost),
            matrix,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_symplectic_up_to_sixteen_times_its_rounding() {
        let flow = |residual: f64| FlowAtTime {
            time: 1.0,
            matrix: DMatrix::identity(2, 2),
            determinant: 1.0,
            determinant_expected: 1.0,
            determinant_lost: false,
            symplectic_residual: Some(residual),
            symplectic_rounding: Some(1e-15),
            rounding_floor: 1e-15,
            residual_lost: false,
        };
        assert!(flow(0.0).is_at_rounding() && flow(15.9e-15).is_at_rounding());
        assert!(!flow(16.1e-15).is_at_rounding() && !flow(f64::NAN).is_at_rounding());
        let unknown = FlowAtTime { symplectic_residual: None, ..flow(0.0) };
        assert!(!unknown.is_at_rounding());
    }
}
