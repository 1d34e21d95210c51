//! How far a motion along a mode of small oscillations is displaced, so that its forces are nearly those of the mode.
//!
//! In: an equilibrium, the initial values at an amplitude, the amplitude that would be seen best. Out: that amplitude or a smaller
//! one. Never here: which mode, what is drawn.

use super::Present;
use crate::dynamics::{Equilibrium, PhaseSpace, VectorField};
use crate::ensemble::Start;
use crate::num::math;
use crate::system::InitialOverride;

/// The part of the forces, and of the velocities, that may come from beyond the first order.
const NONLINEAR: f64 = 0.1;

/// The most halvings: beyond, nothing would be seen of a mode.
const HALVINGS: u32 = 12;

/// The amplitude, at most the one that is wanted.
pub(super) fn mode_amplitude(
    present: &Present<'_>,
    one: &Equilibrium,
    wanted: f64,
    given: impl Fn(f64) -> Vec<InitialOverride>,
) -> f64 {
    let physics = present.physics;
    let (model, equations, system) = (physics.model, physics.equations, physics.system);
    let parameters = present.parameters;
    // where nothing can be compared it stays
    let Ok(space) = PhaseSpace::without_impulses((model, equations, system), parameters) else {
        return wanted;
    };
    let mut field = space.vector_field();
    let mut beyond = |amplitude: f64| {
        let (time, parameters) = (present.time, parameters.to_vec());
        let start = Start { time, parameters, overrides: given(amplitude) };
        let state = start.state(system).and_then(|state| space.state(&state)).ok()?;
        beyond_first_order(&mut field, time, (&one.variables, space.variables(&state)))
    };
    let mut amplitude = wanted;
    for _ in 0..HALVINGS {
        if beyond(amplitude).is_none_or(|part| part <= NONLINEAR) {
            break;
        }
        amplitude *= 0.5;
    }
    amplitude
}

/// The part of the rates at a displaced state that does not follow from their derivatives D at the equilibrium, of the
/// coordinates or of the momenta, whichever is greater. A motion that begins at rest has no velocity yet: rates are measured by
/// those that come a quarter of an oscillation later, ω times the displacement, with ω² = |D² η|/|η|.
fn beyond_first_order(
    field: &mut VectorField,
    time: f64,
    (rest, displaced): (&[f64], &[f64]),
) -> Option<f64> {
    field.evaluate(time, rest).ok()?;
    let (still, derivative) = (field.rate(), field.derivative());
    field.evaluate(time, displaced).ok()?;
    let moved = displaced.iter().zip(rest).map(|(x, y)| x - y);
    let moved = nalgebra::DVector::from_iterator(rest.len(), moved);
    let linear = &derivative * &moved;
    let other = field.rate() - still - &linear;
    let second = derivative * &linear;
    let half = rest.len() / 2;
    let size = |v: &nalgebra::DVector<f64>, from: usize| {
        v.iter().skip(from).take(half).fold(0.0, |sum, x| math::hypot(sum, *x))
    };
    let turning = (size(&second, 0) / size(&moved, 0)).sqrt();
    let turning = if turning.is_finite() { turning } else { 0.0 };
    let part = |from: usize| match size(&other, from) {
        0.0 => 0.0,
        other => other / size(&linear, from).max(turning * size(&moved, from)),
    };
    Some(part(0).max(part(half))).filter(|part| !part.is_nan())
}
