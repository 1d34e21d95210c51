//! Newton's method on the flow map: the equations of a periodic orbit, and steps that leave less missing.
//!
//! In: a state near the orbit, a period, what is held fixed. Out: where the steps have come to. Never here: whether that is an
//! orbit.
//!
//! Unknown are the state and the period; the equations are that the motion closes, that the state
//! does not move along the orbit, and that the energy (or the period) is the given one, and Casimirs are. They are
//! solved by least squares, because with a conserved energy one of them follows from the others, and
//! symmetries leave a choice (Viswanath, SIAM Review 43 (2001) 478, has the method). Under constraints the state moves by
//! displacements that they allow, and back onto them.

use nalgebra::{DMatrix, DVector};

use super::amplified_rounding::MapRounding;
use super::end_state::end_state;
use super::error::DynamicsError;
use super::first_return::difference;
use super::flow_direction::{FlowDirection, basis_of_range};
use super::flow_map::flow_map_while;
use super::linear;
use super::orbit_units::OrbitUnits;
use super::phase_space::PhaseSpace;
use super::search_budget::SearchBudget;
use crate::integrate::{Method, Settings};
use crate::num::{DoubleDouble, math};
use crate::system::State;

/// The maximal number of steps of Newton's method, and of halvings of one.
const STEPS: usize = 50;
const HALVINGS: u32 = 10;

/// The maximal number of corrections of the period alone, before those of the state.
const SETTLINGS: usize = 6;

/// An orbit is closed up to this part of its size.
pub(super) const CLOSED: f64 = 1e-9;

/// A residual below this part of the size is rounding.
pub(super) const ROUNDING: f64 = 2e-15;

/// The quantity that is held fixed in the search for an orbit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Fixed {
    /// The orbit has this energy.
    Energy(f64),
    /// The orbit has this period.
    Period(f64),
    /// Neither: a limit cycle.
    Nothing,
}

pub(super) struct Newton<'a> {
    pub(super) space: &'a PhaseSpace,
    pub(super) method: (&'static Method, Settings),
    pub(super) fixed: Fixed,
    pub(super) units: OrbitUnits,
    pub(super) casimirs: Vec<f64>,
    /// The steps that are left; without one there is no end to them.
    pub(super) budget: Option<&'a SearchBudget<'a>>,
}

/// A level set on which an orbit is to lie, beside a start, in the units of the orbit.
struct LevelSet {
    /// The direction across it, a unit vector; zero where it has none.
    normal: DVector<f64>,
    /// How far the start lies beyond it.
    excess: f64,
}

impl LevelSet {
    fn new(gradient: &DVector<f64>, excess: f64) -> LevelSet {
        let slope = gradient.norm().max(f64::MIN_POSITIVE);
        LevelSet { normal: gradient / slope, excess: excess / slope }
    }
}

/// The motion over one period, in the units of the orbit but for the monodromy matrix.
pub(super) struct Circuit {
    miss: DVector<f64>,
    pub(super) monodromy: DMatrix<f64>,
    /// The displacements that constraints allow at the start, as columns of unit length; all without constraints.
    pub(super) basis: DMatrix<f64>,
    /// The rates at its two ends.
    pub(super) rates: [DVector<f64>; 2],
    /// What is to have given values at the start.
    surfaces: Vec<LevelSet>,
    pub(super) size: f64,
    /// How often each variable with a period has gone round.
    pub(super) rounds: Vec<i64>,
    /// The largest singular value of the monodromy matrix.
    growth: f64,
    /// What rounding may leave of the monodromy matrix, in the units of the file.
    pub(super) rounding: Option<MapRounding>,
    pub(super) settings: Settings,
}

impl Circuit {
    /// The factor by which neighbouring states part at most in the period.
    pub(super) fn growth(&self) -> f64 {
        self.growth.max(1.0)
    }
}

/// A singular value up to this part of the largest is that of a symmetry, whose direction matters nowhere.
pub(super) const SYMMETRY: f64 = 1e-11;

/// A residual up to this many times rounding, grown as neighbours of the orbit part in a period, is rounding.
const TIMES: f64 = 100.0;

/// Where a search has come to: a state, a period, the motion over it, and what is missing of an orbit.
pub(super) struct NewtonIterate {
    pub(super) state: State,
    pub(super) period: f64,
    pub(super) circuit: Circuit,
    pub(super) residual: f64,
}

impl NewtonIterate {
    /// Whether nothing but rounding is missing.
    pub(super) fn is_exact(&self) -> bool {
        self.residual <= ROUNDING * self.circuit.size
    }

    /// Whether what is missing may be rounding, or within the tolerance, as it is grown over a period.
    pub(super) fn is_rounding(&self) -> bool {
        let tolerance = self.circuit.settings.tolerance.unwrap_or(0.0);
        let grown = self.circuit.growth();
        self.residual <= TIMES * ROUNDING.max(tolerance) * grown * self.circuit.size
    }
}

impl Newton<'_> {
    pub(super) fn circuit(&self, state: &State, period: f64) -> Result<Circuit, DynamicsError> {
        let (space, method) = (self.space, self.method);
        let until = state.time + period;
        let mut count = |time| {
            self.budget.into_iter().for_each(SearchBudget::step);
            time == until || self.budget.is_none_or(|budget| !budget.is_spent())
        };
        let ended = || self.budget.and_then(SearchBudget::ended).map(DynamicsError::Unclosed);
        if let Some(ended) = ended() {
            return Err(ended);
        }
        let map = flow_map_while(space, method, state, until, &mut count)?;
        if let Some(ended) = ended().filter(|_| map.error.is_none() && map.time != until) {
            return Err(ended);
        }
        if let Some(error) = map.error {
            return Err(error.into());
        }
        let mut direction = FlowDirection::new(space);
        let rates = [direction.at(state)?, direction.at(&map.state)?];
        let miss = self.units.scaled(&difference(space, &map.state, state));
        let ends = space.variables(&map.state).iter().zip(space.variables(state));
        let rounds = ends.zip(space.periods()).map(|((end, start), turn)| {
            turn.map_or(0, |turn| ((end - start) / turn).round() as i64)
        });
        let rounds = rounds.collect();
        let rates = rates.map(|rate| self.units.rates(&rate));
        let surfaces = self.surfaces(state, &rates[0])?;
        let basis = self.basis(state)?;
        let size = self.size(state).max(rates[0].amax() * (period / self.units.time()).min(1.0));
        let growth = linear::singular_values(&self.units.map(&map.matrix)).ok_or_else(|| {
            DynamicsError::Unsuited("the map of a period has no finite entries".to_owned())
        })?;
        let growth = growth.sizes.max();
        Ok(Circuit {
            miss,
            growth,
            monodromy: map.matrix,
            basis,
            rates,
            surfaces,
            size,
            rounds,
            rounding: map.rounding,
            settings: map.settings,
        })
    }

    /// The displacements that constraints allow, in the units of the orbit.
    pub(super) fn basis(&self, state: &State) -> Result<DMatrix<f64>, DynamicsError> {
        let (allowed, dimension) = self.space.allowed_displacements(state)?;
        if !self.space.is_constrained() {
            return Ok(allowed);
        }
        Ok(basis_of_range(&self.units.map(&allowed), dimension))
    }

    /// A state displaced by as much, on the constraints.
    pub(super) fn displaced(
        &self,
        state: &State,
        by: &DVector<f64>,
    ) -> Result<State, DynamicsError> {
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

    pub(super) fn size(&self, state: &State) -> f64 {
        let variables = DVector::from_column_slice(self.space.variables(state));
        self.units.scaled(&variables).amax()
    }

    /// The level sets on which the orbit is to lie, beside a state with these rates: those of the energy, if it is given, and of
    /// the Casimirs.
    fn surfaces(&self, state: &State, rate: &DVector<f64>) -> Result<Vec<LevelSet>, DynamicsError> {
        let (space, mut surfaces) = (self.space, Vec::new());
        let levels = match space.levels() {
            Some(levels) => levels.at(state, space.parameters())?,
            None => Vec::new(),
        };
        if let Fixed::Energy(wanted) = self.fixed {
            let energy = space.system().energy(state, space.parameters())?;
            let gradient = match levels.first() {
                Some(energy) => self.units.covector(&energy.gradient),
                None => self.units.gradient(rate),
            };
            surfaces.push(LevelSet::new(&gradient, energy - wanted));
        }
        let casimirs = levels.iter().skip(usize::from(space.has_energy_levels()));
        for (casimir, wanted) in casimirs.zip(&self.casimirs) {
            let gradient = self.units.covector(&casimir.gradient);
            surfaces.push(LevelSet::new(&gradient, casimir.value - wanted));
        }
        Ok(surfaces)
    }

    /// What is missing: closure, and the level sets, in units of length.
    pub(super) fn residual(circuit: &Circuit) -> f64 {
        let beyond = circuit.surfaces.iter().map(|surface| surface.excess);
        beyond.fold(circuit.miss.norm(), math::hypot)
    }

    /// The period at which the motion misses its start across itself only: a start that lies on a periodic orbit
    /// is then left as it is.
    pub(super) fn settled(&self, start: &State, period: f64) -> f64 {
        let mut time = period;
        if !self.space.is_autonomous() || matches!(self.fixed, Fixed::Period(_)) {
            return time;
        }
        let Ok(mut circuit) = self.circuit(start, time) else { return time };
        for _ in 0..SETTLINGS {
            let rate = &circuit.rates[1];
            let later = time - circuit.miss.dot(rate) / rate.norm_squared() * self.units.time();
            if !(0.5 * period..2.0 * period).contains(&later) {
                break;
            }
            match self.circuit(start, later) {
                Ok(found) if found.miss.norm() < circuit.miss.norm() => {
                    (time, circuit) = (later, found);
                }
                _ => break,
            }
        }
        time
    }

    pub(super) fn reached(
        &self,
        state: State,
        period: f64,
    ) -> Result<NewtonIterate, DynamicsError> {
        let circuit = self.circuit(&state, period)?;
        let residual = Self::residual(&circuit);
        Ok(NewtonIterate { state, period, circuit, residual })
    }

    /// Newton's steps from there as long as they leave less missing; the period stays within five times `first`.
    pub(super) fn approach(
        &self,
        mut here: NewtonIterate,
        first: f64,
    ) -> Result<NewtonIterate, DynamicsError> {
        let mut stalled = 0;
        for _ in 0..STEPS {
            if here.is_exact() || stalled > 1 {
                break;
            }
            // a direction that hardly matters must not be moved along as long as there is much to do, unless that is all
            // that is left
            let next = match self.advanced(&here, first, 1e-3 * here.residual)? {
                None => self.advanced(&here, first, 0.0)?,
                next => next,
            };
            let Some(next) = next else { break };
            // parts of steps are slow far from the orbit; close to it slowness is rounding
            let slow = if here.residual <= CLOSED * here.circuit.size { 0.5 } else { 0.95 };
            stalled = if next.residual > slow * here.residual { stalled + 1 } else { 0 };
            here = next;
        }
        Ok(here)
    }

    /// The length of the step that Newton's method has left, where symmetries alone are left out.
    pub(super) fn step_left(&self, here: &NewtonIterate) -> Option<f64> {
        let (matrix, right) = self.equations(&here.circuit);
        linear::least_squares(&matrix, &right, SYMMETRY * matrix.amax()).map(|step| step.norm())
    }

    /// A step of the state and the period, in the units of the orbit and the coordinates of the allowed displacements, if the
    /// period stays within five times `first` and the motion can be followed there.
    pub(super) fn stepped(
        &self,
        from: &NewtonIterate,
        step: &DVector<f64>,
        first: f64,
    ) -> Result<Option<NewtonIterate>, DynamicsError> {
        let n = from.circuit.basis.ncols();
        let change = self.units.unscaled(&(&from.circuit.basis * step.rows(0, n)));
        let later = from.period + step[n] * self.units.time();
        if !(0.2 * first..5.0 * first).contains(&later) {
            return Ok(None);
        }
        let there = self.displaced(&from.state, &change);
        match there.and_then(|there| self.reached(there, later)) {
            Err(error) if error.is_cancelled() => Err(error),
            found => Ok(found.ok()),
        }
    }

    /// After a correction, or a part of it, that leaves less missing. Singular values up to `cut` count as zero.
    fn advanced(
        &self,
        from: &NewtonIterate,
        first: f64,
        cut: f64,
    ) -> Result<Option<NewtonIterate>, DynamicsError> {
        let (matrix, right) = self.equations(&from.circuit);
        let step = linear::least_squares(&matrix, &right, SYMMETRY * matrix.amax() + cut);
        let Some(step) = step else { return Ok(None) };
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let found = self.stepped(from, &(&step * part), first)?;
            if let Some(found) = found.filter(|found| found.residual < from.residual) {
                return Ok(Some(found));
            }
            part *= 0.5;
        }
        Ok(None)
    }

    /// What is missing, equation by equation, and the derivatives by the displacements of the state that are allowed, and T.
    pub(super) fn equations(&self, circuit: &Circuit) -> (DMatrix<f64>, DVector<f64>) {
        let (n, basis) = (self.space.dimension(), &circuit.basis);
        let allowed = basis.ncols();
        let autonomous = self.space.is_autonomous();
        let mut matrix = DMatrix::zeros(self.count(), allowed + 1);
        let identity = DMatrix::identity(n, n);
        matrix
            .view_mut((0, 0), (n, allowed))
            .copy_from(&((self.units.map(&circuit.monodromy) - identity) * basis));
        let speed = circuit.rates[0].norm();
        let mut row = |i: usize, of: DVector<f64>| {
            matrix.view_mut((i, 0), (1, allowed)).copy_from(&(of.transpose() * basis));
        };
        if autonomous && speed > 0.0 {
            // the state does not move along the orbit
            row(n, &circuit.rates[0] / speed);
        }
        for (k, surface) in circuit.surfaces.iter().enumerate() {
            row(n + 1 + k, surface.normal.clone());
        }
        if !matches!(self.fixed, Fixed::Period(_)) {
            matrix.view_mut((0, allowed), (n, 1)).copy_from(&circuit.rates[1]);
        }
        (matrix, -self.missed(circuit))
    }

    /// The number of equations.
    fn count(&self) -> usize {
        self.space.dimension() + 2 + self.casimirs.len()
    }

    /// What is missing at a state, without its derivatives.
    pub(super) fn missing(
        &self,
        state: &State,
        period: f64,
    ) -> Result<DVector<f64>, DynamicsError> {
        let space = self.space;
        let end = end_state(space, self.method, state, state.time + period)?;
        let rate = self.units.rates(&FlowDirection::new(space).at(state)?);
        let surfaces = self.surfaces(state, &rate)?;
        Ok(self.listed(&self.units.scaled(&difference(space, &end, state)), &surfaces))
    }

    /// The distance by which the motion does not close, no motion along the orbit, and how far the start lies beyond the level
    /// sets.
    pub(super) fn missed(&self, circuit: &Circuit) -> DVector<f64> {
        self.listed(&circuit.miss, &circuit.surfaces)
    }

    fn listed(&self, miss: &DVector<f64>, surfaces: &[LevelSet]) -> DVector<f64> {
        let n = self.space.dimension();
        let mut missed = DVector::zeros(self.count());
        missed.rows_mut(0, n).copy_from(miss);
        for (k, surface) in surfaces.iter().enumerate() {
            missed[n + 1 + k] = surface.excess;
        }
        missed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion of size 3 whose neighbours part by this factor, and which misses itself by so much.
    fn missing(residual: f64, growth: f64, tolerance: Option<f64>) -> NewtonIterate {
        let circuit = Circuit {
            miss: DVector::zeros(2),
            monodromy: DMatrix::identity(2, 2),
            basis: DMatrix::identity(2, 2),
            rates: [DVector::zeros(2), DVector::zeros(2)],
            surfaces: Vec::new(),
            size: 3.0,
            rounds: Vec::new(),
            growth,
            rounding: None,
            settings: Settings { step: None, tolerance },
        };
        let state = State::new(0.0, crate::system::Form::Momentum, vec![0.0; 2]);
        NewtonIterate { state, period: 1.0, circuit, residual }
    }

    #[test]
    fn a_hundred_times_rounding_as_it_grows_is_rounding() {
        for (growth, tolerance, limit) in [
            (1.0, None, 100.0 * 2e-15 * 3.0),
            (0.1, None, 100.0 * 2e-15 * 3.0),
            (50.0, None, 100.0 * 2e-15 * 3.0 * 50.0),
            (50.0, Some(1e-10), 100.0 * 1e-10 * 3.0 * 50.0),
        ] {
            assert!(missing(0.8 * limit, growth, tolerance).is_rounding());
            assert!(!missing(1.25 * limit, growth, tolerance).is_rounding());
        }
    }
}
