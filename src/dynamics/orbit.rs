//! Periodic orbits, with their multipliers.
//!
//! In: a state near the orbit, and what is held fixed. Out: the orbit's start, its period, the
//! multipliers of its monodromy matrix, its stability. Never here: families, text, the equations of an orbit.
//!
//! Newton's method begins at the first return near the start. Where it stalls along a resonance of tori, that is followed;
//! where no orbit is found, the search begins again at the returns after the first.

use nalgebra::{DMatrix, DVector};

use super::eigenvalue_error::eigenvalue_errors;
use super::error::DynamicsError;
use super::first_return::{difference, return_near};
use super::flow_direction::FlowDirection;
use super::linear;
use super::newton::{CLOSED, Fixed, Newton, NewtonIterate};
use super::orbit_units::OrbitUnits;
use super::phase_space::PhaseSpace;
use super::resonance::along_resonance;
use super::search_budget::SearchBudget;
use super::transverse::{self, Removed};
use super::unclosed_motion::explained;
use crate::integrate::{Method, Settings};
use crate::num::short;
use crate::system::State;

/// The returns at which a search begins, one after the other.
const RETURNS: usize = 5;

/// How often an orbit that was found may have been followed, or a factor of that: the shortest parts cost least.
const TURNS: [f64; 11] = [31.0, 29.0, 23.0, 19.0, 17.0, 13.0, 11.0, 7.0, 5.0, 3.0, 2.0];

/// What moves less than this part of its size in a period rests.
const STILL: f64 = 1e-6;

/// What moves less than this part of what the search began with has run into rest, where all is as small as its own rounding.
const VANISHED: f64 = 1e-12;

/// What closes but for more than rounding is an orbit only if one is this near, in its own units, by the derivatives.
const BESIDE: f64 = 1e-5;

/// The rounds in which steps of both kinds are taken.
const ROUNDS: usize = 4;

/// The part of a matrix by which rounding turns what is across an orbit.
const DIRECTIONS: f64 = 4.0 * f64::EPSILON;

/// A periodic orbit.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// The least time after which it closes.
    pub period: f64,
    /// One of those through which it passes.
    pub state: State,
    /// The value of H on it.
    pub energy: f64,
    /// The distance by which it does not close, relative to its size.
    pub closure: f64,
    /// Whether that is no more than rounding, or the tolerance, grown over a period.
    pub closes_to_rounding: bool,
    /// ∮ p dq, for canonical variables.
    pub action: Option<f64>,
    /// The monodromy matrix.
    pub monodromy: DMatrix<f64>,
    /// The same across the orbit, without the trivial directions.
    pub transverse: DMatrix<f64>,
    /// The multipliers of these, the largest first.
    pub multipliers: Vec<[f64; 2]>,
    /// The error of each, to first order in what rounding leaves of the matrix; infinite where that has no bound.
    pub errors: Vec<f64>,
    pub(super) is_symplectic: bool,
    /// The trivial directions, whose multipliers are 1.
    pub trivial: Removed,
    /// The functions whose level sets have trivial directions across them too: of a system that is given by brackets, its energy
    /// and its Casimirs.
    pub levels: Vec<String>,
    /// What rounding may leave of the entries of `transverse`, at most; `None` under constraints.
    pub rounding: Option<f64>,
    /// Whether no multiplier lies outside the unit circle, as far as rounding lets it be known.
    pub stable: bool,
    /// The step or tolerance used.
    pub settings: Settings,
}

impl Orbit {
    /// The orbit at a state from which the motion closes, without its action, which takes longer than the motion.
    ///
    /// # Errors
    /// Returns an error if the motion comes so near to a singularity of its law that nothing is known of the multipliers.
    pub(super) fn of(newton: &Newton<'_>, closed: &NewtonIterate) -> Result<Orbit, DynamicsError> {
        if let Some(why) = newton.singular(closed)? {
            return Err(DynamicsError::Singular(why));
        }
        let (space, circuit) = (newton.space, &closed.circuit);
        let rate = FlowDirection::new(space).at(&closed.state)?;
        let trivial = match (space.is_autonomous(), space.is_hamiltonian()) {
            (true, true) => Removed::FlowAndEnergy,
            (true, false) => Removed::Flow,
            (false, _) => Removed::Nothing,
        };
        let rate = newton.units.rates(&rate);
        let mut levels = Vec::new();
        let frame = if space.is_constrained() {
            transverse::frame_within(&circuit.basis, &rate, trivial)
        } else if let Some(functions) = space.levels() {
            let gradients = functions.at(&closed.state, space.parameters())?;
            let gradients: Vec<DVector<f64>> =
                gradients.iter().map(|level| newton.units.covector(&level.gradient)).collect();
            let (frame, independent) = transverse::frame_within_levels(&rate, trivial, &gradients);
            let names = functions.names().iter().zip(independent);
            levels.extend(names.filter(|(_, is_one)| *is_one).map(|(name, _)| name.clone()));
            frame
        } else {
            transverse::frame(&rate, trivial, space.is_hamiltonian())
        };
        let transverse = frame.transpose() * newton.units.map(&circuit.monodromy) * &frame;
        let multipliers = linear::eigenvalues(&transverse);
        let rounding = circuit.rounding.as_ref().map(|rounding| {
            let frame = frame.abs();
            let error = frame.transpose() * newton.units.map(&rounding.error) * &frame;
            // the directions across the orbit are known to rounding, too
            let turned = newton.units.map(&circuit.monodromy).abs() * frame;
            error.amax() + DIRECTIONS * turned.amax()
        });
        let errors = match rounding {
            Some(rounding) => {
                let error = transverse.map(|_| rounding.max(f64::EPSILON));
                eigenvalue_errors(&transverse, &error, &multipliers)
            }
            None => vec![f64::INFINITY; multipliers.len()],
        };
        let size = newton.size(&closed.state);
        let mut orbit = Orbit {
            period: closed.period,
            energy: space.system().energy(&closed.state, space.parameters())?,
            closure: closed.residual / size.max(f64::MIN_POSITIVE),
            closes_to_rounding: closed.is_rounding(),
            action: None,
            state: closed.state.clone(),
            monodromy: circuit.monodromy.clone(),
            transverse,
            multipliers,
            trivial,
            levels,
            errors,
            is_symplectic: space.is_hamiltonian(),
            rounding,
            stable: false,
            settings: circuit.settings,
        };
        orbit.stable = orbit.known().none_is_outside();
        Ok(orbit)
    }
}

/// Finds the periodic orbit near a state of the space. Without a given period the search begins at the first returns near
/// the start.
///
/// # Errors
/// Returns an error if there is none nearby, which says what the motion is instead; if the motion cannot be followed; or on
/// cancellation.
pub fn periodic_orbit(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    period: Option<f64>,
    fixed: Fixed,
) -> Result<Orbit, DynamicsError> {
    let found = nearest_orbit(space, method, start, (period, fixed), &|_, _| ());
    found.map_err(|error| explained(error, space, method, start, &mut |_, _| ()))
}

/// Finds the orbit of [`periodic_orbit`], without saying in an error what the motion is instead. `report` is given the
/// number of steps taken and its maximum.
///
/// # Errors
/// Returns an error if there is none nearby; if the motion cannot be followed; or on cancellation.
pub fn nearest_orbit(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    (period, fixed): (Option<f64>, Fixed),
    report: &dyn Fn(u64, u64),
) -> Result<Orbit, DynamicsError> {
    let budget = SearchBudget::of(method.0, report);
    let found = searched(space, method, start, (period, fixed), &budget)?;
    found.map_err(|missed| missed.error(&budget))
}

/// The orbit, or by how much the best one misses itself.
pub(super) fn searched(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    (period, fixed): (Option<f64>, Fixed),
    budget: &SearchBudget<'_>,
) -> Result<Result<Orbit, Missed>, DynamicsError> {
    let period = match (period, fixed) {
        (Some(period), _) | (None, Fixed::Period(period)) => Some(period),
        (None, _) if !space.is_autonomous() => {
            return Err(unsuited(
                "the law of motion depends on time, and not by sines and cosines of a common period alone: \
                 give the period of the orbit, a multiple of that of the law",
            ));
        }
        (None, _) => None,
    };
    let Some(period) = period else { return near_returns(space, method, start, (fixed, budget)) };
    let fixed = if space.is_autonomous() { fixed } else { Fixed::Period(period) };
    if !(period > 0.0 && period.is_finite()) {
        return Err(unsuited("a period must be above zero"));
    }
    closed_near(space, method, (start, period), (fixed, budget))
}

/// The orbit near the first return from which the search comes to one.
fn near_returns(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    (fixed, budget): (Fixed, &SearchBudget<'_>),
) -> Result<Result<Orbit, Missed>, DynamicsError> {
    let (mut best, mut singular): (Option<Missed>, Option<DynamicsError>) = (None, None);
    for count in 0..RETURNS {
        let found = match return_near(space, method, start, count) {
            Ok(period) => closed_near(space, method, (start, period), (fixed, budget)),
            Err(error) => Err(error),
        };
        match (found, &best) {
            (Ok(Ok(orbit)), _) => return Ok(Ok(orbit)),
            (Err(error), _) if error.is_cancelled() => return Err(error),
            (Err(error @ DynamicsError::Singular(_)), _) => singular = singular.or(Some(error)),
            (Err(error), None) => return Err(singular.unwrap_or(error)),
            // of later returns there may be none
            (Err(_), Some(_)) => {}
            (Ok(Err(missed)), before) => {
                if before.as_ref().is_none_or(|before| missed.part < before.part) {
                    best = Some(missed);
                }
            }
        }
    }
    match singular {
        Some(error) => Err(error),
        None => best.map(Err).ok_or_else(|| unsuited("no periodic orbit was searched for")),
    }
}

/// None was found: by how much the best one misses itself, as a part of its size, and that in words.
pub(super) struct Missed {
    part: f64,
    why: String,
}

impl Missed {
    fn error(self, budget: &SearchBudget<'_>) -> DynamicsError {
        let ended = budget.ended().map_or_else(String::new, |ended| format!("; {ended}"));
        DynamicsError::Unclosed(self.why + &ended)
    }
}

fn closed_near(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    (start, period): (&State, f64),
    (fixed, budget): (Fixed, &SearchBudget<'_>),
) -> Result<Result<Orbit, Missed>, DynamicsError> {
    let apart = |state: &State| difference(space, state, start);
    let units = OrbitUnits::of_motion(space, method, (start, period), apart)?;
    let casimirs = space.casimirs(start)?;
    let newton = Newton { space, method, fixed, units, casimirs, budget: Some(budget) };
    let period = newton.settled(start, period);
    let mut closed = match solve(&newton, start, period)? {
        Ok(closed) => closed,
        Err(missed) => return Ok(Err(missed)),
    };
    // the same orbit may have been followed several times
    if !matches!(fixed, Fixed::Period(_)) {
        for parts in TURNS {
            while let Some(shorter) = part(&newton, &closed, parts)? {
                closed = shorter;
            }
        }
    }
    Orbit::of(&newton, &closed)?.with_action(space, method).map(Ok)
}

fn unsuited(why: &str) -> DynamicsError {
    DynamicsError::Unsuited(why.to_owned())
}

fn solve(
    newton: &Newton<'_>,
    start: &State,
    period: f64,
) -> Result<Result<NewtonIterate, Missed>, DynamicsError> {
    let begun = newton.reached(start.clone(), period)?;
    let speed = begun.circuit.rates[0].norm();
    let found = polished(newton, begun, period)?;
    // rest is an equilibrium; under a drive it may be one of the orbits that have its period. At the origin a state is as
    // small as its rates, and what does not close is compared with what the search began with
    let turned = found.period / newton.units.time();
    let circuit = &found.circuit;
    // what a motion moves by in a period may be much larger than where it is
    let near = newton.size(start).max(newton.size(&found.state)).min(circuit.size);
    let (moved, open) = (circuit.rates[0].norm() * turned, found.residual > CLOSED * near);
    let still = is_still(moved, circuit.size, speed, open);
    if newton.space.is_autonomous() && still {
        return Ok(Err(Missed { part: f64::INFINITY, why: rest(newton, &found.state) }));
    }
    let part = found.residual / near.max(f64::MIN_POSITIVE);
    let why = if open {
        "the best one misses itself by"
    } else if !found.is_rounding() && !is_beside(newton.step_left(&found)) {
        // along a resonance of tori a motion nearly closes everywhere
        "along a resonance of tori motions nearly close everywhere, and the best one still misses itself by"
    } else {
        return Ok(Ok(found));
    };
    let why = format!(
        "no periodic orbit was found near the start: {why} {part:.1e} of its size after {}",
        short(found.period)
    );
    Ok(Err(Missed { part, why }))
}

/// Whether an orbit is so near, by the step that Newton's method has left, that what does not close is rounding.
fn is_beside(step_left: Option<f64>) -> bool {
    step_left.is_some_and(|step| step <= BESIDE)
}

/// Where Newton's steps and those along a resonance come to by turns, for as long as they leave less missing.
fn polished(
    newton: &Newton<'_>,
    begun: NewtonIterate,
    period: f64,
) -> Result<NewtonIterate, DynamicsError> {
    let mut found = newton.approach(begun, period)?;
    for _ in 0..ROUNDS {
        if found.is_exact() {
            break;
        }
        let before = found.residual;
        found = along_resonance(newton, found, period)?;
        if found.is_rounding() || found.residual > 0.5 * before {
            break;
        }
        found = newton.approach(found, period)?;
    }
    Ok(found)
}

/// The orbit after a part of its period, if it closes there already.
///
/// # Errors
/// Returns an error on cancellation; where the motion cannot be followed, it closes after the whole period alone.
fn part(
    newton: &Newton<'_>,
    closed: &NewtonIterate,
    parts: f64,
) -> Result<Option<NewtonIterate>, DynamicsError> {
    let shorter = || -> Result<Option<NewtonIterate>, DynamicsError> {
        let begun = newton.reached(closed.state.clone(), closed.period / parts)?;
        if begun.residual > 1e-6 * begun.circuit.size {
            return Ok(None);
        }
        Ok(solve(newton, &closed.state, closed.period / parts)?.ok())
    };
    match shorter() {
        Err(why) if why.is_cancelled() => Err(why),
        Err(_) => Ok(None),
        found => found,
    }
}

/// What was found is an equilibrium, which closes after any time.
fn rest(newton: &Newton<'_>, state: &State) -> String {
    let variables = newton.space.variables(state);
    let sizes = newton.units.scaled(&DVector::from_column_slice(variables));
    let place: Vec<String> = (newton.space.names().iter().zip(variables).zip(sizes.iter()))
        .map(|((name, value), size)| {
            format!("{name} = {}", short(if size.abs() <= STILL { 0.0 } else { *value }))
        })
        .collect();
    format!(
        "no periodic orbit was found near the start: the search ended at the equilibrium {}; begin farther from it, or \
         with another period or energy",
        place.join(", ")
    )
}

/// Whether what moves so fast is at rest, beside the size of its orbit and the speed with which the search began: where an
/// orbit closes, only what has vanished beside that speed.
fn is_still(moved: f64, size: f64, speed: f64, open: bool) -> bool {
    moved < STILL * size || moved <= if open { STILL } else { VANISHED } * speed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rest_is_a_millionth_of_the_orbit_and_of_the_speed_where_it_is_open_and_else_nothing() {
        for (moved, size, speed, open, still) in [
            (0.9e-6, 1.0, 0.0, false, true),
            (1.1e-6, 1.0, 0.0, false, false),
            (0.9e-6, 0.0, 1.0, true, true),
            (1.1e-6, 0.0, 1.0, true, false),
            (0.9e-6, 0.0, 1.0, false, false),
            (0.9e-12, 0.0, 1.0, false, true),
            (1.1e-12, 0.0, 1.0, false, false),
        ] {
            assert_eq!(
                is_still(moved, size, speed, open),
                still,
                "{moved:e} of {size:e}, {speed:e}"
            );
        }
    }

    #[test]
    fn an_orbit_is_beside_a_motion_within_a_hundred_thousandth_of_its_size() {
        assert!(is_beside(Some(0.8e-5)) && !is_beside(Some(1.25e-5)) && !is_beside(None));
    }
}
