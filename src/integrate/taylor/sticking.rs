//! Static friction in more than one direction: −μ v/|v| is undefined at v = 0, where it may be any
//! vector up to its strength.
//!
//! In: a state in which all velocities have reached zero. Out: whether the motion stays there, or the
//! rates with which it starts to move. It stays if a small velocity in any direction loses energy. This is
//! tested in many directions, including those in which all other forces pull. Never: the motion at rest,
//! which is `static_friction`, or the trial velocities themselves, which are `trial_velocities`.

use super::static_friction::{FIRST, RestUnderFriction};
use super::trial_velocities::TrialVelocities;
use crate::num::DoubleDouble;
use crate::system::{ExactRates, Form, MotionError, State, System};

/// Velocities below this part of their change in a typical step count as zero where friction
/// removes even more.
const SLOW: f64 = 1e-9;

/// Velocities below this part are nothing but rounding.
const NOTHING: f64 = 1e-15;

/// The trial velocity, in the same measure.
const TRIAL: f64 = 1e-12;

/// The ratio of the second trial velocity to the first, for the auxiliary numbers.
const SMALLER: f64 = 1e-3;

/// Friction that grows by more than this factor from the first to the second has a pole at rest: no vector of a limited
/// strength holds a motion there.
const POLE: f64 = 2.0;

/// Friction that is more than this part of the first at the second is dry: a drag is not, which shrinks as the velocity does.
const DRY: f64 = 0.5;

/// The maximal number of degrees of freedom that are tested in all directions.
const MOST: usize = 12;

pub(super) enum Sticking {
    /// The motion stays at rest: it is held by dry friction, or by a force that vanishes with the velocity.
    Stays { still: RestUnderFriction, dry: bool },
    /// The motion starts from this state, with these rates.
    SetsOut(State, Vec<DoubleDouble>),
    /// The motion is not at rest, or the test is inconclusive.
    Unknown,
}

/// Tests a state; `stride` is the length of a typical step.
pub(super) fn of(
    system: &System,
    rates: &mut ExactRates,
    parameters: &[f64],
    state: &State,
    stride: f64,
) -> Result<Sticking, MotionError> {
    let n = system.degrees();
    if state.form == Form::Variables || n > MOST || n == 0 {
        return Ok(Sticking::Unknown);
    }
    let mut still = state.clone();
    for i in n..2 * n {
        still.set(i, DoubleDouble::ZERO);
    }
    if state.form == Form::Momentum {
        // the momenta that belong to zero velocity
        let resting = State { form: Form::Velocity, ..still.clone() };
        let Ok(found) = system.convert(&resting, Form::Momentum, parameters) else {
            return Ok(Sticking::Unknown);
        };
        still = found;
    }
    let moved = |i: usize| (state.exact(i) - still.exact(i)).high.abs();
    let fastest = (n..2 * n).map(moved).fold(0.0, f64::max);
    let mut trial = TrialVelocities { system, rates, parameters, still, n, size: 1.0 };
    // the strength of the forces, sampled in one direction
    let mut some = vec![0.0; n];
    some[0] = 1.0;
    trial.size = if fastest > 0.0 { fastest } else { 1e-9 };
    let Some(pull) = trial.accelerations(&some)? else { return Ok(Sticking::Unknown) };
    let strength = pull.iter().fold(0.0_f64, |m, a| m.max(a.high.abs()));
    if strength == 0.0 || fastest > SLOW * strength * stride {
        return Ok(Sticking::Unknown);
    }
    trial.size = TRIAL * strength * stride;
    let Some(margin) = trial.margin()? else { return Ok(Sticking::Unknown) };
    if margin < 0.0 {
        return carried(trial, &some, stride);
    }
    if fastest > NOTHING * strength * stride {
        return Ok(Sticking::Unknown);
    }
    if !trial.has_friction()? {
        return Ok(Sticking::Unknown);
    }
    let Some((_, accelerations)) = trial.direction()? else { return Ok(Sticking::Unknown) };
    let mut toward = vec![DoubleDouble::ZERO; state.values.len()];
    toward[n..2 * n].copy_from_slice(&accelerations);
    Ok(Sticking::SetsOut(trial.still, toward))
}

/// Takes a first step from rest, for a motion that no collocation step starts.
pub(super) fn set_out(
    system: &System,
    rates: &mut ExactRates,
    parameters: &[f64],
    still: &State,
    (stride, limit): (f64, f64),
) -> Result<Option<(RestUnderFriction, State)>, MotionError> {
    let n = system.degrees();
    let size = TRIAL * stride;
    let mut trial =
        TrialVelocities { system, rates: &mut *rates, parameters, still: still.clone(), n, size };
    if !trial.has_friction()? {
        return Ok(None);
    }
    let onset = trial.onset(stride)?;
    let Some(state) = trial.first_step(FIRST * stride)? else { return Ok(None) };
    let none = vec![DoubleDouble::ZERO; still.values.len()];
    let (from, length) = (still.clone(), stride.abs());
    let mut still = RestUnderFriction::new(from, none, (n, system.moving()), (size, length));
    let state = still.begin(rates, (onset, state), limit)?;
    Ok(Some((still, state)))
}

/// The end of a motion: the rates of the auxiliary numbers and integrals, at rest or in the
/// limit of zero velocities.
fn carried(
    mut trial: TrialVelocities<'_>,
    some: &[f64],
    stride: f64,
) -> Result<Sticking, MotionError> {
    let moving = trial.system.moving();
    let len = trial.still.values.len();
    let size = trial.size;
    let mut rates = vec![DoubleDouble::ZERO; len];
    let mut samples = [vec![DoubleDouble::ZERO; len], vec![DoubleDouble::ZERO; len]];
    for sample in &mut samples {
        if trial.accelerations(some)?.is_none() {
            return Ok(Sticking::Unknown);
        }
        for (i, x) in sample.iter_mut().enumerate() {
            *x = trial.rates.rate(i);
        }
        trial.size *= SMALLER;
    }
    let n = trial.n;
    let [strength, nearer] =
        samples.each_ref().map(|rates| (n..2 * n).map(|i| rates[i].high.abs()).fold(0.0, f64::max));
    if nearer > POLE * strength {
        return Ok(Sticking::Unknown);
    }
    for i in moving..len {
        let (before, after) = (samples[0][i], samples[1][i]);
        // a rate that goes to zero with the velocity is zero
        let falls = after.high.abs() <= 2.0 * SMALLER * before.high.abs();
        rates[i] = if falls { DoubleDouble::ZERO } else { after };
    }
    let known = rates.iter().all(|x| x.is_finite());
    let (from, degrees) = (trial.still, trial.n);
    let still = RestUnderFriction::new(from, rates, (degrees, moving), (size, stride));
    // a drag proportional to the velocity vanishes with it
    let dry = nearer > DRY * strength;
    Ok(if known { Sticking::Stays { still, dry } } else { Sticking::Unknown })
}
