//! Families of periodic orbits, followed by pseudo-arclength.
//!
//! In: a periodic orbit, and what changes along its family: the energy, the period, or a parameter.
//! Out: a step along the family, with the orbits at given values, and between them the folds,
//! where the family turns back, and the bifurcations, where a multiplier passes 1 or −1. Never
//! here: how one orbit is closed, both sides of a family (`family_course`); what lies between two points of a family (`members`), displacements within what is allowed (`equations`).
//!
//! Source: H. B. Keller, Lectures on Numerical Methods in Bifurcation Problems, Springer 1987; the
//! bifurcations of orbits: K. R. Meyer, Trans. Amer. Math. Soc. 149 (1970) 95.

mod equations;
mod family_end;
mod members;
mod point;
mod tangent;

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::family::{Along, Member};
use super::linear;
use super::newton::{Fixed, Newton, ROUNDING};
use super::orbit::Orbit;
use super::orbit_units::OrbitUnits;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::num::{math, significant};
use crate::system::State;
use equations::FamilyEquations;
use family_end::{ended, lost};
use point::FamilyPoint;

/// The most steps in one direction.
const STEPS: usize = 300;

/// The largest step, and the least that is tried, in the size of an orbit.
const LARGEST: f64 = 0.1;
const LEAST: f64 = 1e-6;

/// The most corrections of one step.
const CORRECTIONS: usize = 8;

/// A point counts as on the family when it closes up to this part of its size.
const CLOSED: f64 = 1e-11;

/// A change of a parameter for its difference.
const DIFFERENCE: f64 = 1e-5;

/// The period of a drive at some parameters.
pub type DrivePeriod<'a> = &'a dyn Fn(&[f64]) -> Option<f64>;

#[derive(Clone)]
pub(super) struct FamilySide {
    pub(super) begin: FamilyPoint,
    pub(super) here: FamilyPoint,
    /// The size of the orbits so far, the next step, and the steps taken.
    size: f64,
    step: f64,
    steps: usize,
    pub(super) members: Vec<Member>,
    /// Why it is followed no farther, if it is not.
    pub(super) ended: Option<SideEnd>,
}

/// Why a side of a family is followed no farther.
#[derive(Clone)]
pub(super) enum SideEnd {
    /// It has come to the last of the values.
    Values,
    /// It ends before.
    Before(String),
}

/// A family that is followed: of which space, by which method, along what.
#[derive(Clone, Copy)]
pub(super) struct Continuation<'a> {
    pub(super) space: &'a PhaseSpace,
    pub(super) method: (&'static Method, Settings),
    /// The method of the members, and of steps that the other does not find.
    pub(super) exact: (&'static Method, Settings),
    pub(super) along: Along,
    pub(super) fixed: Fixed,
    pub(super) values: &'a [f64],
    pub(super) casimirs: &'a [f64],
    /// How many periods of a drive an orbit has, and that period at some parameters.
    pub(super) drive: Option<(f64, DrivePeriod<'a>)>,
}

impl Continuation<'_> {
    /// The period of an orbit at a parameter, if it is that of a drive.
    fn driven(&self, parameter: f64, period: f64) -> Result<f64, DynamicsError> {
        let Some((multiple, drive)) = self.drive else { return Ok(period) };
        let known = drive(self.space_at(parameter).parameters());
        known.map(|period| multiple * period).ok_or_else(|| {
            DynamicsError::Unsuited(format!("the drive has no period at {parameter:?}"))
        })
    }

    pub(super) fn range(&self) -> (f64, f64) {
        let low = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        (low, self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    }

    fn space_at(&self, parameter: f64) -> PhaseSpace {
        match self.along {
            Along::Parameter(index) => {
                let mut parameters = self.space.parameters().to_vec();
                parameters[index] = parameter;
                self.space.at_parameters(&parameters)
            }
            Along::Energy | Along::Period => self.space.clone(),
        }
    }

    fn parameter(&self) -> f64 {
        match self.along {
            Along::Parameter(index) => self.space.parameters()[index],
            Along::Energy | Along::Period => 0.0,
        }
    }

    /// What is held fixed beside what changes.
    fn fixed(&self) -> Fixed {
        match self.along {
            Along::Parameter(_) => self.fixed,
            Along::Energy | Along::Period => Fixed::Nothing,
        }
    }

    fn value_of(&self, orbit: &Orbit, parameter: f64) -> f64 {
        match self.along {
            Along::Energy => orbit.energy,
            Along::Period => orbit.period,
            Along::Parameter(_) => parameter,
        }
    }

    fn first(&self, orbit: &Orbit) -> Result<FamilyPoint, DynamicsError> {
        let parameter = self.parameter();
        let mut point = FamilyPoint {
            state: orbit.state.clone(),
            period: orbit.period,
            parameter,
            tangent: DVector::zeros(self.space.dimension() + 2),
            value: self.value_of(orbit, parameter),
            orbit: orbit.clone(),
            rounds: Vec::new(),
            directions: 1,
        };
        let (low, high) = self.range();
        // the value grows along the tangent
        let found = self.equations(&point.state, point.period, point.parameter)?;
        point.rounds.clone_from(&found.here.circuit.rounds);
        (point.tangent, point.directions) = self.direction(&point, &found, None)?;
        if point.value > high || point.value < low {
            let slope = self.slope(&point)?;
            let wanted = if point.value > high { -1.0 } else { 1.0 };
            if slope * wanted < 0.0 {
                point.tangent.neg_mut();
            }
        }
        Ok(point)
    }

    /// The equations of an orbit of the family, in the units of the file.
    fn newton<'s>(&self, space: &'s PhaseSpace) -> Newton<'s> {
        let units = OrbitUnits::of_file(space.dimension());
        let casimirs = self.casimirs.to_vec();
        Newton { space, method: self.method, fixed: self.fixed(), units, casimirs, budget: None }
    }

    /// The equations of an orbit at (z, T, μ), with their derivatives by the displacements of z that are allowed, T and μ.
    fn equations(
        &self,
        state: &State,
        period: f64,
        parameter: f64,
    ) -> Result<FamilyEquations, DynamicsError> {
        let n = self.space.dimension();
        let space = self.space_at(parameter);
        let newton = self.newton(&space);
        let here = newton.reached(state.clone(), self.driven(parameter, period)?)?;
        let (matrix, missing) = newton.equations(&here.circuit);
        let columns = matrix.ncols();
        let rows = matrix.nrows();
        let mut full = DMatrix::zeros(rows, columns + 1);
        full.view_mut((0, 0), (rows, columns)).copy_from(&matrix);
        if let Along::Parameter(_) = self.along {
            let step = DIFFERENCE * parameter.abs().max(1e-2);
            let none = DVector::zeros(n);
            let at = |parameter: f64| -> Result<DVector<f64>, DynamicsError> {
                let space = self.space_at(parameter);
                let newton = self.newton(&space);
                let there = newton.displaced(state, &none)?;
                let period = self.driven(parameter, period)?;
                newton.missing(&there, period)
            };
            let slope = (at(parameter + step)? - at(parameter - step)?) / (2.0 * step);
            full.view_mut((0, columns), (rows, 1)).copy_from(&slope);
        }
        Ok(FamilyEquations { missing, matrix: full, here })
    }

    /// The point of the family a step onwards, and the corrections that it took.
    fn onwards(
        &self,
        from: &FamilyPoint,
        step: f64,
    ) -> Result<Option<(FamilyPoint, usize)>, DynamicsError> {
        self.corrected(from, &(&from.tangent * step))
    }

    /// The same family by the method of its members, if that is another one.
    fn exact(&self) -> Option<Continuation<'_>> {
        (self.exact.1 != self.method.1).then_some(Continuation { method: self.exact, ..*self })
    }

    fn member(&self, from: &FamilyPoint, point: FamilyPoint) -> Result<Orbit, DynamicsError> {
        let (mut point, mut method) = (point, self.method);
        let exact = self.exact().unwrap_or(*self);
        if let Some((found, _)) = exact.closed_near(from, &from.change(&point), ROUNDING)? {
            (point, method) = (found, exact.method);
        }
        point.orbit.with_action(&self.space_at(point.parameter), method)
    }

    /// The point of the family near a change of (z, T, μ), across its tangent from there.
    fn corrected(
        &self,
        from: &FamilyPoint,
        by: &DVector<f64>,
    ) -> Result<Option<(FamilyPoint, usize)>, DynamicsError> {
        match (self.closed_near(from, by, CLOSED)?, self.exact()) {
            (None, Some(exact)) => exact.closed_near(from, by, CLOSED),
            (found, _) => Ok(found),
        }
    }

    /// The same by this method alone, corrected until it closes up to a part `wanted` of its size, or no better.
    fn closed_near(
        &self,
        from: &FamilyPoint,
        by: &DVector<f64>,
        wanted: f64,
    ) -> Result<Option<(FamilyPoint, usize)>, DynamicsError> {
        let n = self.space.dimension();
        let moved = |state: &State, by: &DVector<f64>, parameter: f64| {
            let space = self.space_at(parameter);
            let there = self.newton(&space).displaced(state, &by.rows(0, n).into_owned());
            match there {
                Err(error) if error.is_cancelled() => Err(error),
                there => Ok(there.ok()),
            }
        };
        let (mut period, mut parameter) = (from.period + by[n], from.parameter + by[n + 1]);
        let Some(mut state) = moved(&from.state, by, parameter)? else { return Ok(None) };
        let mut closest: Option<(FamilyPoint, usize, f64)> = None;
        for count in 0..CORRECTIONS {
            if period <= 0.0 {
                break;
            }
            let found = self.equations(&state, period, parameter);
            let found = match found {
                Ok(found) => found,
                Err(error) if error.is_cancelled() => return Err(error),
                Err(_) => break,
            };
            let missing = found.missing.norm() / found.here.circuit.size;
            if missing <= CLOSED {
                // beyond a separatrix there is another family
                if found.here.circuit.rounds != from.rounds {
                    return Ok(None);
                }
                if closest.as_ref().is_some_and(|(.., before)| missing >= *before) {
                    break;
                }
                closest = Some((self.point(from, &found, parameter)?, count, missing));
                if missing <= wanted {
                    break;
                }
            }
            // across the family only
            let (rows, columns) = found.matrix.shape();
            let mut all = found.matrix.clone().resize_vertically(rows + 1, 0.0);
            all.view_mut((rows, 0), (1, columns))
                .copy_from(&found.within(&from.tangent).transpose());
            let right = found.missing.clone().resize_vertically(rows + 1, 0.0);
            let cut = 1e-10 * found.matrix.amax() + 1e-4 * found.missing.norm();
            let Some(change) = linear::least_squares(&all, &right, cut) else { break };
            let change = found.outside(&change);
            period += change[n];
            parameter += change[n + 1];
            let Some(there) = moved(&state, &change, parameter)? else { break };
            state = there;
        }
        Ok(closest.map(|(point, count, _)| (point, count)))
    }

    fn point(
        &self,
        from: &FamilyPoint,
        found: &FamilyEquations,
        parameter: f64,
    ) -> Result<FamilyPoint, DynamicsError> {
        let here = &found.here;
        let space = self.space_at(parameter);
        let orbit = Orbit::of(&self.newton(&space), here)?;
        let (state, period) = (here.state.clone(), here.period);
        let tangent = from.tangent.clone();
        let value = self.value_of(&orbit, parameter);
        let rounds = here.circuit.rounds.clone();
        let directions = from.directions;
        let mut point =
            FamilyPoint { state, period, parameter, tangent, value, orbit, rounds, directions };
        (point.tangent, point.directions) = self.direction(&point, found, Some(from))?;
        Ok(point)
    }

    pub(super) fn begun(&self, orbit: &Orbit) -> Result<FamilyPoint, DynamicsError> {
        let conserved = self.space.has_energy_levels();
        if !matches!(self.along, Along::Parameter(_)) && !conserved {
            return Err(DynamicsError::Unsuited(
                "without a conserved energy orbits are isolated: name a parameter that changes along \
                 their family"
                    .to_owned(),
            ));
        }
        self.first(orbit)
    }

    fn size(&self, state: &State) -> f64 {
        self.space.variables(state).iter().fold(0.1, |m: f64, x| m.max(x.abs()))
    }

    /// The largest step from a point, of orbits of some size: a long period does not make it short.
    fn largest_step(&self, point: &FamilyPoint, size: f64) -> f64 {
        let n = self.space.dimension();
        let tangent = &point.tangent;
        let by_state = math::hypot(tangent.rows(0, n).norm(), tangent[n + 1]);
        LARGEST * (size / by_state).min(point.period / tangent[n].abs())
    }

    /// The side of a family along the tangent at a point.
    pub(super) fn side(&self, begin: FamilyPoint) -> FamilySide {
        let size = self.size(&begin.state);
        let (here, step) = (begin.clone(), 0.02 * size);
        FamilySide { begin, here, size, step, steps: 0, members: Vec::new(), ended: None }
    }

    /// Why a side is followed no farther after an error: next to a separatrix neighbouring orbits part without bound.
    pub(super) fn failed(side: &FamilySide, error: &DynamicsError) -> String {
        let is_long = family_end::grows(&side.here, side.begin.period);
        let parts = matches!(error, DynamicsError::Singular(_)) && is_long;
        if parts { lost(&side.here, side.begin.period) } else { error.to_string() }
    }

    /// Follows a side along its tangent by a step, and collects the members there. The step is halved where it is too
    /// long.
    pub(super) fn advance(&self, side: &mut FamilySide) -> Result<(), DynamicsError> {
        let (low, high) = self.range();
        let here = &side.here;
        let leaves = if here.value > high {
            self.slope(here)? > 0.0
        } else {
            here.value < low && self.slope(here)? < 0.0
        };
        if leaves {
            side.ended = Some(SideEnd::Values);
            return Ok(());
        }
        if side.steps == STEPS {
            let value = significant(here.value, 6, 1e-4..1e6);
            let why = format!("the family continues beyond {value}, after {STEPS} steps");
            side.ended = Some(SideEnd::Before(why));
            return Ok(());
        }
        side.steps += 1;
        let Some((next, count)) = self.onwards(here, side.step)? else {
            side.step *= 0.5;
            if side.step < LEAST * side.size {
                side.ended = Some(SideEnd::Before(lost(here, side.begin.period)));
            }
            return Ok(());
        };
        let way = (here, &next, side.step);
        if let Some(end) = self.between(way, &side.begin, &mut side.members)? {
            side.ended = Some(SideEnd::Before(ended(here, &end)));
            return Ok(());
        }
        if side.begin.unit().is_some() && here.unit().is_none() && next.unit().is_none() {
            let value = significant(next.value, 6, 1e-4..1e6);
            side.ended = Some(SideEnd::Before(format!(
                "from {value} on the family cannot be distinguished from the orbits beside it: its multipliers are \
                 1 within rounding"
            )));
            return Ok(());
        }
        // orbits may become much larger along their family
        let size = side.size;
        side.size = side.size.max(self.size(&next.state));
        if count <= 3 {
            side.step = (1.5 * side.step).min(self.largest_step(&next, size));
        }
        side.here = next;
        Ok(())
    }
}
