//! The search for the places where nothing moves: Newton's method from many guesses.
//!
//! In: a phase space and a start. Out: the variables of places at which the rates vanish. Never here: what kind of equilibrium it is.

use nalgebra::{DMatrix, DVector};

use crate::dynamics::constrained_balance::ConstrainedBalance;
use crate::dynamics::equilibrium_units::{coordinate_units, units};
use crate::dynamics::error::DynamicsError;
use crate::dynamics::linear;
use crate::dynamics::phase_space::{NOTHING_MOVES, PhaseSpace};
use crate::dynamics::vector_field::VectorField;
use crate::system::{Form, State};

/// The number of steps from each guess.
const STEPS: usize = 60;

/// A rate counts as zero up to this part of what the variables can cause.
pub(super) const ZERO: f64 = 1e-12;

/// Velocities are linear in the momenta if their derivatives differ by no more than this part.
const LINEAR_IN_MOMENTA: f64 = 1e-9;

/// A place is known up to this part of its size plus its unit.
pub(super) const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Singular values up to this part of the largest are not divided by in a step of Newton's.
const VANISHES: f64 = 1e-8;

/// What must vanish at an equilibrium, and of what.
pub(super) enum LawAtRest {
    /// The rates of the variables of the phase space.
    Free(Box<VectorField>),
    /// What remains of the forces under constraints, of coordinates and velocities.
    Constrained(Box<ConstrainedBalance>),
}

pub(super) struct EquilibriumSearch<'a> {
    pub(super) space: &'a PhaseSpace,
    pub(super) start: &'a State,
    pub(super) law: LawAtRest,
    /// The variables of the search at the start: those of the space, or under constraints (q, q̇).
    pub(super) middle: Vec<f64>,
    /// The variables that are searched for, by index.
    pub(super) unknowns: Vec<usize>,
    pub(super) cyclic: Vec<usize>,
    /// The number of coordinates, or of the variables of brackets.
    pub(super) degrees: usize,
    pub(super) units: Vec<f64>,
    /// The values of the Casimirs, which are those of the start.
    pub(super) casimirs: Vec<f64>,
    /// Whether equilibria may differ by their momenta alone, as those of H = p⁴ − p² do.
    pub(super) has_many_momenta: bool,
}

impl<'a> EquilibriumSearch<'a> {
    pub(super) fn new(space: &'a PhaseSpace, start: &'a State) -> Result<Self, DynamicsError> {
        if space.is_constrained() {
            Self::on_surface(space, start)
        } else {
            Self::in_phase_space(space, start)
        }
    }

    /// The search for coordinates on the surface of the constraints.
    fn on_surface(space: &'a PhaseSpace, start: &'a State) -> Result<Self, DynamicsError> {
        let allowed = space.state(start).and_then(|s| space.allowed_displacements(&s));
        if matches!(allowed, Ok((_, 0))) {
            return Err(DynamicsError::Unsuited(NOTHING_MOVES.to_owned()));
        }
        let degrees = space.system().degrees();
        let balance = ConstrainedBalance::new(space, start)?;
        let middle = balance.start();
        let mut units = coordinate_units(space, &middle[..degrees]);
        units.extend(middle[degrees..].iter().map(|v| if *v == 0.0 { 1.0 } else { v.abs() }));
        Ok(Self {
            space,
            start,
            middle,
            unknowns: balance.unknowns(),
            cyclic: cyclic(space),
            degrees,
            units,
            casimirs: Vec::new(),
            has_many_momenta: false,
            law: LawAtRest::Constrained(Box::new(balance)),
        })
    }

    /// The search for all variables but the cyclic coordinates and their momenta.
    fn in_phase_space(space: &'a PhaseSpace, start: &'a State) -> Result<Self, DynamicsError> {
        let (degrees, cyclic) = (space.system().degrees(), cyclic(space));
        let mut field = space.vector_field();
        let units = units(space, start, &mut field);
        let middle = space.variables(start).to_vec();
        Ok(Self {
            space,
            start,
            unknowns: (0..space.dimension()).filter(|i| !cyclic.contains(&(i % degrees))).collect(),
            cyclic,
            degrees,
            casimirs: space.casimirs(start)?,
            has_many_momenta: space.form() == Form::Momentum
                && has_many_momenta(&mut field, start.time, &middle, &units),
            middle,
            units,
            law: LawAtRest::Free(Box::new(field)),
        })
    }

    /// What must vanish and its derivatives, in the units of the variables.
    pub(super) fn equations_in_units(
        &mut self,
        variables: &[f64],
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let field = match &mut self.law {
            LawAtRest::Constrained(balance) => return balance.equations(variables, &self.units),
            LawAtRest::Free(field) => field,
        };
        let (mut f, mut df) = resting_rates(field, (self.start.time, variables), &self.unknowns)?;
        let unit = |k: usize| self.units[self.unknowns[k]];
        for i in 0..f.len() {
            f[i] /= unit(i);
            for j in 0..f.len() {
                df[(i, j)] *= unit(j) / unit(i);
            }
        }
        if self.casimirs.is_empty() {
            return Some((f, df));
        }
        self.with_casimirs(variables, (f, df))
    }

    /// The same with what the Casimirs lack of their values, as large as the rates are by their derivatives.
    fn with_casimirs(
        &self,
        variables: &[f64],
        (mut f, mut df): (DVector<f64>, DMatrix<f64>),
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let levels = self.space.levels()?;
        let state = self.space.state_at(self.start, variables);
        let all = levels.at(&state, self.space.parameters()).ok()?;
        let (rows, scale) = (f.len(), df.amax());
        f = f.resize_vertically(rows + self.casimirs.len(), 0.0);
        df = df.resize_vertically(rows + self.casimirs.len(), 0.0);
        let casimirs = all.iter().skip(usize::from(levels.has_energy()));
        for (k, (level, wanted)) in casimirs.zip(&self.casimirs).enumerate() {
            let slope = |j: usize| {
                let i = self.unknowns[j];
                level.gradient[i] * self.units[i]
            };
            let norm = (0..self.unknowns.len()).fold(0.0_f64, |most, j| most.max(slope(j).abs()));
            let norm = if norm > 0.0 { norm / scale } else { 1.0 };
            f[rows + k] = (level.value - wanted) / norm;
            for j in 0..self.unknowns.len() {
                df[(rows + k, j)] = slope(j) / norm;
            }
        }
        f.iter().chain(df.iter()).all(|x| x.is_finite()).then_some((f, df))
    }

    /// ∂f/∂z of the variables that rest, and its changes over what is uncertain of a place, which may be moved along the `excluded`
    /// directions; 0 where it is smaller than these: it vanishes at the equilibrium, but not at the nearest number.
    pub(super) fn slopes(
        &mut self,
        variables: &[f64],
        excluded: &[DVector<f64>],
    ) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let mut uncertain = self.uncertainty(&self.in_units(variables), excluded)?;
        for (k, &i) in self.unknowns.iter().enumerate() {
            let rounding = ROUNDED * (variables[i].abs() + self.units[i]);
            uncertain[k] = uncertain[k] * self.units[i] + rounding;
        }
        let LawAtRest::Free(field) = &mut self.law else { return None };
        let (time, unknowns) = (self.start.time, &self.unknowns);
        let (_, df) = resting_rates(field, (time, variables), unknowns)?;
        let mut error = DMatrix::zeros(df.nrows(), df.ncols());
        for side in [1.0, -1.0] {
            let mut beside = variables.to_vec();
            for (&i, uncertain) in unknowns.iter().zip(&uncertain) {
                beside[i] += side * uncertain;
            }
            if let Some((_, beside)) = resting_rates(field, (time, &beside), unknowns) {
                error = error.sup(&(&df - beside).abs());
            }
        }
        let known = df.zip_map(&error, |at, error| if at.abs() <= error { 0.0 } else { at });
        Some((known, error))
    }

    /// Newton's method from a guess.
    pub(super) fn from(&mut self, guess: Vec<f64>) -> Option<Vec<f64>> {
        let first = guess.clone();
        let mut variables = guess;
        if self.unknowns.is_empty() {
            return None;
        }
        let (mut f, mut df) = self.equations_in_units(&variables)?;
        let mut settled = 0;
        for _ in 0..STEPS {
            if self.space.system().cancel().is_cancelled() {
                return None;
            }
            let size = size_of(&self.in_units(&variables));
            if is_zero(f.amax(), [size, df.amax()]) {
                settled += 1;
                if settled > 2 {
                    return self.accepted(&variables, &first);
                }
            }
            // without directions in which little changes; where these alone are left, in them too
            let across = step_across(&df, &f)?;
            let mut next = self.damped(&variables, (&f, settled > 0), &across);
            if next.is_none() {
                let whole = newton_step(&df, &f);
                next = whole.and_then(|step| self.damped(&variables, (&f, false), &step));
            }
            let Some(next) = next else { break };
            (variables, f, df) = next;
        }
        if settled > 0 { self.accepted(&variables, &first) } else { None }
    }

    /// The place at the end of a step, or of the first part of it, at which the rates are smaller or need not be.
    fn damped(
        &mut self,
        from: &[f64],
        (f, any): (&DVector<f64>, bool),
        step: &DVector<f64>,
    ) -> Option<(Vec<f64>, DVector<f64>, DMatrix<f64>)> {
        let size = size_of(&self.in_units(from));
        let mut part = 1.0_f64.min(2.0 * size / step.amax().max(f64::MIN_POSITIVE));
        loop {
            let mut there = from.to_vec();
            for (k, &i) in self.unknowns.iter().enumerate() {
                there[i] += part * step[k] * self.units[i];
            }
            match self.equations_in_units(&there) {
                Some((g, dg)) if any || g.norm() < f.norm() => return Some((there, g, dg)),
                _ if part < 1e-4 => return None,
                _ => part *= 0.5,
            }
        }
    }

    /// The unknowns of a place in their units.
    pub(super) fn in_units(&self, variables: &[f64]) -> DVector<f64> {
        let parts = self.unknowns.iter().map(|&i| variables[i] / self.units[i]);
        DVector::from_iterator(self.unknowns.len(), parts)
    }

    /// The variables of a place in units; the others are those of the search.
    pub(super) fn unscaled(&self, place: &DVector<f64>) -> Vec<f64> {
        let mut variables = self.middle.clone();
        for (k, &i) in self.unknowns.iter().enumerate() {
            variables[i] = place[k] * self.units[i];
        }
        variables
    }

    /// What must vanish at a place and its derivatives, all in units.
    pub(super) fn evaluate(
        &mut self,
        place: &DVector<f64>,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        self.equations_in_units(&self.unscaled(place))
    }
}

fn cyclic(space: &PhaseSpace) -> Vec<usize> {
    if space.form() == Form::Momentum { space.cyclic().to_vec() } else { Vec::new() }
}

/// Whether the velocities are not linear in the momenta: then several momenta may belong to rest.
fn has_many_momenta(field: &mut VectorField, time: f64, start: &[f64], units: &[f64]) -> bool {
    let degrees = start.len() / 2;
    let mut mobility = |part: f64| {
        let mut there = start.to_vec();
        (degrees..2 * degrees).for_each(|i| there[i] = part * units[i]);
        field.evaluate(time, &there).ok()?;
        Some(field.derivative().view((0, degrees), (degrees, degrees)).into_owned())
    };
    let (Some(at_rest), Some(moving)) = (mobility(0.0), mobility(1.0)) else { return true };
    differ((&at_rest - &moving).amax(), at_rest.amax().max(moving.amax()))
}

/// The size of a place in units.
pub(super) fn size_of(place: &DVector<f64>) -> f64 {
    place.amax().max(1.0)
}

/// The step at which the linear part of f vanishes, without directions in which little changes.
fn step_across(df: &DMatrix<f64>, f: &DVector<f64>) -> Option<DVector<f64>> {
    linear::least_squares(df, &(-f), VANISHES * df.amax())
}

/// The step at which the linear part of f vanishes; `None` if it does not change in some direction.
fn newton_step(df: &DMatrix<f64>, f: &DVector<f64>) -> Option<DVector<f64>> {
    let step = if df.is_square() {
        // a matrix of rows of very different size is solved row by row, where singular values would be lost
        df.clone().lu().solve(&-f)
    } else {
        linear::least_squares(df, &-f, 0.0)
    };
    step.filter(|step| step.iter().all(|x| x.is_finite()))
}

/// f and ∂f/∂z of the variables that rest.
pub(super) fn resting_rates(
    field: &mut VectorField,
    (time, variables): (f64, &[f64]),
    resting: &[usize],
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    field.evaluate(time, variables).ok()?;
    let (rate, derivative) = (field.rate(), field.derivative());
    let n = resting.len();
    let f = DVector::from_fn(n, |i, _| rate[resting[i]]);
    let df = DMatrix::from_fn(n, n, |i, j| derivative[(resting[i], resting[j])]);
    f.iter().chain(df.iter()).all(|x| x.is_finite()).then_some((f, df))
}

/// Whether a rate is zero beside what variables of this size can cause by its slopes.
fn is_zero(rate: f64, [size, slope]: [f64; 2]) -> bool {
    rate <= ZERO * size * slope
}

/// Whether the derivatives of velocities by momenta differ, of at most this size.
fn differ(by: f64, size: f64) -> bool {
    by > LINEAR_IN_MOMENTA * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_of_the_search_are_parts_of_what_they_are_compared_with() {
        assert!(is_zero(5.9e-12, [3.0, 2.0]) && !is_zero(6.1e-12, [3.0, 2.0]));
        assert!(differ(2.1e-9, 2.0) && !differ(1.9e-9, 2.0));
    }

    #[test]
    fn a_step_leaves_out_directions_of_less_than_a_hundred_millionth_of_the_change() {
        let step = |small: f64| {
            let df = DMatrix::from_diagonal(&DVector::from_vec(vec![2.0, 2.0 * small]));
            step_across(&df, &DVector::from_vec(vec![1.0, 1.0])).expect("a step")
        };
        assert!((step(1.1e-8)[1] * 2.2e-8 + 1.0).abs() < 1e-6);
        assert_eq!(step(0.9e-8)[1], 0.0);
    }
}
