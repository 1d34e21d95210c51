//! The search for the places where nothing moves: Newton's method from many beginnings.
//!
//! In: a phase space and a start. Out: the variables of places at which the rates vanish. Never here: what kind of equilibrium it is.

use nalgebra::{DMatrix, DVector};

use crate::dynamics::constrained_balance::ConstrainedBalance;
use crate::dynamics::equilibrium_units::{coordinate_units, units};
use crate::dynamics::error::DynamicsError;
use crate::dynamics::linear;
use crate::dynamics::phase_space::{NOTHING_MOVES, PhaseSpace, VectorField};
use crate::system::{Form, State};

/// The number of steps from each beginning.
const STEPS: usize = 60;

/// A rate counts as zero up to this part of what the variables can cause.
const ZERO: f64 = 1e-12;

/// Velocities are linear in the momenta if their derivatives differ by no more than this part.
const LINEAR_IN_MOMENTA: f64 = 1e-9;

/// A place is known up to this part of its size plus its unit.
pub(super) const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Half a turn itself is not taken for its opposite by rounding.
const HALF_A_TURN: f64 = 0.5 + 1e-9;

/// Singular values up to this part of the largest are not divided by in a step of Newton's.
const VANISHES: f64 = 1e-8;

/// Next to a zero of the rates they grow over this distance, in the size of the place; next to a pole they fall.
const BEYOND_ROUNDING: f64 = 1e-12;

/// The number of steps in which a zero of higher order is approached further.
const FURTHER_STEPS: usize = 60;

/// Where no step makes the rates smaller there is a zero only if the last one is no more than this part of the place: in the tails of
/// forces, as x⁻⁷, it is a seventh.
const NEAR_ITS_ZERO: f64 = 1e-3;

/// A step of Newton's is a part of the one before it where it converges linearly: that of a zero of order m is 1 − 1/m.
const LINEAR: std::ops::Range<f64> = 0.4..0.999;

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
    /// The cyclic coordinates.
    pub(super) cyclic: Vec<usize>,
    /// The number of coordinates, or of the variables of brackets.
    pub(super) degrees: usize,
    /// The unit of each variable.
    pub(super) units: Vec<f64>,
    /// The values of the Casimirs, which are those of the start.
    pub(super) casimirs: Vec<f64>,
    /// Whether equilibria may differ by their momenta alone, as those of H = p⁴ − p² do.
    pub(super) has_many_momenta: bool,
}

impl<'a> EquilibriumSearch<'a> {
    pub(super) fn new(space: &'a PhaseSpace, start: &'a State) -> Result<Self, DynamicsError> {
        let degrees = space.system().degrees();
        let canonical = space.form() == Form::Momentum;
        let cyclic = if canonical { space.cyclic().to_vec() } else { Vec::new() };
        if space.is_constrained() {
            let allowed = space.state(start).and_then(|s| space.allowed_displacements(&s));
            if matches!(allowed, Ok((_, 0))) {
                return Err(DynamicsError::Unsuited(NOTHING_MOVES.to_owned()));
            }
            let balance = ConstrainedBalance::new(space, start)?;
            let (middle, unknowns) = (balance.start(), balance.unknowns());
            let mut units = coordinate_units(space, &middle[..degrees]);
            units.extend(middle[degrees..].iter().map(|v| if *v == 0.0 { 1.0 } else { v.abs() }));
            let law = LawAtRest::Constrained(Box::new(balance));
            let (casimirs, has_many_momenta) = (Vec::new(), false);
            return Ok(Self {
                space,
                start,
                law,
                middle,
                unknowns,
                cyclic,
                degrees,
                units,
                casimirs,
                has_many_momenta,
            });
        }
        let unknowns =
            (0..space.dimension()).filter(|i| !cyclic.contains(&(i % degrees))).collect();
        let mut field = space.vector_field();
        let units = units(space, start, &mut field);
        let middle = space.variables(start).to_vec();
        let casimirs = space.casimirs(start)?;
        let has_many_momenta =
            canonical && has_many_momenta(&mut field, start.time, &middle, &units);
        let law = LawAtRest::Free(Box::new(field));
        Ok(Self {
            space,
            start,
            law,
            middle,
            unknowns,
            cyclic,
            degrees,
            units,
            casimirs,
            has_many_momenta,
        })
    }

    /// What must vanish and its derivatives, in the units of the variables.
    pub(super) fn look_in_units(
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

    /// ∂f/∂z of the variables that rest, with 0 where it is smaller than its change over the rounding error of the place: it vanishes
    /// at the equilibrium, but not at the nearest number.
    pub(super) fn slopes(&mut self, variables: &[f64]) -> Option<DMatrix<f64>> {
        let LawAtRest::Free(field) = &mut self.law else { return None };
        let mut beside = variables.to_vec();
        for &i in &self.unknowns {
            beside[i] += ROUNDED * (variables[i].abs() + self.units[i]);
        }
        let slopes = resting_rates(field, (self.start.time, &beside), &self.unknowns);
        let (_, df) = resting_rates(field, (self.start.time, variables), &self.unknowns)?;
        let Some((_, beside)) = slopes else { return Some(df) };
        Some(df.zip_map(
            &beside,
            |at, beside| {
                if at.abs() <= (at - beside).abs() { 0.0 } else { at }
            },
        ))
    }

    /// Whether the rates fall away from a place in the direction in which they change most, as they do next to a pole, where they are
    /// as small a part of their derivative as at a zero.
    fn is_pole(&mut self, variables: &[f64]) -> bool {
        let Some((f, df)) = self.look_in_units(variables) else { return true };
        let size = size_of(&self.in_units(variables));
        let steepest = (0..df.ncols())
            .max_by(|&a, &b| df.column(a).amax().total_cmp(&df.column(b).amax()))
            .unwrap_or(0);
        let beside = [1.0, -1.0].map(|side| {
            let mut there = variables.to_vec();
            let i = self.unknowns[steepest];
            there[i] += side * BEYOND_ROUNDING * size * self.units[i];
            self.look_in_units(&there).map_or(f64::INFINITY, |(g, _)| g.amax())
        });
        beside.into_iter().all(|g| g < f.amax())
    }

    /// Newton's method from a beginning.
    pub(super) fn from(&mut self, beginning: Vec<f64>) -> Option<Vec<f64>> {
        let mut variables = beginning;
        if self.unknowns.is_empty() {
            return None;
        }
        let (mut f, mut df) = self.look_in_units(&variables)?;
        let mut settled = 0;
        for _ in 0..STEPS {
            if self.space.system().cancel().is_cancelled() {
                return None;
            }
            let size = size_of(&self.in_units(&variables));
            if f.amax() <= ZERO * size * df.amax() {
                settled += 1;
                if settled > 2 {
                    return self.accepted(variables);
                }
            }
            let step = linear::least_squares(&df, &(-&f), VANISHES * df.amax())?;
            let mut part = 1.0_f64.min(2.0 * size / step.amax().max(f64::MIN_POSITIVE));
            let next = loop {
                let mut there = variables.clone();
                for (k, &i) in self.unknowns.iter().enumerate() {
                    there[i] += part * step[k] * self.units[i];
                }
                match self.look_in_units(&there) {
                    Some((g, dg)) if settled > 0 || g.norm() < f.norm() => {
                        break Some((there, g, dg));
                    }
                    _ if part < 1e-4 => break None,
                    _ => part *= 0.5,
                }
            };
            let Some(next) = next else { break };
            (variables, f, df) = next;
        }
        if settled > 0 { self.accepted(variables) } else { None }
    }

    /// The variables of the search in their units.
    pub(super) fn in_units(&self, variables: &[f64]) -> Vec<f64> {
        self.unknowns.iter().map(|&i| variables[i] / self.units[i]).collect()
    }

    /// Newton's method continued from a place at which the rates are small, with all directions in which they change. Where they
    /// vanish to a higher order, as those of V = x⁴ do, the steps shrink by a constant factor 1 − 1/m, and m of them are taken
    /// at once (E. Schröder, Math. Ann. 2, 317 (1870)). Returns `None` where the rates go on shrinking without a zero, as in the
    /// tail of V = exp(−x²).
    fn approached(&mut self, mut variables: Vec<f64>) -> Option<Vec<f64>> {
        // on a family of equilibria Newton's method is taken across it
        if let Some(there) = self.across(&variables) {
            return Some(there);
        }
        let (mut f, mut df) = self.look_in_units(&variables)?;
        let mut before: Option<DVector<f64>> = None;
        for _ in 0..FURTHER_STEPS {
            if is_rounding(&f, &df, &self.in_units(&variables)) {
                return Some(variables);
            }
            // in a direction in which nothing changes there is a family of equilibria
            let Some(step) = newton_step(&df, &f) else { return Some(variables) };
            if step.amax() <= f64::EPSILON * size_of(&self.in_units(&variables)) {
                return Some(variables);
            }
            let ratio = before.as_ref().map_or(0.0, |last| step.dot(last) / last.norm_squared());
            let multiples =
                if LINEAR.contains(&ratio) { vec![1.0 / (1.0 - ratio), 1.0] } else { vec![1.0] };
            let next = multiples.into_iter().find_map(|multiple| {
                let mut there = variables.clone();
                for (k, &i) in self.unknowns.iter().enumerate() {
                    there[i] += multiple * step[k] * self.units[i];
                }
                let (g, dg) = self.look_in_units(&there)?;
                let shrinks = newton_step(&dg, &g).is_none_or(|s| s.norm() < 0.97 * step.norm());
                (shrinks || g.amax() < 0.9 * f.amax()).then_some((there, g, dg, multiple))
            });
            let Some((there, g, dg, multiple)) = next else {
                // what is left is rounding, unless a zero is far away
                let is_near = step.amax() <= NEAR_ITS_ZERO * size_of(&self.in_units(&variables));
                return is_near.then_some(variables);
            };
            (variables, f, df) = (there, g, dg);
            before = (multiple == 1.0).then_some(step);
        }
        None
    }

    /// Takes the place nearest to the start among its periods, with angles within half a turn of zero. Returns whether it is in reach.
    pub(super) fn within_periods(&self, variables: &mut [f64]) -> bool {
        let start = &self.middle;
        let mut in_reach = true;
        for &i in &self.unknowns {
            if let Some(period) = self.space.turns()[i] {
                let turns = ((variables[i] - start[i]) / period).round();
                variables[i] -= turns * period;
            }
            let far = self.radii()[self.radii().len() - 1] * (self.units[i] + start[i].abs());
            if i < self.degrees && (variables[i] - start[i]).abs() > far {
                in_reach = false;
            }
            if let Some(period) = self.space.periods()[i] {
                variables[i] -= period * (variables[i] / period - HALF_A_TURN).ceil();
            }
            // a zero but for rounding
            if variables[i].abs() < 1e-14 * self.units[i] {
                variables[i] = 0.0;
            }
        }
        in_reach
    }

    /// The variables nearest to the start among their periods, if they are in reach; angles within half a turn of zero,
    /// however often the motion has gone round.
    fn accepted(&mut self, variables: Vec<f64>) -> Option<Vec<f64>> {
        let mut variables = self.approached(variables)?;
        if self.is_pole(&variables) {
            return None;
        }
        if !self.within_periods(&mut variables) {
            return None;
        }
        match &mut self.law {
            LawAtRest::Constrained(balance) => (!balance.drives(&variables)).then_some(variables),
            LawAtRest::Free(field) => {
                // a force on a cyclic coordinate, as friction, lets nothing rest
                resting_rates(field, (self.start.time, &variables), &self.unknowns)?;
                let (rate, derivative, units) = (field.rate(), field.derivative(), &self.units);
                let part = |i: usize, j: usize| derivative[(i, j)].abs() * units[j] / units[i];
                let all = 0..units.len();
                let caused = all.clone().flat_map(|i| all.clone().map(move |j| (i, j)));
                let caused = caused.map(|(i, j)| part(i, j)).fold(0.0, f64::max);
                let of = |i: usize| rate[i].abs() / units[i];
                let size = all.map(of).fold(caused, f64::max);
                let pushed = |i: &usize| of(self.degrees + i) > 1e3 * ZERO * size;
                (!self.cyclic.iter().any(pushed)).then_some(variables)
            }
        }
    }
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
    (&at_rest - &moving).amax() > LINEAR_IN_MOMENTA * at_rest.amax().max(moving.amax())
}

/// The size of a place in units.
fn size_of(place: &[f64]) -> f64 {
    place.iter().fold(1.0, |most, x| most.max(x.abs()))
}

/// Whether f is no more than the rounding of the place leaves of it.
fn is_rounding(f: &DVector<f64>, df: &DMatrix<f64>, place: &[f64]) -> bool {
    f.iter().enumerate().all(|(i, f)| {
        let terms = place.iter().enumerate().map(|(j, x)| (df[(i, j)] * x).abs());
        f.abs() <= ROUNDED * terms.sum::<f64>()
    })
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
fn resting_rates(
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
