//! Equilibria and the small oscillations about them.
//!
//! In: a phase space and where to search. Out: every place in reach where the rates vanish; with
//! cyclic coordinates also where all others rest while these keep moving with their momenta (relative
//! equilibria), with kind, eigenvalues, frequencies and modes; under constraints the places on their surface
//! (`constrained_balance`). Never here: text.
//!
//! The places are found by Newton's method with many guesses (a sequence of Halton's), so that
//! what is found is certain and what is not found is likely, but not certain, to be absent. The
//! kind is that of the effective potential: the least energy at fixed coordinates, whose second
//! derivative is H_qq − H_qp H_pp⁻¹ H_pq.

mod acceptance;
mod equivalence;
mod family;
mod guesses;
mod search;
mod zero;

use nalgebra::{DMatrix, DVector};

use super::equilibrium::{Equilibria, Equilibrium, in_order};
use super::equilibrium_kind::{EquilibriumKind, Signature};
use super::error::DynamicsError;
use super::linear;
use super::phase_space::PhaseSpace;
use super::small_oscillation::{LinearMotion, Mode, growth_errors, linear_motion, modes};
use super::virtual_work::virtual_work;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::{Form, MotionErrorKind, State};
use family::{Belonging, EquilibriumFamily};
use search::{EquilibriumSearch, LawAtRest};

const MOST: usize = 100;

/// The error of the second derivative of a potential along the surface of constraints, as a part of its largest entry.
const ON_SURFACE: f64 = 1e-12;

/// The rounding error of an entry of the derivative of the rates, as a part of it.
const ENTRY: f64 = 8.0 * f64::EPSILON;

/// Gradients of Casimirs depend on each other up to this part of the largest.
const DEPENDENT: f64 = 1e-8;

/// Writes into each equilibrium the forces that balance there, and removes the places at which they do not balance: next to a
/// singularity, and where they are zero only because their values are below the smallest number.
pub fn with_virtual_work(
    law: (&Model, &Equations),
    parameters: &[f64],
    found: &mut Vec<Equilibrium>,
) {
    let places: Vec<_> =
        found.iter().map(|one| (&one.variables[..], &one.units[..], &one.rates[..])).collect();
    let balances = virtual_work(law, parameters, &places);
    let mut balanced = vec![true; found.len()];
    for ((one, balanced), balance) in found.iter_mut().zip(&mut balanced).zip(balances) {
        (one.work, one.multipliers, *balanced) = (balance.work, balance.multipliers, balance.holds);
    }
    let mut balanced = balanced.into_iter();
    found.retain(|_| balanced.next().unwrap_or(true));
}

/// Searches around the coordinates of `start`; cyclic coordinates have its momenta.
///
/// # Errors
/// Returns an error if the law of motion depends on time.
pub fn equilibria(space: &PhaseSpace, start: &State) -> Result<Equilibria, DynamicsError> {
    equilibria_watched(space, start, &mut |_, _| ())
}

/// Searches as [`equilibria`] does. Before each of its searches it reports how many have been made, and how many there
/// will be as far as is known.
///
/// # Errors
/// Returns an error if the law of motion depends on time.
pub fn equilibria_watched(
    space: &PhaseSpace,
    start: &State,
    report: &mut dyn FnMut(usize, usize),
) -> Result<Equilibria, DynamicsError> {
    if !space.is_autonomous() {
        return Err(DynamicsError::Unsuited(
            "the law of motion depends on time, and nothing stays at rest in it".to_owned(),
        ));
    }
    let mut search = EquilibriumSearch::new(space, start)?;
    let mut found: Vec<Equilibrium> = Vec::new();
    let mut families: Vec<EquilibriumFamily> = Vec::new();
    let (mut cancelled, mut is_complete) = (false, true);
    let (mut guess, mut searched) = (0, 0);
    // laws are often the same in a mirror, and so are their equilibria; others may lie close by
    let mut further: Vec<Vec<f64>> = Vec::new();
    let mut crossings: Vec<Vec<f64>> = Vec::new();
    let guesses = search.guesses();
    while guess < guesses || !further.is_empty() {
        if space.system().cancel().is_cancelled() {
            cancelled = true;
            break;
        }
        report(searched, searched + further.len() + guesses - guess);
        searched += 1;
        let place = further.pop().unwrap_or_else(|| {
            guess += 1;
            search.guess(guess - 1)
        });
        let Some(variables) = search.from(place) else { continue };
        if found.iter().any(|known| search.alike(&known.variables, &variables)) {
            continue;
        }
        let is_degenerate = search.is_degenerate(&variables);
        if is_degenerate
            && (families.iter_mut().any(|one| search.belongs(one, &variables))
                || crossings.iter().any(|one| search.is_beside(one, &variables)))
        {
            continue;
        }
        let belonging =
            if is_degenerate { search.belonging(&variables) } else { Belonging::Isolated };
        let mut family = match belonging {
            Belonging::Isolated => None,
            Belonging::Member(family) => Some(family),
            Belonging::Crossing(places) => {
                further.extend(places);
                crossings.push(variables);
                continue;
            }
        };
        let Some(one) = search.described(&variables, family.as_ref())? else { continue };
        let known = found.iter().any(|known| match family {
            // a minimum and a maximum are two, however near
            None if (known.kind == one.kind
                || [known.kind, one.kind].contains(&Some(EquilibriumKind::Degenerate)))
                && search.is_lost_between(&known.variables, &variables) =>
            {
                true
            }
            // its parts may meet where no walk leads through, and have one nearest member all the same
            Some(_) => search.alike(&known.variables, &one.variables),
            None => search.is_flat_between(known, &one),
        });
        if known {
            families.extend(family);
            continue;
        }
        further.extend(search.images(&variables));
        if family.is_none() {
            further.extend(search.beside(&variables));
        }
        if let Some(family) = &mut family
            && matches!(search.law, LawAtRest::Free(_))
        {
            // members from which no walk led on, before the family was known
            found.retain(|known| {
                let alone = known.family.is_empty() && search.is_degenerate(&known.variables);
                !(alone && search.belongs(family, &known.variables))
            });
        }
        families.extend(family);
        found.push(one);
        if found.len() == MOST {
            is_complete = guess == guesses && further.is_empty();
            break;
        }
    }
    in_order(&mut found);
    let periods = search.unknowns.iter().filter_map(|&i| Some((i, space.turns()[i]?))).collect();
    Ok(Equilibria { found, periods, cancelled, is_complete })
}

impl EquilibriumSearch<'_> {
    /// The equilibrium at these variables, or of a family the one nearest to the start.
    fn described(
        &mut self,
        variables: &[f64],
        family: Option<&EquilibriumFamily>,
    ) -> Result<Option<Equilibrium>, DynamicsError> {
        let nearest = family.and_then(|family| self.representative(family));
        let (nearest, along) = nearest.unwrap_or((variables.to_vec(), Vec::new()));
        let variables = &nearest[..];
        let tangents: Vec<_> = along.iter().filter_map(|one| self.tangent(one)).collect();
        let state = match &self.law {
            LawAtRest::Free(_) => self.space.state_at(self.start, variables),
            LawAtRest::Constrained(balance) => match balance.state(variables) {
                Ok(state) => state,
                Err(_) => return Ok(None),
            },
        };
        let energy = match self.space.system().energy(&state, self.space.parameters()) {
            Ok(energy) => energy,
            Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error.into()),
            Err(_) => return Ok(None),
        };
        let found = match &mut self.law {
            LawAtRest::Free(_) => self.around(variables, &along),
            LawAtRest::Constrained(_) => self.around_on_surface(variables, tangents.len()),
        };
        let Some(Around { kind, eigenvalues, linear, is_extremum, modes }) = found else {
            return Ok(None);
        };
        let stable = match linear {
            _ if is_extremum => Some(true),
            LinearMotion::Grows => Some(false),
            LinearMotion::Damped => Some(true),
            LinearMotion::Bounded | LinearMotion::Open => None,
        };
        let rates = match &self.law {
            LawAtRest::Free(field) => {
                let (rate, derivative) = (field.rate(), field.derivative());
                // what the place leaves uncertain of a rate that vanishes, as that of a charge at p = A(q)
                let uncertain = |i: usize| {
                    let sizes = variables.iter().zip(&self.units).map(|(x, unit)| x.abs() + unit);
                    sizes
                        .enumerate()
                        .map(|(j, size)| (derivative[(i, j)] * size).abs())
                        .sum::<f64>()
                };
                let known = |i: usize| {
                    let vanishes = rate[i].abs() <= search::ROUNDED * uncertain(i);
                    if vanishes { 0.0 } else { rate[i] }
                };
                self.cyclic.iter().map(|&i| (i, known(i))).collect()
            }
            LawAtRest::Constrained(_) => {
                self.cyclic.iter().map(|&i| (i, variables[self.degrees + i])).collect()
            }
        };
        let variables = self.space.variables(&state).to_vec();
        let (work, multipliers) = (Vec::new(), Vec::new());
        Ok(Some(Equilibrium {
            name: String::new(),
            variables,
            units: self.units[..self.degrees].to_vec(),
            energy,
            kind,
            family: tangents,
            eigenvalues,
            modes,
            stable,
            linear,
            rates,
            work,
            multipliers,
        }))
    }

    /// How many Casimirs have gradients at a place that do not depend on each other.
    fn independent_casimirs(&mut self, variables: &[f64]) -> usize {
        let count = self.casimirs.len();
        if count == 0 {
            return 0;
        }
        let Some((_, slopes)) = self.equations_in_units(variables) else { return 0 };
        let gradients = slopes.rows(slopes.nrows() - count, count).into_owned();
        independent(&gradients)
    }

    /// The kind, the eigenvalues and the modes at a place, of variables that are independent, on a family with these directions.
    fn around(&mut self, variables: &[f64], along: &[DVector<f64>]) -> Option<Around> {
        let (df, error) = self.slopes(variables, along)?;
        // across their level sets eigenvalues are zero
        let across = self.independent_casimirs(variables);
        let count = self.unknowns.len();
        let unit = |k: usize| self.units[self.unknowns[k]];
        let in_units = DMatrix::from_fn(count, count, |i, j| df[(i, j)] * unit(j) / unit(i));
        let canonical = self.space.form() == Form::Momentum;
        let inertia = canonical.then(|| Signature::of_canonical(&df, &error));
        let flat = inertia.map_or(0, |inertia| inertia.flat).max(along.len());
        let eigenvalues = if canonical && flat == 0 {
            linear::rates(&df)
        } else {
            linear::rates_beside_kernel(&in_units, flat)?
        };
        let error_in_units =
            DMatrix::from_fn(count, count, |i, j| error[(i, j)] * unit(j) / unit(i));
        let errors =
            growth_errors(&in_units, &(error_in_units + in_units.abs() * ENTRY), &eigenvalues);
        let independent = eigenvalues.len().saturating_sub(across);
        let within = &eigenvalues[..independent];
        let linear = linear_motion(&in_units, within, &errors[..independent]);
        let Some(inertia) = inertia else {
            // oscillations in a plane are around an extremum of the energy on the level sets
            let is_extremum = self.space.is_conservative()
                && self.space.is_unforced()
                && within.len() == 2
                && linear == LinearMotion::Bounded;
            let modes = Vec::new();
            return Some(Around { kind: None, eigenvalues, linear, is_extremum, modes });
        };
        let kind = if along.is_empty() { inertia.kind() } else { EquilibriumKind::Degenerate };
        let is_least = kind == EquilibriumKind::Minimum && self.space.is_passive();
        let is_greatest = || {
            let hamiltonian = self.space.is_hamiltonian() && along.is_empty();
            hamiltonian && Signature::of_energy(&df, &error).kind() == EquilibriumKind::Maximum
        };
        let is_extremum = is_least || is_greatest();
        let places = DMatrix::identity(count / 2, count);
        let half = count / 2;
        let mass = df.view((0, half), (half, half)).into_owned().try_inverse();
        let mass = mass.map(|mass| {
            DMatrix::from_fn(half, half, |i, j| {
                f64::midpoint(mass[(i, j)], mass[(j, i)]) * (unit(i) * unit(j))
            })
        });
        let mass = mass.filter(|mass| mass.clone().cholesky().is_some());
        // V has a strict minimum, and so has the energy where T is positive
        let is_flat_minimum = kind == EquilibriumKind::Degenerate
            && along.is_empty()
            && mass.is_some()
            && self.space.is_passive()
            && self.space.has_one_strict_minimum();
        let is_extremum = is_extremum || is_flat_minimum;
        let modes = self.modes(&in_units, (&eigenvalues, &errors), &places, mass.as_ref());
        Some(Around { kind: Some(kind), eigenvalues, linear, is_extremum, modes })
    }

    /// The same of displacements along the surface of constraints.
    fn around_on_surface(&mut self, variables: &[f64], family: usize) -> Option<Around> {
        let LawAtRest::Constrained(balance) = &mut self.law else { return None };
        let around = balance.around(variables, &self.units)?;
        let eigenvalues = linear::rates_beside_kernel(&around.matrix, family)?;
        let positive = |mass: &DMatrix<f64>| {
            let symmetric = (mass + mass.transpose()) * 0.5;
            symmetric.cholesky().is_some()
        };
        let potential = around.potential.filter(|(_, mass)| positive(mass));
        let kind = potential.map(|(second, _)| match family {
            0 => {
                let error = second.map(|_| ON_SURFACE * second.amax());
                Signature::of(&second, &error).kind()
            }
            _ => EquilibriumKind::Degenerate,
        });
        let error = around.matrix.map(|_| ON_SURFACE * around.matrix.amax());
        let errors = growth_errors(&around.matrix, &error, &eigenvalues);
        let linear = linear_motion(&around.matrix, &eigenvalues, &errors);
        let (known, displacements) = ((&eigenvalues[..], &errors[..]), &around.displacements);
        let mut modes = self.modes(&around.matrix, known, displacements, None);
        for mode in &mut modes {
            mode.frequency /= around.time;
        }
        let eigenvalues = eigenvalues.into_iter().map(|z| z.map(|x| x / around.time)).collect();
        let is_extremum = kind == Some(EquilibriumKind::Minimum) && self.space.is_passive();
        Some(Around { kind, eigenvalues, linear, is_extremum, modes })
    }

    /// The modes, with the displacement of every coordinate.
    fn modes(
        &self,
        matrix: &DMatrix<f64>,
        known: (&[[f64; 2]], &[f64]),
        displacements: &DMatrix<f64>,
        mass: Option<&DMatrix<f64>>,
    ) -> Vec<Mode> {
        let resting = &self.unknowns[..displacements.nrows()];
        let units: Vec<f64> = resting.iter().map(|&i| self.units[i]).collect();
        let every = |some: &[f64]| {
            let mut all = vec![0.0; self.degrees];
            resting.iter().zip(some).for_each(|(&i, &x)| all[i] = x);
            all
        };
        let found = modes(matrix, known, displacements, (&units, mass)).into_iter();
        let whole = found.map(|mode| Mode {
            in_phase: every(&mode.in_phase),
            quadrature: every(&mode.quadrature),
            ..mode
        });
        whole.collect()
    }
}

struct Around {
    kind: Option<EquilibriumKind>,
    eigenvalues: Vec<[f64; 2]>,
    linear: LinearMotion,
    /// Whether it is a strict minimum of an energy that does not grow, or a strict maximum of one that is conserved.
    is_extremum: bool,
    modes: Vec<Mode>,
}

/// How many rows do not depend on each other.
fn independent(rows: &DMatrix<f64>) -> usize {
    let sizes = rows.singular_values();
    sizes.iter().filter(|size| **size > DEPENDENT * sizes.max()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_independent_from_a_hundred_millionth_on() {
        for (off, count) in [(1.8e-8, 1), (2.2e-8, 2)] {
            // the singular values are 1 and a half of it
            let rows = DMatrix::from_row_slice(2, 2, &[1.0, off, 1.0, 0.0]);
            assert_eq!(independent(&rows), count, "{off}");
        }
    }
}
