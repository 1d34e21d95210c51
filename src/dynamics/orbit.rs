//! Periodic orbits: closed by Newton's method on the flow map, with their multipliers.
//!
//! In: a state near the orbit, and what is held fixed. Out: the orbit's start, its period, the
//! multipliers of its monodromy matrix, its stability. Never here: families, text.
//!
//! Unknown are the state and the period; the equations are that the motion closes, that the state
//! does not move along the orbit, and that the energy (or the period) is the given one. They are
//! solved by least squares, because with a conserved energy one of them follows from the others, and
//! symmetries leave a choice (Viswanath, SIAM Review 43 (2001) 478, has the method). Under constraints the state moves by
//! displacements that they allow, and back onto them.

use nalgebra::{DMatrix, DVector};

use super::direction::{Direction, basis_of_range};
use super::error::DynamicsError;
use super::first_return::{difference, first_return};
use super::flow_map::flow_map;
use super::linear;
use super::loop_action::loop_action;
use super::orbit_units::OrbitUnits;
use super::phase_space::PhaseSpace;

use super::transverse::{self, Removed};
use crate::integrate::{Method, Settings};
use crate::num::{DoubleDouble, math, short};
use crate::system::State;

/// The maximal number of steps of Newton's method, and of halvings of one.
const STEPS: usize = 50;
const HALVINGS: u32 = 10;

/// The maximal number of corrections of the period alone, before those of the state.
const SETTLINGS: usize = 6;

/// An orbit is closed up to this part of its size.
const CLOSED: f64 = 1e-9;

/// What moves less than this part of its size in a period rests.
const STILL: f64 = 1e-6;

/// A residual below this part of the size is rounding.
const ROUNDING: f64 = 2e-15;

/// A multiplier this close to the unit circle lies on it.
const ON_CIRCLE: f64 = 1e-6;

/// What is the same for the orbit that is searched for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Fixed {
    /// The energy.
    Energy(f64),
    /// The period.
    Period(f64),
    /// Neither: a limit cycle.
    Nothing,
}

/// A periodic orbit.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// The period.
    pub period: f64,
    /// A state on it.
    pub state: State,
    /// The energy there.
    pub energy: f64,
    /// The distance by which it does not close, relative to its size.
    pub closure: f64,
    /// ∮ p dq, for canonical variables.
    pub action: Option<f64>,
    /// The monodromy matrix.
    pub monodromy: DMatrix<f64>,
    /// The same across the orbit, without the trivial directions.
    pub transverse: DMatrix<f64>,
    /// The multipliers of these, the largest first.
    pub multipliers: Vec<[f64; 2]>,
    /// The trivial directions, whose multipliers are 1.
    pub trivial: Removed,
    /// Whether no multiplier lies outside the unit circle.
    pub stable: bool,
    /// The step or tolerance used.
    pub settings: Settings,
}

impl Orbit {
    /// Greene's residue (2 − tr M)/4, where two multipliers are left and areas across the orbit are preserved: between 0 and 1 the orbit is elliptic, below 0
    /// hyperbolic, above 1 hyperbolic with reflection (J. M. Greene, J. Math. Phys. 20 (1979) 1183).
    pub fn residue(&self) -> Option<f64> {
        let across = &self.transverse;
        let preserves = across.nrows() == 2 && (across.determinant() - 1.0).abs() <= ON_CIRCLE;
        preserves.then(|| (2.0 - across.trace()) / 4.0)
    }

    /// The characteristic exponent ln|μ|/T of a multiplier μ: the Lyapunov exponent along its direction.
    pub fn exponent(&self, [re, im]: [f64; 2]) -> f64 {
        math::ln(math::hypot(re, im)) / self.period
    }

    /// The angle by which a pair of multipliers e^{±2πiν} turns in a period, in turns: 0 < ν < ½, or nothing off the unit circle.
    pub fn rotation(&self, [re, im]: [f64; 2]) -> Option<f64> {
        let on_circle = im != 0.0 && (math::hypot(re, im) - 1.0).abs() <= ON_CIRCLE;
        on_circle.then(|| math::atan2(im.abs(), re) / core::f64::consts::TAU)
    }
}

/// Finds the periodic orbit near a state of the space. Without a period it begins at the first
/// return near the start.
///
/// # Errors
/// Returns an error if there is none nearby, if the motion cannot be followed, or on cancellation.
pub fn periodic_orbit(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    period: Option<f64>,
    fixed: Fixed,
) -> Result<Orbit, DynamicsError> {
    let period = match (period, fixed) {
        (Some(period), _) | (None, Fixed::Period(period)) => period,
        (None, _) if !space.is_autonomous() => {
            return Err(unsuited(
                "the law of motion depends on time, and not by sines and cosines of a common period alone: \
                 give the period of the orbit, a multiple of that of the law",
            ));
        }
        (None, _) => first_return(space, method, start)?,
    };
    let fixed = if space.is_autonomous() { fixed } else { Fixed::Period(period) };
    if !(period > 0.0 && period.is_finite()) {
        return Err(unsuited("a period is above zero"));
    }
    let apart = |state: &State| difference(space, state, start);
    let units = OrbitUnits::of_motion(space, method, (start, period), apart)?;
    let mut newton = Newton { space, method, fixed, units };
    let period = newton.settled(start, period);
    let mut closed = newton.solve(start, period)?;
    // the same orbit may have been followed several times
    if !matches!(fixed, Fixed::Period(_)) {
        for parts in [5.0, 3.0, 2.0] {
            while let Some(shorter) = newton.part(&closed, parts) {
                closed = shorter;
            }
        }
    }
    newton.described(&closed)
}

fn unsuited(why: &str) -> DynamicsError {
    DynamicsError::Unsuited(why.to_owned())
}

/// A state whose motion closes after a time, and the derivative of that motion.
struct Closed {
    state: State,
    period: f64,
    residual: f64,
    monodromy: DMatrix<f64>,
    settings: Settings,
}

pub(super) struct Newton<'a> {
    pub(super) space: &'a PhaseSpace,
    pub(super) method: (&'static Method, Settings),
    pub(super) fixed: Fixed,
    pub(super) units: OrbitUnits,
}

/// The motion over one period, in the units of the orbit but for the monodromy matrix and the energy.
pub(super) struct Look {
    miss: DVector<f64>,
    monodromy: DMatrix<f64>,
    /// The displacements that constraints allow at the start, as columns of unit length; all without constraints.
    basis: DMatrix<f64>,
    /// The rates at its two ends.
    rates: [DVector<f64>; 2],
    energy: f64,
    pub(super) size: f64,
    settings: Settings,
}

impl Newton<'_> {
    pub(super) fn look(&self, state: &State, period: f64) -> Result<Look, DynamicsError> {
        let (space, method) = (self.space, self.method);
        let map = flow_map(space, method, state, state.time + period, &mut |_| {})?;
        if let Some(fault) = map.failure {
            return Err(fault.into());
        }
        let mut direction = Direction::new(space);
        let rates = [direction.at(state)?, direction.at(&map.state)?];
        let miss = self.units.scaled(&difference(space, &map.state, state));
        let energy = space.system().energy(state, space.parameters())?;
        let rates = rates.map(|rate| self.units.rates(&rate));
        let basis = self.basis(state)?;
        let size = self.size(state).max(rates[0].amax() * (period / self.units.time()).min(1.0));
        Ok(Look { miss, monodromy: map.matrix, basis, rates, energy, size, settings: map.settings })
    }

    /// The displacements that constraints allow, in the units of the orbit.
    fn basis(&self, state: &State) -> Result<DMatrix<f64>, DynamicsError> {
        let (allowed, dimension) = self.space.allowed_displacements(state)?;
        if !self.space.is_constrained() {
            return Ok(allowed);
        }
        Ok(basis_of_range(&self.units.map(&allowed), dimension))
    }

    /// A state displaced by as much, on the constraints.
    fn displaced(&self, state: &State, by: &DVector<f64>) -> Result<State, DynamicsError> {
        let mut there = state.clone();
        for i in 0..self.space.dimension() {
            there.set(i, state.exact(i) + DoubleDouble::from(by[i]));
        }
        let (system, parameters) = (self.space.system(), self.space.parameters());
        let Some(mut projector) = system.projector(parameters) else { return Ok(there) };
        let mut native = system.convert(&there, system.form(), parameters)?;
        projector.project(&mut native)?;
        Ok(self.space.state(&native)?)
    }

    /// The size of a state.
    fn size(&self, state: &State) -> f64 {
        let variables = DVector::from_column_slice(self.space.variables(state));
        self.units.scaled(&variables).amax()
    }

    /// What is missing: closure, and the energy in units of length.
    fn residual(&self, look: &Look) -> f64 {
        let energy = match self.fixed {
            Fixed::Energy(wanted) => {
                let slope = self.units.gradient(&look.rates[0]).norm();
                (wanted - look.energy) / slope.max(f64::MIN_POSITIVE)
            }
            _ => 0.0,
        };
        math::hypot(look.miss.norm(), energy)
    }

    /// The period at which the motion misses its start across itself only: a start that lies on a periodic orbit
    /// is then left as it is.
    fn settled(&self, start: &State, period: f64) -> f64 {
        let mut time = period;
        if !self.space.is_autonomous() || matches!(self.fixed, Fixed::Period(_)) {
            return time;
        }
        let Ok(mut look) = self.look(start, time) else { return time };
        for _ in 0..SETTLINGS {
            let rate = &look.rates[1];
            let later = time - look.miss.dot(rate) / rate.norm_squared() * self.units.time();
            if !(0.5 * period..2.0 * period).contains(&later) {
                break;
            }
            match self.look(start, later) {
                Ok(found) if found.miss.norm() < look.miss.norm() => (time, look) = (later, found),
                _ => break,
            }
        }
        time
    }

    fn solve(&mut self, start: &State, period: f64) -> Result<Closed, DynamicsError> {
        let (mut state, mut time) = (start.clone(), period);
        let mut look = self.look(&state, time)?;
        let mut residual = self.residual(&look);
        let speed = look.rates[0].norm();
        let mut stalled = 0;
        for _ in 0..STEPS {
            if residual <= ROUNDING * look.size || stalled > 1 {
                break;
            }
            // a direction that hardly matters must not be moved along as long as there is much to do, unless that is all
            // that is left
            let next = match self.advanced(&state, (time, period), &look, 1e-3 * residual)? {
                None => self.advanced(&state, (time, period), &look, 0.0)?,
                next => next,
            };
            let Some((there, later, found)) = next else { break };
            let better = self.residual(&found);
            // parts of steps are slow far from the orbit; close to it slowness is rounding
            let slow = if residual <= CLOSED * look.size { 0.5 } else { 0.95 };
            stalled = if better > slow * residual { stalled + 1 } else { 0 };
            (state, time, look, residual) = (there, later, found, better);
        }
        // rest is an equilibrium; under a drive it may be one of the orbits that have its period. At the origin a state is as
        // small as its rates, and what does not close is compared with what the search began with
        let turned = time / self.units.time();
        // what a motion moves by in a period may be much larger than where it is
        let near = self.size(start).max(self.size(&state)).min(look.size);
        let (moved, open) = (look.rates[0].norm() * turned, residual > CLOSED * near);
        let still = moved < STILL * look.size || open && moved <= STILL * speed;
        if self.space.is_autonomous() && still {
            return Err(self.rest(&state));
        }
        if open {
            return Err(no_orbit(residual / near.max(f64::MIN_POSITIVE), time));
        }
        let settings = look.settings;
        Ok(Closed { state, period: time, residual, monodromy: look.monodromy, settings })
    }

    /// What was found is an equilibrium, which closes after any time.
    fn rest(&self, state: &State) -> DynamicsError {
        let variables = self.space.variables(state);
        let sizes = self.units.scaled(&DVector::from_column_slice(variables));
        let place: Vec<String> = (self.space.names().iter().zip(variables).zip(sizes.iter()))
            .map(|((name, value), size)| {
                format!("{name} = {}", short(if size.abs() <= STILL { 0.0 } else { *value }))
            })
            .collect();
        unsuited(&format!(
            "no periodic orbit was found near the start: the search ended at the equilibrium {}; begin farther from it, or \
             with another period or energy",
            place.join(", ")
        ))
    }

    /// The state and the period after a correction, or a part of it, that leaves less missing; the period within five times
    /// the first one. Singular values up to `cut` count as zero.
    fn advanced(
        &self,
        state: &State,
        (time, first): (f64, f64),
        look: &Look,
        cut: f64,
    ) -> Result<Option<(State, f64, Look)>, DynamicsError> {
        let n = look.basis.ncols();
        let (matrix, right) = self.equations(look);
        let residual = self.residual(look);
        let Some(step) = linear::least_squares(&matrix, &right, 1e-11 * matrix.amax() + cut) else {
            return Err(no_orbit(residual / look.size, time));
        };
        let change = self.units.unscaled(&(&look.basis * step.rows(0, n)));
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let there = self.displaced(state, &(&change * part));
            let later = time + part * step[n] * self.units.time();
            if (0.2 * first..5.0 * first).contains(&later) {
                match there.and_then(|there| Ok((self.look(&there, later)?, there))) {
                    Ok((found, there)) if self.residual(&found) < residual => {
                        return Ok(Some((there, later, found)));
                    }
                    Err(error) if error.is_cancelled() => return Err(error),
                    _ => {}
                }
            }
            part *= 0.5;
        }
        Ok(None)
    }

    /// What is missing, equation by equation, and the derivatives by the displacements of the state that are allowed, and T.
    pub(super) fn equations(&self, look: &Look) -> (DMatrix<f64>, DVector<f64>) {
        let (n, basis) = (self.space.dimension(), &look.basis);
        let allowed = basis.ncols();
        let autonomous = self.space.is_autonomous();
        let mut matrix = DMatrix::zeros(n + 2, allowed + 1);
        let identity = DMatrix::identity(n, n);
        matrix
            .view_mut((0, 0), (n, allowed))
            .copy_from(&((self.units.map(&look.monodromy) - identity) * basis));
        let speed = look.rates[0].norm();
        let mut row = |i: usize, of: DVector<f64>| {
            matrix.view_mut((i, 0), (1, allowed)).copy_from(&(of.transpose() * basis));
        };
        if autonomous && speed > 0.0 {
            // the state does not move along the orbit
            row(n, &look.rates[0] / speed);
        }
        if let Fixed::Energy(_) = self.fixed {
            row(n + 1, self.units.gradient(&look.rates[0]).normalize());
        }
        if !matches!(self.fixed, Fixed::Period(_)) {
            matrix.view_mut((0, allowed), (n, 1)).copy_from(&look.rates[1]);
        }
        (matrix, -self.missed(look))
    }

    /// The distance by which the motion does not close, no motion along the orbit, and the energy in
    /// excess in units of its gradient.
    pub(super) fn missed(&self, look: &Look) -> DVector<f64> {
        let n = self.space.dimension();
        let mut missed = DVector::zeros(n + 2);
        missed.rows_mut(0, n).copy_from(&look.miss);
        if let Fixed::Energy(wanted) = self.fixed {
            missed[n + 1] = (look.energy - wanted) / self.units.gradient(&look.rates[0]).norm();
        }
        missed
    }

    /// The orbit at a state from which the motion closes.
    pub(super) fn at(&self, state: &State, period: f64) -> Result<Orbit, DynamicsError> {
        let look = self.look(state, period)?;
        let (residual, settings) = (self.residual(&look), look.settings);
        let monodromy = look.monodromy;
        let state = state.clone();
        self.described(&Closed { state, period, residual, monodromy, settings })
    }

    /// The orbit after a part of its period, if it closes there already.
    fn part(&mut self, closed: &Closed, parts: f64) -> Option<Closed> {
        let look = self.look(&closed.state, closed.period / parts).ok()?;
        if self.residual(&look) > 1e-6 * look.size {
            return None;
        }
        self.solve(&closed.state, closed.period / parts).ok()
    }

    fn described(&self, closed: &Closed) -> Result<Orbit, DynamicsError> {
        let space = self.space;
        let rate = Direction::new(space).at(&closed.state)?;
        let trivial = match (space.is_autonomous(), space.is_hamiltonian()) {
            (true, true) => Removed::FlowAndEnergy,
            (true, false) => Removed::Flow,
            (false, _) => Removed::Nothing,
        };
        let rate = self.units.rates(&rate);
        let frame = if space.is_constrained() {
            transverse::frame_within(&self.basis(&closed.state)?, &rate, trivial)
        } else {
            transverse::frame(&rate, trivial, space.is_hamiltonian())
        };
        let transverse = frame.transpose() * self.units.map(&closed.monodromy) * &frame;
        let multipliers = linear::eigenvalues(&transverse);
        let stable = multipliers.iter().all(|z| math::hypot(z[0], z[1]) <= 1.0 + ON_CIRCLE);
        let size = self.size(&closed.state);
        Ok(Orbit {
            period: closed.period,
            energy: space.system().energy(&closed.state, space.parameters())?,
            closure: closed.residual / size.max(f64::MIN_POSITIVE),
            action: loop_action(space, self.method, &closed.state, closed.period)?,
            state: closed.state.clone(),
            monodromy: closed.monodromy.clone(),
            transverse,
            multipliers,
            trivial,
            stable,
            settings: closed.settings,
        })
    }
}

/// None was found: by how much the best one misses itself, as a part of its size, and its period.
fn no_orbit(missed: f64, period: f64) -> DynamicsError {
    DynamicsError::Unsuited(format!(
        "no periodic orbit was found near the start: the best one misses itself by {missed:.1e} \
         of its size after {}",
        short(period)
    ))
}
