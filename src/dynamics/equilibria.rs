//! Equilibria and the small oscillations about them.
//!
//! In: a phase space and where to look. Out: every place in reach where the rates vanish; with
//! cyclic coordinates also where all others rest while these go on with their momenta (relative
//! equilibria), with kind, eigenvalues, frequencies and modes; under constraints the places on their surface
//! (`constrained_balance`). Never here: text.
//!
//! The places are found by Newton's method with many beginnings (a sequence of Halton's), so that
//! what is found is certain and what is not found is likely, but not certain, to be absent. The
//! kind is that of the effective potential: the least energy at fixed coordinates, whose second
//! derivative is H_qq − H_qp H_pp⁻¹ H_pq.

use nalgebra::{DMatrix, DVector};

use super::constrained_balance::ConstrainedBalance;
use super::equilibrium::{Equilibria, Equilibrium, in_a_family, in_order};
use super::equilibrium_units::{coordinate_units, units};
use super::error::DynamicsError;
use super::halton::halton;
use super::linear;
use super::phase_space::{NOTHING_MOVES, PhaseSpace, VectorField};
use super::small_oscillation::{Kind, Mode, modes, stable};
use super::virtual_work::{Balance, virtual_work};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::{Form, MotionErrorKind, State};

/// The number of beginnings of the search.
const BEGINNINGS: usize = 600;

/// The number of steps from each.
const STEPS: usize = 60;

/// How far around its centre a coordinate without period is searched, in its size there plus its
/// unit.
const RADII: [f64; 5] = [0.5, 1.5, 4.0, 12.0, 40.0];

/// How many of these are searched where the units are ordinary. In other units a start says how large a coordinate is there,
/// which may be a small part of what the forces reach over.
const ORDINARY_RADII: usize = 3;

/// A rate counts as zero up to this part of what the variables can cause.
const ZERO: f64 = 1e-12;

/// Half a turn itself is not taken for its opposite by rounding.
const HALF_A_TURN: f64 = 0.5 + 1e-9;

/// Two places are the same up to this distance relative to their size plus their unit.
const SAME: f64 = 1e-7;

/// Singular values up to this part of the largest are not divided by in a step of Newton's.
const VANISHES: f64 = 1e-8;

/// The largest number of equilibria.
const MOST: usize = 100;

/// Writes into each equilibrium the forces that balance there.
pub fn with_virtual_work(law: (&Model, &Equations), parameters: &[f64], found: &mut [Equilibrium]) {
    let places: Vec<_> = found.iter().map(|one| (&one.variables[..], &one.rates[..])).collect();
    let balances = virtual_work(law, parameters, &places);
    for (one, Balance { work, multipliers }) in found.iter_mut().zip(balances) {
        (one.work, one.multipliers) = (work, multipliers);
    }
}

/// Searches around the coordinates of `start`; cyclic coordinates have its momenta.
///
/// # Errors
/// Returns an error if the law of motion depends on time.
pub fn equilibria(space: &PhaseSpace, start: &State) -> Result<Equilibria, DynamicsError> {
    equilibria_watched(space, start, &mut |_, _| ())
}

/// Like [`equilibria`]; after each of its beginnings it hands on how many of all are done.
///
/// # Errors
/// Returns an error if the law of motion depends on time.
pub fn equilibria_watched(
    space: &PhaseSpace,
    start: &State,
    look: &mut dyn FnMut(usize, usize),
) -> Result<Equilibria, DynamicsError> {
    if !space.is_autonomous() {
        return Err(DynamicsError::Unsuited(
            "the law of motion depends on time, and nothing stays at rest in it".to_owned(),
        ));
    }
    let mut search = EquilibriumSearch::new(space, start)?;
    let mut found: Vec<Equilibrium> = Vec::new();
    let mut cancelled = false;
    let mut beginning = 0;
    // laws are often the same in a mirror, and so are their equilibria
    let mut images: Vec<Vec<f64>> = Vec::new();
    while beginning < BEGINNINGS {
        if space.system().cancel().is_cancelled() {
            cancelled = true;
            break;
        }
        let place = images.pop().unwrap_or_else(|| {
            look(beginning, BEGINNINGS);
            beginning += 1;
            search.beginning(beginning - 1)
        });
        let Some(variables) = search.from(place) else { continue };
        if found.iter().any(|known| search.alike(&known.variables, &variables)) {
            continue;
        }
        let Some(one) = search.described(&variables)? else { continue };
        // of a family of equilibria one is enough
        let constrained = space.is_constrained();
        if !found.iter().any(|known| in_a_family(known, &one, constrained)) {
            found.push(one);
            images.extend(search.images(&variables));
        }
        if found.len() == MOST {
            break;
        }
    }
    in_order(&mut found);
    let periods = search.unknowns.iter().filter_map(|&i| Some((i, space.turns()[i]?))).collect();
    Ok(Equilibria { found, periods, cancelled })
}

/// What must vanish at an equilibrium, and of what.
enum LawAtRest {
    /// The rates of the variables of the phase space.
    Free(Box<VectorField>),
    /// What remains of the forces under constraints, of coordinates and velocities.
    Constrained(Box<ConstrainedBalance>),
}

struct EquilibriumSearch<'a> {
    space: &'a PhaseSpace,
    start: &'a State,
    law: LawAtRest,
    /// The variables of the search at the start: those of the space, or under constraints (q, q̇).
    middle: Vec<f64>,
    /// The variables that are searched for, by index.
    unknowns: Vec<usize>,
    /// The cyclic coordinates.
    cyclic: Vec<usize>,
    /// The number of coordinates, or of the variables of brackets.
    degrees: usize,
    /// The unit of each variable.
    units: Vec<f64>,
}

impl<'a> EquilibriumSearch<'a> {
    fn new(space: &'a PhaseSpace, start: &'a State) -> Result<Self, DynamicsError> {
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
            return Ok(Self { space, start, law, middle, unknowns, cyclic, degrees, units });
        }
        let unknowns =
            (0..space.dimension()).filter(|i| !cyclic.contains(&(i % degrees))).collect();
        let mut field = space.vector_field();
        let units = units(space, start, &mut field);
        let (law, middle) = (LawAtRest::Free(Box::new(field)), space.variables(start).to_vec());
        Ok(Self { space, start, law, middle, unknowns, cyclic, degrees, units })
    }

    /// How far around its centre a coordinate is searched.
    fn radii(&self) -> &'static [f64] {
        let mut lengths = (0..self.degrees).filter(|&i| self.space.turns()[i].is_none());
        let ordinary = lengths.all(|i| self.units[i] == 1.0);
        if ordinary { &RADII[..ORDINARY_RADII] } else { &RADII }
    }

    /// The variables at which a search begins: the start itself, then places around it.
    fn beginning(&self, index: usize) -> Vec<f64> {
        let mut variables = self.middle.clone();
        let canonical = self.space.form() == Form::Momentum;
        let radii = self.radii();
        let radius = radii[index % radii.len()];
        for (k, &i) in self.unknowns.iter().enumerate() {
            if canonical && i >= self.degrees {
                // velocities of cyclic coordinates are those of the start
                if matches!(self.law, LawAtRest::Free(_)) {
                    variables[i] = 0.0;
                }
            } else if index > 0 {
                let part = halton(index, k);
                let centre = variables[i];
                variables[i] += match self.space.turns()[i] {
                    Some(period) => (part - 0.5) * period,
                    None => (2.0 * part - 1.0) * radius * (self.units[i] + centre.abs()),
                };
            }
        }
        variables
    }

    /// What must vanish and its derivatives, in the units of the variables.
    fn look_in_units(&mut self, variables: &[f64]) -> Option<(DVector<f64>, DMatrix<f64>)> {
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
        Some((f, df))
    }

    /// The images of a place in each coordinate that rests, and in all of them.
    fn images(&self, variables: &[f64]) -> Vec<Vec<f64>> {
        let resting = self.unknowns.iter().copied().filter(|&i| i < self.degrees);
        let resting: Vec<usize> = resting.filter(|&i| variables[i] != 0.0).collect();
        let image = |coordinates: &[usize]| {
            let mut image = variables.to_vec();
            for &i in coordinates {
                image[i] = -image[i];
            }
            image
        };
        resting.iter().map(|&i| image(&[i])).chain([image(&resting)]).collect()
    }

    /// Newton's method from a beginning.
    fn from(&mut self, beginning: Vec<f64>) -> Option<Vec<f64>> {
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
            let sizes = self.unknowns.iter().map(|&i| (variables[i] / self.units[i]).abs());
            let size = sizes.fold(1.0, f64::max);
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

    /// The variables nearest to the start among their periods, if they are in reach; angles within half a turn of zero,
    /// however often the motion has gone round.
    fn accepted(&mut self, mut variables: Vec<f64>) -> Option<Vec<f64>> {
        let start = &self.middle;
        for &i in &self.unknowns {
            if let Some(period) = self.space.turns()[i] {
                let turns = ((variables[i] - start[i]) / period).round();
                variables[i] -= turns * period;
            }
            let far = self.radii()[self.radii().len() - 1] * (self.units[i] + start[i].abs());
            if i < self.degrees && (variables[i] - start[i]).abs() > far {
                return None;
            }
            if let Some(period) = self.space.periods()[i] {
                variables[i] -= period * (variables[i] / period - HALF_A_TURN).ceil();
            }
            // a zero but for rounding
            if variables[i].abs() < 1e-14 * self.units[i] {
                variables[i] = 0.0;
            }
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

    fn alike(&self, a: &[f64], b: &[f64]) -> bool {
        // velocities follow from the coordinates
        let places = matches!(self.law, LawAtRest::Constrained(_));
        let mut unknowns = self.unknowns.iter().filter(|&&i| !places || i < self.degrees);
        unknowns.all(|&i| {
            let mut apart = a[i] - b[i];
            if let Some(period) = self.space.turns()[i] {
                apart -= (apart / period).round() * period;
            }
            apart.abs() <= SAME * (self.units[i] + a[i].abs())
        })
    }

    fn described(&mut self, variables: &[f64]) -> Result<Option<Equilibrium>, DynamicsError> {
        let state = match &self.law {
            LawAtRest::Free(_) => self.space.state_at(self.start, variables),
            LawAtRest::Constrained(balance) => match balance.state(variables) {
                Ok(state) => state,
                Err(_) => return Ok(None),
            },
        };
        let energy = match self.space.system().energy(&state, self.space.parameters()) {
            Ok(energy) => energy,
            Err(fault) if fault.kind == MotionErrorKind::Cancelled => return Err(fault.into()),
            Err(_) => return Ok(None),
        };
        let found = match &mut self.law {
            LawAtRest::Free(_) => self.around(variables),
            LawAtRest::Constrained(_) => self.around_on_surface(variables),
        };
        let Some((kind, eigenvalues, modes)) = found else { return Ok(None) };
        let rates = match &self.law {
            LawAtRest::Free(field) => {
                let rate = field.rate();
                self.cyclic.iter().map(|&i| (i, rate[i])).collect()
            }
            LawAtRest::Constrained(_) => {
                self.cyclic.iter().map(|&i| (i, variables[self.degrees + i])).collect()
            }
        };
        let stable = stable(&eigenvalues);
        let variables = self.space.variables(&state).to_vec();
        let (work, multipliers) = (Vec::new(), Vec::new());
        Ok(Some(Equilibrium {
            name: String::new(),
            variables,
            energy,
            kind,
            eigenvalues,
            modes,
            stable,
            rates,
            work,
            multipliers,
        }))
    }

    /// The kind, the eigenvalues and the modes at a place, of variables that are independent.
    fn around(&mut self, variables: &[f64]) -> Option<Around> {
        let LawAtRest::Free(field) = &mut self.law else { return None };
        let (_, df) = resting_rates(field, (self.start.time, variables), &self.unknowns)?;
        let eigenvalues = linear::rates(&df);
        if self.space.form() != Form::Momentum {
            return Some((None, eigenvalues, Vec::new()));
        }
        let modes = match self.look_in_units(variables) {
            Some((_, in_units)) => {
                let count = self.unknowns.len();
                let places = DMatrix::identity(count / 2, count);
                self.modes(&in_units, &eigenvalues, &places)
            }
            None => Vec::new(),
        };
        Some((Some(Kind::of_canonical(&df)), eigenvalues, modes))
    }

    /// The same of displacements along the surface of constraints.
    fn around_on_surface(&mut self, variables: &[f64]) -> Option<Around> {
        let LawAtRest::Constrained(balance) = &mut self.law else { return None };
        let around = balance.around(variables, &self.units)?;
        let eigenvalues = linear::rates(&around.matrix);
        let positive = |mass: &DMatrix<f64>| {
            let symmetric = (mass + mass.transpose()) * 0.5;
            symmetric.cholesky().is_some()
        };
        let potential = around.potential.filter(|(_, mass)| positive(mass));
        let kind = potential.map(|(second, _)| Kind::of(&second));
        let modes = self.modes(&around.matrix, &eigenvalues, &around.displacements);
        Some((kind, eigenvalues, modes))
    }

    /// The modes, with the displacement of every coordinate.
    fn modes(
        &self,
        matrix: &DMatrix<f64>,
        eigenvalues: &[[f64; 2]],
        displacements: &DMatrix<f64>,
    ) -> Vec<Mode> {
        let resting = &self.unknowns[..displacements.nrows()];
        let units: Vec<f64> = resting.iter().map(|&i| self.units[i]).collect();
        let every = |some: &[f64]| {
            let mut all = vec![0.0; self.degrees];
            resting.iter().zip(some).for_each(|(&i, &x)| all[i] = x);
            all
        };
        let found = modes(matrix, eigenvalues, displacements, &units).into_iter();
        let whole = found.map(|mode| Mode {
            in_phase: every(&mode.in_phase),
            quadrature: every(&mode.quadrature),
            ..mode
        });
        whole.collect()
    }
}

/// The kind, the eigenvalues and the modes of an equilibrium.
type Around = (Option<Kind>, Vec<[f64; 2]>, Vec<Mode>);

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
